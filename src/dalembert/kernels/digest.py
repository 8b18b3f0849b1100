"""The functions and constants that a kernel depends on, and their digest.

A cached kernel is used when its digest is that of the present source. The digest is of compiled Python code, so that
comments do not matter; of the value of each constant; and of the files of functions that Numba replaces.
"""

import dis
import hashlib
import sys
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from pathlib import Path
from types import CodeType, FunctionType, ModuleType
from typing import Any

import numpy as np

_LIBRARIES = ("numba", "numpy", "llvmlite", "scipy")


def digest(function: FunctionType, layout: str = "") -> str:
    """Hexadecimal digits for a function and all that it reaches; ``layout``: what else it depends on."""
    # Sorted, because the order in which functions are reached is no property of the kernel.
    parts = sorted(_own(entry)[0] for entry in _closure(function))
    return hashlib.sha256("\n".join([layout, *parts]).encode()).hexdigest()[:24]


def needs(function: FunctionType) -> list[Any]:
    """Kernels that a function calls by their symbols, directly or through other functions."""
    found = {kernel.symbol: kernel for entry in _closure(function) for kernel in _own(entry)[2]}
    return list(found.values())


def _closure(function: FunctionType) -> list[FunctionType]:
    """A function and all Python functions whose code becomes part of its kernel."""
    return _reached(function, lambda own: _own(own)[1])


def inner_functions(function: FunctionType) -> list[FunctionType]:
    """A function and all functions under ``inner`` that it calls."""
    return _reached(function, lambda own: [value.py_func for _, value in _named(own) if hasattr(value, "py_func")])


def _reached(function: FunctionType, called: Callable[[FunctionType], Iterable[FunctionType]]) -> list[FunctionType]:
    reached, ahead = {function: None}, [function]
    while ahead:
        for other in called(ahead.pop()):
            if other not in reached:
                reached[other] = None
                ahead.append(other)
    return list(reached)


@cache
def _own(function: FunctionType) -> tuple[str, tuple[FunctionType, ...], tuple[Any, ...]]:
    """Digest of a function without those that it calls, these functions, and kernels that it calls."""
    texts, functions, kernels = list(_code_texts(function.__code__)), [], []
    for name, value in _named(function):
        functions += _functions(value)
        # A kernel that is called by its symbol is a separate object: only its signature matters here.
        if hasattr(value, "symbol"):
            kernels.append(value)
        texts.append(f"{name} {_text(value)}")
    return hashlib.sha256("\n".join(texts).encode()).hexdigest(), tuple(functions), tuple(kernels)


def _named(function: FunctionType) -> Iterator[tuple[str, Any]]:
    """Global and closed-over objects that a function names, and attributes of modules that it names."""
    for name, cell in zip(function.__code__.co_freevars, function.__closure__ or (), strict=True):
        yield name, cell.cell_contents
    known, attributes = _names(function.__code__)
    for name in known:
        if name in function.__globals__:
            value = function.__globals__[name]
            yield name, value
            if isinstance(value, ModuleType) and not _foreign(value.__name__):
                yield from ((other, vars(value)[other]) for other in attributes if other in vars(value))


def _names(code: CodeType) -> tuple[list[str], list[str]]:
    """Names of globals, and other names, such as attributes."""
    known, others = set(), set()
    for instruction in dis.get_instructions(code):
        if instruction.opname == "LOAD_GLOBAL":
            known.add(instruction.argval)
        elif isinstance(instruction.argval, str):
            others.add(instruction.argval)
    for entry in code.co_consts:
        if isinstance(entry, CodeType):
            more, beside = _names(entry)
            known.update(more)
            others.update(beside)
    return sorted(known), sorted(others)


def _code_texts(code: CodeType) -> Iterator[str]:
    # Bytecode, names and constants determine the kernel. Line numbers and comments are in none of these.
    yield code.co_code.hex()
    yield repr((code.co_names, code.co_varnames, code.co_freevars))
    for entry in code.co_consts:
        if isinstance(entry, CodeType):
            yield from _code_texts(entry)
        elif not isinstance(entry, str):  # docstrings: kernels have no other texts
            yield repr(sorted(entry) if isinstance(entry, frozenset) else entry)


def _foreign(module: str) -> bool:
    """Whether a module is of a library, which its version identifies."""
    root = module.partition(".")[0]
    return root in _LIBRARIES or root in sys.stdlib_module_names


def _functions(value: Any) -> list[FunctionType]:
    """Python functions whose code becomes part of a kernel."""
    own = getattr(value, "py_func", getattr(value, "_defn", value))  # a function for kernels, an intrinsic
    if isinstance(own, tuple | list):
        return [function for entry in own for function in _functions(entry)]
    return [own] if isinstance(own, FunctionType) and not _foreign(own.__module__ or "") else []


def _text(value: Any) -> str:
    """What identifies a value, beside its functions."""
    if hasattr(value, "abi"):  # a kernel that is called
        return value.abi
    if hasattr(value, "targetoptions"):
        return repr(sorted(value.targetoptions.items()))
    if isinstance(value, FunctionType):  # Numba may replace it by code of the same file
        return f"{value.__qualname__} {file_digest(value.__code__.co_filename)}"
    if isinstance(value, np.ndarray):
        return f"{value.dtype}{value.shape}{value.tobytes().hex()}"
    if isinstance(value, type):
        return f"{value.__qualname__}{getattr(value, '_fields', '')}"
    if isinstance(value, tuple | list):
        return ", ".join(map(_text, value))
    if isinstance(value, ModuleType):
        return value.__name__
    # The usual `repr` of an object has its address, which differs between processes.
    return repr(value) if type(value).__repr__ is not object.__repr__ else type(value).__qualname__


@cache
def file_digest(path: str) -> str:
    """Digest of a file; empty for code that has none."""
    try:
        return hashlib.sha256(Path(path).read_bytes()).hexdigest()
    except OSError:
        return ""
