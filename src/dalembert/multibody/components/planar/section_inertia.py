"""Inertia and weight of elements with a position r, a slope r_x and a section vector r_y at each of two nodes.

The line is the cubic of Hermite, the section vector linear. Local coordinates: (r, r_x, r_y) at both nodes. Numbers:
length, mass, rotatory mass (density x second moment of area x length), gravity.
"""

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components import hermite

WIDTH = 12


@inlined
def inertia_and_weight(p, a, r):
    """Add M a - weight to ``r``."""
    h, mass, rotatory = p.length, p.mass, p.rotatory
    hermite.inertia(mass, h, 0, 2, 6, 8, a, r)
    hermite.inertia(mass, h, 1, 3, 7, 9, a, r)
    hermite.weight(mass, h, p.gravity_x, 0, 2, 6, 8, r)
    hermite.weight(mass, h, p.gravity_y, 1, 3, 7, 9, r)
    for i in range(4, 6):
        r[i] += rotatory * (a[i] / 3 + a[i + 6] / 6)
        r[i + 6] += rotatory * (a[i] / 6 + a[i + 6] / 3)


@inlined
def kinetic_and_weight(x, v, p):
    """Return the kinetic energy and the potential energy of the weight."""
    h, mass, rotatory = p.length, p.mass, p.rotatory
    kinetic = hermite.kinetic(mass, h, 0, 2, 6, 8, v) + hermite.kinetic(mass, h, 1, 3, 7, 9, v)
    for i in range(4, 6):
        kinetic += rotatory / 6 * (v[i] * v[i] + v[i] * v[i + 6] + v[i + 6] * v[i + 6])
    potential = -mass * (
        p.gravity_x * hermite.centre(h, 0, 2, 6, 8, x) + p.gravity_y * hermite.centre(h, 1, 3, 7, 9, x)
    )
    return kinetic, potential
