"""The picture of a model, by its type."""

from functools import singledispatch
from typing import Any

from dalembert.multibody.model.system import BaseSystem
from dalembert.multibody.motion.sketch import sketch
from dalembert.report.pictures.canvas import SIZE
from dalembert.report.pictures.svg import scene_picture
from dalembert.report.scene.mechanism import mechanism_scene
from dalembert.report.scene.structure import structure_scene
from dalembert.vibration import VibrationSystem


@singledispatch
def picture(model: Any, label: str = "Drawing of the model", size: tuple[int, int] = SIZE) -> str | None:
    """Return a picture of a model as SVG; None for a model that has no shape, such as a Python function.

    Its colours can be seen on light and on dark pages. Each part of the model is a group with the attribute
    ``data-part``, its name.

    Parameters
    ----------
    model : System, SpatialSystem, VibrationSystem or another
    label : str
        Description for screen readers.
    size : (int, int)
        Width and height in pixels.

    Raises
    ------
    ModelError
        Where the mechanism cannot be assembled.

    Examples
    --------
    >>> from dalembert.multibody import RevoluteJoint, RigidBar, System
    >>> system = System()
    >>> rod = system.add(RigidBar("rod", length=1.0, mass=1.0))
    >>> joint = system.add(RevoluteJoint("pin", system.ground, rod.start))
    >>> 'data-part="rod"' in picture(system)
    True
    """
    return None


@picture.register
def _(model: BaseSystem, label: str = "Drawing of the mechanism", size: tuple[int, int] = SIZE) -> str | None:
    return scene_picture(mechanism_scene(sketch(model)), label, size) if model.bodies else None


@picture.register
def _(model: VibrationSystem, label: str = "Drawing of the structure", size: tuple[int, int] = SIZE) -> str | None:
    scene = structure_scene(model)
    return None if scene is None else scene_picture(scene, label, size)
