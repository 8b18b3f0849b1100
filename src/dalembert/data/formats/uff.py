"""Columns of a universal file: functions at nodes, its dataset 58 (ASCII or binary)."""

from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from dalembert.data.columns import Columns, chosen, foreign
from dalembert.data.format import Format, Request
from dalembert.data.opening import library, reading
from dalembert.errors import DataError, unknown

TIME, FREQUENCY = 17, 18
AXES = ("X", "Y", "Z", "RX", "RY", "RZ")
"""Directions 1 to 6; negative numbers point the other way."""


class Uff(Format):
    """Universal files, dataset 58."""

    name = "uff"
    suffixes = (".uff", ".unv", ".uf", ".bunv")

    def columns(self, path: Path, request: Request) -> Columns:
        if request.time is None:
            raise DataError(f"{path}: sampling is given, and a universal file has its own times; leave it out")
        return uff_columns(path, request.labels, request.missing, request.units)


def uff_columns(path: Path, names: Iterable[str] | None, missing: str, units: Iterable[str] = ()) -> Columns:
    """Abscissa and functions, each named after its response: node and direction, ``12:+X``. Where several functions
    have the same response they are numbered, ``12:+X#1``, ``12:+X#2``; a function may be named by its first ID line
    too, if no other has the same. ``units`` are the columns whose unit is known.
    """
    with reading(path, "UFF"):
        file = library("pyuff", path, "UFF files").UFF(str(path))
        kinds = [int(kind) for kind in file.get_set_types()]
        functions = [file.read_sets(place) for place, kind in enumerate(kinds) if kind == 58]
        systems = [file.read_sets(place) for place, kind in enumerate(kinds) if kind == 164]
    if not functions:
        numbers = ", ".join(sorted({str(kind) for kind in kinds})) or "none"
        raise DataError(f"{path}: no function at a node, dataset 58; the file holds datasets: {numbers}")
    labels = _labels(functions)
    lines = Counter(function["id1"] for function in functions)
    also = {f["id1"]: label for label, f in zip(labels, functions, strict=True) if f["id1"] and lines[f["id1"]] == 1}
    by_label = dict(zip(labels, functions, strict=True))
    wanted = labels if names is None else list(dict.fromkeys(names))
    for name in wanted:
        if name not in by_label and name not in also:
            raise DataError(unknown("column", name, [*by_label, *also], str(path)))
    picked = {name: by_label[also.get(name, name) if name not in by_label else name] for name in wanted}
    for name, function in picked.items():
        _check(path, name, function)
        if name not in units:
            _check_unit(path, name, function, systems)
    first, reference = next(iter(picked.items()))
    for name, function in picked.items():
        if not np.array_equal(function["x"], reference["x"]) or _along(function) != _along(reference):
            raise DataError(
                f"{path}: the functions {first!r} and {name!r} have different abscissas; expected one for all that are "
                "read together; read each by itself, and resample one at the other's samples"
            )
    columns = {"t": reference["x"], **{name: function["data"] for name, function in picked.items()}}
    return Columns(path, "t", *chosen(path, columns, "t", wanted, missing), frequency=_along(reference) == FREQUENCY)


def _labels(functions: list[dict[str, Any]]) -> list[str]:
    names = [f"{f['rsp_node']}:{_direction(f['rsp_dir'])}".rstrip(":") for f in functions]
    several = Counter(names)
    count: Counter[str] = Counter()
    labels = []
    for name in names:
        count[name] += 1
        labels.append(f"{name}#{count[name]}" if several[name] > 1 else name)
    return labels


def _direction(number: int) -> str:
    """
    >>> _direction(1), _direction(-6), _direction(0)
    ('+X', '-RZ', '')
    """
    if not 1 <= abs(number) <= len(AXES):
        return "" if number == 0 else str(number)
    return f"{'-' if number < 0 else '+'}{AXES[abs(number) - 1]}"


def _along(function: dict[str, Any]) -> int:
    return FREQUENCY if function["abscissa_spec_data_type"] == FREQUENCY else TIME


def _check(path: Path, name: str, function: dict[str, Any]) -> None:
    count, promised = len(function["data"]), function["num_pts"]
    if count != promised:
        raise DataError(f"{path}, column {name!r}: {count} values; the file promises {promised}; is it cut short?")
    kind = function["abscissa_spec_data_type"]
    if kind not in (0, 1, TIME, FREQUENCY):
        raise DataError(
            f"{path}, column {name!r}: its abscissa is of type {kind}; expected time ({TIME}) or frequency "
            f"({FREQUENCY})"
        )


def _check_unit(path: Path, name: str, function: dict[str, Any], systems: list[dict[str, Any]]) -> None:
    label = function["ordinate_axis_units_lab"].strip()
    other = [system for system in systems if system["length"] != 1 or system["force"] != 1]
    if foreign(label):
        says = f"the file calls its unit {label!r}"
    elif other and label in ("", "NONE"):
        says = f"the file's units are {other[0]['units_description'].strip()!r} (dataset 164)"
    else:
        return
    raise DataError(f"{path}, column {name!r}: {says}, which is not SI; give its unit: units = {{{name!r}: ...}}")
