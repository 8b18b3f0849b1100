"""Columns of a file, whatever its format: chosen by name, checked, and in SI units."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from dalembert.arguments import is_real
from dalembert.data.clock_times import clock_seconds
from dalembert.data.unit_suffixes import sure_suffix
from dalembert.errors import DataError, InputError, unknown
from dalembert.forward import Coordinate
from dalembert.unit_table import readings
from dalembert.units import factor_of, is_si


@dataclass(frozen=True, eq=False)
class Columns:
    """What a file holds.

    Parameters
    ----------
    path : Path
    time : str
        Name of the column that the samples lie along.
    along : array, shape (samples,)
        Its numbers, growing.
    table : mapping of str to array, shape (samples,)
        The other columns.
    units : mapping of str to str
        Units of columns that the file itself names.
    frequency : bool
        Whether the samples lie along a frequency in Hz, not along time.
    layout : str
        What a text file was taken to be, in words.
    """

    path: Path
    time: str
    along: np.ndarray
    table: Mapping[str, np.ndarray]
    units: Mapping[str, str] = field(default_factory=dict)
    frequency: bool = False
    layout: str = ""

    def converted(self, units: Mapping[str, str] | None) -> tuple[Coordinate, dict[str, np.ndarray]]:
        """Coordinate and columns in SI units, from the given units, or else those that the file names.

        Raises
        ------
        DataError
            For a unit that is unknown, that is not a multiple of an SI unit, or that is no time for the times; for a
            unit of a column that there is not.
        """
        for name in units or {}:
            if name not in (self.time, *self.table):
                raise DataError(unknown("column", name, [self.time, *self.table], f"{self.path}, units"))
        chosen = self.named_units(units)
        name, unit = ("frequency", "Hz") if self.frequency else ("time", "s")
        along = self.along * self._factor(self.time, chosen, unit)
        table = {column: values * self._factor(column, chosen, None) for column, values in self.table.items()}
        return Coordinate(name, unit, along), table

    def named_units(self, units: Mapping[str, str] | None) -> dict[str, str]:
        """Units of columns that are given, or else that the file names, or else at the ends of their names."""
        suffixes = {name: sure_suffix(name) for name in self.table}
        suffixes[self.time] = sure_suffix(self.time, "Hz" if self.frequency else "s")
        named = {name: unit for name, unit in self.units.items() if unit.strip()}
        return {name: unit.strip() for name, unit in (suffixes | named | dict(units or {})).items() if unit.strip()}

    def _factor(self, column: str, units: Mapping[str, str], expected: str | None) -> float:
        unit = units.get(column, "")
        if unit in ("", "-", "1"):
            return 1.0
        where = f"{self.path}, column {column!r}"
        try:
            factor = factor_of(unit, measured=True)
        except InputError as error:
            more = "" if readings(unit) else "; expected one such as 'mm', 'deg' or 'm/s^2'; give it in units"
            raise DataError(f"{where}: {error}{more}") from None
        if expected is None:
            return factor
        try:
            return factor_of(unit, expected)
        except InputError:
            kind = "frequency such as 'Hz' or 'kHz'" if self.frequency else "time such as 's' or 'ms'"
            raise DataError(f"{where}: the unit {unit!r} was given; expected a unit of {kind}") from None


@dataclass(frozen=True)
class Trial:
    """One of the trials in a file: the samples at which a column has a value.

    ``column``: column that numbers the trials; ``label``: its value as text, ``"3"`` for 3 and 3.0.
    """

    column: str | int
    label: str


def trial_label(value: object) -> str:
    """Label of a trial by a cell or a number.

    >>> trial_label("3.0"), trial_label(3), trial_label(1234567), trial_label("left"), trial_label("1_0")
    ('3', '3', '1234567', 'left', '1_0')
    """
    text = str(value).strip()
    try:
        return text if "_" in text else f"{float(text):.15g}"
    except ValueError:
        return text


def of_trial(path: Path, labels: Sequence[str], trial: Trial) -> np.ndarray:
    """Mask of the samples of a trial, from the label of each sample."""
    mask = np.array([label == trial.label for label in labels])
    if not mask.any():
        known = dict.fromkeys(labels)
        raise DataError(unknown("trial", trial.label, list(known), f"{path}, column {trial.column!r}"))
    return mask


def chosen(
    path: Path,
    columns: Mapping[str, np.ndarray],
    time: str | None,
    names: Iterable[str] | None,
    missing: str,
    trial: Trial | None = None,
) -> tuple[np.ndarray, dict[str, np.ndarray], dict[str, str]]:
    """Times (samples,), columns (samples,) by name, and known units of a file, or of one of its trials. Times that are
    dates become seconds since the first, whatever unit their name has. Without ``names`` all columns of numbers as long
    as the times are chosen. Without ``time`` samples are numbered.
    """
    wanted = None if names is None else list(dict.fromkeys(names))
    if trial is not None:
        columns = _of_trial(path, columns, trial)
    for column in (*([] if time is None else [time]), *(wanted or ())):
        if column not in columns:
            raise DataError(unknown("column", column, columns, str(path)))
    seconds = None if time is None else _seconds(columns[time])
    along = _numbered(columns, wanted) if time is None or seconds is None else _numbers(path, time, seconds)
    units = {} if time is None or seconds is columns[time] else {time: "s"}
    time = time or "sample"
    if wanted is None:
        wanted = [name for name, column in columns.items() if name != time and _fits(column, along)]
        if not wanted:
            raise DataError(f"{path}: no column of numbers is as long as {time!r}, {len(along)} samples; name another")
    table = {name: _numbers(path, name, columns[name]) for name in wanted}
    for name, column in table.items():
        if len(column) != len(along):
            raise DataError(f"{path}, column {name!r}: {len(column)} values; expected {len(along)}, as {time!r} has")
    check_finite(path, time, along, missing="refuse")
    for name, column in table.items():
        check_finite(path, name, column, missing)
    check_growing(path, time, along)
    return along, table, units


def of_numbers(columns: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The columns of real numbers or dates, one a sample, among others; dates as seconds since the first."""
    rows = {name: _seconds(column) for name, column in columns.items() if column.ndim == 1}
    return {name: column for name, column in rows.items() if column.dtype.kind in "fiu"}


