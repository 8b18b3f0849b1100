"""Mass, damping and stiffness of a motion, kept apart, and the linear systems that implicit methods make of them."""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inlined, inner, kernel
from dalembert.kernels.lanes import WIDTH
from dalembert.kernels.words import Address, Integers, Integers2, Reals, Reals2
from dalembert.multibody.integrators.shared.problem import IntegrationProblem
from dalembert.multibody.kernels.assembly import set_signals, tangent
from dalembert.multibody.kernels.linear import (
    DENSE,
    Factors,
    Layout,
    band_layout,
    dense_layout,
    factorise,
    padded,
    storage,
)
from dalembert.multibody.kernels.linear_lanes import solve_slopes
from dalembert.multibody.kernels.records import call_at, model_at
from dalembert.multibody.kernels.states import MotionState, clear
from dalembert.multibody.model.structure import Structure


class Pattern(NamedTuple):
    """Where the entries of the matrix of motion stand: in a list, in a real system and in a complex one. The complex
    system A + iB stands as the real one [A, -B; B, A], whose blocks' places are ``double`` (4, entries). ``varies``
    says whether masses may change with the coordinates.
    """

    slots: Integers
    rows: Integers
    columns: Integers
    single: Integers
    layout: Layout
    double: Integers2
    double_layout: Layout
    varies: bool


class Doubles(NamedTuple):
    """Factorised complex systems: the arrays of `Factors` with one more leading axis."""

    matrix: Reals2
    pivots: Integers2
    tops: Integers2
    buffer: Reals2


class Matrices(NamedTuple):
    """Values of the entries of a pattern, and factorised systems. ``mass``, ``damping`` and ``stiffness`` are the
    derivatives of the equations of motion by accelerations, velocities and coordinates; with the stiffness stand those
    of the constraints and by the multipliers. ``rigid`` is factorised [M, J^T; J, 0], ``real`` and ``doubles`` are
    [M + C/s + K/s^2, J^T; J, 0] for a real s and for complex ones. ``heavy`` are the numbers of the entries that have a
    mass, as many as its last entry says.
    """

    pattern: Pattern
    heavy: Integers
    mass: Reals
    damping: Reals
    stiffness: Reals
    rigid: Factors
    real: Factors
    doubles: Doubles


def pattern_of(structure: Structure) -> Pattern:
    """Pattern of a structure; bands where matrices that are factorised often are kept as bands."""
    slots, rows, columns = structure.full.entries
    _, layout = structure.full.fresh
    size, varies = structure.size, any(kind.varying_mass for kind in structure.index)
    if layout.kind == DENSE:
        wide = dense_layout(2 * size)
        single = columns * layout.lead + rows
        corners = ((0, 0), (0, size), (size, 0), (size, size))
        double = np.array([(columns + j) * wide.lead + rows + i for i, j in corners])
        return Pattern(slots, rows, columns, single, layout, double, wide, varies)
    i, j = layout.order[rows], layout.order[columns]
    single = j * layout.lead + 2 * layout.reach + i - j
    reach = padded(2 * int(np.max(np.abs(i - j))) + 1)
    wide = band_layout(np.concatenate([2 * layout.order, 2 * layout.order + 1]), reach)
    parts = ((a, b) for a in (0, 1) for b in (0, 1))
    double = np.array([(2 * j + b) * wide.lead + 2 * reach + 2 * i + a - 2 * j - b for a, b in parts])
    return Pattern(slots, rows, columns, single, layout, double, wide, varies)


def scratch(pattern: Pattern, pairs: int) -> Matrices:
    """Workspace for the matrices of a motion, with as many complex systems as ``pairs``."""
    entries, layout = len(pattern.rows), pattern.double_layout
    room = layout.size + 3 * layout.reach
    doubles = Doubles(
        np.zeros((pairs, layout.lead * layout.size)), np.zeros((pairs, layout.size), np.int64),
        np.zeros((pairs, layout.size), np.int64), np.zeros((pairs, WIDTH * room)),
    )  # fmt: skip
    return Matrices(
        pattern, np.zeros(entries + 1, np.int64), np.zeros(entries), np.zeros(entries), np.zeros(entries),
        storage(pattern.layout), storage(pattern.layout), doubles,
    )  # fmt: skip


@kernel
def weigh_masses(matrices: Matrices, tangent_model: Address, n: int, state: MotionState, complex_work: Address) -> None:
    """Evaluate the masses; the signals in ``complex_work`` hold the time."""
    tangent(
        tangent_model, matrices.pattern.slots, n, state.x, state.v, state.a, (0.0, 0.0, 1.0), (1.0, 0.0), complex_work,
        matrices.mass,
    )  # fmt: skip
    count = 0
    for e in range(len(matrices.mass)):
        if matrices.mass[e] != 0.0 and matrices.pattern.rows[e] < n and matrices.pattern.columns[e] < n:
            matrices.heavy[count] = e
            count += 1
    matrices.heavy[len(matrices.mass)] = count


