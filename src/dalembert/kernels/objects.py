"""Object files of kernels: where they are stored, and how they are loaded."""

import hashlib
import os
import platform
import sys
import tempfile
import threading
import time
from collections.abc import Iterable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, Protocol

import llvmlite
import llvmlite.binding as ll

from dalembert.kernels.digest import file_digest
from dalembert.kernels.packaged import packaged
from dalembert.kernels.processor import processor

_UNUSED = 30 * 86400  # s after which a cached object is removed
_DAY = 86400
FOLDER = "DALEMBERT_CACHE_DIR"  # environment variable


class Compilable(Protocol):
    """A kernel, as objects see it."""

    symbol: str
    in_python: bool

    @property
    def digest(self) -> Any:
        """Digest of its sources, a text."""
        ...

    @property
    def needs(self) -> Any:
        """List of the kernels that it calls."""
        ...

    def object_code(self) -> bytes:
        """Compile it."""
        ...


def cache_root() -> Path:
    """The folder of all cached objects of this user."""
    if FOLDER in os.environ:
        return Path(os.environ[FOLDER])
    base = os.environ.get("LOCALAPPDATA") if os.name == "nt" else os.environ.get("XDG_CACHE_HOME")
    if base is None:
        base = Path.home() / ("Library/Caches" if sys.platform == "darwin" else ".cache")
    return Path(base) / "dalembert"


@cache
def cache_folder() -> Path:
    """The folder for this processor, these versions, and this compiler of kernels."""
    import numba

    # The compiler itself is a part of the source of each object.
    own = sorted(Path(__file__).parent.glob("*.py"))
    parts = (
        numba.__version__, llvmlite.__version__, platform.python_version(), platform.machine(), *processor(),
        *(file_digest(str(path)) for path in own),
    )  # fmt: skip
    return cache_root() / "kernels" / hashlib.sha256("\n".join(parts).encode()).hexdigest()[:16]


def cached_path(kernel: Compilable) -> Path:
    """Where the object of a kernel is kept."""
    return cache_folder() / f"{kernel.symbol}-{kernel.digest}.o"


def read_cached(kernel: Compilable) -> bytes | None:
    """The object of a kernel, if it is kept."""
    path = cached_path(kernel)
    try:
        if time.time() - path.stat().st_mtime > _DAY:
            path.touch()  # it is in use
        return path.read_bytes()
    except OSError:
        return None


def is_writable() -> bool:
    """Whether the folder can be written."""
    try:
        cache_folder().mkdir(parents=True, exist_ok=True)
    except OSError:
        return False
    return os.access(cache_folder(), os.W_OK)


def keep(kernel: Compilable, code: bytes) -> None:
    """Keep an object for later processes, unless the folder cannot be written."""
    with suppress(OSError):
        write_object(cached_path(kernel), code)


def write_object(path: Path, code: bytes) -> None:
    """Write an object, whole or not at all."""
    if not path.parent.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        remove_unused()
    # Written under another name and then renamed: other processes see no half of an object.
    handle, name = tempfile.mkstemp(dir=path.parent, suffix=".tmp")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(code)
        Path(name).replace(path)
    except OSError:
        Path(name).unlink(missing_ok=True)
        raise


def remove_unused() -> None:
    """Remove objects that no process has used for thirty days, and folders that are empty."""
    for path in (cache_root() / "kernels").glob("*/*"):
        with suppress(OSError):
            if time.time() - path.stat().st_mtime > _UNUSED:
                path.unlink()
                path.parent.rmdir()


class Objects:
    """The objects of this process."""

    def __init__(self) -> None:
        self._codes: dict[str, bytes] = {}  # by symbol, before they are loaded
        self._loaded: set[str] = set()
        self._engines: list[Any] = []
        self._lock = threading.RLock()
        self._packaged = False

    def _load_package(self) -> None:
        """Load the object of the wheel, once, if there is one that fits."""
        if not self._packaged:
            self._packaged = True
            own = packaged()
            if own is not None:
                self._load(own.code, own.symbols)

    def missing(self, kernels: Iterable[Any]) -> list[Any]:
        """Kernels that must be compiled, among these and those that they call."""
        with self._lock:
            return [kernel for kernel in self._reached(kernels) if self._code(kernel) is None]

    def make(self, kernel: Compilable) -> bytes:
        """Compile a kernel, and keep it."""
        code = kernel.object_code()
        keep(kernel, code)
        self.add(kernel, code)
        return code

    def add(self, kernel: Compilable, code: bytes) -> None:
        """Take an object that was compiled elsewhere."""
        self._codes[kernel.symbol] = code

    def address(self, kernel: Compilable) -> int:
        """Address of a kernel, which is loaded, or compiled, with those that it calls."""
        with self._lock:
            for other in reversed(self._reached([kernel])):
                code = self._code(other)
                self._load(self.make(other) if code is None else code, [other.symbol])
                self._codes.pop(other.symbol, None)
            return ll.address_of_symbol(kernel.symbol)

    def _reached(self, kernels: Iterable[Compilable]) -> list[Compilable]:
        """Kernels that are not loaded among these and those that they call; callers first."""
        self._load_package()
        reached: dict[str, Compilable] = {}
        ahead = list(kernels)
        while ahead:
            kernel = ahead.pop()
            if kernel.symbol not in self._loaded and not kernel.in_python:
                reached.pop(kernel.symbol, None)
                reached[kernel.symbol] = kernel
                ahead += kernel.needs
        return list(reached.values())

    def _code(self, kernel: Compilable) -> bytes | None:
        if kernel.symbol not in self._codes and (code := read_cached(kernel)) is not None:
            self._codes[kernel.symbol] = code
        return self._codes.get(kernel.symbol)

    def _load(self, code: bytes, symbols: Iterable[str]) -> None:
        """Load an object, and let others call its symbols.

        Each object has an engine, so that its sections are allocated together.
        """
        if not self._engines:
            ll.initialize_native_target()
            ll.initialize_native_asmprinter()
        machine = ll.Target.from_triple(ll.get_process_triple()).create_target_machine(jit=True)
        engine = ll.create_mcjit_compiler(ll.parse_assembly(""), machine)
        engine.add_object_file(ll.object_file.ObjectFileRef.from_data(code))
        engine.finalize_object()
        for symbol in symbols:
            ll.add_symbol(symbol, engine.get_function_address(symbol))
            self._loaded.add(symbol)
        self._engines.append(engine)


OBJECTS = Objects()
