"""Errors for operations that kernels do not support, with file and line."""

import dis
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from types import CodeType

from numba.core.errors import NumbaError

from dalembert.errors import ModelError
from dalembert.kernels.digest import inner_functions

_RAISES = "a kernel cannot raise an exception. Return nan, or check the input before, in the component's __post_init__"
_ALLOCATES = (
    "a kernel cannot make arrays, lists or texts. Use numbers, tuples, or stack(x, n) for n numbers like those of x"
)
_BRANCHES = (
    "a branch depends on the state, but samples side by side take the same branches. Select by where(condition, a, b), "
    "branch on a number by is_zero(number), or declare the kind with lanes=False"
)
_PRINTS = "a kernel cannot call {}. Run the component in plain Python for that: with in_python(...)"
_TALKS = ("print", "open", "input", "breakpoint")
_ARRAYS = re.compile(
    r"NRT required|built-in function (zeros|ones|empty|full|array|zeros_like|empty_like|ones_like|copy)"
)
_NOISE = re.compile(r"^(Failed in nopython|During:|File |\s*\^|\s*<source elided>|Invalid use of type|\s*$)")


@contextmanager
def refusals(function: Callable) -> Iterator[None]:
    """Translate Numba's errors about a kernel, or about a function that it calls, into a short message."""
    # Numba compiles `raise`, but the C function of a kernel ignores the status that the native function returns.
    _refuse_statements(function)
    try:
        yield
    except NumbaError as error:
        raise ModelError(_sentence(error, function)) from error
    except KeyError as error:
        raise ModelError(
            f"A kernel reads {error}, but its record has no such column. Declare the column, or correct the name"
        ) from error


def _refuse_statements(function: Callable) -> None:
    """Raise for statements that compiled code could only ignore, in a function or in one that it calls."""
    for own in inner_functions(function):  # type: ignore[arg-type] - a Python function
        if refused := _refused(own.__code__, own.__name__):
            raise ModelError(refused)


@cache
def _refused(function: CodeType, name: str) -> str:
    """What is wrong with the first such statement of a function, or an empty text."""
    for code in _codes(function):
        for instruction in dis.get_instructions(code):
            line = instruction.positions.lineno if instruction.positions else code.co_firstlineno
            where = f"{code.co_filename}, line {line}, in {name}"
            if instruction.opname == "RAISE_VARARGS":
                return f"{where}: {_RAISES}"
            if instruction.opname == "LOAD_GLOBAL" and instruction.argval in _TALKS:
                return f"{where}: {_PRINTS.format(instruction.argval)}"
    return ""


def _codes(code: CodeType) -> Iterator[CodeType]:
    yield code
    for entry in code.co_consts:
        if isinstance(entry, CodeType):
            yield from _codes(entry)


def _sentence(error: NumbaError, function: Callable) -> str:
    text = str(error)
    # Numba names places in two formats, by the stage that failed.
    places = re.findall(r'File "([^"]+)", line (\d+)', text) or re.findall(r"at (\S+) \((\d+)\)", text)
    name = function.__name__
    file, line = _innermost(places) if places else ("", "")
    where = f"{Path(file).resolve()}, line {line}" if places else f"in {name}"
    if "bool(Mask)" in text:
        return f"{where}: {_BRANCHES}"
    if _ARRAYS.search(text):
        return f"{where}: {_ALLOCATES}"
    lines = [line.strip() for line in text.splitlines() if not _NOISE.match(line)]
    reason = lines[0].rstrip(".") if lines else type(error).__name__
    return f"{where}: Numba cannot compile this: {reason}. Functions that a kernel calls need 'inner'"


def _innermost(places: list[tuple[str, str]]) -> tuple[str, str]:
    """The first place in code that is not Numba's."""
    own = [place for place in places if "/numba/" not in place[0].replace("\\", "/")]
    return (own or places)[0]
