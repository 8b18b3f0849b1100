"""An axis of a figure: its range and the values at its ticks."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from html import unescape
from typing import Any

import numpy as np

STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)
TICKS = 6
MARGIN = 0.04


@dataclass(frozen=True)
class Axis:
    """An axis.

    Parameters
    ----------
    title : str
    low, high : float
        Ends; of a logarithmic axis their decimal logarithms.
    logarithmic : bool
    """

    title: str
    low: float
    high: float
    logarithmic: bool = False

    @classmethod
    def of(cls, given: Any, series: Iterable[Any]) -> "Axis":
        """Return the axis with the settings of a Plotly layout, which holds all values if it states no range."""
        logarithmic = given.type == "log"
        title = unescape(given.title.text or "")
        if given.range is not None:
            return cls(title, float(given.range[0]), float(given.range[1]), logarithmic)
        known = np.concatenate(
            [np.zeros(0), *(np.asarray(one, dtype=float).ravel() for one in series if one is not None)]
        )
        known = np.log10(known[known > 0]) if logarithmic else known
        known = known[np.isfinite(known)]
        low, high = (float(known.min()), float(known.max())) if len(known) else (0.0, 1.0)
        if given.rangemode == "tozero" and not logarithmic:
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
        """Values at the ticks and their labels, about as many as asked for.

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
        step = decade * next(one for one in STEPS if one * decade >= rough * (1 - 1e-9))
        values = step * np.arange(np.ceil(low / step - 1e-9), np.floor(high / step + 1e-9) + 1)
        return [(float(value), f"{round(float(value), 12) + 0.0:g}".replace("-", "−")) for value in values]

    def _around(self, length: float) -> "Axis":
        middle = (self.low + self.high) / 2
        return replace(self, low=middle - length / 2, high=middle + length / 2)
