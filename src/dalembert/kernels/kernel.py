"""Kernels: functions that are compiled separately, and called by their symbol from other kernels, or from Python."""

import ctypes
import inspect
import struct
import sys
from collections.abc import Callable
from functools import cached_property
from importlib import import_module
from typing import Any, TypeVar, get_type_hints

from numba import njit

from dalembert.kernels.compiler import Inner, caller, entry_point, object_code
from dalembert.kernels.digest import digest, needs
from dalembert.kernels.duals import Dual
from dalembert.kernels.lanes import Lanes
from dalembert.kernels.objects import OBJECTS
from dalembert.kernels.pipeline import PIPELINE
from dalembert.kernels.words import address, form, leaves, packer, unpack

_Function = TypeVar("_Function", bound=Callable)

# No fast-math, not even the fusing of a product with a sum (a thirtieth of a simulation's time): results are those of
# IEEE arithmetic. A kernel allocates no memory: NumPy allocates, and Python keeps the arrays alive.
_OPTIONS: dict[str, Any] = {
    "nogil": True,
    "error_model": "numpy",
    "_nrt": False,
    "no_cpython_wrapper": True,
    "no_cfunc_wrapper": True,
}


def _decorator(**options: Any) -> Callable[[_Function], _Function]:
    decorate: Any = njit(**_OPTIONS, pipeline_class=PIPELINE, **options)

    def decorated(function: _Function) -> _Function:
        dispatcher = decorate(function)
        # Numba's decorator makes its own dispatcher; the class is exchanged, since no option chooses another one.
        dispatcher.__class__ = Inner
        return dispatcher

    return decorated


#: For functions that kernels call; LLVM decides whether they are written into their callers.
inner = _decorator()
#: For small ones that must be.
inlined = _decorator(forceinline=True)


Origin = tuple[str, str, tuple[str, ...]]
"""Module of a kernel, name there, and role and arithmetic if it is a kind's."""
Owner = tuple[Any, str, type]
"""A kind of component, a role and an arithmetic."""

_NUMBERS = {kind.__name__: kind for kind in (float, complex, Dual, Lanes)}


class Compiled:
    """A C function that is loaded, or compiled, when its address is first needed."""

    symbol: str
    function: Callable
    in_python = False  #: whether it is called back as a Python function, and never compiled
    is_vector = False  #: whether it computes in lanes or dual numbers alone

    @cached_property
    def origin(self) -> Origin | None:
        """Module and name by which another process imports the kernel; None if there is none."""
        return origin_of(self.function.__module__, self)

    def __reduce__(self) -> Any:
        """In another process: the kernel of the same origin, which has other addresses."""
        if self.origin is None:
            raise TypeError(f"kernel {self.symbol} is defined in a script; move it into a module")
        return find, (self.origin,)

    @property
    def family(self) -> str:
        """Kernels of a family share inner functions: one process compiles them."""
        return self.function.__module__

    @cached_property
    def digest(self) -> str:
        """Digest of the source."""
        return digest(self.function)

    @cached_property
    def needs(self) -> list["Compiled"]:
        """Kernels that it calls by their symbols."""
        return needs(self.function)

    @property
    def abi(self) -> str:
        """What a caller depends on."""
        return self.symbol

    @property
    def entry(self) -> tuple[Callable, str, int]:
        """The Python function to compile, its symbol, and the number of addresses that it takes."""
        raise NotImplementedError

    def object_code(self) -> bytes:
        """Machine code of the function for this processor."""
        return object_code(*self.entry)

    @cached_property
    def address(self) -> int:
        """Address of the C function."""
        return OBJECTS.address(self)


class BlockKernel(Compiled):
    """A C function of two addresses: those of a call and of a block, or of what else its function takes."""

    def __init__(
        self, function: Callable[[Any, Any], None], symbol: str, owner: Owner | None = None, dtype: type = float
    ) -> None:
        self.function, self.symbol, self._owner = function, symbol, owner
        self.is_vector = (dtype if owner is None else owner[2]) in (Dual, Lanes)

    @cached_property
    def origin(self) -> Origin | None:
        if self._owner is None:
            return super().origin
        kind, role, dtype = self._owner
        return origin_of(kind.module, kind, role, dtype.__name__)

    @property
    def family(self) -> str:
        return self.function.__module__ if self._owner is None else self._owner[0].name

    @property
    def entry(self) -> tuple[Callable, str, int]:
        return self.function, self.symbol, 2

    @cached_property
    def _entry(self) -> Any:
        return ctypes.CFUNCTYPE(None, ctypes.c_int64, ctypes.c_int64)(self.address)

    def __call__(self, first: int, second: int) -> None:
        self._entry(first, second)


