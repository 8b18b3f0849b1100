"""Conditions between two markers, of which joints consist, with their constraint forces J^T lambda.

A joint is a row of conditions, as in the tables of textbooks: a revolute joint about e3 is ``meets``,
``perpendicular(1, 3)`` and ``perpendicular(2, 3)``.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.spatial.spatial_pairs import E, F, push_a_axis, push_b_axis, push_pair, separation
from dalembert.multibody.components.spatial.vectors import at, dot, times

Function = Callable[..., Any]


class Condition(NamedTuple):
    """One condition or several.

    ``count``: rows; ``residual`` (x, p, m, row, g): fills ``g[row:row + count]``, which are zero where the condition
    holds; ``forces`` (x, p, m, k, r): adds the forces of the multipliers ``x[k:k + count]``.
    """

    count: int
    residual: Function
    forces: Function


@inlined
def _meets(x, p, m, row, g):
    g[row], g[row + 1], g[row + 2] = separation(x, p, m)


@inlined
def _meets_forces(x, p, m, k, r):
    push_pair(p, m, at(x, k), r)


#: Both points coincide: Delta = 0.
MEETS = Condition(3, _meets, _meets_forces)


def perpendicular(i: int, j: int) -> Condition:
    """Axis i of a is perpendicular to axis j of b: e_i . f_j = 0."""
    e, f, push_e, push_f = E[i - 1], F[j - 1], push_a_axis(i), push_b_axis(j)

    @inlined
    def residual(x, p, m, row, g):
        g[row] = dot(e(x, p, m), f(x, p, m))

    @inlined
    def forces(x, p, m, k, r):
        push_e(p, m, times(x[k], f(x, p, m)), r)
        push_f(p, m, times(x[k], e(x, p, m)), r)

    return Condition(1, residual, forces)


def level(i: int) -> Condition:
    """The points keep their height along axis i of a: e_i . Delta = 0."""
    e, push_e = E[i - 1], push_a_axis(i)

    @inlined
    def residual(x, p, m, row, g):
        g[row] = dot(e(x, p, m), separation(x, p, m))

    @inlined
    def forces(x, p, m, k, r):
        push_e(p, m, times(x[k], separation(x, p, m)), r)
        push_pair(p, m, times(x[k], e(x, p, m)), r)

    return Condition(1, residual, forces)


def constraint_of(conditions: tuple[Condition, ...]) -> Function:
    """The function (x, p, m, inputs, g) of a kind that has these conditions."""
    fill: Any = _in_turn([(entry.residual, row) for entry, row in zip(conditions, _rows(conditions, 0), strict=True)])

    @inlined
    def constraint(x, p, m, inputs, g):
        fill(x, p, m, g)

    return constraint


def forces_of(conditions: tuple[Condition, ...], coordinates: int) -> Function:
    """The function (x, p, m, r) of a kind that has these conditions and this number of coordinates."""
    return _in_turn([(entry.forces, k) for entry, k in zip(conditions, _rows(conditions, coordinates), strict=True)])


def _rows(conditions: tuple[Condition, ...], first: int) -> list[int]:
    """Where each condition begins."""
    return [first + sum(entry.count for entry in conditions[:k]) for k in range(len(conditions))]


def _in_turn(calls: list[tuple[Function, int]]) -> Function:
    """A function (x, p, m, out) that calls functions (x, p, m, number, out) one after the other."""
    (function, number), *others = calls
    first: Any = function

    @inlined
    def last(x, p, m, out):
        first(x, p, m, number, out)

    if not others:
        return last
    rest: Any = _in_turn(others)

    @inlined
    def chain(x, p, m, out):
        first(x, p, m, number, out)
        rest(x, p, m, out)

    return chain
