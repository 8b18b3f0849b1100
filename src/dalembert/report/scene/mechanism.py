"""The scene of a mechanism in one pose."""

from collections.abc import Collection, Mapping
from typing import Any

import numpy as np

from dalembert.multibody.components.base_joint import BaseJoint
from dalembert.multibody.components.points import Point
from dalembert.multibody.model.drawing import Drawing
from dalembert.multibody.motion.sketch import Sketch, is_grounded
from dalembert.report.scene.scene import Label, Primitive, Scene, readable, unit_vector

FEW_BODIES = 7
"""Number of bodies above which all lines have one colour."""
TURNING = ("torque", "motor", "servo")
"""Kinds of loads that are drawn as a turn."""
NEAR = 1e-9
"""Distance in m below which two labels are at one point."""
Channels = Mapping[str, tuple[np.ndarray, list[str]]]
"""Positions (2 or 3,) in m and names of channels, by the point, joint or load that has them."""


def mechanism_scene(sketch: Sketch, channels: Channels | None = None, tables: Collection[str] | None = None) -> Scene:
    """Return bodies, loads, joints, points with channels and located points of a mechanism in one pose. ``tables`` are
    the parts that have tables. A load at the position of another label has a label only if it is among them: the drives
    of a robot would crowd its joints.
    """
    shapes = body_shapes(sketch.drawing)
    labels = [Label("body", name, line[0].mean(axis=0), name) for name, line in sketch.drawing.lines.items()]
    shapes += [_load(load, sketch) for load in sketch.system.loads if load.name in sketch.ends]
    for joint in sketch.system.joints:
        at = sketch.drawing.joints.get(joint.name)
        ends = sketch.ends.get(joint.name, at)
        if ends is not None:
            middle = ends.mean(axis=0) if at is None else at[0]
            labels.append(Label("joint", joint.name, middle, joint.name))
            is_between = at is None and isinstance(joint.a, BaseJoint)  # a coupling of joints
            shapes += _joint(joint, ends, middle if at is not None or is_between else ends[-1])
    for load in sketch.system.loads:
        if load.name in sketch.ends:
            label = Label("load", load.name, sketch.ends[load.name].mean(axis=0), load.name)
            named = tables is None or label.part in tables
            if named or not any(np.allclose(label.at, other.at, atol=NEAR) for other in labels):
                labels.append(label)
    for owner, (position, names) in (channels or {}).items():
        outputs = ", ".join(channel.rpartition(".")[2] for channel in names)
        shapes.append(Primitive("ring", "channel", names[0], position[None, None], 1))
        labels.append(Label("channel", names[0], position, f"{owner}: {outputs}", 1))
    shapes += [Primitive("point", "point", name, position[None, None]) for name, position in sketch.marks.items()]
    gravity = unit_vector(np.real(np.array(sketch.system.gravity, dtype=complex)))
    return Scene(tuple(shapes), readable(labels), gravity)


def body_shapes(drawing: Drawing) -> list[Primitive]:
    """Return the surface of the ground, and of each body its line and its surface if it has one."""
    shapes, ground = [], drawing.ground
    if ground is not None:
        shapes.append(Primitive("surface", "ground", "", ground.corners[None], faces=ground.triangles))
    for number, (name, line) in enumerate(drawing.lines.items()):
        has_surface = name in drawing.surfaces
        colour = number if has_surface or len(drawing.lines) <= FEW_BODIES else 0
        shapes.append(Primitive("line", "body", name, line, colour))
        if has_surface:
            faces = drawing.surfaces[name].triangles
            shapes.append(Primitive("surface", "body", name, drawing.corners(name), colour, faces))
    return shapes


def _joint(joint: Any, ends: np.ndarray, centre: np.ndarray) -> list[Primitive]:
    """Dashes between two sides, the ground at the fixed side, and the joint at its centre."""
    shapes = [Primitive("dashes", "joint", joint.name, ends[None])] if len(ends) == 2 else []
    if is_grounded(joint):
        fixed = ends[0] if isinstance(joint.b, Point) else ends[-1]
        shapes.append(Primitive("ground", "joint", joint.name, fixed[None, None]))
    return [*shapes, Primitive("joint", "joint", joint.name, centre[None, None])]


def _load(load: Any, sketch: Sketch) -> Primitive:
    """A ring at a driven joint, a turn for a torque, a spring between two points, an arrow along a force, or a dot."""
    ends = sketch.ends[load.name][None]
    if hasattr(load, "joint"):
        return Primitive("ring", "load", load.name, ends[:, :1], 1)
    if load.kind.name.removesuffix("_in_space") in TURNING:
        return Primitive("turn", "load", load.name, ends[:, :1], 1)
    if ends.shape[1] == 2:
        return Primitive("spring", "load", load.name, ends, 2)
    along = unit_vector(sketch.forces[load.name]) if load.name in sketch.forces else None
    return Primitive(
        "dot" if along is None else "arrow", "load", load.name, ends, 1 if along is None else 3, along=along
    )
