"""All kernels of the package: for compiling ahead, and for the object file of a wheel."""

import json
import platform
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from pkgutil import walk_packages

from dalembert.kernels.compiler import optimised, target_machine
from dalembert.kernels.kernel import Compiled
from dalembert.kernels.packaged import FAMILIES, source_digest

_HOMES = ("dalembert.multibody", "dalembert.vibration", "dalembert.surrogate")


def package_kernels(vectors: bool = False) -> list[Compiled]:
    """Every kernel of the package by its symbol, those of each kind of component in all roles.

    ``vectors``: also those in dual numbers and in lanes, and those of kinds that are not usual.
    """
    found: dict[str, Compiled] = {}
    for home in _HOMES:
        package = import_module(home)
        for entry in walk_packages(package.__path__, f"{home}."):
            for kernel in _kernels_of(import_module(entry.name), vectors):
                found.setdefault(kernel.symbol, kernel)
    return [found[symbol] for symbol in sorted(found)]


def _kernels_of(module: object, vectors: bool) -> Iterator[Compiled]:
    for value in vars(module).values():
        if isinstance(value, Compiled):
            if vectors or not value.is_vector:
                yield value
        elif hasattr(value, "all_kernels") and not isinstance(value, type):  # a kind of component
            if vectors or getattr(value, "is_usual", True):
                yield from value.all_kernels()
            if vectors and hasattr(value, "vector_kernels"):  # laws in frequency have none
                yield from value.vector_kernels()


def build(folder: Path, progress: Callable[[int, int, str], None] = lambda *_: None) -> list[Path]:
    """Write the object of all kernels and what is to be known of it: ``kernels.o`` and ``kernels.json``."""
    own = FAMILIES[platform.machine()]
    kernels, whole = package_kernels(vectors=True), None
    for count, kernel in enumerate(kernels, 1):
        module = optimised(*kernel.entry, cpu=own.cpu)
        if whole is None:
            whole = module
        else:
            # All symbols differ, so that the objects of kernels can be one module.
            whole.link_in(module)
        progress(count, len(kernels), kernel.symbol)
    about = {
        "machine": platform.machine(), "cpu": own.cpu, "sources": source_digest(),
        "symbols": [kernel.symbol for kernel in kernels],
    }  # fmt: skip
    folder.mkdir(parents=True, exist_ok=True)
    paths = [folder / "kernels.o", folder / "kernels.json"]
    paths[0].write_bytes(target_machine(own.cpu).emit_object(whole))
    paths[1].write_text(json.dumps(about, indent=1))
    return paths
