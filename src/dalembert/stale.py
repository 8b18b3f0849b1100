"""Compiled functions on disk that were made from other sources, and their removal.

Numba looks only at the file of a function itself, not at those of the functions that it calls, so that an edited
function would live on inside its callers.
"""

import hashlib
import json
import re
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from dalembert.files import write_text


def forget_stale(package: Path, decorators: Path) -> None:
    """Remove what was compiled from a file that has changed since, or that imports one that has, however far down.

    Parameters
    ----------
    package : Path
        Folder of a package of dalembert's.
    decorators : Path
        The module of the package that says how its functions are compiled; those that import it hold some.
    """
    stamp = decorators.parent / "__pycache__" / "sources.json"
    digests = _digests(package, decorators)
    with suppress(OSError):  # a folder that cannot be written holds no cache either
        known = _read(stamp)
        if known == digests:
            return
        for name, digest in digests.items():
            if known.get(name) != digest:
                folder, _, stem = name.rpartition("/")
                for cached in (package / folder / "__pycache__").glob(f"{stem}.*.nb[ci]"):
                    cached.unlink(missing_ok=True)
        stamp.parent.mkdir(exist_ok=True)
        write_text(stamp, json.dumps(digests))


def _digests(package: Path, decorators: Path) -> dict[str, str]:
    """Hash of each file with compiled functions and of all such files that it imports, by ``folder/stem``."""
    texts = {_name(path, package): path.read_text(encoding="utf-8") for path in sorted(package.glob("**/*.py"))}
    all_imports = {name: _imports(text, package.name) for name, text in texts.items()}
    own = _name(decorators, package)
    imports = {name: found for name, found in all_imports.items() if own in found or name == own}
    return {name: _digest(texts[other] for other in sorted(_reached(name, imports))) for name in imports}


def _name(path: Path, package: Path) -> str:
    return path.relative_to(package).with_suffix("").as_posix()


def _imports(text: str, package: str) -> set[str]:
    """Modules of a package that a text may import, as ``folder/stem``."""
    found = set()
    statement = rf"^from dalembert\.{package}\.([\w.]+) import (\([^)]*\)|.*)"
    for module, names in re.findall(statement, text, re.MULTILINE):
        place = module.replace(".", "/")
        found |= {place, *(f"{place}/{name}" for name in re.findall(r"\w+", names))}
    return found


def _reached(name: str, imports: dict[str, set[str]]) -> set[str]:
    reached: set[str] = set()
    ahead = {name}
    while ahead:
        reached |= ahead
        ahead = {other for one in ahead for other in imports[one] if other in imports} - reached
    return reached


def _digest(texts: Iterable[str]) -> str:
    return hashlib.sha256("".join(texts).encode()).hexdigest()


def _read(stamp: Path) -> dict[str, str]:
    try:
        return json.loads(stamp.read_text())
    except (FileNotFoundError, ValueError):  # never written, or not whole
        return {}
