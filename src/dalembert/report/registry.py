"""Which sections a kind of result has: one registered function each."""

from collections.abc import Callable
from importlib import import_module
from typing import Any, TypeVar

from dalembert.errors import InputError
from dalembert.report.headline import headline_of
from dalembert.report.options import ReportOptions
from dalembert.report.section import Section
from dalembert.results import Summarised

Sections = Callable[[Any, ReportOptions], list[Section]]
Function = TypeVar("Function", bound=Sections)
_MODULES = {
    "inverse": "fit assessment alternative inertial decay",
    "multibody": "motion path",
    "study": "motion",
    "structure": "mode",
    "uncertainty": "bound",
    "vibration": "curve family shape",
}
"""Modules ``…_sections`` with the sections of each package's results, imported when needed."""
_PACKAGE = "dalembert.report.sections"
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
        Of a function ``(result, options) -> list of Section``.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> from dalembert.report import ReportSection, sections_of
    >>> @dataclass
    ... class Weather:
    ...     rain: float
    >>> @sections_of(Weather)
    ... def weather(result, options):
    ...     return [ReportSection("Weather", (f"{result.rain} mm of rain.",))]
    """

    def registered(function: Function) -> Function:
        name = kind if isinstance(kind, str) else _full_name(kind)
        if name not in _SECTIONS or not function.__module__.startswith(_PACKAGE):  # sections of others win over ours
            _SECTIONS[name] = function
        return function

    return registered


def registered_sections(result: object, options: ReportOptions) -> list[Section]:
    """Return the sections of a result: the registered ones, or its facts and tables."""
    for kind in type(result).__mro__:
        package, module = [*kind.__module__.split("."), ""][:2]
        if package == "dalembert":
            for name in _MODULES.get(module, "").split():
                import_module(f"{_PACKAGE}.{name}_sections")
        if (function := _SECTIONS.get(_full_name(kind))) is not None:
            return function(result, options)
    if isinstance(result, Summarised) and (tables := result.tables()):
        return [headline_of(result), Section("Tables", tables)]
    raise InputError(
        f"report: a {type(result).__name__} was given; expected a result, such as identify(), simulate() or "
        "propagate() return. For a class of your own, register its sections first by dalembert.report.sections_of"
    )


def _full_name(kind: type) -> str:
    return f"{kind.__module__}.{kind.__qualname__}"
