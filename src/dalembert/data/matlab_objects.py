"""Numbers in the objects of a MAT file: tables, timetables, timeseries, and datasets of Simulink."""

import re
import warnings
from collections.abc import Iterator
from importlib import import_module
from typing import Any

import numpy as np

Array = tuple[str, np.ndarray, str]
"""Name as MATLAB writes it, values, and unit (``""`` if the object has none)."""

TIMESERIES, DATASET = "timeseries", "Simulink.SimulationData.Dataset"
"""Classes whose saved properties differ from those that MATLAB shows."""


def object_arrays(path: str) -> list[Array]:
    """Return the arrays of a MAT file with objects; those outside of objects as well. Names are those of MATLAB: a
    variable of a table ``run.angle``, the times of a timetable ``run.Time``, a timeseries ``run.Time`` and
    ``run.Data``, the first element of a dataset of Simulink ``logsout{1}.Values.Data``. Properties of other classes are
    named as fields of structs are.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of time zones and display formats
        variables = import_module("matio").load_from_mat(path, add_table_attrs=True)
    return [entry for name, value in variables.items() for entry in _arrays(name, value)]


def _arrays(name: str, value: Any) -> Iterator[Array]:
    if hasattr(value, "columns"):
        yield from _of_table(name, value)
    elif hasattr(value, "classname") and hasattr(value, "properties"):
        yield from _of_object(name, value.classname, value.properties)
    elif isinstance(value, np.ndarray) and value.dtype.names is not None:
        entries = value.ravel(order="F")
        for number, entry in enumerate(entries, start=1):
            front = name if len(entries) == 1 else f"{name}({number})"
            for field in value.dtype.names:
                yield from _arrays(f"{front}.{field}", entry[field])
    elif isinstance(value, np.ndarray) and value.dtype.kind == "O":
        for number, entry in enumerate(value.ravel(order="F"), start=1):
            yield from _arrays(f"{name}{{{number}}}", entry)
    elif isinstance(value, np.ndarray) and value.dtype.kind in "fiubcmM" and value.size:
        array = _seconds(value)
        yield name, np.atleast_1d(np.squeeze(array)), "s" if value.dtype.kind == "m" else ""


def _of_table(name: str, frame: Any) -> Iterator[Array]:
    units = frame.attrs.get("VariableUnits") or frame.attrs.get("varUnits") or []
    if frame.index.dtype.kind in "mM":
        times = frame.index.to_numpy()
        yield f"{name}.{frame.index.name or 'Time'}", _seconds(times), "s" if times.dtype.kind == "m" else ""
    variables = list(frame.columns)
    units = units if len(units) == len(variables) else [""] * len(variables)  # a matrix is split into several columns
    for variable, unit in zip(variables, units, strict=True):
        array = frame[variable].to_numpy()
        if array.dtype.kind in "fiubmM":
            yield f"{name}.{variable}", _seconds(array), "s" if array.dtype.kind == "m" else str(unit)


def _of_object(name: str, kind: str, properties: Any) -> Iterator[Array]:
    if kind == TIMESERIES:
        yield from _of_timeseries(name, properties)
    elif kind == DATASET and hasattr(storage := properties.get("Storage_"), "properties"):
        yield from _arrays(
            name, next((storage.properties[key] for key in _ELEMENTS if key in storage.properties), None)
        )
    elif isinstance(properties, dict):
        for key, value in properties.items():
            yield from _arrays(f"{name}.{key}", value)


_ELEMENTS = ("Elements", "Elements_")


def _of_timeseries(name: str, properties: dict[str, Any]) -> Iterator[Array]:
    """Times and data. Even times are saved as their start, increment and number, without an array."""
    about = _properties(properties, "TimeInfo")
    times = _numbers(properties, "Time")
    times = times if times.size else _numbers(about, "Time")
    data = np.squeeze(_numbers(properties, "Data"))
    start, step, length = (_numbers(about, key) for key in ("Start", "Increment", "Length"))
    if not times.size and step.size and np.all(np.isfinite(step)):
        times = (start.item() if start.size else 0.0) + step.item() * np.arange(int(length.item()))
    yield f"{name}.Time", np.ravel(times), _text(about.get("Units")) or "s"
    if data.dtype.kind in "fiubc":
        yield f"{name}.Data", np.atleast_1d(data), _text(_properties(properties, "DataInfo").get("Units"))


def _properties(properties: dict[str, Any], key: str) -> dict[str, Any]:
    values = (getattr(properties.get(name), "properties", None) for name in (f"{key}_", key))
    return next((value for value in values if isinstance(value, dict)), {})


def _numbers(properties: dict[str, Any], key: str) -> np.ndarray:
    """Numbers of a property, which is saved with or without an underscore; empty if it has none."""
    arrays = (properties.get(name) for name in (key, f"{key}_"))
    return next((array for array in arrays if isinstance(array, np.ndarray) and array.size), np.zeros(0))


def _text(value: Any) -> str:
    """
    >>> _text(np.array(["seconds"])), _text(None)
    ('seconds', '')
    """
    array = np.asarray("" if value is None else value)
    return str(array.item()) if array.dtype.kind == "U" and array.size == 1 else ""


def _seconds(array: np.ndarray) -> np.ndarray:
    """Durations in s; anything else as it is."""
    if array.dtype.kind != "m":
        return array
    seconds = array.astype("timedelta64[ns]").astype(np.int64) * 1e-9
    return np.where(np.isnat(array), np.nan, seconds)


def array_of(column: str) -> str:
    """Return the array of a column: without the number of a column or row of a matrix.

    >>> array_of("run.q(:,1)"), array_of("out.signals(1).values")
    ('run.q', 'out.signals(1).values')
    """
    return re.sub(r"\((:,\d+|\d+,:)\)$", "", column)
