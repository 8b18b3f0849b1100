"""Structures in three dimensions: deformed shapes and modes."""

from typing import TYPE_CHECKING

from dalembert.report.player.animation import Animation
from dalembert.report.scene.shape import deformation_scene, mode_scene
from dalembert.structure import ModeShapes
from dalembert.tables import shown

if TYPE_CHECKING:
    from dalembert.vibration import Deformation


def deformation(shape: "Deformation", *, title: str | None = None) -> Animation:
    """The structure over a period, magnified, coloured by the largest displacement of each node in the period.

    Parameters
    ----------
    shape : Deformation
    title : str, optional

    Returns
    -------
    Animation
    """
    return Animation(deformation_scene(shape), title or f"Deformed shape at {shown(shape.frequency)} Hz")


def mode_shapes(modes: ModeShapes, *, title: str = "Mode shapes") -> Animation:
    """Each mode at its largest deflection, coloured by the size of the displacement; a slider takes one after another.

    Parameters
    ----------
    modes : ModeShapes
    title : str

    Returns
    -------
    Animation
    """
    return Animation(mode_scene(modes), title)
