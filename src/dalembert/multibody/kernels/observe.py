"""Channels: what is read off a motion, from pairs of markers, joints, springs and the whole system.

A channel is a quantity of one row of a block laid out as those of :mod:`joints` and :mod:`spring`; a point against the
axes is the pair (ground, point).
"""

from dalembert.multibody.kernels import joints, spring
from dalembert.multibody.kernels.assembly import energies, gather
from dalembert.multibody.kernels.compiled import compiled
from dalembert.multibody.kernels.markers import acceleration, spin_rate

(
    X,
    Y,
    ANGLE,
    VX,
    VY,
    RATE,
    AX,
    AY,
    ACCELERATION,
    FORCE_X,
    FORCE_Y,
    TORQUE,
    STRETCH,
    TENSION,
    KINETIC,
    POTENTIAL,
    TOTAL,
) = range(17)


@compiled
def _pair(quantity, x, v, a, data, meta, e):
    """Relative position, velocity, acceleration or angle of a row's markers."""
    if quantity == X or quantity == Y:
        return joints.separation(x, data, meta, e)[quantity - X]
    if quantity == VX or quantity == VY:
        return joints.separation_rate(x, v, data, meta, e)[quantity - VX]
    if quantity == AX or quantity == AY:
        a0, a1 = acceleration(meta[e, 1], 0, x, v, a, data[e, 0], data[e, 1])
        b0, b1 = acceleration(meta[e, 2], 4, x, v, a, data[e, 3], data[e, 4])
        return b0 - a0 if quantity == AX else b1 - a1
    if quantity == ANGLE:
        return joints.relative_angle(x, data, meta, e)
    if quantity == RATE:
        return joints.relative_spin(x, v, meta, e)
    return spin_rate(meta[e, 2], 4, x, v, a) - spin_rate(meta[e, 1], 0, x, v, a)


@compiled
def observe(model, quantities, index, meta, data, x, v, a, work, out):
    """Fill ``out`` (samples, channels) from the states x, v, a (samples, N + 1)."""
    for s in range(len(x)):
        for e in range(len(quantities)):
            quantity = quantities[e]
            if quantity >= KINETIC:
                energies(model, x[s], v[s], work, work.r)
                out[s, e] = work.r[0] + work.r[1] if quantity == TOTAL else work.r[quantity - KINETIC]
                continue
            gather(index, e, joints.WIDTH, x[s], v[s], a[s], work)
            if quantity <= ACCELERATION:
                out[s, e] = _pair(quantity, work.x, work.v, work.a, data, meta, e)
            elif quantity <= TORQUE:
                out[s, e] = joints.reaction(work.x, data, meta, e)[quantity - FORCE_X]
            elif quantity == STRETCH:
                out[s, e] = spring.stretch(work.x, work.v, data, meta, e)[0]
            else:
                out[s, e] = spring.tension(work.x, work.v, data, meta, e)
