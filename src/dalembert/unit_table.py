"""Units by their names, and the product of powers of units that a text such as ``"N*m/rad"`` is."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from itertools import product
from math import pi

BASE = ("kg", "m", "s", "A", "K", "rad", "cycle", "count")
"""Kinds of base units. Radians and cycles differ, so that an angular velocity is no frequency."""


@dataclass(frozen=True)
class Unit:
    """A multiple of SI units: ``scale`` π^``turns`` times the product of the units :data:`BASE` to the powers
    ``exponents``. ``offset``: added to a number of this unit before it is scaled; of temperatures alone.
    """

    scale: Fraction = Fraction(1)
    turns: int | Fraction = 0
    exponents: tuple[int | Fraction, ...] = (0,) * len(BASE)
    offset: Fraction = Fraction(0)

    @property
    def factor(self) -> float:
        """Number of SI units."""
        return float(self.scale) if self.turns == 0 else float(pi**self.turns * float(self.scale))

    def __mul__(self, other: "Unit") -> "Unit":
        exponents = tuple(a + b for a, b in zip(self.exponents, other.exponents, strict=True))
        return Unit(self.scale * other.scale, self.turns + other.turns, exponents)

    def __pow__(self, power: int | Fraction) -> "Unit":
        if power == 1:
            return self
        scale = self.scale**power  # a float where the power is no whole number, as in N*m/rad^1.5
        return Unit(Fraction(scale), self.turns * power, tuple(power * exponent for exponent in self.exponents))

    def times(self, scale: str | Fraction) -> "Unit":
        """Return a multiple of this unit."""
        return Unit(self.scale * Fraction(scale), self.turns, self.exponents)


NONE = Unit()
_KG, _M, _S, _A, _K, _RAD, _CYCLE, _COUNT = (Unit(exponents=tuple(int(name == base) for base in BASE)) for name in BASE)
_N = _KG * _M * _S**-2
_J, _PA, _DEG = _N * _M, _N * _M**-2, Unit(Fraction(1, 180), 1, _RAD.exponents)
_W = _J * _S**-1
_V = _W * _A**-1
_MINUTE, _HOUR, _TURN = _S.times("60"), _S.times("3600"), _DEG.times("360")
# BIPM, The International System of Units, 9th edition 2019, table 8 and section 4; inch, foot, pound, pound-force and
# standard gravity are exact by NIST SP 811 (2008), appendix B.8.
_INCH, _FOOT, _POUND, _GRAVITY = _M.times("0.0254"), _M.times("0.3048"), _KG.times("0.45359237"), "9.80665"
_G_N = (_M * _S**-2).times(_GRAVITY)
_POUND_FORCE = (_POUND * _M * _S**-2).times(_GRAVITY)
_PSI = _POUND_FORCE * _INCH**-2

_PREFIXES = {
    "G": 9, "M": 6, "k": 3, "K": 3, "h": 2, "da": 1, "d": -1, "c": -2, "m": -3, "µ": -6, "u": -6, "n": -9, "p": -12,
}  # fmt: skip
_LONG = {"giga": 9, "mega": 6, "kilo": 3, "deci": -1, "centi": -2, "milli": -3, "micro": -6, "nano": -9}
_SYMBOLS: dict[str, tuple[Unit, str]] = {  # with the prefixes that engineers write before them
    "m": (_M, "k d c m µ u n"), "g": (_KG.times("1/1000"), "k K m µ u"), "s": (_S, "m µ u n p"),
    "A": (_A, "k m µ u n p"), "K": (_K, "m"), "rad": (_RAD, "k K m µ u"), "N": (_N, "M k K da c m µ u n"),
    "Pa": (_PA, "G M k K h m µ u"), "J": (_J, "M k K m µ u"), "W": (_W, "M k K m µ u"), "V": (_V, "k K m µ u n"),
    "Hz": (_CYCLE * _S**-1, "G M k K m"), "Ω": (_V * _A**-1, "M k K m µ u"), "T": (_V * _S * _M**-2, "m µ u n"),
    "H": (_V * _S * _A**-1, "m µ u"), "bar": (_PA.times("100000"), "m"), "l": ((_M**3).times("1/1000"), "m c d"),
    "L": ((_M**3).times("1/1000"), "m c d"), "ε": (NONE, "m µ u n"), "min": (_MINUTE, ""), "h": (_HOUR, ""),
    "d": (_S.times("86400"), ""), "S": (_S, ""), "°": (_DEG, "m"), "in": (_INCH, ""), "ft": (_FOOT, ""),
    "mi": (_M.times("1609.344"), ""), "t": (_KG.times("1000"), ""), "U": (_TURN, ""), "Grad": (_DEG, ""),
    "PS": (_W.times("735.49875"), ""), "Wh": (_W * _HOUR, "M k K m"),
    "G": (_G_N, "m µ u"), "%": (NONE.times("1/100"), ""), "‰": (NONE.times("1/1000"), ""),
    "°C": (Unit(exponents=_K.exponents, offset=Fraction("273.15")), ""),
    "°F": (Unit(Fraction(5, 9), 0, _K.exponents, Fraction("459.67")), ""),
}  # fmt: skip
_WORDS: dict[str, tuple[Unit, str]] = {  # in any case of letters, also with an s at the end
    **{name: _SYMBOLS[symbol] for symbol, names in {
        "m": "meter metre", "g": "gram", "s": "sec second sek sekunde", "A": "ampere amp", "K": "kelvin",
        "rad": "rad radian", "N": "newton", "Pa": "pascal", "J": "joule", "W": "watt", "V": "volt", "Hz": "hertz",
        "Ω": "ohm", "T": "tesla", "H": "henry", "bar": "bar", "l": "liter litre", "ε": "strain", "min": "min minute",
        "h": "hr hour", "d": "day", "°": "deg degree", "in": "inch", "ft": "foot feet", "mi": "mile",
        "t": "tonne", "%": "percent pct", "°C": "degc celsius", "°F": "degf fahrenheit",
    }.items() for name in names.split()},
    "hz": (_CYCLE * _S**-1, "G M k K"), "knot": (_M.times("1852") * _HOUR**-1, ""),
    "sekunden": (_S, ""), "inches": (_INCH, ""), "micron": (_M.times("1e-6"), ""), "thou": (_INCH.times("1/1000"), ""),
    "yd": (_FOOT.times("3"), ""), "yard": (_FOOT.times("3"), ""), "slug": (_POUND_FORCE * _S**2 * _FOOT**-1, ""),
    "lbm": (_POUND, ""), "lbf": (_POUND_FORCE, ""), "kip": (_POUND_FORCE.times("1000"), ""),
    "kgf": (_N.times(_GRAVITY), ""), "kp": (_N.times(_GRAVITY), ""), "gf": (_N.times("0.00980665"), ""),
    "dyn": (_N.times("1e-5"), ""), "psi": (_PSI, ""), "ksi": (_PSI.times("1000"), ""),
    "atm": (_PA.times("101325"), ""), "mmhg": (_PA.times("133.322387415"), ""),
    "hp": (_POUND_FORCE.times("550") * _FOOT * _S**-1, ""),
    "mph": (_M.times("1609.344") * _HOUR**-1, ""), "kmh": (_M.times("1000") * _HOUR**-1, ""),
    "kph": (_M.times("1000") * _HOUR**-1, ""), "rpm": (_TURN * _MINUTE**-1, "k"), "dps": (_DEG * _S**-1, "m"),
    "rps": (_TURN * _S**-1, ""), "turn": (_TURN, ""), "rev": (_TURN, ""), "revolution": (_TURN, ""),
    "umdr": (_TURN, ""), "gon": (_DEG.times("9/10"), ""), "arcmin": (_DEG.times("1/60"), ""),
    "arcsec": (_DEG.times("1/3600"), ""), "cycle": (_CYCLE, ""), "cps": (_CYCLE * _S**-1, ""),
    "ppm": (NONE.times("1e-6"), ""), "count": (_COUNT, ""), "cnt": (_COUNT, ""), "px": (_COUNT, ""),
    "pixel": (_COUNT, ""), "digit": (_COUNT, ""), "lsb": (_COUNT, ""),
    "g_n": (_G_N, "m µ u"), "g0": (_G_N, "m µ u"), "gn": (_G_N, "m µ u"), "g_0": (_G_N, "m µ u"),
}  # fmt: skip
_SECOND: dict[str, tuple[Unit, str]] = {  # another meaning of the same name, which the expected kind decides on
    "g": (_G_N, "m µ u"),
    **dict.fromkeys(("lb", "pound"), (_POUND_FORCE, "")),
    **dict.fromkeys(("oz", "ounce"), (_POUND_FORCE.times("1/16"), "")),
}
_WORDS |= dict.fromkeys(("lb", "pound"), (_POUND, "")) | dict.fromkeys(("oz", "ounce"), (_POUND.times("1/16"), ""))
_JOINED = {  # products written without a sign between them; a power belongs to the last
    **{f"{prefix}Nm": (f"{prefix}N", "m") for prefix in ("", "M", "k", "c", "m", "µ", "u")},
    **{name: tuple(re.findall("kg|mm|cm|mA|kN|[A-Zgmsh]", name)) for name in (
        "Nmm", "kNmm", "Ncm", "Nms", "Nmms", "Ns", "kNs", "kgm", "kgcm", "kgmm", "gcm", "gmm", "Ws", "Vs", "As", "Ah",
        "mAh",
    )},
    "ftlb": ("ft", "lbf"), "lbft": ("lbf", "ft"), "ftlbf": ("ft", "lbf"), "lbfft": ("lbf", "ft"),
    "inlb": ("in", "lbf"), "lbin": ("lbf", "in"), "inlbf": ("in", "lbf"), "lbfin": ("lbf", "in"),
    "ozin": ("oz", "in"), "inoz": ("in", "oz"),
}  # fmt: skip
DOUBTFUL = {"grad": "'deg' or 'gon'", "ton": "'t', 'lbf' or 'kN'", "tons": "'t', 'lbf' or 'kN'"}
"""Names that mean different units to different people, and what to write."""

_SAME = str.maketrans("μº˚−⋅∙•×²³⁴⁻¹", "µ°°-····234-1")
_TOKEN = re.compile(
    r"\s*(?P<sign>[*/·]|(?<=[^\W\d])-(?=[^\W\d°])|\bper\b|)\s*"
    r"(?:(?P<bracket>\()|(?P<word>g_n|g_0|g0|1(?!\d)|°?[^\W\d_]+|[°%‰]))"
)
_POWER = re.compile(r"(?:\s*(?:\^|\*\*)\s*)?([+-]?\d(?:\.\d)?)(?!\d|\.)")


@cache
def readings(text: str) -> tuple[Unit, ...]:
    """Return the units that a text may be, the usual one first; none if it is no product of powers of known units.
    >>> [unit.factor for unit in readings("g")], readings("potato")
    ([0.001, 9.80665], ())
    """
    text = text.strip().translate(_SAME)
    if text == "U":  # a turn in "U/min", a voltage alone
        return ()
    try:
        units, place = _product(text, 0) if text else ([NONE], 0)
    except (KeyError, RecursionError):
        return ()
    return tuple(dict.fromkeys(units)) if place == len(text) else ()


def _product(text: str, place: int) -> tuple[list[Unit], int]:
    """Readings of the product that begins at a place, and the place behind it."""
    so_far, begin = [NONE], place
    while (token := _TOKEN.match(text, place)) is not None:
        if place == begin and token["sign"]:
            raise KeyError(text)
        place = token.end()
        if token["bracket"]:
            units, place = _product(text, place)
            if not text.startswith(")", place):
                raise KeyError(text)
            power, place = _power(text, place + 1)
            factors = [(units, power)]
        else:
            power, place = _power(text, place)
            if token["word"] == "1" and power != 1:
                raise KeyError(text)
            names = _JOINED.get(token["word"], (token["word"],))
            factors = [(list(_named(name)), power if name is names[-1] else 1) for name in names]
        sign = -1 if token["sign"] in ("/", "per") else 1
        for units, power in factors:
            so_far = [first * unit ** (sign * power) if so_far != [NONE] or sign * power != 1 else unit
                     for first, unit in product(so_far, units)]  # fmt: skip
    if place == begin:
        raise KeyError(text)
    return so_far, place


def _power(text: str, place: int) -> tuple[int | Fraction, int]:
    match = _POWER.match(text, place)
    if match is None:
        return 1, place
    power = Fraction(match[1])
    return int(power) if power.denominator == 1 else power, match.end()


@cache
def _named(word: str) -> tuple[Unit, ...]:
    """Units that a word may name."""
    if word == "1":
        return (NONE,)
    units_found = next(iter(_prefixed(word, _SYMBOLS, _WORDS)), None)
    second = next(iter(_prefixed(word, {"g": _SECOND["g"]}, _SECOND)), None)
    units = tuple(unit for unit in (units_found, second) if unit is not None)
    if not units:
        raise KeyError(word)
    return units


def _prefixed(word: str, symbols: dict[str, tuple[Unit, str]], words: dict[str, tuple[Unit, str]]) -> Iterator[Unit]:
    """Yield a unit of a symbol or a word: as it is, then with a prefix, then as a long name with a long prefix."""
    lower = word.lower()
    for known, name in ((symbols, word), (words, lower), (words, lower.removesuffix("s"))):
        if name in known:
            yield known[name][0]
    for prefix, power in _PREFIXES.items():
        rest = word.removeprefix(prefix)
        if rest == word or not rest:
            continue
        for known, name in ((symbols, rest), (words, rest.lower()), (words, rest.lower().removesuffix("s"))):
            unit, prefixes = known.get(name, (NONE, ""))
            if prefix in prefixes.split() and (known is symbols or len(rest) > 1):
                yield unit.times(Fraction(10) ** power)
    for prefix, power in _LONG.items():
        rest = lower.removeprefix(prefix).removesuffix("s")
        if rest != lower and len(rest) > 2 and rest in words:
            yield words[rest][0].times(Fraction(10) ** power)
