"""Kinds of which a reduced body consists, in sums: a rigid body, its modes, pairs of modes, and its interface nodes.

A point of the body is x = r + sum_i z_i d_i with z_i = s_i + sum_a Phi_ia eta_a: the place s and the shapes Phi are in
the axes of the body, d_i are its directors, eta_a its modal coordinates. With d_0 = r and z_0 = 1 the inertia force
x'' on every coordinate is polynomial, and the integrals over the mass are constant:

    P_ij = integral of s_i s_j,   u_ij = integral of s_i Phi_ja,   g_ij = integral of Phi_ia Phi_jb,
    M_ab = sum_i g_ii.

P alone is the rigid body. A mode adds the terms of u and of g with itself; a pair of modes adds those of g of both. So
these kinds have few coordinates, whatever the number of modes. An interface node is a node without mass, fixed to the
body's frame by a fixed joint's conditions, to whose rows each mode adds its displacement and rotation there.

Shabana, A. A.: Dynamics of Multibody Systems, 5th ed., 2020, chapter 5, has the integrals; with directors in place of
rotation parameters no term is of a degree above four.
"""

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.spatial.directors import CHART, POSE
from dalembert.multibody.components.spatial.vectors import add_at, at, combined, dot, minus, plus, times
from dalembert.multibody.kernels.charts import flat
from dalembert.multibody.kernels.kind import Kind

FIRST = tuple(f"u{i}{j}" for i in range(4) for j in range(1, 4))
OWN = ("g11", "g12", "g13", "g22", "g23", "g33")
BOTH = tuple(f"g{i}{j}" for i in range(1, 4) for j in range(1, 4))
MODAL = ("mass", "stiffness", "damping")
GRAVITY = ("gravity_x", "gravity_y", "gravity_z")


@inlined
def _gravity(p):
    return p.gravity_x, p.gravity_y, p.gravity_z


@inlined
def _first(p, w1, w2, w3):
    """Sums of u_ij w_j over j, for i = 0 to 3."""
    return (
        combined((p.u01, p.u02, p.u03), w1, w2, w3),
        combined((p.u11, p.u12, p.u13), w1, w2, w3),
        combined((p.u21, p.u22, p.u23), w1, w2, w3),
        combined((p.u31, p.u32, p.u33), w1, w2, w3),
    )


@inlined
def _first_transposed(p, w0, w1, w2, w3):
    """Sums of u_ij w_i over i, for j = 1 to 3."""
    return (
        plus(times(p.u01, w0), combined((p.u11, p.u21, p.u31), w1, w2, w3)),
        plus(times(p.u02, w0), combined((p.u12, p.u22, p.u32), w1, w2, w3)),
        plus(times(p.u03, w0), combined((p.u13, p.u23, p.u33), w1, w2, w3)),
    )


@inlined
def _own(p):
    """Rows of g_ij, of a mode with itself."""
    return (p.g11, p.g12, p.g13), (p.g12, p.g22, p.g23), (p.g13, p.g23, p.g33)


@inlined
def _both(p):
    """Rows of g_ij: the second mode on the first."""
    return (p.g11, p.g12, p.g13), (p.g21, p.g22, p.g23), (p.g31, p.g32, p.g33)


@inlined
def _both_transposed(p):
    """Rows of g_ji: the first mode on the second."""
    return (p.g11, p.g21, p.g31), (p.g12, p.g22, p.g32), (p.g13, p.g23, p.g33)


@inlined
def _sums(rows, w):
    """Sums of three vectors w_j by the rows of a matrix."""
    w1, w2, w3 = w
    return combined(rows[0], w1, w2, w3), combined(rows[1], w1, w2, w3), combined(rows[2], w1, w2, w3)


@inlined
def _mixed(a, v, b, w):
    """a v_j + b w_j of three vectors each."""
    return (
        plus(times(a, v[0]), times(b, w[0])),
        plus(times(a, v[1]), times(b, w[1])),
        plus(times(a, v[2]), times(b, w[2])),
    )


