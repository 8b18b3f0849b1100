"""Columns of a JSON file: an object of arrays, or an array of objects or of rows."""

import json
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from dalembert.data.columns import Columns, Trial, chosen, of_numbers, trial_label
from dalembert.data.format import Format, Request
from dalembert.data.text_lines import file_bytes
from dalembert.errors import DataError, unknown

_FORMS = "an object of arrays, or an array of objects or of rows, of numbers"


class Json(Format):
    """JSON: columns or rows."""

    name = "json"
    suffixes = (".json",)
    compressed = trials = True

    def columns(self, path: Path, request: Request) -> Columns:
        return json_columns(path, request.time, request.names, request.missing, request.trial)

    def all_columns(self, path: Path) -> dict[str, tuple[np.ndarray, str]]:
        arrays = {name: _array(path, name, entries) for name, entries in _by_name(path, _content(path)).items()}
        return {name: (array, "") for name, array in of_numbers(arrays).items()}

    def trial_labels(self, path: Path, column: str | int, separator: str, decimal: str) -> list[str]:
        return json_labels(path, column)


def json_columns(
    path: Path, time: str | int | None, names: Iterable[str | int] | None, missing: str, trial: Trial | None = None
) -> Columns:
    """Times and columns by name; those of rows by their numbers from 1."""
    content = _content(path)
    columns = {name: _array(path, name, entries) for name, entries in _by_name(path, content).items()}
    rows = isinstance(content, list) and isinstance(content[0], list)
    label = "1" if rows and time == "t" else None if time is None else str(time)
    wanted = None if names is None else list(map(str, names))
    return Columns(path, label or "sample", *chosen(path, columns, label, wanted, missing, trial), layout="JSON")


def json_labels(path: Path, column: str | int) -> list[str]:
    """Label of the trial that each sample belongs to, by the column that numbers them."""
    columns = _by_name(path, _content(path))
    if str(column) not in columns:
        raise DataError(unknown("column", str(column), columns, str(path)))
    return [trial_label(value) for value in columns[str(column)]]


def _content(path: Path) -> Any:
    try:
        return json.loads(file_bytes(path))
    except json.JSONDecodeError as error:
        raise DataError(
            f"{path}, line {error.lineno}, column {error.colno}: the file is not JSON ({error.msg}); expected {_FORMS}"
        ) from None
    except UnicodeDecodeError as error:
        raise DataError(f"{path}: the file is not text ({error.reason}); expected JSON") from None


def _by_name(path: Path, content: Any) -> dict[str, list[Any]]:
    if isinstance(content, dict):
        columns = dict(_nested("", path, content))
        if columns:
            return columns
    if isinstance(content, list) and content and all(isinstance(entry, dict) for entry in content):
        rows = [dict(_flat("", entry)) for entry in content]
        names = dict.fromkeys(name for row in rows for name in row)
        return {name: [row.get(name) for row in rows] for name in names}
    if isinstance(content, list) and content and all(isinstance(entry, list) for entry in content):
        width = len(content[0])
        for number, entry in enumerate(content):
            if len(entry) != width:
                raise DataError(
                    f"{path}, row {number + 1}: {len(entry)} values; expected {width}, as the first row has"
                )
        return {str(k + 1): [entry[k] for entry in content] for k in range(width)}
    raise DataError(f"{path}: the file holds something else than {_FORMS}")


def _nested(front: str, path: Path, content: dict[str, Any]) -> Iterator[tuple[str, list[Any]]]:
    for name, entries in content.items():
        label = f"{front}{name}"
        if isinstance(entries, dict):
            yield from _nested(f"{label}.", path, entries)
        elif isinstance(entries, list) and entries and all(isinstance(entry, dict) for entry in entries):
            yield from ((f"{label}.{key}", column) for key, column in _by_name(path, entries).items())
        elif isinstance(entries, list):
            yield label, entries


def _flat(front: str, entry: dict[str, Any]) -> Iterator[tuple[str, Any]]:
    for name, value in entry.items():
        if isinstance(value, dict):
            yield from _flat(f"{front}{name}.", value)
        else:
            yield f"{front}{name}", value


def _array(path: Path, name: str, entries: list[Any]) -> np.ndarray:
    if any(isinstance(entry, bool | str | list | dict) for entry in entries):
        for row, entry in enumerate(entries):
            if isinstance(entry, str | list | dict) and any(isinstance(value, int | float) for value in entries):
                raise DataError(f"{path}, column {name!r}, sample {row}: {entry!r} is not a number")
        return np.array(list(map(str, entries)))
    return np.array([np.nan if entry is None else entry for entry in entries], dtype=float)
