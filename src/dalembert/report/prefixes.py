"""Units with a prefix that makes numbers easy to read."""

import math

from dalembert.report.digits import shown

PREFIXES = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}
SMALLEST = {"m": (-9, 0), "N": (0, 6), "J": (-9, 6)}
"""Exponents of the smallest and the largest prefix that people use with a unit; others stay as they are."""


def prefixed(largest: float, unit: str) -> tuple[float, str]:
    """Factor from a unit to one in which the largest of some values lies between 1 and 1000, and its name.

    Examples
    --------
    >>> prefixed(2.5e-5, "m"), prefixed(1200.0, "N"), prefixed(3e-5, "rad"), prefixed(1e4, "m")
    ((1000000.0, 'µm'), (0.001, 'kN'), (1.0, 'rad'), (1.0, 'm'))
    """
    if unit not in SMALLEST or not (math.isfinite(largest) and largest > 0):
        return 1.0, unit
    least, most = SMALLEST[unit]
    exponent = min(max(3 * math.floor(math.log10(largest * (1 + 1e-12)) / 3), least), most)
    return 10.0**-exponent, f"{PREFIXES[exponent]}{unit}"


def in_words(value: float, unit: str, digits: int = 6) -> str:
    """Text of a number with the prefix of its unit that makes it easy to read.

    Examples
    --------
    >>> in_words(1.8883e-4, "m"), in_words(2.5, "rad")
    ('188.83 µm', '2.5 rad')
    """
    factor, own = prefixed(abs(value), unit)
    return f"{shown(factor * value, digits=digits)} {own}"
