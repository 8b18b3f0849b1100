"""What the columns of a file probably are: the times among them, and the unit of each."""

import re
from dataclasses import dataclass
from typing import Literal

import numpy as np

from dalembert.data.preview import Preview, PreviewColumn
from dalembert.data.unit_suffixes import NAMED, suffix
from dalembert.errors import InputError
from dalembert.units import si, symbol

TIMES = {"t", "time", "times", "timestamp", "time stamp", "zeit", "temps", "tiempo", "tempo", "tid", "seconds", "sec"}
"""What columns of times are called, without a unit."""
OF_STEPS = ((0.5, "s"), (500.0, "ms"), (5e5, "us"), (np.inf, "ns"))
"""Units of times that no name gives: the first whose limit is above the usual step, at sampling rates above 2 Hz."""

Source = Literal["file", "name", "steps", ""]


@dataclass(frozen=True)
class Unit:
    """A unit that a column probably has; ``name``: ``""`` where nothing gives it. ``source``: ``"file"`` (the file
    names it), ``"name"`` (the column's name ends in it), ``"steps"`` (the steps of the times are usual in it) or
    ``""``.
    """

    name: str
    source: Source


def time_column(preview: Preview) -> str | int | None:
    """Return the column that probably has the times: by name, else by unit, else the first that grows evenly."""
    columns = preview.columns
    named = [column for column in columns if _bare(str(column.key)) in TIMES or _named_unit(str(column.key)) == "s"]
    named += [column for column in columns if column.unit and _measures(column.unit) == "s"]
    growing = [column for column in columns if _grows(column.values)]
    even = [column for column in growing if _is_even(column.values)]
    return next((column.key for column in (*named, *even, *growing)), None)


def unit_of(column: PreviewColumn, *, times: bool = False) -> Unit:
    """Return the unit that a column probably has: by the file, by its name, or by the steps of ``times``."""
    if column.unit:
        return Unit(column.unit, "file")
    unit = suffix(str(column.key))
    if unit and (_measures(unit) == "s") == times:
        return Unit(unit, "name")
    if times:
        steps = np.abs(np.diff(column.values))
        usual = float(np.nanmedian(steps)) if np.isfinite(steps).any() else 0.0
        return Unit(next(unit for limit, unit in OF_STEPS if usual < limit), "steps")
    return Unit("", "")


def _bare(name: str) -> str:
    plain = re.sub(r"[\[(].*?[\])]", "", name).strip().lower()
    stem = re.sub(r"[_\s.\-]*$", "", plain)
    first, _, last = re.sub(r"[\s.\-]", "_", stem).rpartition("_")
    return first.replace("_", " ") if first and last in NAMED else stem.replace("_", " ")


def _named_unit(name: str) -> str:
    return _measures(NAMED[name.lower()]) if len(name) > 1 and name.lower() in NAMED else ""


def _measures(unit: str) -> str:
    """SI unit of what a unit measures; ``""`` if it is unknown."""
    try:
        si(f"1 {unit}", None)
        return symbol(f"1 {unit}")
    except InputError:
        return ""


def _grows(values: np.ndarray) -> bool:
    return len(values) > 1 and bool(np.isfinite(values).all() and np.all(np.diff(values) > 0))


def _is_even(values: np.ndarray) -> bool:
    steps = np.diff(values)
    return bool(np.ptp(steps) <= 0.01 * np.median(steps))
