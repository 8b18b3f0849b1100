"""All kernels of the package: for compiling ahead, and for the object file of a wheel."""

from collections.abc import Iterator
from importlib import import_module
from pkgutil import walk_packages

from dalembert.kernels.kernel import Compiled

_HOMES = ("dalembert.multibody", "dalembert.vibration", "dalembert.surrogate")


def package_kernels() -> list[Compiled]:
    """Every kernel of the package by its symbol, those of each kind of component in all roles."""
    found: dict[str, Compiled] = {}
    for home in _HOMES:
        package = import_module(home)
        for entry in walk_packages(package.__path__, f"{home}."):
            for kernel in _kernels_of(import_module(entry.name)):
                found.setdefault(kernel.symbol, kernel)
    return [found[symbol] for symbol in sorted(found)]


def _kernels_of(module: object) -> Iterator[Compiled]:
    for value in vars(module).values():
        if isinstance(value, Compiled):
            yield value
        elif hasattr(value, "all_kernels") and not isinstance(value, type):  # a kind of component
            yield from value.all_kernels()
