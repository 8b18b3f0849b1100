"""Python functions that a study file names: ``"model.py:pendulum"`` or ``"package.module:function"``."""

import importlib
import importlib.util
import inspect
import re
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.machinery import SourceFileLoader
from pathlib import Path
from types import CodeType, ModuleType
from typing import Annotated, Any

from pydantic import PlainValidator, ValidationInfo, WithJsonSchema

from dalembert.errors import DalembertError, InputError, listed, told, unknown, users_place
from dalembert.study.text.table import Context, checked

_WAYS = "'model.py:function' (a file beside the study) or 'package.module:function'"


@dataclass(frozen=True)
class FunctionReference:
    """A function by name, imported when it is first needed. ``text``: as the study file writes it; ``path``: the file,
    None if a module is named; ``folder``: of the study, from which the function's own imports are resolved.
    """

    text: str
    path: Path | None
    folder: Path

    def __str__(self) -> str:
        return self.text

    def load(self) -> Callable[..., Any]:
        """The function itself."""
        source, name = self.text.rsplit(":", 1)
        with _importing_from(self.folder):
            try:
                module = importlib.import_module(source) if self.path is None else _module(self.path)
            except (Exception, SystemExit) as error:  # whatever the user's file raises
                raise InputError(f"{source} cannot be imported: {told(error)}") from error
        function = getattr(module, name, None)
        if not callable(function):
            known = [key for key, value in vars(module).items() if callable(value) and not key.startswith("_")]
            raise InputError(unknown("function", name, known, where=source))
        return function

    def fitting(self, *arguments: Any, **named: Any) -> Callable[..., Any]:
        """The function, if it can be called with these arguments."""
        function = self.load()
        try:
            inspect.signature(function).bind(*arguments, **named)
        except TypeError as error:
            kinds = [*(f"a {type(argument).__name__}" for argument in arguments), *map(repr, named)]
            raise InputError(
                f"{self} cannot be called with {listed(kinds) if kinds else 'no arguments'}: {error}"
            ) from None
        except ValueError:  # a function that does not say what it takes
            pass
        return function


@contextmanager
def users_code() -> Iterator[None]:
    """A block that calls functions of the user: errors in them are reported with the place in their file."""
    try:
        yield
    except MemoryError as error:
        raise InputError(
            f"the study needs more memory than there is: {told(error)}. Choose fewer samples, simulations or starts"
        ) from error
    except (Exception, SystemExit) as error:
        if isinstance(error, DalembertError) or not users_place(error):
            raise
        raise InputError(f"the study's Python code raised {told(error)}; mend it there") from error


def read_function(value: object, context: Context) -> FunctionReference:
    """Reference from what a study file says."""
    if not isinstance(value, str) or not re.fullmatch(r"[^:]+:[^\W\d]\w*", value):
        raise InputError(f"{value!r} was given; expected a function such as {_WAYS}")
    source = value.rsplit(":", 1)[0]
    if not source.endswith(".py"):
        if not re.fullmatch(r"[^\W\d]\w*(\.[^\W\d]\w*)*", source):
            raise InputError(f"{value!r} was given; expected a function such as {_WAYS}")
        return FunctionReference(value, None, context.folder)
    path = context.file(source)
    if not path.is_file():
        raise InputError(f"{value!r} was given, but there is no file {path}")
    return FunctionReference(value, path, context.folder)


def _read(value: Any, info: ValidationInfo) -> FunctionReference:
    return checked(read_function, value, info.context if isinstance(info.context, Context) else Context())


FunctionName = Annotated[
    Any,
    PlainValidator(_read),
    WithJsonSchema({"type": "string", "description": f"a function such as {_WAYS}"}),
]


@contextmanager
def _importing_from(folder: Path) -> Iterator[None]:
    sys.path.insert(0, str(folder.resolve()))
    try:
        yield
    finally:
        sys.path.remove(str(folder.resolve()))


class _SourceLoader(SourceFileLoader):
    """Loads a user's file without a cache of compiled code, which a full disk leaves damaged."""

    def get_code(self, fullname: str) -> CodeType:
        path = self.get_filename(fullname)
        return self.source_to_code(self.get_data(path), path)


def _module(path: Path) -> ModuleType:
    name = f"dalembert_study_{path.stem}"
    spec = importlib.util.spec_from_file_location(name, path, loader=_SourceLoader(name, str(path)))
    if spec is None or spec.loader is None:
        raise ImportError(f"{path} is no Python file")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # dataclasses and pickles of the file look their module up
    spec.loader.exec_module(module)
    return module
