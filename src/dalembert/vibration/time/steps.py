r"""Compiled: a structure in its modes, with elements, through periods in steps (Newmark, generalized-alpha).

With w the auxiliary accelerations of generalized-alpha (Arnold and Bruels 2007; Newmark's where both alphas are 0),

    x_1 = x_0 + h v_0 + h² ((1/2 - beta) w_0 + beta w_1),   v_1 = v_0 + h ((1 - gamma) w_0 + gamma w_1),
    (1 - alpha_m) w_1 + alpha_m w_0 = (1 - alpha_f) a_1 + alpha_f a_0,   M a_1 + C v_1 + K x_1 + L^T lambda_1 = f_1

holds at the end of each step. With S = M + g C + b K, where v_1 and x_1 change by g and b with a_1, the displacements u
that the elements see obey u + b L S⁻¹ L^T lambda = u_0. Each row of L is seen by one element. A cell of friction is
given the stiffness rho that matches the compliance behind it, and d = u + (1/rho - 1/k) lambda, at which it says of
lambda what its own stiffness k says at u. Newton's method solves d + (b L S⁻¹ L^T - 1/rho + 1/k) lambda(d) = u_0: as
many equations as there are rows, linear between changes of the contacts' states.
"""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.blas import gemv
from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Address, Bytes2, Reals, Reals2
from dalembert.vibration.dense import apply, assign, dot, invert, size_of
from dalembert.vibration.laws.friction_law import LOAD, NORMAL
from dalembert.vibration.time.elements import Elements, Instant, Reaction, answer

STEADY, MOVING, LOST = 0, 1, 2
"""How a run ends: periodic, not yet, or at a step that Newton's method cannot take."""
NEWTON = 80
"""Iterations of a step."""
ASTRAY = 8
"""Iterations after which a step begins again with stuck contacts: from the slip of one side a contact may be thrown to
that of the other and back, from where it sticks not."""
BOLD = 30
"""Iterations after which steps are halved."""
ACCURACY = 1e-13
"""Last change of the elements' displacements, as part of the largest one, and of those that a preload brings."""


class Scheme(NamedTuple):
    """Numbers of the method."""

    step: float
    beta: float
    gamma: float
    alpha_m: float
    alpha_f: float


class ModalStructure(NamedTuple):
    """A structure in modes. ``mass``, ``damping``, ``stiffness`` and ``inverse`` (S⁻¹) are diagonals (n,); where modes
    are coupled by damping, ``coupled`` and ``solver`` are whole matrices of C and S⁻¹ instead, else empty. ``seen``
    (rows, n) is L, ``pushed`` (rows, n) S⁻¹ L^T transposed, ``compliance`` (rows, rows) b L S⁻¹ L^T - 1/rho + 1/k;
    ``force`` (steps, n) acts at the steps' ends.
    """

    mass: Reals
    damping: Reals
    stiffness: Reals
    inverse: Reals
    coupled: Reals2
    solver: Reals2
    seen: Reals2
    pushed: Reals2
    compliance: Reals2
    force: Reals2


class ModalState(NamedTuple):
    """At an instant: modes (4, n) of displacements, velocities, accelerations, auxiliary ones; what elements remember.

    ``sliders`` (cells, 2); ``states`` of all elements that follow a law, one after the other.
    """

    modes: Reals2
    sliders: Reals2
    states: Reals


class Record(NamedTuple):
    """At the ends of the last period's steps.

    Modes (steps, n), shifted displacements and forces of elements (steps, rows), states of contacts (steps, contacts).
    """

    modes: Reals2
    displacements: Reals2
    forces: Reals2
    states: Bytes2


class StepWorkspace(NamedTuple):
    """Workspace for a step: vectors of rows, matrices (rows, rows), vectors of modes; sliders (cells, 2), states.

    ``gemv``: the BLAS's address. ``largest``: of the states over a period.
    """

    gemv: Address
    u: Reals
    rate: Reals
    start: Reals
    residual: Reals
    change: Reals
    matrix: Reals2
    inverse: Reals2
    history: Reals
    pull: Reals
    first_q: Reals
    first_v: Reals
    first_z: Reals2
    first_states: Reals
    largest: Reals


def scratch(modes: ModalStructure, state: ModalState) -> StepWorkspace:
    """Workspace for steps from a state."""
    rows, n = modes.seen.shape
    vectors = *np.zeros((5, rows)), *np.zeros((2, rows, rows)), *np.zeros((4, n))
    return StepWorkspace._make([gemv(), *vectors, np.zeros_like(state.sliders), *np.zeros((2, len(state.states)))])


