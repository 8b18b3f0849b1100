"""Results on disk as they come, by what they are results of, so that a run that was killed need not repeat them."""

import hashlib
import json
import os
import sqlite3
import struct
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from threading import Lock
from time import monotonic, perf_counter
from typing import NamedTuple, Self

import numpy as np

from dalembert.errors import unwritable
from dalembert.files import set_aside

EVERY = 0.5  # seconds between two times at which what came is written to the disk for good
Arrays = tuple[np.ndarray, ...]
_COLUMNS = "key, shapes, content, seconds, digest"
_TABLE = (
    "CREATE TABLE IF NOT EXISTS results (key BLOB PRIMARY KEY, shapes BLOB, content BLOB, seconds REAL, digest BLOB)"
)
_INSERT = "INSERT OR REPLACE INTO results VALUES (?, ?, ?, ?, ?)"
# What SQLite says where the file itself is right; of anything else the file is the cause.
_NO_STORAGE = (
    sqlite3.SQLITE_FULL, sqlite3.SQLITE_IOERR, sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_PERM, sqlite3.SQLITE_BUSY,
    sqlite3.SQLITE_LOCKED, sqlite3.SQLITE_NOMEM, sqlite3.SQLITE_INTERRUPT, sqlite3.SQLITE_READONLY,
)  # fmt: skip


class Result(NamedTuple):
    """Arrays as bytes: their kinds and shapes, their content, and the seconds of their computation."""

    shapes: bytes
    content: bytes
    seconds: float


