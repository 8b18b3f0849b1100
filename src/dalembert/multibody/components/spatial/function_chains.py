"""Functions of kernels one after the other: compiled code has no loop over functions, so each calls the rest."""

from collections.abc import Callable
from typing import Any

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.spatial.vectors import plus


def in_turn(functions: list[Callable[..., Any]]) -> Callable[..., Any]:
    """A function that calls all of them with its arguments."""
    first, *following = functions
    if not following:
        return first
    rest = in_turn(following)

    @inlined
    def both(*arguments):
        first(*arguments)
        rest(*arguments)

    return both


def summed(functions: list[Callable[..., Any]]) -> Callable[..., Any]:
    """A function that adds the three numbers that each of them returns."""
    first, *following = functions
    if not following:
        return first
    rest = summed(following)

    @inlined
    def both(*arguments):
        return plus(first(*arguments), rest(*arguments))

    return both
