"""Inertia and weight of rigid bodies and point masses.

Local coordinates (x, y, theta) of the centre of mass; a point mass has no theta (its slot is absent).
Data: mass, moment of inertia about the centre, gravity (gx, gy).
"""

from dalembert.multibody.kernels.compiled import inlined, kernel

WIDTH = 3


@inlined
def residual(x, v, a, signals, callbacks, data, meta, e, r):
    """m a - m g and J alpha."""
    mass, inertia = data[e, 0], data[e, 1]
    r[0] = mass * (a[0] - data[e, 2])
    r[1] = mass * (a[1] - data[e, 3])
    r[2] = inertia * a[2]


@kernel
def energy(x, v, signals, callbacks, data, meta, e):
    """Kinetic energy, potential energy, power of other forces."""
    mass, inertia = data[e, 0], data[e, 1]
    kinetic = 0.5 * (mass * (v[0] * v[0] + v[1] * v[1]) + inertia * v[2] * v[2])
    potential = -mass * (data[e, 2] * x[0] + data[e, 3] * x[1])
    return kinetic, potential, 0.0 * mass
