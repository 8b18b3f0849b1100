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

from dalembert.vibration.compiled import compiled
from dalembert.vibration.friction_law import FRICTION, LOAD, NORMAL, SEPARATED, SLIPPING, STUCK, TANGENTIAL, update

CUBIC, GAP, STOP = 0, 1, 2
"""Springs without memory."""
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


class Modes(NamedTuple):
    """A structure in modes.

    ``mass``, ``damping``, ``stiffness`` and ``inverse`` (S⁻¹) are diagonals (n,); where modes are coupled by damping,
    ``coupled`` and ``solver`` are whole matrices of C and S⁻¹ instead, else empty. ``seen`` (rows, n) is L, ``pushed``
    (n, rows) S⁻¹ L^T, ``compliance`` (rows, rows) b L S⁻¹ L^T - 1/rho + 1/k; ``force`` (steps, n) acts at the steps'
    ends.
    """

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    inverse: np.ndarray
    coupled: np.ndarray
    solver: np.ndarray
    seen: np.ndarray
    pushed: np.ndarray
    compliance: np.ndarray
    force: np.ndarray


class Elements(NamedTuple):
    """Elements of a system.

    Cells of friction: ``rows`` (cells, 3), ``tangents``, ``normal``, ``numbers`` (cells, 5) as the friction law takes
    them, ``contacts`` (cells,). Springs: ``kinds``, ``places``, ``values`` (springs, 2) of stiffness and gap.
    ``users``: whether there are laws of the user's.
    """

    rows: np.ndarray
    tangents: np.ndarray
    normal: np.ndarray
    numbers: np.ndarray
    contacts: np.ndarray
    kinds: np.ndarray
    places: np.ndarray
    values: np.ndarray
    users: bool


class State(NamedTuple):
    """At an instant: modes (4, n) of displacements, velocities, accelerations, auxiliary ones; sliders (cells, 2)."""

    modes: np.ndarray
    sliders: np.ndarray


class Record(NamedTuple):
    """At the ends of the last period's steps.

    Modes (steps, n), shifted displacements and forces of elements (steps, rows), states of contacts (steps, contacts).
    """

    modes: np.ndarray
    displacements: np.ndarray
    forces: np.ndarray
    states: np.ndarray


@compiled
def _spring(kind, stiffness, gap, u):
    """Force of a spring without memory and its slope."""
    if kind == CUBIC:
        return stiffness * u**3, 3.0 * stiffness * u**2
    side = -1.0 if kind == STOP and u <= 0.0 else 1.0
    over = u - side * gap
    if side * over <= 0.0:
        return 0.0, 0.0
    return stiffness * over, stiffness


@compiled
def _cell(elements, c, u, sliders, moved, force, slopes, states):
    """Add the forces of a cell and their slopes; where its slider goes."""
    rows, t, numbers = elements.rows[c], elements.tangents[c], elements.numbers[c]
    columns = t + (1 if elements.normal[c] else 0)
    d, own, direction = np.zeros(3), np.zeros(3), np.zeros(2)
    for i in range(columns):
        d[i] = u[rows[i]]
    for i in range(t):
        direction[i] = numbers[TANGENTIAL] * (d[i] - sliders[c, i])
    moved[c] = sliders[c]
    state, size = update(d, moved[c], own, numbers, t, elements.normal[c], True)
    states[elements.contacts[c]] = max(states[elements.contacts[c]], state)
    for i in range(columns):
        force[rows[i]] += own[i]
    if state == SEPARATED:
        return
    if elements.normal[c]:
        slopes[rows[t], rows[t]] += numbers[NORMAL]
    if state == STUCK:
        for i in range(t):
            slopes[rows[i], rows[i]] += numbers[TANGENTIAL]
    elif state == SLIPPING:
        ratio = np.sqrt(own[0] * own[0] + (own[1] * own[1] if t == 2 else 0.0)) / size
        for i in range(t):
            direction[i] /= size
        for i in range(t):
            if elements.normal[c]:
                slopes[rows[i], rows[t]] += numbers[FRICTION] * numbers[NORMAL] * direction[i]
            if t == 2:
                slopes[rows[i], rows[i]] += numbers[TANGENTIAL] * ratio
                for j in range(t):
                    slopes[rows[i], rows[j]] -= numbers[TANGENTIAL] * ratio * direction[i] * direction[j]


@compiled
def react(elements, users, u, sliders, moved, force, slopes, states):
    """Forces (rows,) of all elements at displacements, their slopes (rows, rows), new sliders, and contacts' states."""
    force[:] = 0.0
    slopes[:] = 0.0
    states[:] = 0
    for c in range(len(elements.tangents)):
        _cell(elements, c, u, sliders, moved, force, slopes, states)
    for s in range(len(elements.kinds)):
        row = elements.places[s]
        value, slope = _spring(elements.kinds[s], elements.values[s, 0], elements.values[s, 1], u[row])
        force[row] += value
        slopes[row, row] += slope
    if elements.users:
        users(u.ctypes, force.ctypes, slopes.ctypes)


