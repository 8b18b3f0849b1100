"""Files that are there whole or not at all, whatever happens while they are written."""

import errno
import os
import re
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from itertools import chain, count
from pathlib import Path
from typing import TYPE_CHECKING

from dalembert.errors import DataError, InputError, unwritable

if TYPE_CHECKING:
    from xarray import Dataset

    from dalembert.contents import Contents

_STORAGE = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS, errno.EACCES, errno.EPERM)
"""What the system says of a disk without room, and of a folder that may not be written to."""


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Yield a temporary path beside ``path`` to write to; it becomes ``path`` when the block ends without an error. The
    content is on the disk before the name is, so that not even a power cut leaves half a file.
    """
    path = Path(path)
    if not path.parent.is_dir():
        raise InputError(f"{path} cannot be written: there is no folder {path.parent}; make it, or choose another path")
    try:
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.stem}-", suffix=path.suffix)
    except OSError as error:
        raise unwritable(path, error.strerror) from None
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        temporary.chmod(0o644)
        _sync(temporary)
        temporary.replace(path)
    except BaseException as error:
        with suppress(OSError):
            temporary.unlink()
        number = _number(error)
        if number in _STORAGE:
            raise unwritable(path, os.strerror(number)) from None
        raise
    _sync(path.parent)


def free_path(path: Path, taken: Callable[[Path], bool] = Path.exists) -> Path:
    """Return the path itself, or ``NAME-2`` and so on: the first that is not taken."""
    paths = chain([path], (path.with_name(f"{path.name}-{number}") for number in count(2)))
    return next(candidate for candidate in paths if not taken(candidate))


def set_aside(path: Path, *suffixes: str) -> Path:
    """Rename a damaged file, and files with suffixes beside it, to ``NAME.damaged-1`` or the next free number."""
    number = 1
    while (aside := path.with_name(f"{path.name}.damaged-{number}")).exists():
        number += 1
    path.replace(aside)
    for suffix in suffixes:
        with suppress(FileNotFoundError):
            path.with_name(path.name + suffix).replace(aside.with_name(aside.name + suffix))
    return aside


def write_text(path: str | os.PathLike[str], text: str) -> None:
    """Write a text file atomically."""
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")


def write_contents(path: str | os.PathLike[str], contents: "Contents") -> None:
    """Write a NetCDF-4 file atomically."""
    with replacing(path) as temporary:
        contents.write(temporary)


def read_dataset(path: str | os.PathLike[str], *, form: str, expected: str) -> "Dataset":
    """Dataset of a NetCDF-4 file whose attribute ``format`` is ``form``, for example ``"dalembert fit 1"``.

    ``expected`` says in an error what should have been there, for example ``"a fit written by Fit.save"``.
    """
    from xarray import load_dataset

    path = Path(path)
    if not path.is_file():
        raise DataError(f"{path}: there is no such file; expected {expected}")
    try:
        dataset = load_dataset(path, engine="h5netcdf")
    except Exception as error:  # each layer below has errors of its own for a file that is not NetCDF
        raise DataError(f"{path}: cannot be read as NetCDF ({error}); expected {expected}") from error
    if dataset.attrs.get("format") != form:
        format_of_file = dataset.attrs.get("format", f"no {form.split()[1]}")
        raise DataError(f"{path}: holds {format_of_file!r}; expected {form!r}, {expected}")
    return dataset


def _number(error: BaseException) -> int:
    """Number of the system's error, which HDF5 gives in its text alone where it closes a file; 0 if there is none."""
    if isinstance(error, OSError) and error.errno is not None:
        return error.errno
    match = re.search(r"\berrno = (\d+)", str(error)) if isinstance(error, OSError | RuntimeError) else None
    return int(match[1]) if match else 0


def _sync(path: Path) -> None:
    """Wait until a file's content, or a folder's names, are on the disk."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