@inlined
def _triple(x, k):
    """The directors, their velocities or their accelerations from the slot ``k`` on."""
    return at(x, k), at(x, k + 3), at(x, k + 6)


@inlined
def _work(c, d):
    """Sum of the dot products of three vectors and three others."""
    return dot(c[0], d[0]) + dot(c[1], d[1]) + dot(c[2], d[2])


# -- a mode ----------------------------------------------------------------------------------------------------------


@inlined
def _mode_residual(x, v, a, p, m, inputs, r):
    """Inertia with the terms of one mode, its stiffness and damping, and its weight."""
    directors, rates, seconds = _triple(x, 3), _triple(v, 3), _triple(a, 3)
    eta, rate, second = x[12], v[12], a[12]
    # Acceleration by the mode, w_j = (eta d_j)'', without and with that of the modal coordinate.
    carried = _mixed(eta, seconds, 2.0 * rate, rates)
    w1, w2, w3 = _mixed(1.0, carried, second, directors)
    n0, n1, n2, n3 = _first(p, w1, w2, w3)
    fall, (a1, a2, a3) = minus(at(a, 0), _gravity(p)), seconds
    back = _first_transposed(p, fall, a1, a2, a3)
    g1, g2, g3 = _mixed(eta, back, eta, _sums(_own(p), (w1, w2, w3)))
    add_at(r, 0, n0)
    add_at(r, 3, plus(n1, g1))
    add_at(r, 6, plus(n2, g2))
    add_at(r, 9, plus(n3, g3))
    # The directors are orthonormal: sum of g_ij d_i . d_j is the modal mass.
    r[12] += _work(back, directors) + _work(_sums(_own(p), carried), directors)
    r[12] += p.mass * second + p.damping * rate + p.stiffness * eta


@inlined
def _mode_energy(x, v, p, m, inputs):
    directors, rates = _triple(x, 3), _triple(v, 3)
    eta, rate = x[12], v[12]
    y1, y2, y3 = _mixed(rate, directors, eta, rates)
    n0, n1, n2, n3 = _first(p, y1, y2, y3)
    turning, (d1, d2, d3) = _sums(_own(p), rates), directors
    kinetic = dot(at(v, 0), n0) + _work((n1, n2, n3), rates)
    kinetic += 0.5 * p.mass * rate * rate + eta * rate * _work(turning, directors)
    kinetic += 0.5 * eta * eta * _work(turning, rates)
    drop = dot(_gravity(p), combined((p.u01, p.u02, p.u03), d1, d2, d3))
    return kinetic, 0.5 * p.stiffness * eta * eta - eta * drop, -p.damping * rate * rate


MODE = Kind(
    "reduced_mode",
    coordinates=13,
    numbers=(*FIRST, *OWN, *MODAL, *GRAVITY),
    residual=_mode_residual,
    energy=_mode_energy,
    dissipates=("damping",),
    varying_mass=(*FIRST, *OWN),
    gravity=GRAVITY,
    charts=(*POSE, flat(1)),
)


# -- a pair of modes -------------------------------------------------------------------------------------------------


@inlined
def _pair_residual(x, v, a, p, m, inputs, r):
    """Inertia with the terms of two modes at once, and what couples their coordinates."""
    directors, rates, seconds = _triple(x, 0), _triple(v, 0), _triple(a, 0)
    eta, rate, second = x[9], v[9], a[9]
    other, other_rate, other_second = x[10], v[10], a[10]
    first_carried = _mixed(eta, seconds, 2.0 * rate, rates)
    second_carried = _mixed(other, seconds, 2.0 * other_rate, rates)
    on_first = _sums(_both(p), _mixed(1.0, second_carried, other_second, directors))
    on_second = _sums(_both_transposed(p), _mixed(1.0, first_carried, second, directors))
    f1, f2, f3 = _mixed(eta, on_first, other, on_second)
    add_at(r, 0, f1)
    add_at(r, 3, f2)
    add_at(r, 6, f3)
    r[9] += _work(_sums(_both(p), second_carried), directors)
    r[9] += p.mass * other_second + p.damping * other_rate + p.stiffness * other
    r[10] += _work(_sums(_both_transposed(p), first_carried), directors)
    r[10] += p.mass * second + p.damping * rate + p.stiffness * eta


