"""Quantities with units at the edge, plain SI numbers inside."""

import math
import re
from fractions import Fraction
from itertools import zip_longest

from dalembert.errors import InputError
from dalembert.unit_table import BASE, DOUBTFUL, Unit, readings

# Units of a structure's degrees of freedom by their direction: displacements, rotations, twist, modal coordinate.
OF_DIRECTION = {"x": "m", "y": "m", "z": "m", "rx": "rad", "ry": "rad", "rz": "rad", "rxy": "1/m", "q": "m √kg"}

# What a unit measures, and an example that a user may write in another unit.
KNOWN = {
    "m": ("length", "400 mm"),
    "rad": ("angle", "45 deg"),
    "s": ("time", "20 ms"),
    "kg": ("mass", "500 g"),
    "Pa": ("pressure or modulus", "200 GPa"),
    "kg/m^3": ("density", "7.85 g/cm^3"),
    "kg*m^2": ("moment of inertia", "120 kg*cm^2"),
    "m/s": ("speed", "36 km/h"),
    "rad/s": ("angular velocity", "60 rpm"),
    "m/s^2": ("acceleration", "980 cm/s^2"),
    "rad/s^2": ("angular acceleration", "90 deg/s^2"),
    "N": ("force", "2 kN"),
    "N*m": ("torque", "500 N*mm"),
    "N/m": ("stiffness", "20 N/mm"),
    "N/m^3": ("cubic stiffness", "3 N/mm^3"),
    "N*s/m": ("damping coefficient", "0.5 N*s/mm"),
    "N*m/rad": ("torsional stiffness", "2 N*m/deg"),
    "N*m*s/rad": ("torsional damping coefficient", "5 N*mm*s/rad"),
    "N*m*s": ("torsional damping coefficient", "5 N*mm*s"),
    "m^2": ("area", "80 cm^2"),
    "m^4": ("second moment of area", "12 cm^4"),
    "J": ("energy", "3 kJ"),
    "W": ("power", "2 kW"),
    "A": ("electric current", "200 mA"),
    "V": ("voltage", "500 mV"),
    "K": ("temperature", "300 K"),
    "1/s": ("rate", "5 1/ms"),
    "Hz": ("frequency", "2 kHz"),
    "": ("number without a unit", "0.3"),
}
_QUANTITY = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*((?:[^\W\d_]|[°º%‰]|1/)[^()]{0,60}?)\s*")
_RAD, _CYCLE, _COUNT = map(BASE.index, ("rad", "cycle", "count"))


def si(value: object, unit: str | None, where: str = "") -> float:
    """Number in SI units, from a number that already is or from a string with its own unit.

    Parameters
    ----------
    value : float or str
        ``0.4``, ``"0.4"`` or ``"400 mm"``.
    unit : str or None
        SI unit expected, for example ``"m"`` or ``"kg/m^3"``; ``""`` for a pure number, None for any.
    where : str
        Place named at the front of an error, for example ``"beam OA, length"``.

    Examples
    --------
    >>> si("400 mm", "m"), si(0.4, "m"), si("60 rpm", "rad/s")
    (0.4, 0.4, 6.283185307179586)
    >>> si("3 kg", "m", where="length")
    Traceback (most recent call last):
    dalembert.errors.InputError: length: '3 kg' was given; expected a length such as '400 mm' or 0.4 in m
    """
    try:
        number = _converted(value, unit)
    except (ValueError, OverflowError) as error:
        raise InputError(sentence(value, unit, where, str(error))) from None
    if not math.isfinite(number):
        raise InputError(sentence(value, unit, where, "it is not a finite number"))
    return number


def is_quantity(text: str) -> bool:
    """Whether a text reads as a number followed by a unit, so that it is no expression.

    >>> is_quantity("400 mm"), is_quantity("9.81 m/s^2"), is_quantity("2*L"), is_quantity("-theta1")
    (True, True, False, False)
    """
    return _QUANTITY.fullmatch(text) is not None


