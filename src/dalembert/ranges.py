"""Ranges of numbers, and how they are said."""

from typing import NamedTuple

import numpy as np


class Range(NamedTuple):
    """Range of a number, of which the limits ``above`` and ``below`` are no part.
    >>> [0 in POSITIVE, 0 in NOT_NEGATIVE, -0.5 in Range(above=-1.0, most=0.0)]
    [False, True, True]
    >>> f"{POSITIVE}; {Range(least=1.0)}; {Range(above=-1.0, below=0.5)}"
    'a positive number; a number of at least 1; a number between -1 and 0.5'
    """

    above: float = -np.inf
    least: float = -np.inf
    below: float = np.inf
    most: float = np.inf

    def __contains__(self, value: object) -> bool:
        above, least, below, most = self
        if isinstance(value, float | int | complex):
            return above < value.real < below and least <= value.real <= most
        real = np.real(value)  # type: ignore[call-overload]
        return bool(np.all((above < real) & (least <= real) & (real < below) & (real <= most)))

    def __str__(self) -> str:
        if self in (POSITIVE, NOT_NEGATIVE):
            return "a positive number" if self == POSITIVE else "zero or a positive number"
        limits = {name: limit for name, limit in self._asdict().items() if np.isfinite(limit)}
        if limits.keys() == {"least", "most"}:
            return f"a number from {self.least:g} to {self.most:g}"
        if limits.keys() == {"above", "below"}:
            return f"a number between {self.above:g} and {self.below:g}"
        words = {"above": "above", "least": "of at least", "below": "below", "most": "at most"}
        return "a number " + " and ".join(f"{words[name]} {limit:g}" for name, limit in limits.items())


POSITIVE, NOT_NEGATIVE = Range(above=0.0), Range(least=0.0)
