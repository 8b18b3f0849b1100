"""The SVG picture of a scene."""

from collections.abc import Callable
from dataclasses import replace
from itertools import groupby

import numpy as np

from dalembert.report.pictures.canvas import COLOURS, FAINT, INK, SIZE, Canvas, between, moved
from dalembert.report.pictures.colour_bar import ROOM, draw_bar, graded
from dalembert.report.pictures.labels import draw_labels
from dalembert.report.pictures.projection import Projection
from dalembert.report.pictures.row import row_picture
from dalembert.report.scene.scene import Primitive, Scene

MOST_FACES = 1500
"""Faces of all surfaces above which bodies are drawn as lines."""
MANY_FACES = 1200
"""Faces of a mesh above which their sides are not drawn."""
BEHIND = ("outline", "path", "measured")
"""Roles of what is drawn behind the bodies."""
NEAR = 4.0
"""Distance in pixels below which two points count as one."""


def scene_picture(
    scene: Scene,
    label: str,
    size: tuple[int, int] = SIZE,
    *,
    box: np.ndarray | None = None,
    choosable: bool = False,
    labels: bool = False,
) -> str:
    """Return the SVG picture of a scene in its first frame. Each part is a group ``<g class="ROLE" data-part="NAME">``.
    ``label``: for screen readers; ``size``: pixels; ``box`` (2, 2): corners of the picture, m, around all points if not
    given; ``choosable``: whether the parts are buttons; ``labels``: whether those of the scene are drawn. The edges of
    a motion in the plane have values in m.
    """
    if not scene.to_scale:
        return row_picture(scene, label, size, choosable)
    view = Projection.of(scene.dimensions)
    corners = view(scene.positions) if box is None else box
    if scene.bar is not None:
        beside = corners.max(axis=0) + np.array([ROOM * float(np.ptp(corners[:, 0])), 0.0])
        corners = np.vstack([corners, beside])
    canvas = Canvas.around(corners, size, choosable)
    if view.flat and len(scene.times) > 1:
        canvas.axes()
    start = scene.start
    if scene.bar is not None:  # values as shares of the bar
        graded_shapes = (
            shape if shape.values is None else replace(shape, values=shape.values / scene.bar.highest)
            for shape in start.primitives
        )
        start = replace(start, primitives=tuple(graded_shapes))
    shapes = _from_far_to_near(start, view)
    for (role, name), part in groupby(shapes, lambda shape: (shape.role, shape.name)):
        with canvas.part(name, role):
            for shape in part:
                DRAW[shape.kind](canvas, view, shape)
    if scene.gravity is not None:
        _gravity(canvas, view, scene)
    if scene.bar is not None:
        draw_bar(canvas, scene.bar)
    if labels:
        draw_labels(canvas, view, scene)
    return canvas.svg(label)


def _from_far_to_near(scene: Scene, view: Projection) -> list[Primitive]:
    """Shapes with each body as a surface or as a line: surfaces before lines, the farthest first, and paths behind."""
    behind = [shape for shape in scene.primitives if shape.role in BEHIND]
    primitives = [shape for shape in scene.primitives if shape.role not in BEHIND]
    surfaces = {shape.part: shape for shape in primitives if shape.kind == "surface"}
    if sum(len(shape.faces) for shape in surfaces.values() if shape.faces is not None) > MOST_FACES:
        surfaces = {}
    lines = [shape for shape in primitives if shape.kind == "line" and shape.role != "axis"]
    depth = {shape.part: float(np.nanmean(view.depth(shape.points[0]))) for shape in [*surfaces.values(), *lines]}
    bodies = {shape.part: shape for shape in lines} | surfaces
    ordered = sorted(bodies.values(), key=lambda shape: (shape.kind == "line", depth[shape.part]))
    first = next((k for k, shape in enumerate(primitives) if shape.kind in ("line", "surface")), 0)
    symbols = [shape for shape in primitives if shape.kind not in ("line", "surface") or shape.role == "axis"]
    return [*behind, *symbols[:first], *ordered, *symbols[first:]]


def _line(canvas: Canvas, view: Projection, shape: Primitive) -> None:
    points = shape.points[0]
    pixels = canvas.at(view(points))
    if shape.role in ("outline", "path", "axis"):
        styles = {"outline": (FAINT, 2.5, ""), "path": (INK, 1.2, "0.5 3.5"), "axis": (_colour(shape), 2, "")}
        canvas.stroke(pixels, *styles[shape.role])
    elif float(np.ptp(pixels, axis=0).max()) < NEAR:
        canvas.circle(pixels[0], 8, _colour(shape))
    else:
        canvas.stroke(pixels, _colour(shape), 5 if len(np.unique(points, axis=0)) < 5 or view.flat else 3)


def _faces(canvas: Canvas, view: Projection, shape: Primitive) -> None:
    """Faces from the farthest to the nearest; those of one colour that follow each other in one path."""
    assert shape.faces is not None
    points, faces, colour = shape.points[0], shape.faces, _colour(shape)
    is_mesh = shape.kind == "mesh"
    pixels, has_sides = canvas.at(view(points)), is_mesh and len(faces) <= MANY_FACES
    first, second, third = (points[faces[:, corner]] for corner in range(3))
    bright = view.brightness(np.cross(second - first, third - first))
    bright = (0.3 + 0.35 * bright).round(2) if is_mesh else (0.55 * bright).round(2)
    ordered = np.argsort(view.depth(points)[faces].mean(axis=1), kind="stable")
    corners = [_one_way(pixels[face]) for face in faces]
    if shape.values is None:
        shades = [between(colour, "#ffffff", float(share)) for share in bright]
    else:
        shades, has_sides = graded(shape.values[0][faces].mean(axis=1)), False
    for shade, run in groupby(ordered, lambda face: shades[face]):
        shapes = [corners[face].round() if is_mesh and not has_sides else corners[face] for face in run]
        canvas.polygons(shapes, shade, colour if has_sides else shade, 0.25 if has_sides else 0.6)


