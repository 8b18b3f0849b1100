"""Mass, damping and stiffness of a motion, kept apart, and the linear systems that implicit methods make of them."""

from typing import NamedTuple

import numpy as np

from dalembert.multibody.integrators.lifting import set_signals
from dalembert.multibody.kernels import beam, cable
from dalembert.multibody.kernels.assembly import tangent
from dalembert.multibody.kernels.compiled import compiled, inlined, kernel
from dalembert.multibody.kernels.linear import BAND, DENSE, Factors, Layout, factorise, padded, solve, storage
from dalembert.multibody.kernels.model import Slots
from dalembert.multibody.kernels.motion import clear
from dalembert.multibody.lowering import Lowered
from dalembert.multibody.structure import Structure


class Pattern(NamedTuple):
    """Where the entries of the matrix of motion stand: in a list, in a real system and in a complex one.

    The complex system A + iB stands as the real one [A, -B; B, A], whose blocks' places are ``double`` (4, entries).
    """

    slots: Slots
    rows: np.ndarray
    columns: np.ndarray
    single: np.ndarray
    layout: Layout
    double: np.ndarray
    double_layout: Layout


class Matrices(NamedTuple):
    """Values of the entries, and factorised systems.

    ``mass``, ``damping`` and ``stiffness`` are the derivatives of the equations of motion by accelerations, velocities
    and coordinates; with the stiffness stand those of the constraints and by the multipliers. ``rigid`` is factorised
    [M, J^T; J, 0], ``real`` and ``doubles`` are [M + C/s + K/s^2, J^T; J, 0] for a real s and for complex ones (their
    arrays have one more leading axis).
    ``heavy`` are the numbers of the entries that have a mass, as many as its last entry says.
    """

    heavy: np.ndarray
    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    rigid: Factors
    real: Factors
    doubles: Factors


def pattern_of(structure: Structure) -> Pattern:
    """Pattern of a structure; bands where matrices that are factorised often are kept as bands."""
    slots, rows, columns = structure.entries
    _, layout = structure.fresh
    size = structure.size
    if layout.kind == DENSE:
        lead = padded(2 * size)
        single = columns * layout.lead + rows
        double = np.array([(columns + j) * lead + rows + i for i, j in ((0, 0), (0, size), (size, 0), (size, size))])
        return Pattern(
            slots, rows, columns, single, layout, double, Layout(DENSE, 2 * size, 0, lead, np.zeros(0, dtype=np.int64))
        )
    i, j = layout.order[rows], layout.order[columns]
    single = j * layout.lead + 2 * layout.reach + i - j
    reach = padded(2 * int(np.max(np.abs(i - j))) + 1)
    lead = 3 * reach + 2
    double = np.array([(2 * j + b) * lead + 2 * reach + 2 * i + a - 2 * j - b for a in (0, 1) for b in (0, 1)])
    order = np.concatenate([2 * layout.order, 2 * layout.order + 1])
    return Pattern(slots, rows, columns, single, layout, double, Layout(BAND, 2 * size, reach, lead, order))


def damps(lowered: Lowered) -> bool:
    """Whether a force of the model may depend on velocities."""
    index, data = lowered.structure.index, lowered.data
    touched = any(len(index[kind]) for kind in ("frictions", "springs", "users"))
    return touched or bool(np.any(data["beams"][:, beam.DAMPING]) or np.any(data["cables"][:, cable.DAMPING]))


@compiled
def room(pattern, pairs):
    """Room for the matrices of a motion, with as many complex systems as ``pairs``."""
    entries, layout = len(pattern.rows), pattern.double_layout
    doubles = Factors(
        np.zeros((pairs, layout.lead * layout.size)), np.zeros((pairs, layout.size), np.int64),
        np.zeros((pairs, layout.size), np.int64), np.zeros((pairs, layout.size + 3 * layout.reach)),
    )  # fmt: skip
    return Matrices(
        np.zeros(entries + 1, np.int64), np.zeros(entries), np.zeros(entries), np.zeros(entries),
        storage(pattern.layout), storage(pattern.layout), doubles,
    )  # fmt: skip


