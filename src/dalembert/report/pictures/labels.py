"""Labels in a picture, where they cover least."""

import numpy as np

from dalembert.report.pictures.canvas import COLOURS, INK, Canvas
from dalembert.report.pictures.projection import Projection
from dalembert.report.scene.scene import Scene

LETTER, HEIGHT = 6.6, 14.0
"""Size of a letter in pixels."""
AROUND = tuple(
    (distance * np.cos(angle), distance * np.sin(angle))
    for distance in (16.0, 24.0, 34.0)
    for angle in np.pi * np.array([-0.25, 0.25, -0.75, 0.75, 0.0, 1.0, -0.5, 0.5])
)
"""Where a label may stand from the point that it belongs to, the best first."""


def draw_labels(canvas: Canvas, view: Projection, scene: Scene) -> None:
    """Draw the labels of a scene where they cover least."""
    labels = _Labels(canvas, _drawn(canvas, view, scene))
    for label in scene.labels:
        colour = INK if label.colour < 0 else COLOURS[label.colour]
        labels.put(canvas.at(view(label.at[None]))[0], label.text, colour)


def _drawn(canvas: Canvas, view: Projection, scene: Scene) -> np.ndarray:
    """Pixels along the bodies and at joints and loads, which labels should not cover."""
    shares = np.linspace(0.0, 1.0, 12)[:, None, None]
    pixels = [np.zeros((0, 2))]
    for shape in scene.primitives:
        ends = canvas.at(view(shape.points[0]))
        if shape.kind == "line":
            pixels.append(((1 - shares) * ends[:-1] + shares * ends[1:]).reshape(-1, 2))
        elif shape.role in ("joint", "load", "contact", "spring", "force"):
            pixels.append(ends)
    points = np.concatenate(pixels)
    return points[np.isfinite(points).all(axis=1)]


class _Labels:
    """Names that keep clear of each other and of the pixels ``drawn`` (points, 2), where they can."""

    def __init__(self, canvas: Canvas, drawn: np.ndarray) -> None:
        self.canvas, self.drawn = canvas, drawn
        self.boxes: list[np.ndarray] = []

    def put(self, pixel: np.ndarray, words: str, colour: str) -> None:
        """Write words near a pixel."""
        if not np.isfinite(pixel).all():
            return
        boxes = [self._box(pixel + np.array(step), words, step[0]) for step in AROUND]
        box = min(boxes, key=self._covered)
        self.boxes.append(box)
        self.canvas.text(np.array([box[0].mean(), box[1, 1] - 4]), words, colour)

    def _box(self, pixel: np.ndarray, words: str, right: float) -> np.ndarray:
        """Ranges (2, 2) along x and y of words that begin, end or lie at a pixel."""
        wide = LETTER * len(words)
        left = pixel[0] - wide * (0.5 if abs(right) < 1 else 0.0 if right > 0 else 1.0)
        return np.array([[left, left + wide], [pixel[1] - HEIGHT / 2, pixel[1] + HEIGHT / 2]])

    def _covered(self, box: np.ndarray) -> float:
        """How much the words of a box would cover; what lies outside of the picture counts most."""
        size = np.array(self.canvas.size)
        outside = float(np.maximum(-box[:, 0], 0).sum() + np.maximum(box[:, 1] - size, 0).sum())
        sides = (np.minimum(box[:, 1], other[:, 1]) - np.maximum(box[:, 0], other[:, 0]) for other in self.boxes)
        over = sum(float(np.prod(np.maximum(side, 0))) for side in sides)
        inside = (self.drawn > box[:, 0]) & (self.drawn < box[:, 1])
        return 100 * outside + over + 20 * int(inside.all(axis=1).sum())