class Checkpoint:
    """Arrays by key, in one SQLite file: whatever stops the process, all but those of the last moment are there.

    Parameters
    ----------
    path : Path
        Made if it is not there.
    on_damage : callable, optional
        Called with a sentence where the file is damaged; the sentence is a warning if not given.

    Attributes
    ----------
    spared : float
        Computing time of the recalled results in earlier processes, s: what this process saved.

    Raises
    ------
    StorageError
        Where the file cannot be written.

    Notes
    -----
    A transaction is written whole or not at all (SQLite's rollback journal, which unlike its write-ahead log works on
    shared file systems too), and what was written before stays. A computation that takes longer than half a second is
    on the disk before the next begins; of shorter ones at most half a second is lost. Results wait in memory until a
    transaction is due: the summary of a batch soon replaces most of them, which are then never written.

    Each result has a digest. A damaged file is kept as ``NAME.damaged-1`` and so on, and a new one takes the results
    whose digests are right.

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

    def __init__(self, path: Path, on_damage: Callable[[str], None] | None = None) -> None:
        self.path = path
        self._tell = on_damage or (lambda sentence: warnings.warn(sentence, RuntimeWarning, stacklevel=2))
        self._lock = Lock()
        self._written = monotonic()
        self._counted: set[bytes] = set()
        self._waiting: dict[bytes, Result | Callable[[], Result]] = {}
        self._replaced: set[bytes] | None = None
        self.spared = 0.0
        try:
            known = path.is_file()
            self._open()
            self._file.execute(f"SELECT {_COLUMNS} FROM results LIMIT 1").fetchone()
            if known and self._file.execute("PRAGMA integrity_check(1)").fetchone() != ("ok",):
                raise sqlite3.DatabaseError("the file is malformed")
        except sqlite3.Error as error:
            self._replace(error)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def recall(self, key: bytes) -> Arrays | None:
        """The arrays kept by a key, or None."""
        with self._lock:
            waiting = self._waiting.get(key)
            result = self._row(key) if waiting is None else _resolved(waiting)
        if result is None:
            return None
        if self._replaced is not None:
            self._replaced.add(key)
        if key not in self._counted:
            self.spared += result.seconds
            self._counted.add(key)
        arrays, begin = [], 0
        for kind, shape in json.loads(result.shapes):
            arrays.append(np.ndarray(tuple(shape), kind, result.content, begin).copy())
            begin += arrays[-1].nbytes
        return tuple(arrays)

    def keep(self, key: bytes, arrays: Sequence[np.ndarray], seconds: float = 0.0) -> None:
        """Keep arrays of numbers, and how long it took to compute them."""
        self._wait(key, _result(arrays, seconds))
        if self._replaced is not None:
            self._replaced.add(key)

    @contextmanager
    def summarised(self, key: bytes, summary: Callable[[], tuple[Sequence[np.ndarray], float]]) -> Iterator[None]:
        """A block at whose end a summary, arrays and seconds, replaces all results that were recalled or kept in it.

        ``summary`` is called where it is written or recalled, at the end of the block or later.
        """
        self._replaced = set[bytes]()
        try:
            yield
            replaced = self._replaced - {key}
        finally:
            self._replaced = None
        with self._lock:
            for former in replaced:
                if self._waiting.pop(former, None) is None:
                    self._ask("DELETE FROM results WHERE key = ?", (former,))
        self._wait(key, lambda: _result(*summary()))

    def once(self, key: bytes, compute: Callable[[], Sequence[np.ndarray]]) -> Sequence[np.ndarray]:
        """The arrays kept by a key; where there are none they are computed and kept."""
        known = self.recall(key)
        if known is None:
            began = perf_counter()
            known = compute()
            self.keep(key, known, perf_counter() - began)
        return known

    def close(self) -> None:
        """Write the results that wait, and close the file."""
        with self._lock:
            try:
                if self._file.in_transaction:  # a full disk ends it
                    self._write()
            finally:
                self._file.close()

    def _wait(self, key: bytes, result: "Result | Callable[[], Result]") -> None:
        """Let a result wait for the next transaction, which is written where it is due."""
        with self._lock:
            self._waiting[key] = result
            self._counted.add(key)
            if monotonic() - self._written >= EVERY:
                self._write()

    def _row(self, key: bytes) -> "Result | None":
        """The result of the file, or None."""
        row = self._ask(f"SELECT {_COLUMNS} FROM results WHERE key = ?", (key,))
        if row is None:
            return None
        if not _is_right(row):
            self._replace(None)
            return None
        return Result(*row[1:-1])

    def _write(self) -> None:
        for key, waiting in self._waiting.items():
            result = _resolved(waiting)
            self._ask(_INSERT, (key, *result, _digest(key, *result)))
        self._commit()
        self._waiting.clear()

    def _commit(self) -> None:
        self._ask("COMMIT")
        if not self._file.in_transaction:  # a new file has begun one
            self._ask("BEGIN")
        self._written = monotonic()

    def _open(self) -> None:
        self._file = sqlite3.connect(self.path, check_same_thread=False, isolation_level=None)
        self._file.execute(_TABLE)
        self._file.execute("BEGIN")

    def _ask(self, text: str, values: tuple = ()) -> tuple | None:
        """First row of an answer, None if there is none; from the new file where this one is damaged."""
        try:
            return self._file.execute(text, values).fetchone()
        except sqlite3.Error as error:
            self._replace(error)
            return self._file.execute(text, values).fetchone() if values else None

    def _replace(self, error: sqlite3.Error | None) -> None:
        """Set a damaged file aside, and begin a new one with the results that can be read."""
        if error is not None and not self._is_damage(error):
            raise unwritable(self.path, error) from None
        with suppress(sqlite3.Error, AttributeError):
            self._file.execute("COMMIT")
        with suppress(sqlite3.Error, AttributeError):
            self._file.close()
        try:
            aside = set_aside(self.path, "-journal")
            self._open()
            readable = 0
            for row in _readable(aside):
                self._file.execute(_INSERT, row)
                readable += 1
            self._commit()
        except (sqlite3.Error, OSError) as reason:
            raise unwritable(self.path, reason) from None
        self._tell(
            f"{self.path} is damaged and was kept as {aside.name}. {readable} results of it could be read; the others "
            "are computed again."
        )

    def _is_damage(self, error: sqlite3.Error) -> bool:
        code = getattr(error, "sqlite_errorcode", sqlite3.SQLITE_CORRUPT) & 0xFF
        if code == sqlite3.SQLITE_READONLY:  # the file's header can say so, too
            return os.access(self.path, os.W_OK) and os.access(self.path.parent, os.W_OK)
        return code not in _NO_STORAGE


def _result(arrays: Sequence[np.ndarray], seconds: float) -> Result:
    shapes = json.dumps([(array.dtype.str, array.shape) for array in arrays]).encode()
    return Result(shapes, b"".join(np.ascontiguousarray(array).tobytes() for array in arrays), seconds)


def _resolved(waiting: Result | Callable[[], Result]) -> Result:
    return waiting() if callable(waiting) else waiting


def _digest(key: bytes, shapes: bytes, content: bytes, seconds: float) -> bytes:
    digest = hashlib.blake2b(key, digest_size=16)
    for part in (shapes, content, struct.pack("<dQ", seconds, len(shapes))):
        digest.update(part)
    return digest.digest()


def _is_right(row: tuple) -> bool:
    """Whether a result is as it was kept."""
    *result, digest = row
    try:
        return _digest(*result) == digest
    except (TypeError, struct.error):
        return False


def _readable(path: Path) -> Iterator[tuple]:
    """Results of a damaged file that are as they were kept, from its beginning and from its end."""
    with suppress(sqlite3.Error), closing(sqlite3.connect(path)) as file:
        file.execute("PRAGMA writable_schema = ON")  # a file that was cut off is read all the same
        for order in ("ASC", "DESC"):
            with suppress(sqlite3.Error):
                for row in file.execute(f"SELECT {_COLUMNS} FROM results ORDER BY rowid {order}"):
                    if _is_right(row):
                        yield row


def holds_results(path: Path) -> bool:
    """Return True if a checkpoint holds results, or if that cannot be known."""
    if not path.is_file():
        return False
    try:
        with closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)) as file:
            return file.execute("SELECT 1 FROM results LIMIT 1").fetchone() is not None
    except sqlite3.Error:
        return True
