"""The way of a slider between the bounds of a parameter, logarithmic where the bounds span decades."""

import math
from dataclasses import dataclass

from dalembert.parameters import Parameter

STEPS = 1000
"""Positions of a slider, less one."""


@dataclass(frozen=True)
class Travel:
    """Positions of a slider, from 0 to :data:`STEPS`, and values of a parameter.

    Parameters
    ----------
    item : Parameter

    Examples
    --------
    >>> angle, modulus = Travel(Parameter("angle", 0.6, 1.0)), Travel(Parameter("E", 1e6, 1e9))
    >>> angle.value(500), modulus.value(500), modulus.position(1e8)
    (0.8, 31622800.0, 667)
    """

    item: Parameter

    def value(self, position: float) -> float:
        """Value at a position, with as many digits as tell neighbouring positions apart."""
        lower, upper, share = self.item.lower, self.item.upper, min(max(position / STEPS, 0.0), 1.0)
        if share in (0.0, 1.0):
            return upper if share else lower
        if self._logarithmic:
            return float(f"{lower * (upper / lower) ** share:.6g}")
        decimals = 1 - math.floor(math.log10((upper - lower) / STEPS))
        return round(lower + share * (upper - lower), decimals)

    def position(self, value: float) -> int:
        """The position that is nearest to a value."""
        lower, upper = self.item.lower, self.item.upper
        if self._logarithmic:
            return round(STEPS * math.log(value / lower) / math.log(upper / lower))
        return round(STEPS * (value - lower) / (upper - lower))

    @property
    def _logarithmic(self) -> bool:
        return self.item.logarithmic and self.item.lower > 0
