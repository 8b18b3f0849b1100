"""A file of any other format inside a ZIP archive."""

from pathlib import Path
from tempfile import TemporaryDirectory
from zipfile import BadZipFile, ZipFile

import numpy as np

from dalembert.data.columns import Columns
from dalembert.data.format import Format, Request
from dalembert.data.opening import absent
from dalembert.errors import DataError

MOST = 2_000_000_000
"""Bytes of a file in an archive: what unpacks to more is refused."""


class Archive(Format):
    """ZIP with one file of data; others, such as a text about it, may be beside it."""

    name = "zip"
    suffixes = (".zip",)
    trials = True

    def columns(self, path: Path, request: Request) -> Columns:
        from dataclasses import replace

        with TemporaryDirectory() as folder:
            form, inner = _unpacked(path, Path(folder))
            content = form.columns(inner, request)
        return replace(content, path=path, layout=f"{inner.name}: {content.layout}".rstrip(": "))

    def all_columns(self, path: Path) -> dict[str, tuple[np.ndarray, str]]:
        with TemporaryDirectory() as folder:
            form, inner = _unpacked(path, Path(folder))
            return form.all_columns(inner)

    def trial_labels(self, path: Path, column: str | int, separator: str, decimal: str) -> list[str]:
        with TemporaryDirectory() as folder:
            form, inner = _unpacked(path, Path(folder))
            return form.trial_labels(inner, column, separator, decimal)


def _unpacked(path: Path, folder: Path) -> tuple[Format, Path]:
    from dalembert.data.known_formats import known_formats

    suffixes = {suffix: form for form in known_formats().values() for suffix in form.suffixes if form is not Archive}
    if not path.is_file():
        raise absent(path)
    try:
        with ZipFile(path) as archive:
            entries = [entry for entry in archive.infolist() if not entry.is_dir()]
            entries = [entry for entry in entries if not entry.filename.startswith("__MACOSX/")]
            known = [entry for entry in entries if Path(entry.filename).suffix.lower() in suffixes]
            if len(known) != 1:
                names = ", ".join(entry.filename for entry in (known or entries)) or "none"
                raise DataError(f"{path}: expected one file of data in the archive; it has: {names}; unpack it")
            if known[0].file_size > MOST:
                raise DataError(f"{path}: {known[0].filename} has more than {MOST} bytes; unpack it")
            inner = folder / Path(known[0].filename).name
            inner.write_bytes(archive.read(known[0]))
    except (BadZipFile, OSError, RuntimeError, NotImplementedError, EOFError, ValueError) as error:
        raise DataError(f"{path}: cannot be read as ZIP ({error})") from error
    return suffixes[inner.suffix.lower()](), inner