@inlined
def _pair_energy(x, v, p, m, inputs):
    directors, rates = _triple(x, 0), _triple(v, 0)
    eta, rate, other, other_rate = x[9], v[9], x[10], v[10]
    turning = _sums(_both(p), rates)
    kinetic = p.mass * rate * other_rate + rate * other * _work(turning, directors)
    kinetic += eta * other_rate * _work(_sums(_both_transposed(p), rates), directors)
    kinetic += eta * other * _work(turning, rates)
    return kinetic, p.stiffness * eta * other, -2.0 * p.damping * rate * other_rate


PAIR = Kind(
    "reduced_mode_pair",
    coordinates=11,
    numbers=(*BOTH, *MODAL),
    residual=_pair_residual,
    energy=_pair_energy,
    dissipates=("damping",),
    varying_mass=BOTH,
    charts=(CHART, flat(2)),
)


# -- a mode at an interface node -------------------------------------------------------------------------------------


@inlined
def _shift(p):
    return p.shift_1, p.shift_2, p.shift_3


@inlined
def _turned(x, p):
    """Change of the axes of the interface by a unit of the modal coordinate: psi x e_k, with e_k along d_k."""
    d1, d2, d3 = _triple(x, 0)
    return (
        minus(times(p.turn_3, d2), times(p.turn_2, d3)),
        minus(times(p.turn_1, d3), times(p.turn_3, d1)),
        minus(times(p.turn_2, d1), times(p.turn_1, d2)),
    )


@inlined
def _interface_rows(x, p, m, inputs, g):
    """What a mode adds to the rows of a fixed joint: -eta Phi_j d_j, and eta c_k . f_l for (k, l) = 12, 23 and 31."""
    d1, d2, d3 = _triple(x, 0)
    f1, f2, f3 = _triple(x, 10)
    c1, c2, c3 = _turned(x, p)
    g[0], g[1], g[2] = times(-x[9], combined(_shift(p), d1, d2, d3))
    g[3] = x[9] * dot(c1, f2)
    g[4] = x[9] * dot(c2, f3)
    g[5] = x[9] * dot(c3, f1)


@inlined
def _interface_forces(x, p, m, r):
    """J^T lambda of these rows."""
    d1, d2, d3 = _triple(x, 0)
    f1, f2, f3 = _triple(x, 10)
    c1, c2, c3 = _turned(x, p)
    eta, force = x[9], at(x, 19)
    on_1, on_2, on_3 = times(x[22], f2), times(x[23], f3), times(x[24], f1)
    r[9] += dot(c1, on_1) + dot(c2, on_2) + dot(c3, on_3) - dot(force, combined(_shift(p), d1, d2, d3))
    first = minus(times(p.turn_2, on_3), times(p.turn_3, on_2))
    second = minus(times(p.turn_3, on_1), times(p.turn_1, on_3))
    third = minus(times(p.turn_1, on_2), times(p.turn_2, on_1))
    add_at(r, 0, times(eta, minus(first, times(p.shift_1, force))))
    add_at(r, 3, times(eta, minus(second, times(p.shift_2, force))))
    add_at(r, 6, times(eta, minus(third, times(p.shift_3, force))))
    add_at(r, 10, times(eta * x[24], c3))
    add_at(r, 13, times(eta * x[22], c1))
    add_at(r, 16, times(eta * x[23], c2))


INTERFACE = Kind(
    "reduced_interface",
    coordinates=19,
    multipliers=6,
    numbers=("shift_1", "shift_2", "shift_3", "turn_1", "turn_2", "turn_3"),
    constraint=_interface_rows,
    forces=_interface_forces,
    charts=(CHART, flat(1), CHART),
)
