"""A small SVG picture: shapes in the plane of the picture, grouped by the part of the model that they show."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from html import escape
from typing import Any

import numpy as np

from dalembert.report.look import DARK, FONT, LIGHT, faint

SIZE = (360, 225)
"""Width and height in pixels."""
MARGIN = 26


def between(light: str, dark: str, share: float = 0.15) -> str:
    """Return a colour between two that can be seen on light and dark pages; ``share`` is the part of ``dark``.
    >>> between("#000000", "#ffffff", 0.5)
    '#808080'
    """
    pairs = [(int(light[k : k + 2], 16), int(dark[k : k + 2], 16)) for k in (1, 3, 5)]
    return "#" + "".join(f"{round(first + share * (other - first)):02x}" for first, other in pairs)


INK = between(LIGHT.muted, DARK.muted, 0.3)
FAINT = faint(INK, 0.3)
COLOURS = tuple(between(*pair) for pair in zip(LIGHT.series, DARK.series, strict=True))
"""Of bodies, as in the figures of reports."""


@dataclass
class Canvas:
    """Shapes of a picture with equal scales along both axes. ``low``, ``high`` (2,): corners of what is drawn, m;
    ``size``: width and height, pixels; ``zoom``: pixels of the shown picture a pixel; ``choosable``: whether its parts
    are buttons that the keyboard reaches.
    """

    low: np.ndarray
    high: np.ndarray
    size: tuple[int, int] = SIZE
    zoom: float = 1.0
    choosable: bool = False
    _lines: list[str] = field(default_factory=list)

    @classmethod
    def around(cls, points: np.ndarray, size: tuple[int, int] = SIZE, choosable: bool = False) -> "Canvas":
        """Return an empty canvas that holds points (points, 2)."""
        known = points[np.isfinite(points).all(axis=1)]
        if not len(known):
            known = np.zeros((1, 2))
        return cls(known.min(axis=0), known.max(axis=0), size, choosable=choosable)

    @property
    def scale(self) -> float:
        """Pixels a metre."""
        room = np.array(self.size) - 2.0 * MARGIN
        extent = np.maximum(self.high - self.low, 1e-9 * max(1.0, float(np.abs(self.high).max())))
        longest = float(extent.max())
        return float(np.min(room / np.maximum(extent, 0.02 * longest)))

    def at(self, points: np.ndarray) -> np.ndarray:
        """Pixels (points, 2) of points in m."""
        offset = (np.asarray(points, dtype=float).reshape(-1, 2) - (self.low + self.high) / 2) * self.scale
        return np.array(self.size) / 2 + offset * (1, -1)

    @contextmanager
    def part(self, name: str, role: str) -> Iterator[None]:
        """A group of shapes that show one part of the model: ``data-part`` is its name, ``class`` its role."""
        button = f' tabindex="0" role="button" aria-label="{escape(f"{role} {name}")}"' if self.choosable else ""
        self._lines.append(f'<g class="{role}" data-part="{escape(name)}"{button}><title>{escape(name)}</title>')
        yield
        self._lines.append("</g>")

    def line(self, points: np.ndarray, colour: str, width: float, dash: str = "") -> None:
        """A line through points in m, (points, 2)."""
        self.stroke(self.at(points), colour, width, dash)

    def stroke(self, pixels: np.ndarray, colour: str, width: float, dash: str = "") -> None:
        """A line through pixels (points, 2)."""
        dashed = f' stroke-dasharray="{dash}"' if dash else ""
        self._lines.append(
            f'<path d="{path(pixels)}" fill="none" stroke="{colour}" stroke-width="{width:g}" stroke-linecap="round" '
            f'stroke-linejoin="round"{dashed}/>'
        )

    def polygons(self, pixels: Sequence[np.ndarray], fill: str, stroke: str = "none", width: float = 0.6) -> None:
        """Closed shapes in one path, each (corners, 2)."""
        shapes = "".join(f"{path(corners)}Z" for corners in pixels)
        self._lines.append(f'<path d="{shapes}" fill="{fill}" stroke="{stroke}" stroke-width="{width:g}"/>')

    def circle(self, pixel: np.ndarray, radius: float, fill: str, stroke: str = "none") -> None:
        """A circle about a pixel."""
        x, y = pixel
        self._lines.append(
            f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius:g}" fill="{fill}" stroke="{stroke}" stroke-width="2"/>'
        )

    def text(self, pixel: Any, words: str, colour: str = INK, *, size: int = 12, anchor: str = "middle") -> None:
        """Words about a pixel, or from it on with the anchor ``start``."""
        style = f'text-anchor="{anchor}" font-size="{size}" fill="{colour}"'
        self._lines.append(f'<text x="{pixel[0]:.1f}" y="{pixel[1]:.1f}" {style}>{escape(words)}</text>')

    def arrow(self, tail: np.ndarray, head: np.ndarray, colour: str) -> None:
        """An arrow between two pixels."""
        along = (head - tail) / (np.linalg.norm(head - tail) or 1.0)
        across = np.array([-along[1], along[0]])
        self.stroke(np.array([tail, head - 6 * along]), colour, 2)
        self.polygons([np.array([head, head - 9 * along + 4 * across, head - 9 * along - 4 * across])], colour)

    def ground(self, pixel: np.ndarray) -> None:
        """The symbol of a joint with the ground, its tip at a pixel."""
        x, y = pixel
        self.polygons([np.array([[x, y], [x - 9, y + 15], [x + 9, y + 15]])], "none", INK, 1.5)
        self.stroke(np.array([[x - 14, y + 15], [x + 14, y + 15]]), INK, 1.5)
        for step in (-10, -3, 4, 11):
            self.stroke(np.array([[x + step, y + 15], [x + step - 5, y + 20]]), INK, 1)

    def axes(self) -> None:
        """Round positions in m along the lower and the left edge."""
        (width, height), step = self.size, round_below(min(self.size) / self.scale / 3)
        first, last = ((self.low + self.high) / 2 + sign * np.array(self.size) / self.scale / 2 for sign in (-1, 1))
        for number in range(int(min(first) // step), int(max(last) // step) + 1):
            x, y = self.at(np.full(2, number * step))[0]
            words = f"{round(number * step, 12):g} m".replace("-", "−")
            if 24 < x < width - 40:
                self.stroke(np.array([(x, height), (x, height - 4)]), INK, 1)
                self.text((x + 3, height - 6), words, size=11, anchor="start")
            if 16 < y < height - 24:
                self.stroke(np.array([(0, y), (4, y)]), INK, 1)
                self.text((7, y + 4), words, size=11, anchor="start")

    def spring(self, first: np.ndarray, second: np.ndarray, turns: int = 7) -> None:
        """A zigzag between two pixels; a dot where they meet."""
        span = second - first
        length = float(np.linalg.norm(span))
        if length < 4:
            self.circle(first, 3, "none", COLOURS[2])
            return
        across = np.array([-span[1], span[0]]) / length * min(6.0, length / 6)
        shares = np.concatenate([[0.0, 0.18], 0.18 + 0.64 * (np.arange(2 * turns) + 0.5) / (2 * turns), [0.82, 1.0]])
        sides = np.concatenate([[0.0, 0.0], np.tile([1.0, -1.0], turns), [0.0, 0.0]])
        self.stroke(first + shares[:, None] * span + sides[:, None] * across, COLOURS[2], 1.5)

    def svg(self, label: str) -> str:
        """The picture; ``label`` describes it for screen readers."""
        width, height = self.size
        shown = f'width="{self.zoom * width:g}" height="{self.zoom * height:g}"'
        role, style = ("group", "max-width:100%") if self.choosable else ("img", "max-width:100%;height:auto")
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" {shown} '
            f'role="{role}" aria-label="{escape(label)}" font-family="{escape(FONT)}" style="{style}">'
            f"{''.join(self._lines)}</svg>"
        )


def round_below(length: float) -> float:
    """Return the largest length of 1, 2 or 5 times a power of ten that is not above a length.
    >>> round_below(0.34), round_below(7.0)
    (0.2, 5.0)
    """
    decade = 10.0 ** np.floor(np.log10(length))
    return float(decade * next(digit for digit in (5, 2, 1) if digit * decade <= length * (1 + 1e-9)))


def message_picture(words: str, size: tuple[int, int] = SIZE) -> str:
    """Return a picture with a short message where there is nothing to draw."""
    canvas = Canvas(np.zeros(2), np.ones(2), size)
    canvas.text(np.array(size) / 2, words)
    return canvas.svg(words)


def moved(pixel: np.ndarray, right: float, down: float) -> np.ndarray:
    """Return the pixel to the right of one and below it."""
    return np.asarray(pixel) + np.array((right, down), dtype=float)


def path(pixels: np.ndarray) -> str:
    """Return commands of an SVG path through pixels (points, 2), with gaps where they are not finite.
    >>> path(np.array([[0, 0], [1.25, 2], [np.nan, 0], [3, 3], [4, 4]]))
    'M0 0L1.2 2M3 3L4 4'
    """
    commands, begun = [], False
    for x, y in np.asarray(pixels, dtype=float):
        if not (np.isfinite(x) and np.isfinite(y)):
            begun = False
            continue
        commands.append(f"{'L' if begun else 'M'}{round(x, 1):g} {round(y, 1):g}")
        begun = True
    return "".join(commands)
