"""The bar that explains the colours of a scene."""

import numpy as np

from dalembert.report.pictures.canvas import Canvas, between, round_below
from dalembert.report.scene.scene import ColourBar

VIRIDIS = (
    "#440154", "#482878", "#3e4989", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725",
)  # fmt: skip
"""Colours of equal steps of brightness for any kind of colour vision: ten of Matplotlib's map of this name."""
SMALL = 1e-3
"""Of the highest value: below it, text with zeros in place of an exponent is wider than the room for it."""
STEPS = 32
ROOM = 0.16
"""Of the bar, as part of the width of what is drawn."""


def graded(shares: np.ndarray) -> list[str]:
    """Return colours of shares from 0 to 1, rounded to ``STEPS`` steps.
    >>> graded(np.array([0.0, 1.0]))
    ['#440154', '#fde725']
    """
    places = np.round(STEPS * np.clip(shares, 0.0, 1.0)) / STEPS * (len(VIRIDIS) - 1)
    first = np.minimum(places.astype(int), len(VIRIDIS) - 2)
    return [between(VIRIDIS[k], VIRIDIS[k + 1], float(place - k)) for k, place in zip(first, places, strict=True)]


def ticks(bar: ColourBar) -> list[tuple[float, str]]:
    """Return shares of the bar at round values, and the values as text; those of small strains with an exponent.
    >>> ticks(ColourBar("size (m)", 0.5))
    [(0.0, '0'), (0.2, '0.1'), (0.4, '0.2'), (0.6, '0.3'), (0.8, '0.4'), (1.0, '0.5')]
    >>> ticks(ColourBar("strain", 4e-4))
    [(0.0, '0'), (0.25, '100e-6'), (0.5, '200e-6'), (0.75, '300e-6'), (1.0, '400e-6')]
    """
    step = round_below(bar.highest / 4)
    values = step * np.arange(int(bar.highest / step * (1 + 1e-9)) + 1)
    exponent = 3 * int(np.floor(np.log10(bar.highest) / 3)) if bar.highest < SMALL else 0
    words = f"e{exponent}" if exponent else ""
    return [
        (round(float(value / bar.highest), 9), f"{round(float(value) / 10.0**exponent, 12):g}{words if value else ''}")
        for value in values
    ]


def draw_bar(canvas: Canvas, bar: ColourBar) -> None:
    """Draw the bar at the right edge of a picture, with its title above it."""
    (width, height), thickness = canvas.size, 12
    low, high, left = height - 24.0, 40.0, width - 62.0
    step = (low - high) / STEPS
    for k, colour in enumerate(graded((np.arange(STEPS) + 0.5) / STEPS)):
        y = low - k * step
        canvas.polygons(
            [np.array([(left, y), (left + thickness, y), (left + thickness, y - step), (left, y - step)])],
            colour,
            colour,
        )
    for share, text in ticks(bar):
        canvas.text((left + thickness + 5, low - share * (low - high) + 4), text, size=11, anchor="start")
    canvas.text((width - 6, 20), bar.title, anchor="end")
