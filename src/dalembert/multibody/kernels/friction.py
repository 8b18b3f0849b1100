"""Friction in revolute and prismatic joints: viscous and smoothed Coulomb.

Local unknowns and the first eight data are those of the joint (:mod:`joints`); behind them viscous coefficient,
constant Coulomb torque (force), friction coefficient times pin radius (friction coefficient), and the rate at which the
smoothed sign tanh(rate/transition) turns.
"""

from dalembert.multibody.kernels import joints
from dalembert.multibody.kernels.compiled import inlined, kernel
from dalembert.multibody.kernels.dual import root, tanh

WIDTH = joints.WIDTH
_TINY = 1e-18  # keeps |reaction| differentiable where the reaction vanishes, N^2


@inlined
def _rate(x, v, data, meta, e):
    """Rate of turning or of sliding."""
    if meta[e, 0] == joints.REVOLUTE:
        return joints.relative_spin(x, v, meta, e)
    c, s = joints.axis(x, data, meta, e)
    ux, uy = joints.separation_rate(x, v, data, meta, e)
    return c * ux + s * uy


@inlined
def _resistance(x, rate, data, meta, e):
    """Friction torque (revolute) or force (prismatic) against the rate."""
    normal = x[8] * x[8]
    if meta[e, 0] == joints.REVOLUTE:
        normal += x[9] * x[9]
    coulomb = data[e, 9] + data[e, 10] * root(normal + _TINY)
    return data[e, 8] * rate + coulomb * tanh(rate / data[e, 11])


@inlined
def residual(x, v, a, signals, callbacks, data, meta, e, r):
    """Friction torque or force on both bodies."""
    for i in range(WIDTH):
        r[i] = 0.0
    resistance = _resistance(x, _rate(x, v, data, meta, e), data, meta, e)
    if meta[e, 0] == joints.REVOLUTE:
        joints.twist_pair(x, meta, e, resistance, r)
    else:
        c, s = joints.axis(x, data, meta, e)
        joints.push_pair(x, data, meta, e, resistance * c, resistance * s, r)


@kernel
def energy(x, v, signals, callbacks, data, meta, e):
    """No energy; the power that friction takes."""
    rate = _rate(x, v, data, meta, e)
    zero = 0.0 * rate
    return zero, zero, -rate * _resistance(x, rate, data, meta, e)
