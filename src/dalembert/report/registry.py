"""Which sections a kind of result has: one registered function each."""

from collections.abc import Callable
from typing import Any, TypeVar

from dalembert.errors import InputError
from dalembert.report.asked import Asked
from dalembert.report.sections.section import Section

Sections = Callable[[Any, Asked], list[Section]]
Function = TypeVar("Function", bound=Sections)
_BY_CLASS: dict[type, Sections] = {}
_BY_PROTOCOL: dict[type, Sections] = {}


def sections_of(kind: type) -> Callable[[Function], Function]:
    """Register the function that makes the sections of a kind of result.

    Parameters
    ----------
    kind : type
        A class, or a protocol that can be checked at run time. The nearest class of a result serves; protocols are
        tried after classes, in the order of their registration.

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
        (_BY_PROTOCOL if getattr(kind, "_is_protocol", False) else _BY_CLASS)[kind] = function
        return function

    return registered


def register_single(kind: type, headline: Callable[..., Section], section: Callable[[Any], Section]) -> None:
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
        if kind in _BY_CLASS:
            return _BY_CLASS[kind](result, asked)
    for kind, function in _BY_PROTOCOL.items():
        if isinstance(result, kind):
            return function(result, asked)
    raise InputError(
        f"report: a {type(result).__name__} was given; expected a result, such as identify(), simulate() or "
        "propagate() return, or one whose sections are registered by sections_of"
    )
