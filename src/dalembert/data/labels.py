"""Checks and hashes that all data along a coordinate share."""

import hashlib
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from dalembert.errors import DataError, shown
from dalembert.forward import Coordinate


def check_labels(coordinate: Coordinate, channels: tuple[str, ...], **arrays: np.ndarray) -> None:
    """Refuse samples that do not grow, channels that repeat, and arrays that are not (samples, channels)."""
    samples = coordinate.values
    expected = (len(samples), len(channels))
    if len(samples) == 0 or len(channels) == 0:
        raise DataError(f"the data hold {expected[0]} samples of {expected[1]} channels; expected at least one of each")
    for name, array in arrays.items():
        if array.shape != expected:
            raise DataError(
                f"the {name} have shape {array.shape}; expected (samples, channels) = {expected} "
                f"for {', '.join(channels)}"
            )
    repeated = sorted({name for name in channels if channels.count(name) > 1})
    if repeated:
        raise DataError(f"channel names must differ; repeated: {', '.join(repeated)}")
    if not np.all(np.isfinite(samples)):
        row = int(np.argmin(np.isfinite(samples)))
        raise DataError(f"sample {row}: {coordinate.name} is {samples[row]}; expected a finite number")
    back = np.flatnonzero(np.diff(samples) <= 0)
    if len(back):
        row = int(back[0]) + 1
        raise DataError(
            f"sample {row}: {coordinate.name} {samples[row]:.10g} comes after {samples[row - 1]:.10g}; "
            "expected values that grow; sort the samples or remove the repeated one"
        )


def coordinate_of(coordinate: Coordinate | ArrayLike) -> Coordinate:
    """A coordinate as it is; an array, shape (samples,), as times in seconds."""
    if isinstance(coordinate, Coordinate):
        there = coordinate.values
        if isinstance(there, np.ndarray) and there.dtype == float and there.ndim == 1:
            return coordinate
    along = coordinate if isinstance(coordinate, Coordinate) else Coordinate("time", "s", np.asarray(None))
    values = real_numbers(along.values if along is coordinate else coordinate, f"the {along.name}")
    if values.ndim != 1:
        raise DataError(f"the {along.name} has shape {values.shape}; expected (samples,), one value a sample")
    return replace(along, values=values)


def real_numbers(values: Any, what: str) -> np.ndarray:
    """Return an array of floats from anything like an array."""
    try:
        array = np.asarray(values)
    except ValueError:  # rows of unequal length
        raise DataError(f"{what} is {shown(values)}; expected numbers, in rows of equal length") from None
    if np.iscomplexobj(array) and array.size:
        raise DataError(
            f"{what} has complex values, such as {array.flat[0]}; expected real numbers; give the real and the "
            "imaginary part, or amplitude and phase, as two channels"
        )
    if array.dtype.kind in "mM" and array.size:
        raise DataError(f"{what} has dates or time spans, such as {array.flat[0]}; expected numbers in SI units")
    texts = array.dtype.kind in "USO"
    try:
        if not (texts and any("_" in str(entry) for entry in array.flat)):  # which Python alone takes for a number
            return np.array(array, dtype=float)
    except (TypeError, ValueError):
        pass
    for place, entry in np.ndenumerate(array):
        try:
            float("" if "_" in str(entry) else entry)
        except (TypeError, ValueError):
            at = f", sample {place[0]}" if place else ""
            value = entry.item() if isinstance(entry, np.generic) else entry
            raise DataError(f"{what}{at}: {shown(value)}; expected a number") from None
    raise DataError(f"{what} is {shown(values)}; expected numbers")


def by_name(columns: Any) -> Mapping[str, Any]:
    """Columns by name, refused if they are anything else."""
    if not isinstance(columns, Mapping):
        raise DataError(
            f"the channels are {shown(columns)}; expected columns by their names, such as {{'AB.end.x': values}}"
        )
    return columns


def table_of(coordinate: Coordinate, columns: Mapping[str, ArrayLike]) -> np.ndarray:
    """Array (samples, channels) of columns (samples,) by name."""
    arrays = [real_numbers(column, f"channel {name!r}") for name, column in columns.items()]
    for name, column in zip(columns, arrays, strict=True):
        if column.shape != coordinate.values.shape:
            raise DataError(
                f"channel {name!r} has shape {column.shape}; expected {coordinate.values.shape}, "
                f"one value a {coordinate.name}"
            )
    return np.stack(arrays, axis=1) if arrays else np.empty((len(coordinate.values), 0))


def cut(coordinate: Coordinate, samples: int) -> Coordinate:
    """The coordinate of the first ``samples`` samples."""
    return Coordinate(coordinate.name, coordinate.unit, coordinate.values[:samples])


def digest(coordinate: Coordinate, channels: tuple[str, ...], *arrays: np.ndarray) -> str:
    """Hash of labels and numbers."""
    names = "\n".join([coordinate.name, coordinate.unit, *channels])
    parts = (np.ascontiguousarray(part).tobytes() for part in (coordinate.values, *arrays))
    return hashlib.sha256(names.encode() + b"".join(parts)).hexdigest()
