"""A figure of lines and points as SVG: small, without a script, and the same in every notebook."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from html import escape, unescape
from typing import Any
from zlib import crc32

import numpy as np

from dalembert.report.look import FONT, LIGHT
from dalembert.report.pictures.canvas import path

STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)
TICKS = 6
MARGIN = 0.04


@dataclass(frozen=True)
class Axis:
    """An axis; ``low``, ``high``: its ends, of a logarithmic axis their decimal logarithms."""

    title: str
    low: float
    high: float
    logarithmic: bool = False

    @classmethod
    def of(cls, layout: Any, series: Iterable[Any]) -> "Axis":
        """Return the axis with the settings of a Plotly layout, which holds all values if it states no range."""
        logarithmic = layout.type == "log"
        title = unescape(layout.title.text or "")
        if layout.range is not None:
            return cls(title, float(layout.range[0]), float(layout.range[1]), logarithmic)
        known = np.concatenate(
            [np.zeros(0), *(np.asarray(values, dtype=float).ravel() for values in series if values is not None)]
        )
        known = np.log10(known[known > 0]) if logarithmic else known
        known = known[np.isfinite(known)]
        low, high = (float(known.min()), float(known.max())) if len(known) else (0.0, 1.0)
        if layout.rangemode == "tozero" and not logarithmic:
            low, high = min(low, 0.0), max(high, 0.0)
        margin = MARGIN * (high - low) or 0.5 * abs(high) or 0.5
        return cls(title, low - margin, high + margin, logarithmic)

    def share(self, values: Any) -> np.ndarray:
        """Positions of values along the axis, from 0 to 1 within its range."""
        values = np.asarray(values, dtype=float)
        if self.logarithmic:
            values = np.log10(np.where(values > 0, values, np.nan))
        return (values - self.low) / (self.high - self.low)

    def equal(self, other: "Axis", width: float, height: float) -> tuple["Axis", "Axis"]:
        """Return both axes with the same length of a unit on a rectangle of pixels; one of them is longer then."""
        unit = max((self.high - self.low) / width, (other.high - other.low) / height)
        return self._around(unit * width), other._around(unit * height)

    def ticks(self, most: int = TICKS) -> list[tuple[float, str]]:
        """Return values at the ticks and their labels, about as many as asked for.
        >>> [label for _, label in Axis("", 0.0, 1.0).ticks()]
        ['0', '0.2', '0.4', '0.6', '0.8', '1']
        >>> [label for _, label in Axis("", -3.0, 1.0, logarithmic=True).ticks()]
        ['0.001', '0.01', '0.1', '1', '10']
        """
        if self.logarithmic and self.high - self.low >= 1.0:
            each = max(1, int(np.ceil((self.high - self.low) / (most + 1))))
            decades = range(int(np.ceil(self.low)), int(np.floor(self.high)) + 1, each)
            parts = (1, 2, 5) if self.high - self.low < 2.0 else (1,)
            marks = [float(f"{part}e{decade}") for decade in (decades[0] - 1, *decades) for part in parts]
            return [(mark, f"{mark:g}") for mark in marks if self.low <= np.log10(mark) <= self.high]
        low, high = (10**self.low, 10**self.high) if self.logarithmic else (self.low, self.high)
        rough = (high - low) / max(most, 1)
        decade = 10.0 ** np.floor(np.log10(rough))
        step = decade * next(factor for factor in STEPS if factor * decade >= rough * (1 - 1e-9))
        values = step * np.arange(np.ceil(low / step - 1e-9), np.floor(high / step + 1e-9) + 1)
        return [(float(value), f"{round(float(value), 12) + 0.0:g}".replace("-", "−")) for value in values]

    def _around(self, length: float) -> "Axis":
        middle = (self.low + self.high) / 2
        return replace(self, low=middle - length / 2, high=middle + length / 2)


LEFT, RIGHT, TOP, BOTTOM = 78.0, 14.0, 34.0, 46.0
LEGEND = 18.0
"""Height of a row of the legend."""
MOST_POINTS, MOST_MARKERS = 1000, 400
DASHES = {"dot": "2 4", "dash": "7 5", "dashdot": "7 4 2 4", "longdash": "11 5"}


@dataclass(frozen=True)
class Panel:
    """A pair of axes and the rectangle of pixels that it takes."""

    x: Axis
    y: Axis
    traces: Sequence[Any]
    left: float
    top: float
    width: float
    height: float

    def pixels(self, x: Any, y: Any) -> np.ndarray:
        """Pixels (points, 2)."""
        return np.column_stack(
            [self.left + self.width * self.x.share(x), self.top + self.height * (1 - self.y.share(y))]
        )


def figure_svg(figure: Any, width: float = 540.0, height: float | None = None) -> str | None:
    """Return a figure of one or more rows as SVG; None where it is not made of lines and points in the plane.
    ``width``, ``height``: pixels; without a height that of the figure's layout, at most 420.
    """
    if not figure.data or any(trace.type != "scatter" for trace in figure.data):
        return None
    layout = figure.layout
    height = height or min(float(layout.height or 380), 420.0)
    title = unescape(layout.title.text or "") or "Figure"
    legend = _legend_rows(figure, width)
    panels = _panels(figure, width, height, TOP + LEGEND * len(legend))
    lines = [f'<rect width="{width:g}" height="{height:g}" rx="4" fill="{LIGHT.surface}"/>', _text(LEFT, 20, title, 15)]
    for number, row in enumerate(legend):
        lines += _legend(row, TOP + LEGEND * number)
    for place, panel in enumerate(panels):
        lines += _frame(panel, place == len(panels) - 1 or panel.x is not panels[place + 1].x)
        box = f'x="{panel.left:g}" y="{panel.top:.1f}" width="{panel.width:g}" height="{panel.height:.1f}"'
        clip = f"clip-{crc32(box.encode()):x}"  # equal names have equal boxes
        lines.append(f'<clipPath id="{clip}"><rect {box}/></clipPath><g clip-path="url(#{clip})">')
        for number, trace in enumerate(panel.traces):
            lines += _trace(panel, trace, panel.traces[number - 1] if number else None)
        lines.append("</g>")
    size = f'viewBox="0 0 {width:g} {height:g}" width="{width:g}" height="{height:g}"'
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} role="img" aria-label="{escape(title)}" '
        f'font-family="{escape(FONT)}" style="max-width:100%;height:auto">{"".join(lines)}</svg>'
    )


def _panels(figure: Any, width: float, height: float, top: float) -> list[Panel]:
    """Panels from the highest to the lowest; rows below each other share their abscissa."""
    found: dict[tuple[str, str], list[Any]] = {}
    for trace in figure.data:
        found.setdefault((trace.xaxis or "x", trace.yaxis or "y"), []).append(trace)
    rows = sorted(found, key=lambda key: -_domain(figure, key[1])[0])
    room = height - top - BOTTOM
    shared = Axis.of(_axis(figure, rows[-1][0]), [trace.x for trace in figure.data])
    panels = []
    for key in rows:
        low, high = _domain(figure, key[1])
        traces = found[key]
        y = Axis.of(_axis(figure, key[1]), [trace.y for trace in traces])
        area = (LEFT, top + (1 - high) * room, width - LEFT - RIGHT, (high - low) * room)
        x, y = shared.equal(y, area[2], area[3]) if _axis(figure, key[1]).scaleanchor else (shared, y)
        panels.append(Panel(x, y, traces, *area))
    return panels


def _axis(figure: Any, name: str) -> Any:
    """Settings of an axis, such as ``"y2"``."""
    return figure.layout[f"{name[0]}axis{name[1:]}"]


def _domain(figure: Any, name: str) -> tuple[float, float]:
    low, high = _axis(figure, name).domain or (0.0, 1.0)
    return low, high


def _frame(panel: Panel, lowest: bool) -> list[str]:
    """Grid, labels of the ticks, and titles of the axes."""
    bottom, right, lines = panel.top + panel.height, panel.left + panel.width, []
    for value, label in panel.x.ticks(int(panel.width / 75)):
        x = panel.left + panel.width * float(panel.x.share([value])[0])
        lines.append(_stroke([[x, panel.top], [x, bottom]], LIGHT.grid, 1))
        if lowest:
            lines.append(_text(x, bottom + 16, label, 12, LIGHT.muted, "middle"))
    for value, label in panel.y.ticks(int(panel.height / 32)):
        y = bottom - panel.height * float(panel.y.share([value])[0])
        lines.append(_stroke([[panel.left, y], [right, y]], LIGHT.grid, 1))
        lines.append(_text(panel.left - 6, y + 4, label, 12, LIGHT.muted, "end"))
    lines.append(_stroke([[panel.left, panel.top], [panel.left, bottom], [right, bottom]], LIGHT.muted, 1))
    if lowest:
        lines.append(_text(panel.left + panel.width / 2, bottom + 36, panel.x.title, 12, anchor="middle"))
    middle = panel.top + panel.height / 2
    turned = f'<g transform="rotate(-90 14 {middle:.1f})">{_text(14, middle, panel.y.title, 12, anchor="middle")}</g>'
    return [*lines, turned]


def _trace(panel: Panel, trace: Any, before: Any) -> list[str]:
    x, y = (np.asarray(values if values is not None else [], dtype=float) for values in (trace.x, trace.y))
    count = min(len(x), len(y))
    if not count:
        return []
    pixels, lines = panel.pixels(x[:count], y[:count]), []
    mode = trace.mode or "lines"
    colour = trace.line.color or trace.marker.color
    colour = colour if isinstance(colour, str) else LIGHT.series[0]
    if trace.fill in ("toself", "tozeroy") or (trace.fill == "tonexty" and before is not None):
        fill = trace.fillcolor or f"{colour}38"
        lines.append(f'<path d="{path(_area(panel, trace, pixels, before))}Z" fill="{fill}"/>')
    if "lines" in mode and trace.line.width != 0:
        lines.append(_stroke(_thinned(pixels), colour, trace.line.width or 2, DASHES.get(trace.line.dash or "", "")))
    if "markers" in mode:
        lines += _markers(trace, pixels)
    return lines


def _area(panel: Panel, trace: Any, pixels: np.ndarray, before: Any) -> np.ndarray:
    """Corners of what a trace fills."""
    if trace.fill == "toself":
        return pixels
    if trace.fill == "tozeroy":
        zero = panel.pixels(trace.x, np.zeros(len(pixels)))
        return np.concatenate([pixels, zero[::-1]])
    return np.concatenate([pixels, panel.pixels(before.x, before.y)[::-1]])


def _markers(trace: Any, pixels: np.ndarray) -> list[str]:
    """Dots; crosses and open symbols as rings."""
    marker = trace.marker
    colour = marker.color if isinstance(marker.color, str) else marker.line.color or LIGHT.series[0]
    colour = colour if isinstance(colour, str) else LIGHT.series[0]
    edge = marker.line.color if isinstance(marker.line.color, str) else None
    cross = "thin" in str(marker.symbol)
    radius = 0.5 * float(marker.size if isinstance(marker.size, int | float) else 6)
    shown = pixels[np.isfinite(pixels).all(axis=1)]
    shown = shown[:: -(-len(shown) // MOST_MARKERS) or 1]
    if cross:
        arms = np.array([[-1, -1], [1, 1], [np.nan, np.nan], [-1, 1], [1, -1], [np.nan, np.nan]]) * radius
        return [_stroke((shown[:, None] + arms).reshape(-1, 2), edge or colour, 1.2)]
    ring = f' stroke="{edge}" stroke-width="{marker.line.width or 1:g}"' if edge else ""
    return [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius:g}" fill="{colour}"{ring}/>' for x, y in shown]


def _thinned(pixels: np.ndarray) -> np.ndarray:
    """Of very many points the lowest and the highest of each stretch, so that no peak is lost."""
    if len(pixels) <= MOST_POINTS:
        return pixels
    kept = []
    for part in np.array_split(np.arange(len(pixels)), MOST_POINTS // 2):
        y = np.where(np.isfinite(pixels[part, 1]), pixels[part, 1], 0.0)
        kept += sorted({int(part[np.argmin(y)]), int(part[np.argmax(y)])})
    return pixels[kept]


def _legend_rows(figure: Any, width: float) -> list[list[tuple[Any, float]]]:
    """Named traces in rows, with where each begins."""
    named = {
        unescape(trace.name): trace for trace in reversed(figure.data) if trace.name and trace.showlegend is not False
    }
    named = dict(reversed(named.items()))
    if len(named) < 2 or figure.layout.showlegend is False:
        return []
    rows: list[list[tuple[Any, float]]] = [[]]
    at = LEFT
    for name, trace in named.items():
        room = 34 + 6.6 * len(name)
        if at + room > width - RIGHT and rows[-1]:
            rows.append([])
            at = LEFT
        rows[-1].append((trace, at))
        at += room + 10
    return rows


def _legend(row: list[tuple[Any, float]], top: float) -> list[str]:
    lines = []
    for trace, at in row:
        colour = trace.line.color or trace.marker.color
        colour = colour if isinstance(colour, str) else LIGHT.series[0]
        sample = np.array([[at, top + 4], [at + 22, top + 4]])
        if "lines" in (trace.mode or "lines"):
            lines.append(_stroke(sample, colour, trace.line.width or 2, DASHES.get(trace.line.dash or "", "")))
        else:
            lines += _markers(trace, sample.mean(axis=0, keepdims=True))
        lines.append(_text(at + 28, top + 8, unescape(trace.name), 12))
    return lines


def _stroke(pixels: Any, colour: str, width: float, dash: str = "") -> str:
    dashed = f' stroke-dasharray="{dash}"' if dash else ""
    drawn = path(np.asarray(pixels, dtype=float))
    return f'<path d="{drawn}" fill="none" stroke="{colour}" stroke-width="{width:g}" stroke-linejoin="round"{dashed}/>'


def _text(x: float, y: float, words: str, size: int, colour: str = LIGHT.ink, anchor: str = "start") -> str:
    where = f'x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"'
    return f'<text {where} font-size="{size}" fill="{colour}">{escape(words)}</text>'