def _of_trial(path: Path, columns: Mapping[str, np.ndarray], trial: Trial) -> dict[str, np.ndarray]:
    """The samples of one trial, of all columns that are as long as the one that numbers the trials."""
    name = str(trial.column)
    if name not in columns:
        raise DataError(unknown("column", name, columns, str(path)))
    mask = of_trial(path, [trial_label(value) for value in columns[name]], trial)
    return {key: column[mask] for key, column in columns.items() if column.shape == mask.shape}


def check_finite(path: Path, name: str, column: np.ndarray, missing: str) -> None:
    """Refuse a column with a value that is not finite; NaN is allowed where it is to be left out."""
    wrong = np.isinf(column) if missing == "leave-out" else ~np.isfinite(column)
    if np.any(wrong):
        sample = int(np.argmax(wrong))
        advice = (
            "" if np.isinf(column[sample]) or missing == "leave-out" else ", or leave it out: missing = 'leave-out'"
        )
        raise DataError(
            f"{path}, column {name!r}, sample {sample}: {column[sample]}; expected a finite number; "
            f"remove the sample or the column{advice}"
        )


def check_growing(path: Path, time: str, along: np.ndarray) -> None:
    """Refuse times, or frequencies, that do not grow."""
    back = np.flatnonzero(np.diff(along) <= 0)
    if len(back):
        now = int(back[0]) + 1
        raise DataError(
            f"{path}, column {time!r}, sample {now}: {along[now]:.10g} comes after {along[now - 1]:.10g}; expected "
            "growing values; sort the samples or remove the repeated one"
        )


def rate_of(path: Path, sampling: float) -> float:
    """Return samples a second (Hz), refused if they are no positive number."""
    if not is_real(sampling) or not 0 < sampling < np.inf:
        raise DataError(f"{path}: sampling is {sampling}; expected a positive number of samples a second")
    return float(sampling)


def times_as_channel(path: Path, column: str) -> DataError:
    """Error for a channel whose column is that of the times or frequencies."""
    return DataError(f"{path}, column {column!r} has what the samples lie along; expected another column for a channel")


def foreign(unit: str) -> bool:
    """Whether a unit that a file names is none, or needs no conversion, the other way round."""
    return unit not in ("", "1", "NONE") and not is_si(unit)


def _numbered(columns: Mapping[str, np.ndarray], wanted: Sequence[str] | None) -> np.ndarray:
    """Numbers of the samples of the columns that are wanted, or of most of them."""
    if wanted:
        return np.arange(columns[wanted[0]].size, dtype=float)
    lengths = Counter(column.size for column in columns.values() if column.dtype.kind in "fiu" and column.ndim == 1)
    return np.arange(lengths.most_common(1)[0][0] if lengths else 0, dtype=float)


def _numbers(path: Path, name: str, column: np.ndarray) -> np.ndarray:
    where = f"{path}, column {name!r}"
    if column.ndim != 1:
        raise DataError(f"{where}: an array of shape {column.shape}; expected one number a sample")
    if column.dtype.kind == "c":
        raise DataError(f"{where}: complex numbers; expected real ones, such as a motion over time")
    if column.dtype.kind not in "fiub":
        raise DataError(f"{where}: {'dates' if column.dtype.kind in 'mM' else 'no numbers'}; expected numbers")
    return column.astype(float)


def _fits(column: np.ndarray, along: np.ndarray) -> bool:
    return column.shape == along.shape and column.dtype.kind in "fiu"


def _seconds(column: np.ndarray) -> np.ndarray:
    if column.dtype.kind in "UO" and column.ndim == 1:
        clock = clock_seconds(list(map(str, column)))
        return column if clock is None else clock
    if column.dtype.kind not in "mM" or len(column) == 0:
        return column
    since = (column - column[0]).astype("timedelta64[ns]")
    return np.where(np.isnat(since), np.nan, since.astype(np.int64) * 1e-9)
