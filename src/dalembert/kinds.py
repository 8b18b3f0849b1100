"""Classes that derive from a base, in this package and in others: a subclass is its registration."""

import dataclasses
import inspect
import sys
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from importlib import import_module
from importlib.metadata import entry_points
from itertools import filterfalse
from operator import attrgetter
from pkgutil import iter_modules

from dalembert.errors import InputError

PLUGINS, TASKS = "dalembert.components", "dalembert.tasks"
"""Groups of entry points: modules of other packages that define components, laws, methods or formats; tasks."""


@cache
def load_plugins(group: str = PLUGINS) -> None:
    """Import the modules of other packages that define kinds."""
    for entry in entry_points(group=group):
        entry.load()


def derived(base: type) -> Iterator[type]:
    """Public concrete classes that derive from a class, those of a class after it."""
    for kind in base.__subclasses__():
        yield from derived(kind)
        if not inspect.isabstract(kind) and not kind.__name__.startswith("_"):
            yield kind


def derived_dataclasses(*bases: type) -> Iterator[type]:
    """Public concrete dataclasses that derive from some classes."""
    return filter(dataclasses.is_dataclass, (kind for base in bases for kind in derived(base)))


def distinct(kinds: Iterable[type], key: Callable[[type], str] = attrgetter("__name__")) -> dict[str, type]:
    """Return one kind of each name: the newest definition of a file, as a notebook or a reload makes several. Two kinds
    of one name from different files are an error.
    """
    by_name: dict[str, type] = {}
    for kind in kinds:
        other = by_name.setdefault(key(kind), kind)
        if _file(kind) != _file(other):
            raise InputError(
                f"two components are named {key(kind)!r}, in the modules {other.__module__!r} and "
                f"{kind.__module__!r}. Rename one, or import only one of the modules"
            )
        by_name[key(kind)] = kind
    return by_name


def named(package: str, *bases: type, plugins: str = PLUGINS) -> dict[str, type]:
    """Return the concrete classes that derive from some bases, or are one of them, by their attribute ``name``. They
    come from all modules of a package, and from other packages that are imported or that an entry point of the group
    ``plugins`` names. So one file in the folder of the package is all that a new kind needs.
    """
    load_modules(package)
    load_plugins(plugins)
    kinds = (kind for base in bases for kind in (base, *derived(base)) if hasattr(kind, "name"))
    return distinct(filterfalse(inspect.isabstract, kinds), attrgetter("name"))


@cache
def load_modules(package: str) -> None:
    """Import all modules in the folder of a package."""
    for module in iter_modules(import_module(package).__path__):
        import_module(f"{package}.{module.name}")


def _file(kind: type) -> str:
    """The file that defines a kind; its module if there is none."""
    return getattr(sys.modules.get(kind.__module__), "__file__", None) or kind.__module__
