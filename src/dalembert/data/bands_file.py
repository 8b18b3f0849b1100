"""Bands from files."""

from collections.abc import Collection, Mapping
from dataclasses import replace
from pathlib import Path

from dalembert.data.bands import Bands
from dalembert.data.columns import rate_of
from dalembert.data.format import Request
from dalembert.data.known_formats import columns_in
from dalembert.data.opening import errors_with_file
from dalembert.data.text_layout import AUTO
from dalembert.errors import DataError


def read_bands(
    path: str | Path,
    time: str | int = "t",
    columns: Mapping[str, tuple[str, str]] | None = None,
    *,
    separator: str = AUTO,
    decimal: str = AUTO,
    units: Mapping[str, str] | None = None,
    format: str | None = None,  # noqa: A002
    frequency: str | None = None,
    sampling: float | None = None,
) -> Bands:
    """Bands from a file of any format that :func:`read` reads.

    Parameters
    ----------
    path : path
    time : str
        Column of the times.
    columns : mapping of str to (str, str), optional
        Columns of each channel's lower and upper bounds, for example ``{"AB.end.x": ("x_lower", "x_upper")}``. If not
        given, every pair of columns ``name_lower`` and ``name_upper`` is the channel ``name``.
    separator, decimal, units, format, frequency, sampling
        As in :func:`read`.

    Raises
    ------
    DataError
        As :func:`read`; where a lower bound is larger than its upper bound; where a channel has not two columns.

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
    names = None if columns is None else tuple(column for pair in columns.values() for column in pair)
    along_column = (frequency or time) if sampling is None else None
    request = Request(along_column, names, units=tuple(units or ()), separator=separator, decimal=decimal)
    from_file = columns_in(path, request, format)
    if sampling is not None:
        from_file = replace(from_file, along=from_file.along / rate_of(path, sampling))
    along, table = replace(from_file, frequency=from_file.frequency or frequency is not None).converted(units)
    pairs = _pairs(path, table) if columns is None else columns
    with errors_with_file(path):
        bands = Bands.of(along, {name: (table[lower], table[upper]) for name, (lower, upper) in pairs.items()})
    named = from_file.named_units(units)
    return replace(
        bands,
        source_units={
            name: named[name_of_end] for name, pair in pairs.items() for name_of_end in pair if name_of_end in named
        },
    )


def _pairs(path: Path, names: Collection[str]) -> dict[str, tuple[str, str]]:
    stems = [name.removesuffix("_lower") for name in names if name.endswith("_lower")]
    pairs = {stem: (f"{stem}_lower", f"{stem}_upper") for stem in stems if f"{stem}_upper" in names}
    if not pairs:
        raise DataError(
            f"{path}: no two columns are named NAME_lower and NAME_upper; "
            "give columns = {channel: (lower column, upper column)}"
        )
    return pairs
