"""The formats that data are read from, by name and by suffix."""

from pathlib import Path

from dalembert.data.columns import Columns
from dalembert.data.format import Format, Request
from dalembert.data.text_layout import AUTO
from dalembert.errors import DataError, unknown
from dalembert.kinds import named


def known_formats() -> dict[str, type[Format]]:
    """Formats by name, in alphabetical order."""
    return dict(sorted(named("dalembert.data.formats", Format).items()))


def columns_in(path: Path, request: Request, format: str | None = None) -> Columns:  # noqa: A002
    """Columns of a file, in the given format or else that of its suffix."""
    return _reader(path, format, trials=request.trial is not None).columns(path, request)


def trial_labels(
    path: Path,
    column: str | int,
    *,
    separator: str = AUTO,
    decimal: str = AUTO,
    format: str | None = None,  # noqa: A002
) -> list[str]:
    """Labels of the trials that a column of a text or JSON file numbers, in the order in which they begin."""
    labels = _reader(path, format, trials=True).trial_labels(path, column, separator, decimal)
    return list(dict.fromkeys(labels))


def _reader(path: Path, format: str | None, *, trials: bool) -> Format:  # noqa: A002
    name, known = format or format_of(path), known_formats()
    if name not in known:
        raise DataError(unknown("format", name, known, str(path)))
    if trials and not known[name].trials:
        raise DataError(f"{path}: trials are read from text and JSON files only; write one file a trial")
    return known[name]()


def format_of(path: Path) -> str:
    """Name of the format that a suffix, in upper or lower case, stands for."""
    compressed = path.suffix.lower() == ".gz"
    suffix = Path(path.stem).suffix if compressed else path.suffix
    known = known_formats()
    for name, form in known.items():
        if suffix.lower() in form.suffixes and (form.compressed or not compressed):
            return name
    if compressed:
        raise DataError(f"{path}: only text and JSON are read from .gz files; decompress the file")
    suffixes = ", ".join(suffix for form in known.values() for suffix in form.suffixes)
    raise DataError(
        f"{path}: the suffix {path.suffix!r} stands for no format; expected one of {suffixes}; rename the file, or say "
        f"which format it has: {', '.join(known)}"
    )