@kernel
def renew(
    problem: IntegrationProblem, matrices: Matrices, tangent_model: Address, damped: bool, t: float, within: float,
    state: MotionState, complex_work: Address,
) -> bool:  # fmt: skip
    """Evaluate stiffness (and damping, if ``damped``), and factorise [M, J^T; J, 0]; whether it is regular.

    In a call with the length of a step they are those of the mean forces of the step, whose middle is the state.
    """
    n = problem.n
    set_signals(tangent_model, t, within, complex_work)
    if matrices.pattern.varies:
        weigh_masses(matrices, tangent_model, n, state, complex_work)
    x, v, a, slots = state.x, state.v, state.a, matrices.pattern.slots
    forces = tangent_model if call_at(complex_work).step == 0.0 else model_at(tangent_model).middle
    # K with J^T and J: the rows of constraints come with the coordinates, J^T with the multipliers.
    tangent(forces, slots, n, x, v, a, (1.0, 0.0, 0.0), (1.0, 1.0), complex_work, matrices.stiffness)
    if damped:
        tangent(forces, slots, n, x, v, a, (0.0, 1.0, 0.0), (1.0, 0.0), complex_work, matrices.damping)
    return _factorise(n, matrices, 0.0, 0.0, matrices.rigid)


@inner
def factorise_real(n, matrices, s):
    """Factorise [M + C/s + K/s^2, J^T; J, 0] for a real s; whether it is regular."""
    return _factorise(n, matrices, 1.0 / s, 1.0 / (s * s), matrices.real)


@inner
def _factorise(n, matrices, first, second, factors):
    """Factorise [M + first C + second K, J^T; J, 0]; whether it is regular."""
    pattern, matrix = matrices.pattern, factors.matrix
    rows, columns, places = pattern.rows, pattern.columns, pattern.single
    mass, damping, stiffness = matrices.mass, matrices.damping, matrices.stiffness
    clear(matrix)
    for e in range(len(rows)):
        value = stiffness[e]
        if rows[e] < n and columns[e] < n:
            # M, C and K are kept apart, so that a new step length needs sums over the entries and a factorisation, but
            # no evaluation.
            value = mass[e] + first * damping[e] + second * value
        matrix[places[e]] = value
    return factorise(pattern.layout, factors)


@inlined
def product(a, b):
    """Product of complex numbers; Numba's own looks at infinities, which takes long to compile, and to run."""
    return complex(*times(a, b.real, b.imag))


@inlined
def times(a, x, y):
    """Real and imaginary part of a complex number times x + iy, which are real numbers or lanes."""
    return a.real * x - a.imag * y, a.real * y + a.imag * x


@inlined
def inverse(s):
    """Reciprocal of a complex number, likewise."""
    square = s.real * s.real + s.imag * s.imag
    return complex(s.real / square, -s.imag / square)


@inlined
def _double(matrices, p):
    """Complex system ``p``."""
    stack = matrices.doubles
    return Factors(stack.matrix[p], stack.pivots[p], stack.tops[p], stack.buffer[p])


@inner
def factorise_complex(n, matrices, p, s):
    """Factorise [M + C/s + K/s^2, J^T; J, 0] for a complex s as system ``p``; whether it is regular."""
    first = inverse(s)
    second = product(first, first)
    pattern, factors = matrices.pattern, _double(matrices, p)
    rows, columns, places = pattern.rows, pattern.columns, pattern.double
    matrix, mass, damping, stiffness = factors.matrix, matrices.mass, matrices.damping, matrices.stiffness
    clear(matrix)
    for e in range(len(rows)):
        value, turned = stiffness[e], 0.0
        if rows[e] < n and columns[e] < n:
            turned = first.imag * damping[e] + second.imag * value
            value = mass[e] + first.real * damping[e] + second.real * value
        # A complex entry z is the real block [Re z, -Im z; Im z, Re z]: real kernels factorise complex systems too.
        matrix[places[0, e]] = value
        matrix[places[1, e]] = -turned
        matrix[places[2, e]] = turned
        matrix[places[3, e]] = value
    return factorise(matrices.pattern.double_layout, factors)


@inner
def solve_complex(matrices, p, given, answer):
    """Solve with the complex system ``p``: real parts, then imaginary ones."""
    solve_slopes(matrices.pattern.double_layout, _double(matrices, p), given, answer)


@inner
def add_inertia(matrices, vector, target):
    """target += M vector."""
    pattern, heavy, mass = matrices.pattern, matrices.heavy, matrices.mass
    rows, columns = pattern.rows, pattern.columns
    # Most entries have no mass: only those that do are visited, as this product is taken at each iteration.
    for number in range(heavy[len(heavy) - 1]):
        e = heavy[number]
        target[rows[e]] += mass[e] * vector[columns[e]]


@inner
def add_product(n, matrices, values, vector, factor, target):
    """target += factor A vector, for the entries ``values`` of A between coordinates."""
    rows, columns = matrices.pattern.rows, matrices.pattern.columns
    for e in range(len(rows)):
        i, j = rows[e], columns[e]
        if i < n and j < n:
            target[i] += factor * values[e] * vector[j]
