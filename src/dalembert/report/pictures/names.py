"""Names in the picture of a mechanism: of its bodies, joints and loads, and of points with channels."""

from collections.abc import Mapping

import numpy as np

from dalembert.multibody.motion.sketch import Sketch
from dalembert.report.pictures.canvas import COLOURS, INK, Canvas
from dalembert.report.pictures.projection import Projection

MOST_NAMES = 24
"""Above this number, names are left out; each part has its name as a tip."""
LETTER, HEIGHT = 6.6, 14.0
"""Size of a letter in pixels."""
AROUND = tuple(
    (distance * np.cos(angle), distance * np.sin(angle))
    for distance in (16.0, 24.0, 34.0)
    for angle in np.pi * np.array([-0.25, 0.25, -0.75, 0.75, 0.0, 1.0, -0.5, 0.5])
)
"""Where a name may stand from the point that it belongs to, the best first."""


def draw_names(
    canvas: Canvas, view: Projection, sketch: Sketch, channels: Mapping[str, tuple[np.ndarray, list[str]]]
) -> None:
    """Draw the points that are located, those with channels, and names where there is room.

    Parameters
    ----------
    canvas : Canvas
    view : Projection
    sketch : Sketch
    channels : mapping of str to (array, list of str)
        Positions in m and names of channels, by the point, joint or load that has them.
    """
    for position, own in channels.values():
        with canvas.part(own[0], "channel"):
            canvas.circle(canvas.at(view(position[None]))[0], 8, "none", COLOURS[1])
    for name, position in sketch.marks.items():
        with canvas.part(name, "point"):
            canvas.circle(canvas.at(view(position[None]))[0], 2.5, INK)
    anchors = _anchors(canvas, view, sketch)
    if len(anchors) > MOST_NAMES:
        return
    labels = _Labels(canvas, _drawn(canvas, view, sketch))
    for name, pixel in anchors.items():
        labels.put(pixel, name, INK)
    for owner, (position, own) in channels.items():
        outputs = ", ".join(channel.rpartition(".")[2] for channel in own)
        labels.put(canvas.at(view(position[None]))[0], f"{owner}: {outputs}", COLOURS[1])


def _anchors(canvas: Canvas, view: Projection, sketch: Sketch) -> dict[str, np.ndarray]:
    """Pixels that the names of bodies, joints and loads belong to."""
    places = {name: line[0].mean(axis=0) for name, line in sketch.drawing.lines.items()}
    places |= {name: ends.mean(axis=0) for name, ends in sketch.ends.items()}
    places |= {name: motion[0] for name, motion in sketch.drawing.joints.items()}
    return {name: canvas.at(view(position[None]))[0] for name, position in places.items()}


def _drawn(canvas: Canvas, view: Projection, sketch: Sketch) -> np.ndarray:
    """Pixels along the bodies and at joints, which names should not cover."""
    lines = [canvas.at(view(line[0])) for line in sketch.drawing.lines.values()]
    shares = np.linspace(0.0, 1.0, 12)[:, None, None]
    found = [((1 - shares) * line[:-1] + shares * line[1:]).reshape(-1, 2) for line in lines]
    found += [canvas.at(view(ends)) for ends in sketch.ends.values()]
    found += [canvas.at(view(motion[0][None])) for motion in sketch.drawing.joints.values()]
    points = np.concatenate([np.zeros((0, 2)), *found])
    return points[np.isfinite(points).all(axis=1)]


class _Labels:
    """Names that keep clear of each other and of what is drawn, where they can.

    Parameters
    ----------
    canvas : Canvas
    drawn : array, shape (points, 2)
        Pixels to keep clear of.
    """

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
        over = sum(float(np.prod(np.maximum(np.minimum(box[:, 1], one[:, 1]) - np.maximum(box[:, 0], one[:, 0]), 0)))
                   for one in self.boxes)  # fmt: skip
        inside = (self.drawn > box[:, 0]) & (self.drawn < box[:, 1])
        return 100 * outside + over + 20 * int(inside.all(axis=1).sum())