def symbol(text: str) -> str:
    """SI unit symbol of what a text like ``"200 MPa"`` measures.

    >>> symbol("200 MPa"), symbol("30 deg")
    ('Pa', 'rad')
    """
    match = _QUANTITY.fullmatch(text)
    if match is None:
        return ""
    try:
        unit = _reading(match[2], None)
    except ValueError as error:
        raise InputError(sentence(text, None, "", str(error))) from None
    return si_unit(unit)


def is_si(unit: str) -> bool:
    """Whether a unit is coherent SI, so that numbers in it need no conversion.

    >>> is_si("Pa"), is_si("rad/s"), is_si("mm"), is_si("deg"), is_si("potato")
    (True, True, False, False, False)
    """
    return any(reading.factor == 1 and reading.offset == 0 for reading in readings(unit)[:1])


def factor_of(unit: str, wanted: str | None = None, *, measured: bool = False) -> float:
    """Return how many SI units a unit is.

    Parameters
    ----------
    unit : str
    wanted : str, optional
        SI unit of what it measures, which decides on names with two meanings: ``"g"``, ``"lb"``, ``"oz"``.
    measured : bool
        Whether it is the unit of measured numbers: ``"g"`` and ``"lb"`` alone are then an acceleration and a force if
        nothing else decides.

    Examples
    --------
    >>> factor_of("mm"), factor_of("g"), factor_of("g", "m/s^2"), factor_of("g", measured=True)
    (0.001, 0.001, 9.80665, 9.80665)
    """
    try:
        reading = _reading(unit, wanted, measured=measured)
    except ValueError as error:
        raise InputError(str(error) or f"the unit {unit!r} was given; expected that of {expected(wanted)}") from None
    if reading.offset:
        raise InputError(f"the unit {unit!r} has an offset; expected a multiple of an SI unit, such as 'K'")
    return reading.factor


def wrong_kind(unit: str, wanted: str) -> str:
    """Return a sentence if the unit of measured numbers does not suit an SI unit; empty if it does, or is unknown.

    >>> wrong_kind("deg", "rad"), wrong_kind("kg", "rad")
    ('', "the unit 'kg' was given; expected that of an angle such as '45 deg' or 0.785398 in rad")
    """
    if not unit.strip("-1 ") or not readings(unit) or not readings(wanted):
        return ""
    try:
        factor = factor_of(unit, wanted)
    except InputError:
        return f"the unit {unit!r} was given; expected that of {expected(wanted)}"
    if factor != factor_of(unit, measured=True):
        return f"the unit {unit!r} has two meanings; write 'kg', 'lbm', 'N', 'lbf' or 'g_n'"
    return ""


def expected(unit: str | None) -> str:
    """What a user may write where a unit is expected.

    >>> expected("m")
    "a length such as '400 mm' or 0.4 in m"
    """
    if unit is None:
        return "a number in SI units, or a number with its unit such as '400 mm'"
    if unit == "":
        return "a number without a unit such as 0.3"
    unit = unit.replace("**", "^")
    if unit not in KNOWN:
        return f"a number in {unit}, or a number with a unit of that kind"
    word, example = KNOWN[unit]
    article = "an" if word[0] in "aeiou" else "a"
    return f"{article} {word} such as {example!r} or {_converted(example, unit):.6g} in {unit}"


def sentence(value: object, unit: str | None, where: str = "", reason: str = "") -> str:
    """Sentence for a value that cannot be the quantity expected."""
    prefix = f"{where}: " if where else ""
    return f"{prefix}{value!r} was given{f', but {reason}' if reason else ''}; expected {expected(unit)}"


def _converted(value: object, unit: str | None) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise ValueError
    if not isinstance(value, str):
        return float(value)
    match = _QUANTITY.fullmatch(value)
    if match is None:
        try:
            return float(value)
        except ValueError:
            raise ValueError from None
    number, reading = float(match[1]), _reading(match[2], unit)
    if reading.turns or not math.isfinite(number) or number == 0:
        return _tidy(number * reading.factor)
    return float((Fraction(match[1]) + reading.offset) * reading.scale)


