"""Jacobians of functions with many parameters by few complex steps, where each number depends on few parameters.

Columns that share no row are moved together (Curtis, Powell and Reid 1974), so the price is that of as many steps as a
number has parameters. Which parameters a number depends on is found by moving groups, every second or fourth parameter
and random ones: where one parameter of a group moves a number, two steps with different weights show which one.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array, csr_array

# Derivative of all numbers (numbers,) along a direction (parameters,), exact.
Along = Callable[[np.ndarray], np.ndarray]
FEW = 6  # parameters up to which each is moved alone
_STRIDES = 1, 2, 4  # of the first groups: neighbours, as coefficients of a spline, often move the same number
_RANDOM = 40  # random groups after these, while they cost less than all parameters; then the Jacobian is dense
_ROUNDING = 1e-13  # of a derivative along a direction, relative to its terms
_EXACT = 1e-12  # relative agreement of two derivatives, of which one tells the parameter and the other confirms it
_TERMS = 1e-14  # of the known terms, which the rest of a derivative may be in error by


@dataclass(frozen=True, eq=False)
class Pattern:
    """Which numbers depend on which parameters."""

    groups: tuple[np.ndarray, ...]  # parameters that are moved together: no number depends on two of them
    owners: tuple[np.ndarray, ...]  # for each group the parameter that a number depends on, -1 if none


def singly(count: int, numbers: int) -> Pattern:
    """Return the pattern that moves each of ``count`` parameters alone."""
    return Pattern(tuple(np.array([k]) for k in range(count)), tuple(np.full(numbers, k) for k in range(count)))


def sparse_jacobian(along: Along, count: int, pattern: Pattern | None = None) -> tuple[csc_array, Pattern]:
    """Return the Jacobian (numbers, parameters) of a function, and the pattern for the next point. ``along``:
    derivative of the numbers along a direction; ``count``: number of parameters; ``pattern``: of an earlier point; it
    is confirmed by one more step, and sought anew where it no longer holds.
    """
    probe = np.random.default_rng(0).uniform(1.0, 2.0, count)
    if count <= FEW:
        columns = [along(unit) for unit in np.eye(count)]
        return csc_array(np.column_stack(columns)), singly(count, len(columns[0]))
    answer = along(probe)
    if pattern is not None:
        jacobian = _coloured(along, count, pattern)
        if _agrees(jacobian, probe, answer):
            return jacobian, pattern
    pattern = _pattern(along, count, probe, answer)
    jacobian = _coloured(along, count, pattern)
    if not _agrees(jacobian, probe, answer):
        pattern = singly(count, len(answer))
        jacobian = _coloured(along, count, pattern)
    return jacobian, pattern


def _coloured(along: Along, count: int, pattern: Pattern) -> csc_array:
    """The Jacobian by one step a group."""
    rows, columns, values = [], [], []
    for group, owners in zip(pattern.groups, pattern.owners, strict=True):
        direction = np.zeros(count)
        direction[group] = 1.0
        slopes = along(direction)
        rows_of_group = np.flatnonzero((slopes != 0) & (owners >= 0))
        rows.append(rows_of_group)
        columns.append(owners[rows_of_group])
        values.append(slopes[rows_of_group])
    places = np.concatenate(rows), np.concatenate(columns)
    return csc_array((np.concatenate(values), places), shape=(len(pattern.owners[0]), count))


def _agrees(matrix: csc_array | csr_array, direction: np.ndarray, slopes: np.ndarray) -> bool:
    return not np.any(_rest(matrix, direction, slopes)[1])


def _rest(matrix: csc_array | csr_array, direction: np.ndarray, slopes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What a matrix leaves of the derivative along a direction, and where that is more than rounding."""
    rest = slopes - matrix @ direction
    return rest, np.abs(rest) > _ROUNDING * (abs(matrix) @ np.abs(direction))


def _pattern(along: Along, count: int, probe: np.ndarray, answer: np.ndarray) -> Pattern:
    """The pattern by random groups; that of single parameters where numbers depend on many of them."""
    random, numbers = np.random.default_rng(1), len(answer)
    known = csr_array((numbers, count))
    for chosen in _choices(count, random):
        _, open_ = _rest(known, probe, answer)
        if not open_.any():
            return _grouped(csc_array(known), count, numbers)
        weights = np.array([np.ones(count), np.arange(1.0, count + 1), random.uniform(1.0, 2.0, count)]) * chosen
        (first, single), (second, _), (third, _) = (_rest(known, weight, along(weight)) for weight in weights)
        single &= open_
        with np.errstate(divide="ignore", invalid="ignore"):
            place = np.rint(np.where(single, second / first, 1.0)).clip(1, count).astype(int) - 1
        for number, rest in ((1, second), (2, third)):
            error = _EXACT * np.abs(rest) + _TERMS * (abs(known) @ weights[number])
            single &= np.abs(rest - weights[number, place] * first) <= error
        rows = np.flatnonzero(single & chosen[place])
        known = known + csr_array((first[rows], (rows, place[rows])), shape=(numbers, count))
    return singly(count, numbers)


def _choices(count: int, random: np.random.Generator) -> Iterator[np.ndarray]:
    """Groups of parameters to move together, as masks (parameters,)."""
    places = np.arange(count)
    for stride in _STRIDES:
        yield from (places % stride == offset for offset in range(stride))
    for number in range(min(_RANDOM, count // 3)):
        yield random.random(count) < (0.5, 0.25)[number % 2]


def _grouped(known: csc_array, count: int, numbers: int) -> Pattern:
    """Groups of parameters without a common number, each parameter in the first that takes it."""
    owners: list[np.ndarray] = []
    groups: list[list[int]] = []
    for column in range(count):
        rows = known.indices[known.indptr[column] : known.indptr[column + 1]]
        place = next((k for k, owner in enumerate(owners) if np.all(owner[rows] < 0)), len(owners))
        if place == len(owners):
            owners.append(np.full(numbers, -1))
            groups.append([])
        owners[place][rows] = column
        groups[place].append(column)
    return Pattern(tuple(np.array(group) for group in groups), tuple(owners))
