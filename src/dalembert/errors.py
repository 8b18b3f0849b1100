"""Errors that tell a user what is wrong, where, what was given, what is expected and what to do."""

from collections.abc import Iterable
from difflib import get_close_matches


class DalembertError(Exception):
    """Base of every error that the package raises on purpose."""


class InputError(DalembertError):
    """An argument, an option or a study file says something that cannot be meant."""


class ModelError(DalembertError):
    """A mechanism that is not well posed: it cannot be assembled, or its constraints are redundant."""


class SolveError(DalembertError):
    """A solver that could not go on; the message names the time and the component."""


class DataError(DalembertError):
    """Measured data with a defect: a NaN, a missing column, a time that goes backwards."""


def unknown(what: str, given: str, known: Iterable[str], where: str = "") -> str:
    """Sentence for an unknown name, with the closest known ones.

    >>> unknown("channel", "AB.end.z", ["AB.end.x", "AB.end.y", "OA.end.x"])
    "unknown channel 'AB.end.z'; did you mean 'AB.end.y' or 'AB.end.x'?"
    """
    names = sorted(known)
    close = get_close_matches(given, names, n=2, cutoff=0.6)
    prefix = f"{where}: " if where else ""
    if close:
        return f"{prefix}unknown {what} {given!r}; did you mean {' or '.join(map(repr, close))}?"
    return f"{prefix}unknown {what} {given!r}; known: {', '.join(names) or 'none'}"