def _one_way(corners: np.ndarray) -> np.ndarray:
    """Corners of a face, all faces in the same sense: shapes of one path would cancel where they overlap."""
    x, y = (corners - corners.mean(axis=0)).T
    return corners if float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))) >= 0 else corners[::-1]


def _edges(canvas: Canvas, view: Projection, shape: Primitive) -> None:
    pairs = canvas.at(view(shape.points[0])).reshape(-1, 2, 2)
    lines = np.full((len(pairs), 3, 2), np.nan)
    lines[:, :2] = pairs
    canvas.stroke(lines.reshape(-1, 2), _colour(shape), 1.2)


def _dashes(canvas: Canvas, view: Projection, shape: Primitive) -> None:
    ends = canvas.at(view(shape.points[0]))
    if np.linalg.norm(ends[1] - ends[0]) > NEAR:
        canvas.stroke(ends, _colour(shape), 1.5, "5 4")


def _crosses(canvas: Canvas, view: Projection, shape: Primitive) -> None:
    arms = np.array([(-3, -3), (3, 3), (np.nan, np.nan), (-3, 3), (3, -3), (np.nan, np.nan)])
    canvas.stroke((canvas.at(view(shape.points[0]))[:, None] + arms).reshape(-1, 2), _colour(shape), 1)


def _points(canvas: Canvas, view: Projection, shape: Primitive) -> None:
    points = shape.points[0]
    colours = [_colour(shape)] * len(points) if shape.values is None else graded(shape.values[0])
    for pixel, colour in zip(canvas.at(view(points)), colours, strict=True):
        canvas.circle(pixel, 1.5 if shape.values is None else 3, colour)


def _arrow(canvas: Canvas, view: Projection, shape: Primitive) -> None:
    """An arrow with its head at the point; a dot where it points at the eye."""
    assert shape.along is not None
    head, along = canvas.at(view(shape.points[0]))[0], view(shape.along[None])[0] * (1, -1)
    length = float(np.linalg.norm(along))
    if length > 1e-9:
        canvas.arrow(head - (34 if shape.role == "force" else 44) * along / length, head, _colour(shape))
    else:
        canvas.circle(head, 3, _colour(shape))


def _turn(canvas: Canvas, view: Projection, shape: Primitive) -> None:
    turn = np.linspace(-0.4, 4.2, 24)
    arc = canvas.at(view(shape.points[0]))[0] + 13 * np.column_stack([np.cos(turn), np.sin(turn)])
    canvas.stroke(arc[:-2], _colour(shape), 2)
    canvas.arrow(arc[-3], arc[-3] + 3 * (arc[-1] - arc[-3]), _colour(shape))


def _spot(radius: float, fill: str = "", stroke: bool = False) -> Callable[[Canvas, Projection, Primitive], None]:
    """A circle at the point of a shape: filled with its colour or another, with or without its stroke."""

    def draw(canvas: Canvas, view: Projection, shape: Primitive) -> None:
        colour = _colour(shape)
        canvas.circle(canvas.at(view(shape.points[0]))[0], radius, fill or colour, colour if stroke else "none")

    return draw


DRAW: dict[str, Callable[[Canvas, Projection, Primitive], None]] = {
    "line": _line,
    "surface": _faces,
    "mesh": _faces,
    "edges": _edges,
    "dashes": _dashes,
    "crosses": _crosses,
    "points": _points,
    "arrow": _arrow,
    "turn": _turn,
    "spring": lambda canvas, view, shape: canvas.spring(*canvas.at(view(shape.points[0]))),
    "ground": lambda canvas, view, shape: canvas.ground(canvas.at(view(shape.points[0]))[0]),
    "joint": _spot(4, "#fffffe", stroke=True),
    "ring": _spot(8.5, "none", stroke=True),
    "dot": _spot(3),
    "point": _spot(2.5),
}
"""How shapes are drawn, by their kind."""


def _colour(shape: Primitive) -> str:
    return INK if shape.colour < 0 else COLOURS[shape.colour % len(COLOURS)]


def _gravity(canvas: Canvas, view: Projection, scene: Scene) -> None:
    """An arrow along gravity, in the corner that is farthest from the bodies."""
    assert scene.gravity is not None
    pull = view(scene.gravity[None])[0] * (1, -1)
    if (strength := float(np.linalg.norm(pull))) < 1e-9:
        return
    width, height = canvas.size
    corners = np.array([(x, y) for y in (26.0, height - 26.0) for x in (width - 26.0, 26.0)])
    drawn = [_between(canvas.at(view(shape.points[0]))) for shape in scene.primitives if shape.kind == "line"]
    gap = np.linalg.norm(corners[:, None] - np.concatenate(drawn), axis=2).min(axis=1)
    centre = corners[int(np.argmax(np.minimum(gap, 60.0)))]
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
