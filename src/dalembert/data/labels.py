"""Checks and hashes that all data along a coordinate share."""

import hashlib
from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from dalembert.errors import DataError
from dalembert.forward import Coordinate


def check_labels(coordinate: Coordinate, channels: tuple[str, ...], **arrays: np.ndarray) -> None:
    """Refuse samples that do not grow, channels that repeat, and arrays that are not (samples, channels).

    Raises
    ------
    DataError
    """
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


def coordinate_of(given: Coordinate | ArrayLike) -> Coordinate:
    """A coordinate as it is; an array, shape (samples,), as times in seconds."""
    return given if isinstance(given, Coordinate) else Coordinate("time", "s", np.array(given, dtype=float))


def table_of(coordinate: Coordinate, columns: Mapping[str, ArrayLike]) -> np.ndarray:
    """Array (samples, channels) of columns (samples,) by name.

    Raises
    ------
    DataError
        For a column of another length than the coordinate.
    """
    arrays = [np.array(column, dtype=float) for column in columns.values()]
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