def _tidy(number: float) -> float:
    """The short decimal that a conversion missed by a last bit: 7850.0 for 7849.999999999999."""
    short = float(f"{number:.14g}")
    return short if abs(short - number) <= 2 * math.ulp(number) else float(number)


def _reading(text: str, wanted: str | None, *, measured: bool = False) -> Unit:
    """What a unit is: of several readings the one that measures what is wanted, or else the usual one."""
    candidates = readings(text)
    if not candidates:
        more = f" because it has several meanings; write {DOUBTFUL[text]}" if text in DOUBTFUL else ""
        raise ValueError(f"the unit {text!r} is unknown{more}")
    if wanted is None or not readings(wanted):
        if measured and text.strip().isalpha():
            return candidates[-1]
        return next((candidate for candidate in candidates if _is_known(candidate)), candidates[0])
    reasons = [difference(candidate, readings(wanted)[0]) for candidate in candidates]
    for candidate, reason in zip(candidates, reasons, strict=True):
        if reason is None:
            return candidate
    raise ValueError(reasons[0])


def difference(unit: Unit, wanted: Unit) -> str | None:
    """Return why a unit does not measure what another one does, in words or ``""``; None if it does.

    Radians, cycles and counts are numbers, so ``"N*m"`` stands for ``"N*m/rad"`` too.
    """
    if unit.exponents[:_RAD] != wanted.exponents[:_RAD]:
        return ""
    if unit.exponents[_COUNT] != wanted.exponents[_COUNT] and any(wanted.exponents[:_COUNT]):
        return ""
    if unit.exponents[_CYCLE] and wanted.exponents[_RAD]:
        return "a frequency in Hz is no angular velocity: multiply it by 2 pi, or write it in rpm"
    if unit.exponents[_RAD] and wanted.exponents[_CYCLE]:
        return "an angular velocity is no frequency: divide it by 2 pi, and write it in Hz"
    if wanted == readings("rad/s")[0] and not unit.exponents[_RAD] and unit.scale != 1:
        return "a rate without an angle is no angular velocity: write it in rpm or rad/s"
    return None


def _is_known(unit: Unit) -> bool:
    return any(readings(known)[0].exponents == unit.exponents for known in KNOWN)


def si_unit(unit: Unit) -> str:
    """Return the coherent SI unit of what a unit measures.

    >>> si_unit(readings("kNm")[0]), si_unit(readings("Nm/A")[0])
    ('N*m', 'kg*m^2/s^2/A')
    """
    for known in KNOWN:
        if readings(known)[0].exponents == unit.exponents:
            return known
    powers = [(name, float(power)) for name, power in zip_longest(BASE, unit.exponents) if power]
    above = "*".join(name if power == 1 else f"{name}^{power:g}" for name, power in powers if power > 0)
    below = "".join(f"/{name}" if power == -1 else f"/{name}^{-power:g}" for name, power in powers if power < 0)
    return (above or "1") + below


def unit_of(dof: str) -> str:
    """Unit of a degree of freedom, by its direction; m of a name without one.

    >>> unit_of("A.x"), unit_of("A.ry"), unit_of("m2")
    ('m', 'rad', 'm')
    """
    return OF_DIRECTION.get(dof.rpartition(".")[2], "m")


def inertial_unit(parameter: str) -> str:
    """Unit of an inertial parameter of a link by the end of its name; empty for other names.

    >>> [inertial_unit(f"arm.{entry}") for entry in ("mass", "first_x", "second_xy", "friction")]
    ['kg', 'kg*m', 'kg*m^2', '']
    """
    kind = parameter.rpartition(".")[2].partition("_")[0]
    return {"mass": "kg", "first": "kg*m", "second": "kg*m^2"}.get(kind, "")
