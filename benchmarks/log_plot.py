"""A figure of lines over two logarithmic axes, as SVG text."""

from collections.abc import Mapping, Sequence
from html import escape
from math import ceil, floor, log10

WIDTH, HEIGHT = 640, 420
LEFT, RIGHT, TOP, BOTTOM = 80, 215, 40, 60
COLOURS = ("#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#8c564b")
STYLE = 'font-family="sans-serif" font-size="13" fill="#444"'

Line = tuple[Sequence[float], Sequence[float]]


def log_plot(title: str, x: str, y: str, lines: Mapping[str, Line]) -> str:
    """Return an SVG figure with one line, with markers, for each name; values are positive.

    Examples
    --------
    >>> text = log_plot("Errors", "steps", "error", {"method": ((1, 10, 100), (1e-1, 1e-2, 1e-3))})
    >>> text.count("<circle"), text.count("<polyline")
    (3, 1)
    """
    across = _Axis([value for along, _ in lines.values() for value in along], LEFT, WIDTH - RIGHT)
    up = _Axis([value for _, values in lines.values() for value in values], HEIGHT - BOTTOM, TOP)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" role="img">',
        f"<title>{escape(title)}</title>",
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
        _text(title, (LEFT + WIDTH - RIGHT) / 2, TOP - 16, "middle"),
        _text(x, (LEFT + WIDTH - RIGHT) / 2, HEIGHT - 14, "middle"),
        _text(y, 18, (TOP + HEIGHT - BOTTOM) / 2, "middle", turn=True),
    ]
    for tick in across.ticks:
        at = across.place(tick)
        parts.append(f'<path d="M{at:.1f} {TOP}V{HEIGHT - BOTTOM}" stroke="#ddd"/>')
        parts.append(_text(f"{tick:g}", at, HEIGHT - BOTTOM + 20, "middle"))
    for tick in up.ticks:
        at = up.place(tick)
        parts.append(f'<path d="M{LEFT} {at:.1f}H{WIDTH - RIGHT}" stroke="#ddd"/>')
        parts.append(_text(f"{tick:g}", LEFT - 8, at + 4, "end"))
    for k, (name, (along, values)) in enumerate(lines.items()):
        colour = COLOURS[k % len(COLOURS)]
        points = [(across.place(a), up.place(b)) for a, b in zip(along, values, strict=True)]
        path = " ".join(f"{a:.1f},{b:.1f}" for a, b in points)
        parts.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2"/>')
        parts += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="3.5" fill="{colour}"/>' for a, b in points]
        place = TOP + 14 + 22 * k
        parts.append(f'<rect x="{WIDTH - RIGHT + 14}" y="{place - 9}" width="12" height="12" fill="{colour}"/>')
        parts.append(_text(name, WIDTH - RIGHT + 32, place + 2, "start"))
    return "\n".join([*parts, "</svg>"]) + "\n"


class _Axis:
    """Whole decades that hold all values, from one place to another; ticks at 1, and at 2 and 5 of few decades."""

    def __init__(self, values: Sequence[float], start: float, end: float) -> None:
        low, high = log10(min(values)), log10(max(values))
        few = high - low < 2
        self.low, self.high = (low - 0.05, high + 0.05) if few else (floor(low), ceil(high))
        self.start, self.end = start, end
        steps = (1, 2, 5) if few else (1,)
        ticks = [step * 10.0**power for power in range(floor(self.low), ceil(self.high) + 1) for step in steps]
        self.ticks = [tick for tick in ticks if self.low - 1e-9 <= log10(tick) <= self.high + 1e-9]

    def place(self, value: float) -> float:
        return self.start + (self.end - self.start) * (log10(value) - self.low) / (self.high - self.low)


def _text(text: str, x: float, y: float, anchor: str, turn: bool = False) -> str:
    turned = f' transform="rotate(-90 {x:g} {y:g})"' if turn else ""
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" {STYLE}{turned}>{escape(text)}</text>'
