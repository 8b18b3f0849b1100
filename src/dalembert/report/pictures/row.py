"""The SVG picture of masses and springs in a row."""

from itertools import groupby

import numpy as np

from dalembert.report.look import LIGHT
from dalembert.report.pictures.canvas import COLOURS, INK, Canvas, between, moved
from dalembert.report.scene.scene import Primitive, Scene

BOX = 17.0
"""Half of a mass, in pixels."""


def row_picture(scene: Scene, label: str, size: tuple[int, int], choosable: bool) -> str:
    """Return masses in a row, springs between them and to the ground, forces on them and contacts below them."""
    count = sum(shape.kind == "mass" for shape in scene.primitives)
    zoom = 1.8 if count < 3 else 1.2
    width, height = (round(pixels / zoom) for pixels in size)
    canvas = Canvas(np.zeros(2), np.ones(2), (width, height), zoom, choosable)
    pitch = min(110.0, (width - 90.0) / count)
    first = np.array([width / 2 - pitch * (count - 1) / 2 + 18, height / 2])
    box = min(BOX, 0.3 * pitch)
    for (role, name), part in groupby(scene.primitives, lambda shape: (shape.role, shape.name)):
        with canvas.part(name, role):
            for shape in part:
                _draw(canvas, shape, first + shape.points[0] * (pitch, 0.0), box)
    return canvas.svg(label)


def _draw(canvas: Canvas, shape: Primitive, ends: np.ndarray, box: float) -> None:
    if shape.kind == "spring":
        _spring(canvas, shape, ends, box)
    elif shape.kind == "element":
        _element(canvas, shape, ends, box)
    elif shape.kind == "mass":
        wide = max(box, 3.3 * len(shape.name) + 3)
        corners = np.array([(-wide, -box), (wide, -box), (wide, box), (-wide, box)])
        canvas.polygons([ends[0] + corners], between(COLOURS[0], "#ffffff", 0.55), COLOURS[0], 1.5)
        canvas.text(moved(ends[0], 0, 4), shape.name, LIGHT.ink)
    elif shape.kind == "ring":
        canvas.circle(moved(ends[0], 0, -box), 5, "none", COLOURS[1])
    else:
        canvas.arrow(moved(ends[0], box + 4, -box / 2), moved(ends[0], box + 34, -box / 2), COLOURS[3])


def _spring(canvas: Canvas, shape: Primitive, ends: np.ndarray, box: float) -> None:
    """A zigzag to the wall or to the next mass; an arc above the masses to one farther away."""
    if len(ends) == 1:
        is_leftmost = shape.points[0, 0, 0] == 0
        away = np.array([-1.0, 0.0] if is_leftmost else [0.0, -1.0])
        wall, along = ends[0] + (box + 44) * away, away[::-1]
        canvas.spring(wall, ends[0])
        canvas.stroke(np.array([wall - 16 * along, wall + 16 * along]), INK, 1.5)
        for step in (-12, -4, 4, 12):
            canvas.stroke(np.array([wall + step * along, wall + (step + 5) * along + 5 * away]), INK, 1)
    elif np.ptp(shape.points[0, :, 0]) < 1.5:
        canvas.spring(*ends)
    else:
        canvas.stroke(_arc(moved(ends[0], 0, -box), moved(ends[1], 0, -box), -1), COLOURS[2], 1.5)


def _element(canvas: Canvas, shape: Primitive, ends: np.ndarray, box: float) -> None:
    """Hatching below a mass that rubs on the ground, an arc between two masses, a zigzag for any other element."""
    colour = COLOURS[shape.colour]
    if len(ends) == 2:
        canvas.stroke(_arc(moved(ends[0], 0, box), moved(ends[1], 0, box), 1), colour, 2)
    elif shape.role == "contact":
        x, y = moved(ends[0], 0, box + 3)
        canvas.stroke(np.array([[x - box - 8, y], [x + box + 8, y]]), colour, 2.5)
        for step in np.arange(-box - 4, box + 9, 7):
            canvas.stroke(np.array([[x + step, y], [x + step - 5, y + 6]]), colour, 1)
    else:
        x, y = moved(ends[0], 0, box)
        canvas.spring(np.array([x, y]), np.array([x, y + 38]))
        canvas.stroke(np.array([[x - 14, y + 38], [x + 14, y + 38]]), INK, 1.5)


def _arc(first: np.ndarray, second: np.ndarray, side: int) -> np.ndarray:
    """An arc below (1) or above (-1) two pixels."""
    shares = np.linspace(0.0, 1.0, 17)[:, None]
    high = side * min(44.0, 0.3 * float(np.linalg.norm(second - first)))
    return (1 - shares) * first + shares * second + 4 * shares * (1 - shares) * np.array([0.0, high])
