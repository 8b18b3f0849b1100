"""Quantities with units at the edge, plain SI numbers inside."""

import math
import re
from functools import cache

from dalembert.decimal_units import decimal_unit, in_si
from dalembert.errors import InputError

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
    "1/s": ("rate", "5 1/ms"),
    "Hz": ("frequency", "2 kHz"),
    "": ("number without a unit", "0.3"),
}
_QUANTITY = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*((?:[^\W\d_]|[°µμ%]|1/)[^()]{0,60}?)\s*")

_TERM = r"(?:[^\W\d]|[°%])\w*(?:(?:\^|\*\*)[+-]?\d(?:\.\d)?)?"
_UNIT = re.compile(rf"(?:1\s*/\s*)?{_TERM}(?:(?:\s*[*/·]\s*|\s+){_TERM})*")


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

    Raises
    ------
    InputError
        If the value is not a finite number, or its unit is unknown or measures something else.

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
        given = _unit(match[2])
    except ValueError as error:
        raise InputError(sentence(text, None, "", str(error))) from None
    for known in KNOWN:
        if _unit(known).dimensionality == given.dimensionality and _angular(_unit(known)) == _angular(given):
            return known
    return f"{_registry().Quantity(1, given).to_base_units().units:~C}"


def is_si(unit: str) -> bool:
    """Whether a unit is coherent SI, so that numbers in it need no conversion.

    >>> is_si("Pa"), is_si("rad/s"), is_si("mm"), is_si("deg"), is_si("potato")
    (True, True, False, False, False)
    """
    known = decimal_unit(unit)
    if known is not None:
        return known[0] == 0
    try:
        return _registry().Quantity(1, _unit(unit)).to_base_units().magnitude == 1
    except ValueError:
        return False


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
    quick = in_si(match[1], match[2], unit)
    if quick is not None:
        return quick
    given = _unit(match[2])
    quantity = _registry().Quantity(float(match[1]), given)
    if unit is None:
        return _tidy(quantity.to_base_units().magnitude)
    wanted = _unit(unit)
    if given.dimensionality != wanted.dimensionality:
        raise ValueError
    if "hertz" in str(given) and _angular(wanted):
        raise ValueError("a frequency in Hz is no angular velocity: multiply it by 2 pi, or write it in rpm")
    return _tidy(quantity.to(wanted).magnitude)


def _tidy(number: float) -> float:
    """The short decimal that a conversion missed by a last bit: 7850.0 for 7849.999999999999."""
    short = float(f"{number:.14g}")
    return short if abs(short - number) <= 2 * math.ulp(number) else float(number)


def _unit(text: str):
    if text and not _UNIT.fullmatch(text):  # pint would compute a power such as 9**9**9
        raise ValueError(f"the unit {text!r} is unknown")
    try:
        return _registry().parse_units(text)
    except Exception:  # pint answers malformed text with many types, AssertionError among them
        raise ValueError(f"the unit {text!r} is unknown") from None


def _angular(unit) -> bool:
    return "radian" in str(_registry().Quantity(1, unit).to_root_units().units)


@cache
def _registry():
    import pint  # a third of a second that only a study with units such as degrees pays

    return pint.UnitRegistry()


def unit_of(dof: str) -> str:
    """Unit of a degree of freedom, by its direction; m of a name without one.

    >>> unit_of("A.x"), unit_of("A.ry"), unit_of("m2")
    ('m', 'rad', 'm')
    """
    return OF_DIRECTION.get(dof.rpartition(".")[2], "m")


def inertial_unit(parameter: str) -> str:
    """Unit of an inertial parameter of a link by the end of its name; empty where that does not tell it.

    >>> [inertial_unit(f"arm.{entry}") for entry in ("mass", "first_x", "second_xy", "friction")]
    ['kg', 'kg*m', 'kg*m^2', '']
    """
    kind = parameter.rpartition(".")[2].partition("_")[0]
    return {"mass": "kg", "first": "kg*m", "second": "kg*m^2"}.get(kind, "")
