"""Measurements from files."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from dalembert.data.columns import Columns, Trial, rate_of, times_as_channel, trial_label
from dalembert.data.format import Request
from dalembert.data.known_formats import columns_in, trial_labels
from dalembert.data.measurements import Measurements
from dalembert.data.opening import errors_with_file
from dalembert.data.record import FIRST
from dalembert.data.text_layout import AUTO, is_number
from dalembert.errors import DataError, repeated, shown


def read(
    path: str | Path,
    time: str | int = "t",
    columns: Mapping[str, str | int] | None = None,
    deviations: Mapping[str, float] | ArrayLike | None = None,
    *,
    units: Mapping[str, str] | None = None,
    missing: str | Sequence[str | float] = "refuse",
    wraps: Iterable[str] = (),
    format: str | None = None,  # noqa: A002
    separator: str = AUTO,
    decimal: str = AUTO,
    frequency: str | None = None,
    sampling: float | None = None,
    start: float | str | None = None,
    trial: tuple[str | int, str | float] | None = None,
) -> Measurements:
    """Measurements from a file: text with columns, JSON, Parquet, MAT (version 5 and 7.3), UFF (dataset 58) or NetCDF.

    Parameters
    ----------
    path : path
    time : str or int
        Column of the times; in a text file without a header the first one if not given. A universal file has none to
        name: there it is the abscissa, ``"t"`` in ``units``.
    columns : mapping of str to str or int, optional
        Column of each channel, for example ``{"AB.end.x": "case1_x"}``; every column by its own name if not given. In
        text files and rows of JSON a number counts columns from 1. In a MAT file a column is a vector, a field of a
        struct, ``"run.x"``, or a part of a matrix, ``"q(:,1)"``; in a universal file a function, by its response node
        and direction, ``"12:+X"``, or its first ID line; in NetCDF a variable, or an entry of one,
        ``"response[AB.end.x]"``.
    deviations : number, mapping by channel, or array of shape (channels,), optional
        Standard deviations of the noise, in SI units.
    units : mapping of str to str, optional
        Unit of each column of the file that is not in SI units, for example ``{"t": "ms", "case1_x": "mm"}``. Units
        that a NetCDF file names are known without it, and so are those of a text file in a line below the names or in
        brackets behind a name, ``angle [deg]``.
    missing : {"refuse", "leave-out"}, or sequence of str or float
        With ``"leave-out"`` an empty cell, a null or a NaN is a sample that was not measured, and does not count; in a
        text file also ``N/A``, ``-``, ``null`` and the like. A sequence has further words or numbers of such cells.
    wraps : iterable of str
        Channels that are angles known up to whole turns.
    format : {"csv", "json", "parquet", "mat", "uff", "netcdf"}, optional
        By the file's suffix if not given; ``"csv"`` is any text with columns.
    separator : str
        Of the cells of a text file; found from its lines if ``"auto"``. A blank stands for any number of blanks.
    decimal : {"auto", ".", ","}
        What stands before the decimals of the numbers of a text file; found from its lines if ``"auto"``.
    frequency : str, optional
        Column of the frequencies along which the samples lie, in place of the times.
    sampling : float, optional
        Samples a second (Hz) of a file without a column of times, the first sample at 0 s.
    start : float or "first", optional
        Time of the file, in s, at which the motion begins: times count from there. ``"first"`` is that of the first
        sample.
    trial : (column, value), optional
        In text and JSON files with several trials: the column that numbers them, and the one that is read; see
        :func:`read_trials` for all of them.

    Raises
    ------
    DataError
        Naming file, column and line or sample: no such file, a file that is not what its suffix says, a column that is
        missing (with the nearest names) or has another length than the times, a value that is no finite number, a
        time that does not grow, an unknown unit, a library that is not installed.

    Notes
    -----
    Times may be dates, times of day, or both: they become seconds since the first. Tables and timeseries of MATLAB
    cannot be read by anything else: save their columns as vectors.

    Functions over frequency of a universal file give measurements along a frequency in Hz. Functions of which the file
    says that they are not in SI units are refused until ``units`` names their unit, since that is free text there. An
    evenly spaced abscissa is stored with six digits of its distance.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder) / "motion.csv"
    ...     _ = file.write_text("ms,x\\n0,1000\\n100,900\\n")
    ...     data = read(file, "ms", {"AB.end.x": "x"}, units={"ms": "ms", "x": "mm"})
    >>> data.coordinate.values.tolist(), data.values.tolist()
    ([0.0, 0.1], [[1.0], [0.9]])

    >>> from scipy.io import savemat
    >>> with TemporaryDirectory() as folder:
    ...     savemat(Path(folder) / "run.mat", {"run": {"time": [0.0, 0.1], "angle": [[45.0, 30.0], [90.0, 20.0]]}})
    ...     columns = {"crank.angle": "run.angle(:,1)"}
    ...     data = read(Path(folder) / "run.mat", "run.time", columns, units={"run.angle(:,1)": "deg"})
    >>> data.values.round(4).tolist()
    [[0.7854], [1.5708]]
    """
    _refuse_wrong_kinds(path, time, columns, units, missing, separator, trial)
    path = Path(path)
    names = None if columns is None else tuple(columns.values())
    for column, count in repeated(map(str, names or ())).items():
        raise DataError(f"{path}, column {column!r} is given for {count} channels; expected one channel for a column")
    trial_choice = None if trial is None else Trial(trial[0], trial_label(trial[1]))
    absent = () if isinstance(missing, str) else tuple(map(str, missing))
    missing = missing if isinstance(missing, str) else "leave-out"
    along_column = (frequency or time) if sampling is None else None
    if along_column is not None and str(along_column) in map(str, names or ()):
        raise times_as_channel(path, str(along_column))
    request = Request(along_column, names, missing, tuple(units or ()), separator, decimal, trial_choice, absent)
    content = _without(columns_in(path, request, format), absent)
    if sampling is not None:
        content = replace(content, along=content.along / rate_of(path, sampling))
    along, table = replace(content, frequency=content.frequency or frequency is not None).converted(units)
    chosen = {name: name for name in table} if columns is None else {name: str(of) for name, of in columns.items()}
    with errors_with_file(path):
        channels = {name: table[column] for name, column in chosen.items()}
        data = Measurements.of(along, channels, deviations, missing=missing, wraps=wraps)
        data = data if start is None else data.since(start)
    origin = f"{path}: {content.layout}" if content.layout else str(path)
    named = content.named_units(units)
    columns_of = {along.name: content.time, **chosen}
    return replace(
        data, origin=origin, source_units={name: named[of] for name, of in columns_of.items() if of in named}
    )


def _refuse_wrong_kinds(
    path: Any, time: Any, columns: Any, units: Any, missing: Any, separator: Any, trial: Any
) -> None:
    """Refuse arguments of another type than :func:`read` takes."""
    is_names = isinstance(missing, str) or (isinstance(missing, Sequence) and not isinstance(missing, bytes))
    of_text = isinstance(units, Mapping) and all(isinstance(unit, str) for unit in units.values())
    is_pair = isinstance(trial, Sequence) and not isinstance(trial, str) and len(trial) == 2
    for name, value, right, wanted in (
        ("path", path, isinstance(path, str | PathLike), "the path of a file"),
        ("time", time, isinstance(time, str | int), "the name of a column, or its number from 1"),
        ("columns", columns, columns is None or isinstance(columns, Mapping), "a mapping such as {'AB.end.x': 'x'}"),
        ("units", units, units is None or of_text, "a mapping from columns to units, such as {'x': 'mm'}"),
        ("missing", missing, is_names, "'refuse', 'leave-out', or a list of words and numbers such as ['N/A', -9999]"),
        ("separator", separator, isinstance(separator, str), "'auto', or one character, such as ';'"),
        ("trial", trial, trial is None or is_pair, "a column and the trial in it, such as ('run', 3)"),
    ):
        if not right:
            raise DataError(f"read: {name} is {shown(value)}; expected {wanted}")


def _without(content: Columns, absent: Iterable[str]) -> Columns:
    numbers = [float(word) for word in absent if is_number(word)]
    if not numbers:
        return content
    table = {name: np.where(np.isin(values, numbers), np.nan, values) for name, values in content.table.items()}
    return replace(content, table=table)


def read_trials(path: str | Path, split: str | int, *arguments: Any, **options: Any) -> dict[str, Measurements]:
    """All trials in one text or JSON file, each by its label in the column ``split``.

    The other arguments are those of :func:`read`. Times count from the first sample of each trial if not said otherwise
    by ``start``.

    Raises
    ------
    DataError
        As :func:`read`.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder) / "runs.csv"
    ...     _ = file.write_text("run,t,x\\n1,0.0,5\\n1,0.1,6\\n2,7.0,8\\n2,7.1,9\\n")
    ...     trials = read_trials(file, "run", columns={"AB.end.x": "x"})
    >>> {label: data.values[:, 0].tolist() for label, data in trials.items()}
    {'1': [5.0, 6.0], '2': [8.0, 9.0]}
    >>> trials["2"].coordinate.values.round(3).tolist()
    [0.0, 0.1]
    """
    marks = {key: options[key] for key in ("separator", "decimal", "format") if key in options}
    options = {"start": FIRST, **options}
    labels = trial_labels(Path(path), split, **marks)
    return {label: read(path, *arguments, trial=(split, label), **options) for label in labels}
