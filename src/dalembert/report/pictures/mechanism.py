"""The picture of a mechanism in the plane or in space."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from dalembert.multibody.components.base_joint import BaseJoint
from dalembert.multibody.motion.sketch import Sketch, is_grounded
from dalembert.report.charts.motion.outlines import NAMED_BODIES
from dalembert.report.pictures.canvas import COLOURS, INK, SIZE, Canvas, between, moved
from dalembert.report.pictures.projection import Projection

MOST_TRIANGLES = 1500
TURNING = ("torque", "motor", "servo")
"""Kinds of loads that are drawn as a turn."""
NEAR = 4.0
"""Distance in pixels below which two ends of a joint count as one."""


def mechanism_picture(sketch: Sketch, label: str, size: tuple[int, int] = SIZE) -> str:
    """Return the SVG picture of a mechanism: bodies, joints, springs, forces and the direction of gravity.

    Each part is a group ``<g class="ROLE" data-part="NAME">``; roles are body, joint, load and gravity.

    Parameters
    ----------
    sketch : Sketch
    label : str
        For screen readers.
    size : (int, int)
        Pixels.
    """
    view = Projection.of(len(sketch.system.AXES))
    canvas = Canvas.around(view(sketch.positions), size)
    draw_mechanism(canvas, view, sketch)
    return canvas.svg(label)


def draw_mechanism(canvas: Canvas, view: Projection, sketch: Sketch) -> None:
    """Draw the parts of a mechanism."""
    _bodies(canvas, view, sketch)
    for load in sketch.system.loads:
        _load(canvas, view, load, sketch)
    for joint in sketch.system.joints:
        _joint(canvas, view, joint, sketch)
    _gravity(canvas, view, sketch)


def _bodies(canvas: Canvas, view: Projection, sketch: Sketch) -> None:
    """Bodies from the farthest to the nearest: shapes as surfaces, others as lines."""
    drawing, many = sketch.drawing, len(sketch.drawing.lines) > NAMED_BODIES
    shaped = dict(drawing.surfaces)
    if sum(len(surface.triangles) for surface in shaped.values()) > MOST_TRIANGLES:
        shaped = {}
    colours = {name: COLOURS[0 if many else place] for place, name in enumerate(drawing.lines)}
    depth = {name: float(view.depth(line[0]).mean()) for name, line in drawing.lines.items()}
    for name in sorted(drawing.lines, key=lambda name: (name not in shaped, depth[name])):
        with canvas.part(name, "body"):
            if name in shaped:
                _surface(canvas, view, drawing.corners(name)[0], shaped[name].triangles, colours[name])
            else:
                _line(canvas, view, drawing.lines[name][0], colours[name])


def draw_measured(canvas: Canvas, view: Projection, measured: Mapping[str, np.ndarray]) -> None:
    """Draw crosses at measured positions (samples, 2 or 3) of points."""
    for name, positions in measured.items():
        arms = np.array([(-3, -3), (3, 3), (np.nan, np.nan), (-3, 3), (3, -3), (np.nan, np.nan)])
        with canvas.part(name, "measured"):
            canvas.stroke((canvas.at(view(positions))[:, None] + arms).reshape(-1, 2), INK, 1)


def _line(canvas: Canvas, view: Projection, points: np.ndarray, colour: str) -> None:
    pixels = canvas.at(view(points))
    if float(np.ptp(pixels, axis=0).max()) < NEAR:
        canvas.circle(pixels[0], 8, colour)
    else:
        canvas.stroke(pixels, colour, 5 if len(np.unique(points, axis=0)) < 5 or view.flat else 3)


def _surface(canvas: Canvas, view: Projection, corners: np.ndarray, triangles: np.ndarray, colour: str) -> None:
    """Triangles from the farthest to the nearest, each as bright as its direction to the light says."""
    pixels, depth = canvas.at(view(corners)), view.depth(corners)
    first, second, third = (corners[triangles[:, corner]] for corner in range(3))
    normals = np.cross(second - first, third - first)
    bright = view.brightness(normals)
    for place in np.argsort(depth[triangles].mean(axis=1)):
        shade = between(colour, "#ffffff", 0.55 * float(bright[place]))
        canvas.polygons([pixels[triangles[place]]], shade, shade)


def _joint(canvas: Canvas, view: Projection, joint: Any, sketch: Sketch) -> None:
    ends = canvas.at(view(sketch.ends[joint.name])) if joint.name in sketch.ends else None
    drawn = sketch.drawing.joints.get(joint.name)
    centre = canvas.at(view(drawn[:1]))[0] if drawn is not None else _centre(joint, ends) if ends is not None else None
    if centre is None:
        return
    with canvas.part(joint.name, "joint"):
        if ends is not None and len(ends) == 2 and np.linalg.norm(ends[1] - ends[0]) > NEAR:
            canvas.stroke(ends, INK, 1.5, "5 4")
        if is_grounded(joint):
            canvas.ground(ends[0] if ends is not None and len(ends) == 2 else centre)
        canvas.circle(centre, 4, "#fffffe", INK)


def _centre(joint: Any, ends: np.ndarray) -> np.ndarray:
    """Where a joint without a position is drawn: at its second side, and a coupling between its joints."""
    return ends.mean(axis=0) if isinstance(joint.a, BaseJoint) else ends[-1]


def _load(canvas: Canvas, view: Projection, load: Any, sketch: Sketch) -> None:
    if load.name not in sketch.ends:
        return
    ends = canvas.at(view(sketch.ends[load.name]))
    with canvas.part(load.name, "load"):
        if hasattr(load, "joint"):
            canvas.circle(ends[0], 9, "none", COLOURS[1])
        elif turns(load):
            turn = np.linspace(-0.4, 4.2, 24)
            arc = ends[0] + 13 * np.column_stack([np.cos(turn), np.sin(turn)])
            canvas.stroke(arc[:-2], COLOURS[1], 2)
            canvas.arrow(arc[-3], arc[-3] + 3 * (arc[-1] - arc[-3]), COLOURS[1])
        elif len(ends) == 2:
            canvas.spring(*ends)
        elif (along := _pull(view, sketch, load.name)) is not None:
            canvas.arrow(ends[0] - 44 * along, ends[0], COLOURS[3])
        else:
            canvas.circle(ends[0], 3, COLOURS[1])


def turns(load: Any) -> bool:
    """Return True for a torque or a drive."""
    return load.kind.name.removesuffix("_in_space") in TURNING


def _pull(view: Projection, sketch: Sketch, load: str) -> np.ndarray | None:
    """Direction of a force in pixels; None for other loads, and for one without a direction in the picture."""
    if load not in sketch.forces:
        return None
    along = view(sketch.forces[load][None])[0] * (1, -1)
    length = float(np.linalg.norm(along))
    return along / length if length > 1e-9 * float(np.linalg.norm(sketch.forces[load])) else None


def _gravity(canvas: Canvas, view: Projection, sketch: Sketch) -> None:
    """An arrow along gravity, in the corner that is farthest from the bodies."""
    pull = view(np.real(np.array(sketch.system.gravity, dtype=complex))[None])[0] * (1, -1)
    if (strength := float(np.linalg.norm(pull))) < 1e-9:
        return
    width, height = canvas.size
    corners = np.array([(x, y) for y in (26.0, height - 26.0) for x in (width - 26.0, 26.0)])
    drawn = np.concatenate([_between(canvas.at(view(line[0]))) for line in sketch.drawing.lines.values()])
    room = np.linalg.norm(corners[:, None] - drawn, axis=2).min(axis=1)
    centre = corners[int(np.argmax(np.minimum(room, 60.0)))]
    step = 13 * pull / strength
    with canvas.part("gravity", "gravity"):
        canvas.arrow(centre - step, centre + step, INK)
        canvas.text(moved(centre, *((-13, 4) if abs(step[0]) < 9 else (0, 18))), "g")


def _between(pixels: np.ndarray) -> np.ndarray:
    """Ten points of each piece of a line."""
    if len(pixels) == 1:
        return pixels
    shares = np.linspace(0.0, 1.0, 10)[:, None, None]
    return ((1 - shares) * pixels[:-1] + shares * pixels[1:]).reshape(-1, 2)
