"""The object file of a wheel: all kernels of the package, compiled ahead for a family of processors.

It holds plain C functions, and calls none but the mathematical ones of the C library, so that it depends on neither the
Python nor the Numba version. It is used if it was made from the present sources and the processor has what it needs.
"""

import hashlib
import json
import os
import platform
from functools import cache
from pathlib import Path
from typing import NamedTuple

import llvmlite.binding as ll

from dalembert.kernels.processor import VARIABLE

HERE = Path(__file__).parent
_HOMES = ("kernels", "multibody", "vibration", "surrogate")  # folders of the package that hold kernels


class Family(NamedTuple):
    """Processors that one object serves: LLVM's name, and the features that tell whether one belongs to them."""

    cpu: str
    features: tuple[str, ...]


#: By the machine's name; x86-64-v3 are the processors with AVX2 (Haswell of 2013, Zen of 2017, and later).
FAMILIES = {
    "x86_64": Family("x86-64-v3", ("avx", "avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe")),
    "aarch64": Family("generic", ("neon",)),
}


class Packaged(NamedTuple):
    """Symbols of an object file, and its machine code."""

    symbols: frozenset[str]
    code: bytes


def source_digest() -> str:
    """Digest of the package's files that hold kernels."""
    digest = hashlib.sha256()
    for home in _HOMES:
        for path in sorted((HERE.parent / home).rglob("*.py")):
            digest.update(path.relative_to(HERE.parent).as_posix().encode() + path.read_bytes())
    return digest.hexdigest()


def family() -> Family | None:
    """The family of this machine's processor; None for one that no object serves."""
    own = FAMILIES.get(platform.machine())
    if own is None or platform.system() != "Linux" or os.environ.get(VARIABLE):
        return None
    features = ll.get_host_cpu_features()
    return own if all(features.get(name, False) for name in own.features) else None


@cache
def packaged() -> Packaged | None:
    """The object of this installation, if there is one that fits."""
    about = HERE / "kernels.json"
    if not about.exists() or family() is None:
        return None
    said = json.loads(about.read_text())
    if said["machine"] != platform.machine() or said["sources"] != source_digest():
        return None
    return Packaged(frozenset(said["symbols"]), (HERE / "kernels.o").read_bytes())
