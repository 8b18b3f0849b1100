"""Compiled functions on disk that were made from other sources, and their removal.

Numba looks only at the file of a function itself, not at those of the functions that it calls, so that an edited kernel
would live on inside its callers.
"""

import hashlib
import json
import re
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from dalembert.files import write_text

_MULTIBODY = Path(__file__).parent.parent
_MARK = re.compile(r"^from dalembert\.multibody\.kernels\.compiled import", re.MULTILINE)
_IMPORT = re.compile(r"^from dalembert\.multibody\.([\w.]+) import \(?([\w\s,]+)", re.MULTILINE)


def forget_stale() -> None:
    """Remove what was compiled from a file that has changed since, or that imports one that has, however far down."""
    stamp = _MULTIBODY / "kernels" / "__pycache__" / "sources.json"
    digests = _digests()
    with suppress(OSError):  # a folder that cannot be written holds no cache either
        known = _read(stamp)
        if known == digests:
            return
        for name, digest in digests.items():
            if known.get(name) != digest:
                folder, _, stem = name.rpartition("/")
                for cached in (_MULTIBODY / folder / "__pycache__").glob(f"{stem}.*.nb[ci]"):
                    cached.unlink(missing_ok=True)
        stamp.parent.mkdir(exist_ok=True)
        write_text(stamp, json.dumps(digests))


def _digests() -> dict[str, str]:
    """Hash of each file with compiled functions and of all such files that it imports, by ``folder/stem``."""
    paths = sorted(_MULTIBODY.glob("**/*.py"))
    texts = {
        path.relative_to(_MULTIBODY).with_suffix("").as_posix(): path.read_text(encoding="utf-8") for path in paths
    }
    texts = {name: text for name, text in texts.items() if _MARK.search(text) or name == "kernels/compiled"}
    imports = {name: _imports(text) for name, text in texts.items()}
    return {name: _digest(texts[other] for other in sorted(_reached(name, imports))) for name in texts}


def _imports(text: str) -> set[str]:
    """Modules that a text may import, as ``folder/stem``."""
    found = set()
    for module, names in _IMPORT.findall(text):
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