@kernel
def weigh_masses(pattern, matrices, dual, n, state, dual_work):
    """Evaluate the masses, which do not change in a motion; the signals in ``dual_work`` hold the time."""
    tangent(dual, pattern.slots, n, state.x, state.v, state.a, (0.0, 0.0, 1.0), (1.0, 0.0), dual_work, matrices.mass)
    count = 0
    for e in range(len(matrices.mass)):
        if matrices.mass[e] != 0.0 and pattern.rows[e] < n and pattern.columns[e] < n:
            matrices.heavy[count] = e
            count += 1
    matrices.heavy[len(matrices.mass)] = count


@kernel
def renew(problem, pattern, matrices, dual, damped, t, within, state, dual_work):
    """Evaluate stiffness (and damping, if ``damped``), and factorise [M, J^T; J, 0]; whether it is regular."""
    n = problem.n
    set_signals(dual, t, within, dual_work)
    x, v, a = state.x, state.v, state.a
    tangent(dual, pattern.slots, n, x, v, a, (1.0, 0.0, 0.0), (1.0, 1.0), dual_work, matrices.stiffness)
    if damped:
        tangent(dual, pattern.slots, n, x, v, a, (0.0, 1.0, 0.0), (1.0, 0.0), dual_work, matrices.damping)
    matrix = matrices.rigid.matrix
    clear(matrix)
    for e in range(len(pattern.rows)):
        inner = pattern.rows[e] < n and pattern.columns[e] < n
        matrix[pattern.single[e]] = matrices.mass[e] if inner else matrices.stiffness[e]
    return factorise(pattern.layout, matrices.rigid)


@kernel
def factorise_real(n, pattern, matrices, s):
    """Factorise [M + C/s + K/s^2, J^T; J, 0] for a real s; whether it is regular."""
    first, second = 1.0 / s, 1.0 / (s * s)
    matrix = matrices.real.matrix
    clear(matrix)
    for e in range(len(pattern.rows)):
        value = matrices.stiffness[e]
        if pattern.rows[e] < n and pattern.columns[e] < n:
            value = matrices.mass[e] + first * matrices.damping[e] + second * value
        matrix[pattern.single[e]] = value
    return factorise(pattern.layout, matrices.real)


@inlined
def _double(matrices, p):
    """Complex system ``p``."""
    stack = matrices.doubles
    return Factors(stack.matrix[p], stack.pivots[p], stack.tops[p], stack.buffer[p])


@kernel
def factorise_complex(n, pattern, matrices, p, s):
    """Factorise [M + C/s + K/s^2, J^T; J, 0] for a complex s as system ``p``; whether it is regular."""
    first, second = 1.0 / s, 1.0 / (s * s)
    factors, double = _double(matrices, p), pattern.double
    matrix = factors.matrix
    clear(matrix)
    for e in range(len(pattern.rows)):
        value, turned = matrices.stiffness[e], 0.0
        if pattern.rows[e] < n and pattern.columns[e] < n:
            turned = first.imag * matrices.damping[e] + second.imag * value
            value = matrices.mass[e] + first.real * matrices.damping[e] + second.real * value
        matrix[double[0, e]] = value
        matrix[double[1, e]] = -turned
        matrix[double[2, e]] = turned
        matrix[double[3, e]] = value
    return factorise(pattern.double_layout, factors)


@kernel
def solve_complex(pattern, matrices, p, given, answer):
    """Solve with the complex system ``p``: real parts, then imaginary ones."""
    solve(pattern.double_layout, _double(matrices, p), given, answer)


@kernel
def add_inertia(pattern, matrices, vector, target):
    """target += M vector."""
    heavy = matrices.heavy
    for number in range(heavy[len(heavy) - 1]):
        e = heavy[number]
        target[pattern.rows[e]] += matrices.mass[e] * vector[pattern.columns[e]]


@kernel
def add_product(n, pattern, values, vector, factor, target):
    """target += factor A vector, for the entries ``values`` of A between coordinates."""
    for e in range(len(pattern.rows)):
        i, j = pattern.rows[e], pattern.columns[e]
        if i < n and j < n:
            target[i] += factor * values[e] * vector[j]
