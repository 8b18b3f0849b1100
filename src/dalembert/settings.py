"""Settings of methods, checked: what a number must be, said in the same words everywhere."""

from collections.abc import Callable
from typing import Any

from dalembert.errors import InputError


def expect(settings: object, expected: str, holds: Callable[[Any], bool], *names: str) -> None:
    """Refuse settings, attributes of an object by their names, for which ``holds`` is not true.

    Raises
    ------
    InputError

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> expect(SimpleNamespace(share=2.0), "a number between 0 and 1", lambda given: 0 < given < 1, "share")
    Traceback (most recent call last):
    dalembert.errors.InputError: SimpleNamespace: share is 2.0; expected a number between 0 and 1
    """
    for name in names:
        given = getattr(settings, name)
        if not holds(given):
            raise InputError(f"{type(settings).__name__}: {name} is {given}; expected {expected}")


def expect_at_least(settings: object, least: int, *names: str) -> None:
    """Refuse counts below the least."""
    expect(settings, f"at least {least}", lambda given: given >= least, *names)


def expect_positive(settings: object, *names: str) -> None:
    """Refuse numbers that are not positive."""
    expect(settings, "a positive number", lambda given: given > 0, *names)