@inner
def _product(gemv, diagonal, whole, x, y):
    """Set y to the product of a matrix, which may be a diagonal, and x."""
    if len(whole):
        apply(gemv, whole, x, y)
    else:
        for i in range(len(y)):
            y[i] = diagonal[i] * x[i]


@inner
def _balance(modes, elements, users, instant, reaction, scratch):
    """Solve u + compliance · force(u) = start, u shifted, from a guess; the inverse is one of before. If found."""
    u, start, residual, change = scratch.u, scratch.start, scratch.residual, scratch.change
    scale = max(size_of(start), size_of(u))
    for c in range(len(elements.normal)):
        if elements.normal[c]:
            scale = max(scale, elements.numbers[c, LOAD] / elements.numbers[c, NORMAL])
    # Newton's method with a kept inverse: equations are linear between changes of contact states, so that one inverse
    # serves many steps. It is renewed where the residual falls by less than a factor of ten.
    before, last = np.inf, False
    for iteration in range(NEWTON):
        if iteration == ASTRAY:
            before = 0.0
            for c in range(len(elements.tangents)):
                # Sliders at their displacements: every contact sticks, with no force along its tangents.
                for i in range(elements.tangents[c]):
                    u[elements.rows[c, i]] = instant.sliders[c, i]
        answer(elements, users, instant, reaction)
        # The reaction belongs to the last displacements, whose change was below the accuracy.
        if last:
            return True
        apply(scratch.gemv, modes.compliance, reaction.force, residual)
        for i in range(len(u)):
            residual[i] += u[i] - start[i]
        size = size_of(residual)
        if not np.isfinite(size):
            return False
        # 0 marks an inverse that was never made.
        if size > 0.1 * before or scratch.inverse[0, 0] == 0.0:
            _linearise(modes.compliance, reaction.slopes, scratch.matrix)
            invert(scratch.matrix, scratch.inverse)
        before = size
        apply(scratch.gemv, scratch.inverse, residual, change)
        # Half steps where whole ones alternate between the sides of kinks.
        part = 0.5 if iteration >= BOLD else 1.0
        for i in range(len(u)):
            change[i] *= part
            u[i] -= change[i]
        last = size_of(change) <= ACCURACY * scale
    return False


@inner
def _linearise(compliance, slopes, matrix):
    """Set the matrix to 1 + compliance · slopes."""
    for i in range(len(matrix)):
        # 1 + (b L S⁻¹ L^T - 1/rho + 1/k) ∂λ/∂d
        for j in range(len(matrix)):
            matrix[i, j] = 1.0 if i == j else 0.0
        for k in range(len(matrix)):
            for j in range(len(matrix)):
                matrix[i, j] += compliance[i, k] * slopes[k, j]


@inner
def _step(modes, elements, users, scheme, state, t, reaction, scratch):
    """A step; whether the contacts are solved."""
    h, ratio = scheme.step, (1.0 - scheme.alpha_f) / (1.0 - scheme.alpha_m)
    # With w_1 = (1 - α_f)/(1 - α_m) a_1 + history, x_1 and v_1 change by b and g with a_1.
    b, g = scheme.beta * h * h * ratio, scheme.gamma * h * ratio
    q, v, a, w = state.modes[0], state.modes[1], state.modes[2], state.modes[3]
    history, pull = scratch.history, scratch.pull
    # What w_0 and a_0 add to x_1 and v_1, then the acceleration without elements S⁻¹ (f_1 - C v_1 - K x_1).
    for i in range(len(q)):
        history[i] = (scheme.alpha_f * a[i] - scheme.alpha_m * w[i]) / (1.0 - scheme.alpha_m)
        q[i] += h * v[i] + h * h * ((0.5 - scheme.beta) * w[i] + scheme.beta * history[i])
        v[i] += h * ((1.0 - scheme.gamma) * w[i] + scheme.gamma * history[i])
    _product(scratch.gemv, modes.damping, modes.coupled, v, a)
    for i in range(len(q)):
        pull[i] = modes.force[t, i] - a[i] - modes.stiffness[i] * q[i]
    _product(scratch.gemv, modes.inverse, modes.solver, pull, a)
    if len(modes.seen):
        # u_0 = L (x_1 + b a_1), and Newton's method for d + (b L S⁻¹ Lᵀ - 1/rho + 1/k) lambda(d) = u_0
        for i in range(len(q)):
            pull[i] = q[i] + b * a[i]
        # u_0 = L (x_1 + b a_1) with the acceleration that the elements do not see yet.
        apply(scratch.gemv, modes.seen, pull, scratch.start)
        apply(scratch.gemv, modes.compliance, reaction.force, scratch.u)
        for i in range(len(scratch.u)):
            # The guess: the forces of the step before, since d + compliance · λ(d) = u_0.
            scratch.u[i] = scratch.start[i] - scratch.u[i]
        if len(elements.ruled.laws):  # velocities follow displacements: v + g (u - x)/b
            apply(scratch.gemv, modes.seen, v, scratch.rate)
            apply(scratch.gemv, modes.seen, q, scratch.residual)
            for i in range(len(scratch.rate)):
                scratch.rate[i] -= g / b * scratch.residual[i]
        instant = Instant(scratch.u, scratch.rate, g / b, state.sliders, state.states)
        if not _balance(modes, elements, users, instant, reaction, scratch):
            return False
        for c in range(len(state.sliders)):
            assign(state.sliders[c], reaction.moved[c])
        assign(state.states, reaction.next)
        for k in range(len(modes.pushed)):  # a_1 -= S⁻¹ Lᵀ lambda
            for i in range(len(a)):
                a[i] -= modes.pushed[k, i] * reaction.force[k]
    for i in range(len(q)):
        # Only now, since the elements' part of a_1 was missing in the predicted state.
        w[i] = history[i] + ratio * a[i]
        q[i] += b * a[i]
        v[i] += g * a[i]
    return True


