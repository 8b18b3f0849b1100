"""Compiled: the friction of contacts over the samples of a period, with sliders in their periodic motion."""

import numpy as np

from dalembert.kernels.arithmetic import Numbers2, Numbers3, kernels
from dalembert.kernels.kernel import inner
from dalembert.kernels.views import local, stack
from dalembert.kernels.words import Bytes2
from dalembert.vibration.laws.friction_law import FRICTION, LOAD, SEPARATED, SLIPPING, STUCK, TANGENTIAL, update

SWEEPS = 200
"""Periods after which a slider in two dimensions is taken as it is; one in one dimension is exact after two."""
SETTLED = 1e-13
"""Change of a slider over a period, as part of the largest displacement, at which it is periodic."""
NEUTRAL = 1e-6
"""Determinant of 1 - ∂z(end)/∂z(start), z the slider's place, at which a slider stays wherever it starts."""

_square = local(float, 2, 2)


@inner
def settled(z, before, tangents, scale):
    """Whether a slider has moved over a period, in either part, by no more than rounding."""
    for i in range(tangents):
        change = z[i] - before[i]
        if abs(change.real) > SETTLED * scale or abs(change.imag) > 1e-10 * abs(z[i].imag):
            return False
    return True


@inner
def largest(d):
    """Largest displacement (columns, samples), without its sign."""
    scale = 0.0
    for i in range(d.shape[0]):
        for t in range(d.shape[1]):
            scale = max(scale, abs(d[i, t].real))
    return scale


@inner
def restart(kept, tangents):
    """Determinant of 1 - kept, (tangents, tangents)."""
    if tangents == 1:
        return 1.0 - kept[0, 0]
    return (1.0 - kept[0, 0]) * (1.0 - kept[1, 1]) - kept[0, 1] * kept[1, 0]


@inner
def restarted(kept, tangents, first, second):
    """(1 - kept)⁻¹ times (first, second); of one tangent (first, 0)."""
    determinant = restart(kept, tangents)
    if tangents == 1:
        return first / determinant, second
    return (
        ((1.0 - kept[1, 1]) * first + kept[0, 1] * second) / determinant,
        (kept[1, 0] * first + (1.0 - kept[0, 0]) * second) / determinant,
    )


@inner
def identity(kept, tangents):
    """Set kept (tangents, tangents) to one."""
    for i in range(tangents):
        for j in range(tangents):
            kept[i, j] = 1.0 if i == j else 0.0


@inner
def project(x, y, e, f, ratio):
    """Set derivatives of a force's two parts to those where it keeps its size, by its direction (e, f)."""
    for j in range(len(x)):
        along = e * x[j] + f * y[j]
        x[j], y[j] = ratio * (x[j] - e * along), ratio * (y[j] - f * along)


@inner
def _period(d, z, force, forces, states, kept, numbers, tangents, normal, memory):
    """One period from a slider's place: writes forces and states, moves it; how many samples do not stick.

    ``kept`` (tangents, tangents) becomes the derivative of the place at the end by that at the start.
    """
    moving = 0
    identity(kept, tangents)
    for t in range(d.shape[1]):
        state, size = update(d[:, t], z, force, numbers, tangents, normal, memory)
        states[t] = state
        for i in range(d.shape[0]):
            forces[i, t] = force[i]
        if state == STUCK:
            continue
        # Each sample that moves the slider forgets part of its past: `kept` is the product of these derivatives,
        # ∂z(end)/∂z(start).
        moving += 1
        limit = 0.0 if state == SEPARATED or tangents == 1 else np.hypot(force[0].real, force[1].real)
        if limit == 0.0:
            kept[:] = 0.0
            continue
        # A slip of fixed size keeps the part across its direction, by the ratio of the limit to the trial force.
        project(kept[0], kept[1], force[0].real / limit, force[1].real / limit, limit / size.real)
    return moving


