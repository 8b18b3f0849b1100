"""Units that are a power of ten of SI units: read without Pint, whose table of all units takes a while to load."""

import re
from decimal import Decimal
from functools import cache

_BASE = {  # power of ten to SI units, and exponents of kg, m, s and rad
    "m": (0, (0, 1, 0, 0)),
    "g": (-3, (1, 0, 0, 0)),
    "s": (0, (0, 0, 1, 0)),
    "rad": (0, (0, 0, 0, 1)),
    "N": (0, (1, 1, -2, 0)),
    "Pa": (0, (1, -1, -2, 0)),
    "J": (0, (1, 2, -2, 0)),
}
_PREFIXES = {"": 0, "G": 9, "M": 6, "k": 3, "c": -2, "m": -3, "µ": -6, "n": -9}
SINGLE = {
    prefix + unit: (own + power, over) for unit, (own, over) in _BASE.items() for prefix, power in _PREFIXES.items()
}
_FACTOR = re.compile(r"\s*([*/·]?)\s*(1|[a-zA-Zµ]+)(?:(?:\^|\*\*)([+-]?\d))?\s*")


@cache
def decimal_unit(text: str) -> tuple[int, tuple[int, ...]] | None:
    """Return the power of ten to SI units, and the exponents of kg, m, s and rad; None for any other unit.

    Examples
    --------
    >>> decimal_unit("N/mm"), decimal_unit("kg*m^2"), decimal_unit("deg")
    ((3, (1, 0, -2, 0)), (0, (1, 2, 0, 0)), None)
    """
    power, exponents, place = 0, (0, 0, 0, 0), 0
    while place < len(text):
        match = _FACTOR.match(text, place)
        if match is None or bool(match[1]) != bool(place):
            return None
        if match[2] != "1":
            if match[2] not in SINGLE:
                return None
            own, over = SINGLE[match[2]]
            times = int(match[3] or 1) * (-1 if match[1] == "/" else 1)
            power += times * own
            exponents = tuple(a + times * b for a, b in zip(exponents, over, strict=True))
        place = match.end()
    return power, exponents


def in_si(number: str, unit: str, wanted: str | None) -> float | None:
    """Return a number, given as text, in a coherent SI unit; None if its unit is not a decimal multiple of it.

    ``wanted`` None stands for whatever SI unit fits.

    Examples
    --------
    >>> in_si("400", "mm", "m"), in_si("7.85", "g/cm^3", "kg/m^3"), in_si("45", "deg", "rad"), in_si("1", "mm", "s")
    (0.4, 7850.0, None, None)
    """
    given = decimal_unit(unit)
    if given is None or (wanted is not None and decimal_unit(wanted) != (0, given[1])):
        return None
    return float(Decimal(number).scaleb(given[0]))