@inner
def _distance(x, y):
    """Sum of squares of differences."""
    total = 0.0
    for i in range(len(x)):
        total += (x[i] - y[i]) * (x[i] - y[i])
    return total


@inner
def _change(state, record, omega, scratch):
    """What a period changed, as part of the motion."""
    q, v = state.modes[0], state.modes[1]
    # Velocities by ω have the size of displacements: the distance does not depend on the phase of the motion.
    size = np.sqrt(dot(q, q) + dot(v, v) / omega**2)
    off = np.sqrt(_distance(q, scratch.first_q) + _distance(v, scratch.first_v) / omega**2)
    change = off / size if size > 0.0 else 0.0
    for i in range(len(state.states)):
        # States of laws have no common unit: each by its own largest value of the period.
        if scratch.largest[i] > 0.0:
            change = max(change, abs(state.states[i] - scratch.first_states[i]) / scratch.largest[i])
    if len(state.sliders) == 0 or np.isnan(change):
        return change
    widest, slid = 0.0, 0.0
    for t in range(len(record.displacements)):
        widest = max(widest, size_of(record.displacements[t]))
    for c in range(len(state.sliders)):
        for i in range(2):
            slid = max(slid, abs(state.sliders[c, i] - scratch.first_z[c, i]))
    return max(change, slid / widest if widest > 0.0 else 0.0)


@kernel
def go_through(
    modes: ModalStructure, elements: Elements, users: Address, scheme: Scheme, state: ModalState, omega: float,
    most: int,
    tolerance: float, record: Record, reaction: Reaction, scratch: StepWorkspace,
) -> tuple[int, int, float]:  # fmt: skip
    """Go through periods until one changes nothing, in place; how it ended, periods or step, change of the last one."""
    steps, change = len(modes.force), np.inf
    apply(scratch.gemv, modes.seen, state.modes[0], scratch.u)
    for period in range(most):
        assign(scratch.first_q, state.modes[0])
        assign(scratch.first_v, state.modes[1])
        assign(scratch.first_states, state.states)
        scratch.largest[:] = 0.0
        for c in range(len(state.sliders)):
            assign(scratch.first_z[c], state.sliders[c])
        for t in range(steps):
            if not _step(modes, elements, users, scheme, state, t, reaction, scratch):
                return LOST, period * steps + t, change
            for i in range(len(state.states)):
                scratch.largest[i] = max(scratch.largest[i], abs(state.states[i]))
            assign(record.modes[t], state.modes[0])
            assign(record.displacements[t], scratch.u)
            assign(record.forces[t], reaction.force)
            assign(record.states[t], reaction.states)
        change = _change(state, record, omega, scratch)
        if not np.isfinite(change):
            return LOST, period * steps, change
        # Periodic to the tolerance: the record has the last period as it was gone through.
        if change <= tolerance:
            return STEADY, period + 1, change
    return MOVING, most, change
