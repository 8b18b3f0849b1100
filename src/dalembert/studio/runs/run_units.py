"""Units in which the study of a run writes its parameters, and values in them."""

import re
import tomllib
from collections.abc import Iterable, Mapping
from typing import Any

from dalembert.quantities import unit
from dalembert.studio.editor.chosen_values import unit_in
from dalembert.studio.editor.entries import table_at
from dalembert.study.run.folder import RunFolder
from dalembert.units import inertial_unit

Unit = tuple[str, float]
"""A unit, and its size in SI units."""
PLAIN: Unit = ("", 1.0)
_OF_CHANNEL = re.compile(r"(?:width|peak|rms|harmonic \d+) of (?P<channel>.+)")
_SIDES = (" lower", " upper")


def run_units(folder: RunFolder, names: Iterable[str]) -> dict[str, Unit]:
    """Return the units of the values of a run by their names, as far as its study or a channel gives one."""
    try:
        document = tomllib.loads(folder.study.read_text(encoding="utf-8"))
    except (OSError, ValueError):  # a damaged run
        document = {}
    found = {name: value_unit(document, name) for name in names}
    return {name: unit for name, unit in found.items() if unit != PLAIN}


def value_unit(document: Mapping[str, Any], name: str) -> Unit:
    """Return the unit of a value: that in which the study writes the parameter, or the SI unit that it states.
    >>> parameters = {"angle": {"lower": "-60 deg", "upper": 0, "unit": "rad"}, "drag": {"lower": 0, "unit": "N*s"}}
    >>> study = {"parameters": parameters, "experiments": [{"name": "high", "local": ["drag"]}]}
    >>> value_unit(study, "angle")[0], value_unit(study, "drag"), value_unit(study, "high.drag")
    ('deg', ('N*s', 1.0), ('N*s', 1.0))
    >>> [value_unit(study, name)[0] for name in ("width of bar.end.x", "drag upper", "arm.mass", "runs")]
    ['m', 'N*s', 'kg', '']
    """
    channel = _OF_CHANNEL.fullmatch(name)
    if channel is not None:
        return unit(channel["channel"]), 1.0
    shared = table_at(document, "parameters")
    name = next((name.removesuffix(side) for side in _SIDES if name not in shared and name.endswith(side)), name)
    written = unit_in(document, name)
    if written != PLAIN:
        return written
    names = (f"{table.get('name')}." for table in document.get("experiments", ()))
    bare = next((name.removeprefix(prefix) for prefix in names if name.startswith(prefix)), name)
    stated = table_at(shared, bare).get("unit", "")
    return str(stated or (inertial_unit(name) if "." in name else "")), 1.0


def in_unit(value: Any, unit: Unit) -> Any:
    """Return a number in SI units in another unit; anything else as it is."""
    return value / unit[1] if isinstance(value, int | float) and not isinstance(value, bool) else value


def values_text(best: Mapping[str, Any], units: Mapping[str, Unit]) -> str:
    """Return identified values with their standard deviations and units in one line.
    >>> best = {"values": {"drag": 0.1999, "angle": -0.5}, "deviations": {"drag": 0.00123, "angle": None}}
    >>> values_text(best, {"angle": ("mrad", 1e-3)})
    'drag = 0.1999 ± 0.0012, angle = -500 mrad'
    """
    return ", ".join(f"{name} = {text}" for name, text in values_of(best, units).items())


def values_of(best: Mapping[str, Any], units: Mapping[str, Unit]) -> dict[str, str]:
    """Return identified values by name, with their standard deviations and units."""
    values, deviations = best.get("values") or {}, best.get("deviations") or {}
    return {name: with_deviation(value, deviations.get(name), units.get(name, PLAIN)) for name, value in values.items()}


def with_deviation(value: object, deviation: object, unit: Unit = PLAIN) -> str:
    """Return an identified value and its standard deviation, with two digits, if they are known, and the unit.
    >>> with_deviation(0.7853981, 1.23e-4), with_deviation(2.0, None), with_deviation(None, None)
    ('0.785398 ± 0.00012', '2', '')
    >>> with_deviation(0.5, 0.01, ("mrad", 1e-3)), with_deviation(0.5, None, ("m", 1.0))
    ('500 ± 10 mrad', '0.5 m')
    """
    value, deviation = in_unit(value, unit), in_unit(deviation, unit)
    text = f"{value:.6g}" if isinstance(value, int | float) else ""
    if text and isinstance(deviation, int | float):
        text = f"{text} ± {deviation:.2g}"
    return f"{text} {unit[0]}".rstrip() if text else ""
