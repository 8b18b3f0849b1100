"""Errors whose messages state what is wrong, where, what was expected and what to do."""

import sysconfig
import traceback
from collections import Counter
from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from pathlib import Path

_PACKAGE = str(Path(__file__).parent)
_LONGEST = 60  # text of a value in a sentence
_ROOM = "see that the disk has room and that the folder may be written to"
_BEGUN = f"; what was written before is whole: {_ROOM}, and continue the run by 'dalembert resume'"
_NOT_BEGUN = f"; nothing has run yet: {_ROOM}, and run the study again"
_UNCHANGED = f"; what was there before is unchanged: {_ROOM}, and try again"


class DalembertError(Exception):
    """Base of every error that the package raises on purpose."""


class InputError(DalembertError):
    """An argument, option or study file is invalid."""


class ModelError(DalembertError):
    """A mechanism that is not well posed: it cannot be assembled, or its constraints are redundant."""


class SolveError(DalembertError):
    """A solver failed; the message names the time and the component."""


class ClusterError(SolveError):
    """A cluster that lost what it was asked for, so that there is no answer; no simulation failed."""


class DataError(DalembertError):
    """Measured data with a defect: a NaN, a missing column, a time that goes backwards."""


class StorageError(DalembertError):
    """A file of a run that could not be written: no room, or no right to."""


def unwritable(path: object, reason: object) -> StorageError:
    """Error about a file of a run that could not be written, from what the system says."""
    return StorageError(f"{path} cannot be written: {reason}{_BEGUN}")


def not_begun(error: StorageError) -> StorageError:
    """The same error of a run that has no state yet and cannot be resumed."""
    return StorageError(str(error).replace(_BEGUN, _NOT_BEGUN))


def unchanged(error: Exception) -> str:
    """Sentence of an error about a file that is replaced as a whole or not at all, outside a run."""
    if isinstance(error, OSError):
        return f"{error.filename or 'A file'} cannot be written or read: {error.strerror or error}{_UNCHANGED}"
    return str(error).replace(_BEGUN, _UNCHANGED)


_MOST_SHOWN, _FEW_SHOWN = 60, 12  # names in a sentence: all of them, or the first ones of many


def unknown(what: str, name: object, known: Iterable[str], where: str = "") -> str:
    """Sentence for an unknown name, with the closest known ones. Of names with parts those of the same kind come first,
    as the last part says it.

    >>> unknown("channel", "bar.tip.x", ["bar.end.x", "bar.end.vx", "pin.tip.y", "bar.top.y"])
    "unknown channel 'bar.tip.x'; did you mean 'bar.end.x' or 'bar.top.y'?"
    """
    names = sorted(known)
    close = _closest(str(name), names)
    prefix = f"{where}: " if where else ""
    if close:
        return f"{prefix}unknown {what} {name!r}; did you mean {' or '.join(map(repr, close))}?"
    shown = names if len(names) <= _MOST_SHOWN else [*names[:_FEW_SHOWN], f"and {len(names) - _FEW_SHOWN} more"]
    return f"{prefix}unknown {what} {name!r}; known: {', '.join(shown) or 'none'}"


def require_known(what: str, name: object, known: Iterable[str], where: str = "") -> None:
    """Refuse a name that is not among the known ones, see :func:`unknown`."""
    if name not in (names := list(known)):
        raise InputError(unknown(what, name, names, where))


def _closest(wrong: str, names: list[str]) -> list[str]:
    """Up to two close names; those that end in the part that the given one ends in, or is meant to, come first."""
    close = get_close_matches(wrong, names, n=len(names) or 1, cutoff=0.6)
    kinds = sorted({name.rpartition(".")[2] for name in names if "." in name})
    kind = get_close_matches(wrong.rpartition(".")[2], kinds, n=1, cutoff=0.6) if "." in wrong else []
    return sorted(close, key=lambda name: name.rpartition(".")[2] not in kind)[:2]


def repeated(names: Iterable[str]) -> dict[str, int]:
    """Names that are given more than once, in alphabetical order, with their counts."""
    return {name: count for name, count in sorted(Counter(names).items()) if count > 1}


def no_text(path: object, error: UnicodeDecodeError) -> str:
    """Sentence for a file that is not UTF-8 text, with the line where that shows."""
    line = error.object[: error.start].count(b"\n") + 1
    return f"{path}, line {line}: the file is not UTF-8 text; save it as UTF-8"


def listed(words: Sequence[str]) -> str:
    """Words in a row, ``a, b and c``; ``""`` if there are none.

    >>> listed(["a", "b", "c"]), listed(["a"]), listed([])
    ('a, b and c', 'a', '')
    """
    return " and ".join(filter(None, [", ".join(words[:-1]), *words[-1:]]))


def counted(number: int, what: str) -> str:
    """A number of things, as ``1 value`` or ``3 values``."""
    return f"{number} {what}" + ("" if number == 1 else "s")


def shown(value: object) -> str:
    """A value as a sentence can hold it: in one line, and not long."""
    text = " ".join(repr(value).split())
    if text.startswith("<") or (len(text) > _LONGEST and not isinstance(value, str | list | tuple | dict)):
        kind = type(value).__name__
        return f"the class {value.__name__}" if isinstance(value, type) else f"a{'n' * (kind[0] in 'AEIO')} {kind}"
    return text if len(text) <= _LONGEST else f"{text[:30].rstrip()} ..."


def told(error: BaseException) -> str:
    """Message of an error in one line; an error of another package has its type and place in the user's code before."""
    if isinstance(error, DalembertError):
        return str(error)
    if isinstance(error, SyntaxError):
        return f"SyntaxError: {error.msg} ({Path(error.filename or '').name}, line {error.lineno})"
    place = users_place(error)
    text = " ".join(str(error).split())
    return f"{type(error).__name__}{f': {text}' if text else ''}{f' ({place})' if place else ''}"


def users_place(error: BaseException | None) -> str:
    """File and line of the user's own code that an error went through last; none if it met only libraries and ours."""
    foreign = ("<", _PACKAGE, *sysconfig.get_paths().values())
    frames = traceback.walk_tb(error.__traceback__ if error else None)
    places = [(frame.f_code.co_filename, line) for frame, line in frames]
    of_user = [(Path(name).name, line) for name, line in places if not name.startswith(foreign)]
    return "{}, line {}".format(*of_user[-1]) if of_user else ""