@inner
def _settle(d, z, before, force, forces, states, kept, numbers, tangents, normal, memory, direct):
    """Periods until the slider returns to where it was, from z = 0, in ``before`` and ``z``. By the period's derivative
    (Newton) if ``direct``, else from one period to the next. Returns how many of all their samples did not stick.
    """
    scale, last, moving = largest(d), np.inf, 0
    # From rest: where a contact sticks all period, its force depends on the past, and this past is the convention.
    z[:] = 0.0
    for sweep in range(SWEEPS if memory else 1):
        for i in range(tangents):
            before[i] = z[i]
        moving += _period(d, z, force, forces, states, kept, numbers, tangents, normal, memory)
        if sweep > 0 and (tangents == 1 or settled(z, before, tangents, scale)):
            break
        # Newton's method on z(end) - z(start), once the first period has the states about right. Plain repetition
        # converges slowly where slip is short: its factor is `kept`.
        if direct and sweep > 0 and restart(kept, tangents) > NEUTRAL:
            change = 0.0
            for i in range(tangents):
                change = max(change, abs((z[i] - before[i]).real))
            if change < last:  # two tangents: one is exact by now
                first, second = restarted(kept, tangents, z[0] - before[0], z[1] - before[1])
                z[0], z[1] = before[0] + first, before[1] + second
            last = change
    return moving


@inner
def balanced(d, z, before, force, forces, states, kept, numbers, tangents, normal, memory):
    """Periodic motion of a slider, directly where its place does not depend on its past: that, and whether it moves.
    Writes forces (columns, samples) and states (samples,); ``before`` and ``z`` are the slider's place at the start and
    at the end of the period, ``kept`` the derivative of one by the other.
    """
    moving = _settle(d, z, before, force, forces, states, kept, numbers, tangents, normal, memory, True)
    forgets = restart(kept, tangents) > NEUTRAL
    # A neutral slider stays wherever Newton's method leaves it: the periods from rest are repeated without it, so that
    # its place is that of the convention.
    if memory and not forgets and tangents == 2:
        moving = _settle(d, z, before, force, forces, states, kept, numbers, tangents, normal, memory, False)
    return forgets, moving > 0


@inner
def line(d, force, states, numbers):
    """A slider in one dimension that remembers, under a constant load: the law of :func:`update` in scalars. Writes
    forces and states of the periodic motion, each (samples,). Returns whether its place does not depend on its past,
    since it slips in each period, and whether it slips at all. Slip determines the place of the slider. So once it
    slips in the same direction at the same sample of the first and of the second period, the rest of the second period
    equals that of the first and is not computed.
    """
    stiffness, limit = numbers[TANGENTIAL], numbers[FRICTION] * numbers[LOAD]
    z, begins, forgets = 0.0 * d[0], False, False
    for period in range(2):
        for t in range(len(d)):
            p = stiffness * (d[t] - z)
            if abs(p.real) <= limit.real:
                force[t], states[t] = p, STUCK
                continue
            p = limit if p.real >= 0.0 else -limit
            if period > 0 and states[t] == SLIPPING and force[t] == p:
                return True, True
            force[t], states[t] = p, SLIPPING
            z = d[t] - p / stiffness
            begins, forgets = True, period > 0
        if not begins:
            break
    return forgets, begins


def _forces(
    displacements: Numbers3, numbers: Numbers2, tangents: int, normal: bool, memory: bool, result: Numbers3,
    states: Bytes2,
) -> None:  # fmt: skip
    z, before, force, kept = stack(numbers, 2), stack(numbers, 2), stack(numbers, 3), _square()
    for c in range(len(displacements)):
        if memory and tangents == 1 and not normal:
            line(displacements[c, 0], result[c, 0], states[c], numbers[c])
            continue
        balanced(displacements[c], z, before, force, result[c], states[c], kept, numbers[c], tangents, normal, memory)


forces_real, forces_complex = kernels(_forces)