@compiled
def settle(elements, users, displacements, sliders):
    """Move sliders (cells, 2) to where they end in a period of displacements (steps, rows) gone through repeatedly."""
    rows = displacements.shape[1]
    force, slopes, moved = np.zeros(rows), np.zeros((rows, rows)), np.zeros_like(sliders)
    states = np.zeros(len(elements.tangents), dtype=np.uint8)
    for _ in range(3):
        for t in range(len(displacements)):
            react(elements, users, displacements[t], sliders, moved, force, slopes, states)
            sliders[:] = moved


@compiled
def _product(diagonal, whole, x):
    return whole @ x if len(whole) else diagonal * x


@compiled
def _balance(modes, elements, users, u, start, state, moved, force, slopes, kept, states):
    """Solve u + compliance · force(u) = start, u shifted, from a guess; ``kept`` is an inverse of before. If found."""
    rows = len(u)
    scale = max(np.max(np.abs(start)), np.max(np.abs(u)))
    for c in range(len(elements.normal)):
        if elements.normal[c]:
            scale = max(scale, elements.numbers[c, LOAD] / elements.numbers[c, NORMAL])
    before, last = np.inf, False
    for iteration in range(NEWTON):
        if iteration == ASTRAY:
            before = 0.0
            for c in range(len(elements.tangents)):
                for i in range(elements.tangents[c]):
                    u[elements.rows[c, i]] = state.sliders[c, i]
        react(elements, users, u, state.sliders, moved, force, slopes, states)
        if last:
            return True
        residual = u - start + modes.compliance @ force
        size = np.max(np.abs(residual))
        if not np.isfinite(size):
            return False
        if size > 0.1 * before or kept[0, 0] == 0.0:
            matrix = modes.compliance @ slopes
            for i in range(rows):
                matrix[i, i] += 1.0
            kept[:] = np.linalg.inv(matrix)
        before = size
        change = kept @ residual
        if iteration >= BOLD:
            change *= 0.5
        u -= change
        last = np.max(np.abs(change)) <= ACCURACY * scale
    return False


@compiled
def advance(modes, elements, users, scheme, state, omega, most, tolerance, record):
    """Go through periods until one changes nothing, in place; how it ended, periods or step, change of the last one."""
    steps, rows = len(modes.force), len(modes.seen)
    h, ratio = scheme.step, (1.0 - scheme.alpha_f) / (1.0 - scheme.alpha_m)
    q, v, a, w = state.modes[0], state.modes[1], state.modes[2], state.modes[3]
    b, g = scheme.beta * h * h * ratio, scheme.gamma * h * ratio
    u, force, slopes = modes.seen @ q, np.zeros(rows), np.zeros((rows, rows))
    moved, kept = state.sliders.copy(), np.zeros((rows, rows))
    states = np.zeros(record.states.shape[1], dtype=np.uint8)
    change = np.inf
    for period in range(most):
        first_q, first_v, first_z = q.copy(), v.copy(), state.sliders.copy()
        for t in range(steps):
            history = (scheme.alpha_f * a - scheme.alpha_m * w) / (1.0 - scheme.alpha_m)
            q += h * v + h * h * ((0.5 - scheme.beta) * w + scheme.beta * history)
            v += h * ((1.0 - scheme.gamma) * w + scheme.gamma * history)
            pull = modes.force[t] - _product(modes.damping, modes.coupled, v) - modes.stiffness * q
            a[:] = _product(modes.inverse, modes.solver, pull)
            if rows:
                start = modes.seen @ (q + b * a)
                u[:] = start - modes.compliance @ force
                if not _balance(modes, elements, users, u, start, state, moved, force, slopes, kept, states):
                    return LOST, period * steps + t, change
                state.sliders[:] = moved
                a -= modes.pushed @ force
            w[:] = history + ratio * a
            q += b * a
            v += g * a
            record.modes[t] = q
            record.displacements[t] = u
            record.forces[t] = force
            record.states[t] = states
        size = np.sqrt(np.sum(q * q) + np.sum(v * v) / omega**2)
        off = np.sqrt(np.sum((q - first_q) ** 2) + np.sum((v - first_v) ** 2) / omega**2)
        change = off / size if size > 0.0 else 0.0
        if len(moved):
            widest = np.max(np.abs(record.displacements))
            slid = np.max(np.abs(state.sliders - first_z))
            change = max(change, slid / widest if widest > 0.0 else 0.0)
        if not np.isfinite(change):
            return LOST, period * steps, change
        if change <= tolerance:
            return STEADY, period + 1, change
    return MOVING, most, change
