"""Measurements and bands from text files with named columns."""

from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from numpy.typing import ArrayLike

from dalembert.data.bands import Bands
from dalembert.data.csv_columns import read_columns
from dalembert.data.measurements import Measurements
from dalembert.errors import DataError


def read_csv(
    path: str | Path,
    time: str = "t",
    columns: Mapping[str, str] | None = None,
    deviations: Mapping[str, float] | ArrayLike | None = None,
    *,
    separator: str = ",",
) -> Measurements:
    """Measurements from a CSV file with a header line.

    Parameters
    ----------
    path : path
    time : str
        Column of the times, in seconds.
    columns : mapping of str to str, optional
        Column of each channel, for example ``{"AB.end.x": "case1_x"}``; every column by its own name if not given.
    deviations : number, mapping by channel, or array of shape (channels,), optional
        Standard deviations of the noise.
    separator : str

    Raises
    ------
    DataError
        Naming file, line and column: no such file, empty file, missing column (with the nearest names), a cell that is
        empty, NaN or not a number, a line too short or too long, a time that does not grow.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder) / "motion.csv"
    ...     _ = file.write_text("t,x\\n0.0,1.0\\n0.1,0.9\\n")
    ...     read_csv(file, columns={"AB.end.x": "x"}).values.tolist()
    [[1.0], [0.9]]
    """
    path = Path(path)
    times, table = read_columns(path, time, None if columns is None else columns.values(), separator)
    chosen = {name: name for name in table} if columns is None else columns
    with _told_of(path):
        return Measurements.of(times, {name: table[column] for name, column in chosen.items()}, deviations)


def read_bands(
    path: str | Path, time: str = "t", columns: Mapping[str, tuple[str, str]] | None = None, *, separator: str = ","
) -> Bands:
    """Bands from a CSV file with a header line.

    Parameters
    ----------
    path : path
    time : str
        Column of the times, in seconds.
    columns : mapping of str to (str, str), optional
        Columns of each channel's lower and upper bounds, for example ``{"AB.end.x": ("x_lower", "x_upper")}``. If not
        given, every pair of columns ``name_lower`` and ``name_upper`` is the channel ``name``.
    separator : str

    Raises
    ------
    DataError
        As :func:`read_csv`; where a lower bound is larger than its upper bound; where a channel has not two columns.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder) / "bounds.csv"
    ...     _ = file.write_text("t,x_lower,x_upper\\n0.0,0.9,1.1\\n0.1,0.8,1.2\\n")
    ...     read_bands(file, columns={"AB.end.x": ("x_lower", "x_upper")}).upper.tolist()
    [[1.1], [1.2]]
    """
    path = Path(path)
    if columns is not None:
        for name, pair in columns.items():
            if isinstance(pair, str) or len(pair) != 2:
                raise DataError(f"columns, channel {name!r}: {pair!r} was given; expected two names, (lower, upper)")
    names = None if columns is None else [column for pair in columns.values() for column in pair]
    times, table = read_columns(path, time, names, separator)
    pairs = _pairs(path, table) if columns is None else columns
    with _told_of(path):
        return Bands.of(times, {name: (table[lower], table[upper]) for name, (lower, upper) in pairs.items()})


def _pairs(path: Path, names: Collection[str]) -> dict[str, tuple[str, str]]:
    """Columns that are bounds of one channel, by its name."""
    stems = [name.removesuffix("_lower") for name in names if name.endswith("_lower")]
    pairs = {stem: (f"{stem}_lower", f"{stem}_upper") for stem in stems if f"{stem}_upper" in names}
    if not pairs:
        raise DataError(
            f"{path}: no two columns are named NAME_lower and NAME_upper; "
            "give columns = {channel: (lower column, upper column)}"
        )
    return pairs


@contextmanager
def _told_of(path: Path) -> Iterator[None]:
    """Defects of data, told with the file that they come from."""
    try:
        yield
    except DataError as error:
        raise DataError(f"{path}: {error}") from error
