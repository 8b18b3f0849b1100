"""Results on disk as they come, by what they are results of, so that a run that was killed need not repeat them."""

import json
import sqlite3
from collections.abc import Callable, Sequence
from contextlib import closing
from pathlib import Path
from threading import Lock
from time import monotonic, perf_counter
from types import TracebackType
from typing import Self

import numpy as np

from dalembert.errors import StorageError, unwritable

EVERY = 0.5
"""Seconds between two times at which what came is written to the disk for good."""

Arrays = tuple[np.ndarray, ...]

_TABLE = "CREATE TABLE IF NOT EXISTS results (key BLOB PRIMARY KEY, shapes TEXT, content BLOB, seconds REAL)"


class Checkpoint:
    """Arrays by key, in one SQLite file: whatever stops the process, all but those of the last moment are there.

    Parameters
    ----------
    path : Path
        Made if it is not there.

    Attributes
    ----------
    spared : float
        Seconds that earlier processes computed what this one recalled.

    Raises
    ------
    StorageError
        Where the file cannot be written, or is no checkpoint.

    Notes
    -----
    A transaction is written whole or not at all (SQLite's rollback journal, which unlike its write-ahead log works on
    shared file systems too), and what was written before stays. A computation that takes longer than half a second is
    on the disk before the next begins; of shorter ones at most half a second is lost.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "checkpoint"
    >>> with Checkpoint(path) as first:
    ...     first.keep(b"one", (np.array([1.0, 2.0]),))
    >>> with Checkpoint(path) as second:
    ...     second.recall(b"one"), second.recall(b"two")
    ((array([1., 2.]),), None)
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._lock = Lock()
        self._written = monotonic()
        self._counted: set[bytes] = set()
        self.spared = 0.0
        try:
            self._file = sqlite3.connect(path, check_same_thread=False, isolation_level=None)
            self._file.execute(_TABLE)
            self._file.execute("BEGIN")
        except sqlite3.Error as error:
            raise self._lost(error) from None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def recall(self, key: bytes) -> Arrays | None:
        """The arrays kept by a key, or None."""
        with self._lock:
            found = self._ask("SELECT shapes, content, seconds FROM results WHERE key = ?", (key,)).fetchone()
        if found is None:
            return None
        if key not in self._counted:
            self.spared += found[2]
            self._counted.add(key)
        arrays, begin = [], 0
        for kind, shape in json.loads(found[0]):
            arrays.append(np.ndarray(tuple(shape), kind, found[1], begin).copy())
            begin += arrays[-1].nbytes
        return tuple(arrays)

    def keep(self, key: bytes, arrays: Sequence[np.ndarray], seconds: float = 0.0) -> None:
        """Keep arrays of numbers, and how long it took to compute them."""
        shapes = json.dumps([(array.dtype.str, array.shape) for array in arrays])
        content = b"".join(np.ascontiguousarray(array).tobytes() for array in arrays)
        with self._lock:
            self._ask("INSERT OR REPLACE INTO results VALUES (?, ?, ?, ?)", (key, shapes, content, seconds))
            self._counted.add(key)
            if monotonic() - self._written >= EVERY:
                self._write()

    def once(self, key: bytes, compute: Callable[[], Sequence[np.ndarray]]) -> Sequence[np.ndarray]:
        """The arrays kept by a key; where there are none they are computed and kept."""
        known = self.recall(key)
        if known is None:
            began = perf_counter()
            known = compute()
            self.keep(key, known, perf_counter() - began)
        return known

    def close(self) -> None:
        """Write what has come, and let go of the file."""
        with self._lock:
            try:
                self._ask("COMMIT")
            finally:
                self._file.close()

    def _write(self) -> None:
        self._ask("COMMIT")
        self._ask("BEGIN")
        self._written = monotonic()

    def _ask(self, text: str, values: tuple = ()) -> sqlite3.Cursor:
        try:
            return self._file.execute(text, values)
        except sqlite3.Error as error:
            raise self._lost(error) from None

    def _lost(self, error: sqlite3.Error) -> StorageError:
        return unwritable(self.path, error)


def holds_results(path: Path) -> bool:
    """Return True if a checkpoint holds results, or if that cannot be known."""
    if not path.is_file():
        return False
    try:
        with closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)) as file:
            return file.execute("SELECT 1 FROM results LIMIT 1").fetchone() is not None
    except sqlite3.Error:
        return True
