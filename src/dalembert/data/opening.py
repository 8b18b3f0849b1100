"""Open data files by libraries, and convert their errors."""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from dalembert.errors import DataError, unknown


def absent(path: Path) -> DataError:
    """Error for a file that is not there, with its neighbours' names."""
    near = [entry.name for entry in path.parent.glob("*")] if path.parent.is_dir() else []
    return DataError(unknown("file", path.name, near, f"folder {path.parent}"))


@contextmanager
def reading(path: Path, what: str) -> Iterator[None]:
    """Whatever a library says against a file, as one sentence: the file cannot be read as ``what``."""
    if not path.is_file():
        raise absent(path)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what matters is refused by name afterwards
            yield
    except DataError as error:
        if str(path) in str(error):
            raise
        raise DataError(f"{path}: {error}") from error
    except Exception as error:  # a malformed file may meet any error of a library
        reason = next(iter(str(error).splitlines()), "") or type(error).__name__
        raise DataError(f"{path}: cannot be read as {what} ({reason})") from error


def library(name: str, path: Path, what: str, extra: str = "data", package: str = "") -> Any:
    """A module that comes with an extra."""
    try:
        return import_module(name)
    except ImportError:
        raise _missing(package or name.partition(".")[0], path, what, extra) from None


def require(name: str, path: Path, what: str, extra: str) -> None:
    """Refuse a file if the package that another process reads it with is not installed."""
    if find_spec(name) is None:
        raise _missing(name, path, what, extra)


def _missing(package: str, path: Path, what: str, extra: str) -> DataError:
    return DataError(
        f"{path}: {package} is needed to read {what}, and is not installed; run: pip install 'dalembert[{extra}]'"
    )


@contextmanager
def errors_with_file(path: Path) -> Iterator[None]:
    """Name the file in errors of its data."""
    try:
        yield
    except DataError as error:
        raise DataError(f"{path}: {error}") from error