class Indirect:
    """In compiled functions: a call of any kernel with the arguments of this one, by an address before them."""

    def __init__(self, kernel: "Kernel") -> None:
        self.kernel = kernel

    @property
    def abi(self) -> str:
        """What a caller depends on."""
        return self.kernel.abi

    def __call__(self, address: int, *arguments: Any) -> Any:
        return self.kernel.called(ctypes.CFUNCTYPE(None, ctypes.c_void_p)(address), self.kernel.packed(arguments))


class Kernel(Compiled):
    """A C function of one address: that of the words of its arguments, see :mod:`dalembert.kernels.words`.

    The first argument of the Python function may be the value of another one, ``first``, that is compiled into it.
    """

    def __init__(self, function: Callable, first: Any = None, is_vector: bool = False) -> None:
        self.is_vector = is_vector
        hints = get_type_hints(function, include_extras=True)
        self.function, self._first = function, () if first is None else (first,)
        self.__name__, self.__doc__ = function.__name__, function.__doc__
        words = function.__module__.removeprefix("dalembert."), function.__name__, getattr(first, "__name__", "")
        self.symbol = "_".join(("dal", *words)).rstrip("_").replace(".", "_").replace("__", "_")
        result = hints.pop("return", None)
        self._result = None if result is type(None) else result
        names = list(inspect.signature(function).parameters)[len(self._first) :]
        self._arguments = tuple(hints[name] for name in names)
        # One layout for both directions: words of the arguments, then of the result, at least one of them.
        given, answer = "".join(map(form, self._arguments)), "" if self._result is None else form(self._result)
        self._packers = [packer(f"{function.__name__}: {name}", hints[name]) for name in names]
        self._given = struct.Struct(f"{given}{8 * max(len(answer), 1)}x")
        self._answer = struct.Struct(f"{8 * len(given)}x{answer}")
        self.inner = inner(function)
        caller(self, self.symbol, self._arguments, self._result)
        self.at = Indirect(self)
        caller(self.at, None, self._arguments, self._result)

    @property
    def entry(self) -> tuple[Callable, str, int]:
        return entry_point(self.inner, self._arguments, self._result, self._first), self.symbol, 1

    @property
    def abi(self) -> str:
        return f"{self.symbol}{self._layout}"

    @property
    def _layout(self) -> str:
        return repr([list(leaves(entry)) for entry in self._arguments]) + repr(self._result)

    @cached_property
    def digest(self) -> str:
        return digest(self.function, self._layout + "".join(digest(other.py_func) for other in self._first))

    @cached_property
    def _entry(self) -> Any:
        return ctypes.CFUNCTYPE(None, ctypes.c_void_p)(self.address)  # an address, or the bytes there

    def packed(self, arguments: tuple[Any, ...]) -> list[Any]:
        """Words of all arguments."""
        values: list[Any] = []
        for pack, value in zip(self._packers, arguments, strict=True):
            pack(value, values)
        return values

    def called(self, entry: Any, values: list[Any]) -> Any:
        """The result of a C function that takes the arguments of this kernel."""
        given = self._given.pack(*values)
        if self._result is None:
            return entry(given)
        # The C function writes behind the arguments, and bytes of Python may not change.
        words = bytearray(given)
        entry(address(words))
        return unpack(self._result, self._answer.unpack_from(words))

    def __call__(self, *arguments: Any) -> Any:
        return self.called(self._entry, self.packed(arguments))

    def given(self, *arguments: Any) -> Callable[..., Any]:
        """This kernel with its first arguments, whose words are packed once. This makes frequent calls faster."""
        first, packers = [], self._packers[len(arguments) :]
        for pack, value in zip(self._packers, arguments, strict=False):
            pack(value, first)

        def call(*others: Any, alive: Any = arguments) -> Any:
            values = first.copy()
            for pack, value in zip(packers, others, strict=True):
                pack(value, values)
            return self.called(self._entry, values)

        return call


def kernel(function: Callable) -> Any:
    """Compile a function alone when it is first needed; its annotations are its arguments' types."""
    return Kernel(function)


def vector_kernel(function: Callable) -> Any:
    """Compile a function in lanes, as `kernel` does; `dalembert compile` leaves it out unless asked for all."""
    return Kernel(function, is_vector=True)


def origin_of(module: str | None, owner: Any, *role: str) -> Origin | None:
    """Module and name there of an object, unless the module is a script or does not hold the object."""
    space = vars(sys.modules[module]) if module in sys.modules else {}
    names = [name for name, value in space.items() if value is owner]
    return (module, names[0], role) if module and names and module != "__main__" else None


def find(origin: Origin) -> Compiled:
    """The kernel of an origin."""
    module, name, role = origin
    found = getattr(import_module(module), name)
    return found.kernel(role[0], _NUMBERS[role[1]]) if role else found
