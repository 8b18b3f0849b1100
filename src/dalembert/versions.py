"""Versions of all that the last digits of a result depend on."""

import hashlib
from collections.abc import Mapping
from functools import cache
from importlib.metadata import version
from pathlib import Path

import dalembert

PACKAGES = ("numpy", "scipy", "numba", "llvmlite")
"""Packages whose versions may change the last digits of a result."""
_DRAWING = ("report", "export", "studio", "widget", "cli.py")
"""Parts of this package that compute no result."""


@cache
def versions() -> dict[str, str]:
    """Return the version of this package, the digest of its source files that compute results, and those of packages.

    Two copies of one version may have different source files, for example those of a checkout.
    """
    root = Path(__file__).parent
    digest = hashlib.sha256()
    for path in sorted(root.rglob("*.py")):
        if path.relative_to(root).parts[0] not in _DRAWING:
            digest.update(path.read_bytes())
    package = {"dalembert": dalembert.__version__, "sources": digest.hexdigest()[:12]}
    return package | {name: version(name) for name in PACKAGES}


def difference(other: Mapping[str, str], expected: Mapping[str, str]) -> str:
    """Return how a copy of dalembert differs from the expected one, in a phrase; an empty text if it does not.
    >>> difference({"dalembert": "0.1.0", "sources": "a7"}, {"dalembert": "0.1.0", "sources": "0c"})
    'dalembert 0.1.0 with other source files (digest a7, not 0c)'
    """
    if other["dalembert"] != expected["dalembert"]:
        return f"dalembert {other['dalembert']}, not {expected['dalembert']}"
    if other["sources"] != expected["sources"]:
        both = f"{other['sources']}, not {expected['sources']}"
        return f"dalembert {other['dalembert']} with other source files (digest {both})"
    return ""
