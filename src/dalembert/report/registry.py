"""Which sections a kind of result has: one registered function each."""

from collections.abc import Callable
from importlib import import_module
from typing import Any, TypeVar

from dalembert.errors import InputError
from dalembert.report.asked import Asked
from dalembert.report.sections.section import Section

Sections = Callable[[Any, Asked], list[Section]]
Function = TypeVar("Function", bound=Sections)
SUBJECTS = {
    "inverse": "identification",
    "multibody": "motion",
    "study": "motion",
    "structure": "frequency",
    "uncertainty": "bounds",
    "vibration": "frequency",
}
"""Module in ``dalembert.report.results`` with the sections of each package's results, imported when needed."""
_SECTIONS: dict[str, Sections] = {}


def sections_of(kind: type | str) -> Callable[[Function], Function]:
    """Register the function that makes the sections of a kind of result.

    Parameters
    ----------
    kind : type or str
        A class, or the full name of one of a layer above. The sections of a result are those of its nearest class.

    Returns
    -------
    decorator
        Of a function ``(result, asked) -> list of Section``.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> from dalembert.report import Part, sections_of
    >>> @dataclass
    ... class Weather:
    ...     rain: float
    >>> @sections_of(Weather)
    ... def weather(result, asked):
    ...     return [Part("Weather", (f"{result.rain} mm of rain.",))]
    """

    def registered(function: Function) -> Function:
        _SECTIONS[kind if isinstance(kind, str) else _full_name(kind)] = function
        return function

    if isinstance(kind, type):
        _load(kind)
    return registered


def register_single(kind: type | str, headline: Callable[..., Section], section: Callable[[Any], Section]) -> None:
    """Register a kind of result that has one section below its headline."""
    sections_of(kind)(lambda result, asked: [headline(result, asked.title, asked.notes), section(result)])


def registered_sections(result: object, asked: Asked) -> list[Section]:
    """Sections of a result.

    Raises
    ------
    InputError
        For a result of no registered kind.
    """
    for kind in type(result).__mro__:
        _load(kind)
        if (function := _SECTIONS.get(_full_name(kind))) is not None:
            return function(result, asked)
    raise InputError(
        f"report: a {type(result).__name__} was given; expected a result, such as identify(), simulate() or "
        "propagate() return, or one whose sections are registered by sections_of"
    )


def _full_name(kind: type) -> str:
    return f"{kind.__module__}.{kind.__qualname__}"


def _load(kind: type) -> None:
    """Import the module that registers the sections of a class of this package."""
    package, _, module = kind.__module__.partition(".")
    subject = SUBJECTS.get(module.partition(".")[0]) if package == "dalembert" else None
    if subject:
        import_module(f"dalembert.report.results.{subject}")
