"""Numbers as people read them: no more digits than are known, and prefixes of units."""

import math

SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def shown(value: float | None, deviation: float | None = None, digits: int = 6) -> str:
    """Text of a number.

    Parameters
    ----------
    value : float or None
    deviation : float, optional
        Standard deviation; the text then ends with the second digit of it.
    digits : int
        Significant digits where there is no deviation, trailing zeros dropped.

    Examples
    --------
    >>> shown(0.78539816, 1.2e-5), shown(2e8, 3e5), shown(41), shown(1.65e-8), shown(float("nan"))
    ('0.785398', '2.0000 × 10⁸', '41', '1.65 × 10⁻⁸', '–')
    """
    if value is None or math.isnan(value):
        return "–"
    if math.isinf(value):
        return "∞" if value > 0 else "−∞"
    if value == 0:
        return "0"
    known = deviation is not None and math.isfinite(deviation) and deviation > 0
    if known and deviation:
        digits = min(max(_exponent(value) - _exponent(deviation) + 2, 2), 12)
    rounded = float(f"{value:.{digits - 1}e}")
    exponent = _exponent(rounded)
    if -4 < exponent < 6:
        text = f"{rounded:.{max(digits - 1 - exponent, 0)}f}"
        text = text if known else _trimmed(text)
    else:
        mantissa, _, power = f"{rounded:.{digits - 1}e}".partition("e")
        mantissa = mantissa if known else _trimmed(mantissa)
        text = f"{mantissa} × 10{str(int(power)).translate(SUPERSCRIPTS)}"
    return text.replace("-", "−")


def with_deviation(value: float, deviation: float) -> str:
    """Text of a number and its standard deviation, to the same decimal.

    Examples
    --------
    >>> with_deviation(0.78539816, 1.2e-5), with_deviation(2e8, 3e5), with_deviation(0.5, float("nan"))
    ('0.785398 ± 0.000012', '(2.0000 ± 0.0030) × 10⁸', '0.5')
    """
    if not (math.isfinite(deviation) and deviation > 0):
        return shown(value)
    mantissa, _, power = shown(value, deviation).partition(" × ")
    size = 10.0 ** _exponent(value) if power else 1.0
    spread = f"{deviation / size:.{len(mantissa.partition('.')[2])}f}"
    return f"({mantissa} ± {spread}) × {power}" if power else f"{mantissa} ± {spread}"


def interval(lower: float, upper: float) -> str:
    """Text of an interval; one number where its ends are the same.

    Examples
    --------
    >>> interval(0.74613, 0.8247), interval(0.5, 0.5)
    ('[0.74613, 0.8247]', '0.5')
    """
    return shown(float(lower)) if lower == upper else f"[{shown(float(lower))}, {shown(float(upper))}]"


def counted(number: int) -> str:
    """Text of a whole number, in groups of three digits.

    Examples
    --------
    >>> counted(41), counted(4000)
    ('41', '4 000')
    """
    return f"{number:,}".replace(",", " ")


def percent(part: float, digits: int = 3) -> str:
    """Text of a part of a whole in percent.

    Examples
    --------
    >>> percent(0.12345)
    '12.3 %'
    """
    return f"{shown(100 * float(part), digits=digits)} %"


def _exponent(value: float) -> int:
    return math.floor(math.log10(abs(value)))


def _trimmed(text: str) -> str:
    return text.rstrip("0").rstrip(".") if "." in text else text


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
