"""Contents of study files for lists: a file is read again only if it has changed."""

import tomllib
from functools import lru_cache
from pathlib import Path
from typing import Any

from dalembert.studio.editor.cursor import tolerant

KEPT = 4096
"""Files whose contents are kept."""


def document_of(path: Path) -> dict[str, Any] | None:
    """Return the content of a TOML file, which must not be changed; None if it has mistakes or is not there."""
    try:
        about = path.stat()
    except OSError:
        return None
    return _read(path, about.st_mtime_ns, about.st_size)


def table_names(path: Path) -> frozenset[str]:
    """Return the names at the top of a TOML file, also of one with mistakes; none if no line of it can be read."""
    document = document_of(path)
    if document is not None:
        return frozenset(document)
    try:
        about = path.stat()
    except OSError:
        return frozenset()
    return _names(path, about.st_mtime_ns, about.st_size)


def name_in(path: Path) -> str:
    """Return the name that the study in a file has in its runs."""
    about = (document_of(path) or {}).get("study")
    return str((about.get("name") if isinstance(about, dict) else "") or path.stem)


@lru_cache(KEPT)
def _read(path: Path, changed: int, size: int) -> dict[str, Any] | None:
    """The content of a file as it was at its last change."""
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (ValueError, OSError, RecursionError):
        return None


@lru_cache(KEPT)
def _names(path: Path, changed: int, size: int) -> frozenset[str]:
    """The names in a file with mistakes as it was at its last change."""
    try:
        return frozenset(tolerant(path.read_text(encoding="utf-8")))
    except (ValueError, OSError):
        return frozenset()
