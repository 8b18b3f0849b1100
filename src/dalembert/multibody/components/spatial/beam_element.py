"""Geometrically exact beam element of degree p in space, on p + 1 nodes that are those of rigid bodies.

A node has its origin r and directors d1 (along the axis), d2 and d3 (in the section). Between nodes r is a polynomial,
and so are the quaternions of the nodes relative to the middle one, which are normalised where they are used. At p Gauss
points (P0, p) is the quaternion, (Q0, q) its derivative along the reference line, rho = D_m^T r' the tangent in the
middle node's frame, and sigma = P0^2 + p . p. The strains of Reissner and Simo, in the frame of the section, are

    Gamma = rho + 2/sigma (P0 rho x p + (rho x p) x p),  K = 2/sigma (P0 q - Q0 p - p x q),

the stress resultants (n, m) = C (e - e0 + delay e') with e = (Gamma, K). They are invariant under rigid motions, and p
points for degree p leave no locking: the element is a Gauss collocation of the beam's equations, of order 2 p. The
interpolation is that of projected quaternions (Herrmann et al. 2025, arXiv 2507.01552); its variation is exact here, in
all coordinates. The mass matrix is that of polynomial directors, constant: `docs/theory/beams-in-space.md`.
"""

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

from dalembert.kernels.kernel import inlined, inner
from dalembert.kernels.views import stack
from dalembert.multibody.components.spatial.beam_columns import INERTIAS, POINTS, columns, reference_columns
from dalembert.multibody.components.spatial.beam_kinematics import element_strains
from dalembert.multibody.components.spatial.beam_shapes import rule
from dalembert.multibody.components.spatial.directors import POSE
from dalembert.multibody.components.spatial.spatial_markers import SLOTS
from dalembert.multibody.components.spatial.vectors import add_at, at, combined, cross, dot, minus, plus, times
from dalembert.multibody.kernels.elementary import is_zero, reciprocal, root
from dalembert.multibody.kernels.kind import Kind

MOST_DEGREE = 4
USUAL = (2, 3)
"""Degrees whose kernels are compiled ahead."""


@inlined
def _node(x, i):
    """Directors of node i."""
    return at(x, SLOTS * i + 3), at(x, SLOTS * i + 6), at(x, SLOTS * i + 9)


@inlined
def _relative(x, i, middle):
    """Rotation of node i relative to the middle one: its axis times tan(angle / 2), 1 / |(1, g)|, 1 / (1 + tr T)."""
    m1, m2, m3 = _node(x, middle)
    a1, a2, a3 = _node(x, i)
    # T_kl = m_k . d_l has the trace 1 + 2 cos(angle): no root of a difference, and no branch below half a turn.
    factor = reciprocal(1.0 + dot(m1, a1) + dot(m2, a2) + dot(m3, a3))
    g = times(factor, (dot(m3, a2) - dot(m2, a3), dot(m1, a3) - dot(m3, a1), dot(m2, a1) - dot(m1, a2)))
    return g, reciprocal(root(1.0 + dot(g, g))), factor


@inlined
def _to_directors(x, i, middle, force, r):
    """Pass the force (F0, F) on the quaternion of node i to its directors and to those of the middle node."""
    g, p0, factor = _relative(x, i, middle)
    f = force[1], force[2], force[3]
    # Of the normalisation P = (1, g) / |(1, g)|, then of g = factor times products of directors.
    inner_part = p0 * p0 * p0 * (force[0] + dot(f, g))
    t = times(factor, minus(times(p0, f), times(inner_part, g)))
    e = -dot(t, g)
    m1, m2, m3 = _node(x, middle)
    a1, a2, a3 = _node(x, i)
    k, m = SLOTS * i, SLOTS * middle
    add_at(r, k + 3, combined((e, t[2], -t[1]), m1, m2, m3))
    add_at(r, k + 6, combined((-t[2], e, t[0]), m1, m2, m3))
    add_at(r, k + 9, combined((t[1], -t[0], e), m1, m2, m3))
    add_at(r, m + 3, combined((e, -t[2], t[1]), a1, a2, a3))
    add_at(r, m + 6, combined((t[2], e, -t[0]), a1, a2, a3))
    add_at(r, m + 9, combined((-t[1], t[0], e), a1, a2, a3))


@inlined
def _weighed(weights, quaternions):
    """Sum of quaternions, four numbers each, with weights: scalar and vector."""
    scalar, vector = weights[0] * quaternions[0], times(weights[0], at(quaternions, 1))
    for i in range(1, len(weights)):
        scalar += weights[i] * quaternions[4 * i]
        vector = plus(vector, times(weights[i], at(quaternions, 4 * i + 1)))
    return scalar, vector


@inlined
def _line(weights, x, slot):
    """Sum of vectors of the nodes at a slot, with weights."""
    total = times(weights[0], at(x, slot))
    for i in range(1, len(weights)):
        total = plus(total, times(weights[i], at(x, SLOTS * i + slot)))
    return total


@inlined
def _strains(rho, p0, p, q0, q):
    """Force strains Gamma, curvatures K, 1 / sigma, and P0 rho x p + (rho x p) x p."""
    inverse, once = reciprocal(p0 * p0 + dot(p, p)), cross(rho, p)
    turned = plus(times(p0, once), cross(once, p))
    curved = minus(minus(times(p0, q), times(q0, p)), cross(p, q))
    return plus(rho, times(2.0 * inverse, turned)), times(2.0 * inverse, curved), inverse, turned


@inlined
def _strain_rates(rho, p0, p, q0, q, drho, dp0, dp, dq0, dq, inverse, turned, kappa):
    """Time derivatives of Gamma and K."""
    shrink = 2.0 * inverse * (p0 * dp0 + dot(p, dp))  # sigma' / sigma
    once, rate = cross(rho, p), plus(cross(drho, p), cross(rho, dp))
    turning = plus(plus(times(dp0, once), times(p0, rate)), plus(cross(rate, p), cross(once, dp)))
    gamma = plus(drho, times(2.0 * inverse, minus(turning, times(shrink, turned))))
    curving = minus(plus(times(dp0, q), times(p0, dq)), plus(times(dq0, p), times(q0, dp)))
    curving = minus(curving, plus(cross(dp, q), cross(p, dq)))
    return gamma, minus(times(2.0 * inverse, curving), times(shrink, kappa))


@inlined
def full_product(c, u, v):
    """Both halves of C (u, v), with the upper triangle of C by rows."""
    return (
        (
            c[0] * u[0] + c[1] * u[1] + c[2] * u[2] + c[3] * v[0] + c[4] * v[1] + c[5] * v[2],
            c[1] * u[0] + c[6] * u[1] + c[7] * u[2] + c[8] * v[0] + c[9] * v[1] + c[10] * v[2],
            c[2] * u[0] + c[7] * u[1] + c[11] * u[2] + c[12] * v[0] + c[13] * v[1] + c[14] * v[2],
        ),
        (
            c[3] * u[0] + c[8] * u[1] + c[12] * u[2] + c[15] * v[0] + c[16] * v[1] + c[17] * v[2],
            c[4] * u[0] + c[9] * u[1] + c[13] * u[2] + c[16] * v[0] + c[18] * v[1] + c[19] * v[2],
            c[5] * u[0] + c[10] * u[1] + c[14] * u[2] + c[17] * v[0] + c[19] * v[1] + c[20] * v[2],
        ),
    )


@inlined
def _tangent(x, line, middle):
    """A vector in the middle node's frame."""
    m1, m2, m3 = _node(x, middle)
    return dot(m1, line), dot(m2, line), dot(m3, line)


class Part(NamedTuple):
    """Functions of an element that add forces, and that return kinetic energy, potential energy and power."""

    add: Callable[..., Any]
    energies: Callable[..., Any]


def _in_turn(functions: list[Callable[..., Any]]) -> Callable[..., Any]:
    """A function that calls all of them with its arguments."""
    first, *following = functions
    if not following:
        return first
    rest = _in_turn(following)

    @inlined
    def both(*arguments):
        first(*arguments)
        rest(*arguments)

    return both


def _summed(functions: list[Callable[..., Any]]) -> Callable[..., Any]:
    """A function that adds the three numbers that each of them returns."""
    first, *following = functions
    if not following:
        return first
    rest = _summed(following)

    @inlined
    def both(*arguments):
        return plus(first(*arguments), rest(*arguments))

    return both


def _quaternions(degree: int) -> Part:
    """Functions that fill the quaternions of the nodes, and their rates."""
    nodes, middle = degree + 1, degree // 2

    @inlined
    def fill_quaternions(x, quaternions):
        for i in range(nodes):
            g, p0, _ = _relative(x, i, middle)
            quaternions[4 * i] = p0
            quaternions[4 * i + 1], quaternions[4 * i + 2], quaternions[4 * i + 3] = times(p0, g)

    @inlined
    def fill_rates(x, v, quaternions, rates):
        # The middle frame is held: strains do not see a rigid motion, so each node may turn against it by its spin.
        for i in range(nodes):
            (a1, a2, a3), (b1, b2, b3) = _node(x, i), _node(v, i)
            w = _tangent(x, times(0.5, plus(plus(cross(a1, b1), cross(a2, b2)), cross(a3, b3))), middle)
            p0, p = quaternions[4 * i], at(quaternions, 4 * i + 1)
            rates[4 * i] = -0.5 * dot(p, w)
            rates[4 * i + 1], rates[4 * i + 2], rates[4 * i + 3] = times(0.5, minus(times(p0, w), cross(p, w)))

    return Part(fill_quaternions, fill_rates)


def _strained(degree: int) -> Part:
    """The forces and the energies of the strains."""
    nodes, middle, points = degree + 1, degree // 2, rule(degree, degree)

    # Each function is compiled once for all points: the points differ in its last arguments, which are constants.

    @inlined
    def stresses(x, v, quaternions, rates, delay, length, c, values, slopes, weight):
        """Strains at a point with what they follow from; rates; stress resultants times the weight."""
        across, size = 2.0 * reciprocal(length), weight * length
        p0, p = _weighed(values, quaternions)
        q0, q = _weighed(slopes, quaternions)
        q0, q = across * q0, times(across, q)
        line = times(across, _line(slopes, x, 0))
        rho = _tangent(x, line, middle)
        gamma, kappa, inverse, turned = _strains(rho, p0, p, q0, q)
        u, w = minus(gamma, (c[21], c[22], c[23])), minus(kappa, (c[24], c[25], c[26]))
        du, dw = times(0.0, gamma), times(0.0, kappa)
        if not is_zero(delay):
            dp0, dp = _weighed(values, rates)
            dq0, dq = _weighed(slopes, rates)
            dq0, dq = across * dq0, times(across, dq)
            drho = _tangent(x, times(across, _line(slopes, v, 0)), middle)
            du, dw = _strain_rates(rho, p0, p, q0, q, drho, dp0, dp, dq0, dq, inverse, turned, kappa)
        n, m = full_product(c, plus(u, times(delay, du)), plus(w, times(delay, dw)))
        return p0, p, q0, q, line, rho, inverse, gamma, kappa, times(size, n), times(size, m), u, w, du, dw

    @inner
    def add_strains(x, v, quaternions, rates, delay, length, forces, r, c, values, slopes, weight):
        """Forces on positions and on quaternions of a point of the strains."""
        p0, p, q0, q, line, rho, inverse, gamma, kappa, n, m, _, _, _, _ = stresses(
            x, v, quaternions, rates, delay, length, c, values, slopes, weight
        )
        # Derivatives of (n, m) . e by the quaternion (P0, p) and by its slope (Q0, q): see the top of the file.
        along, twice, work = dot(n, rho), 2.0 * inverse, dot(n, gamma) + dot(m, kappa)
        first = twice * (p0 * along + dot(n, cross(rho, p)) + dot(q, m) - work * p0)
        second = plus(times(-(along + work), p), times(dot(p, n), rho))
        second = plus(plus(second, times(dot(p, rho), n)), times(p0, cross(n, rho)))
        second = times(twice, plus(second, minus(cross(m, q), times(q0, m))))
        third, fourth = -twice * dot(p, m), times(twice, plus(times(p0, m), cross(p, m)))
        across = 2.0 * reciprocal(length)
        # The force in the middle frame, R(P) n, acts on the line; the line's tangent on the middle directors.
        once = cross(n, p)
        c1, c2, c3 = plus(n, times(twice, minus(cross(once, p), times(p0, once))))
        m1, m2, m3 = _node(x, middle)
        force = combined((c1, c2, c3), m1, m2, m3)
        for i in range(nodes):
            a, b = values[i], across * slopes[i]
            forces[4 * i] += a * first + b * third
            add_at(forces, 4 * i + 1, plus(times(a, second), times(b, fourth)))
            add_at(r, SLOTS * i, times(b, force))
        add_at(r, SLOTS * middle + 3, times(c1, line))
        add_at(r, SLOTS * middle + 6, times(c2, line))
        add_at(r, SLOTS * middle + 9, times(c3, line))

    @inner
    def strain_energies(x, v, quaternions, rates, delay, length, c, values, slopes, weight):
        """Strain energy, and the power of the material damping, behind a kinetic energy of zero."""
        _, _, _, _, _, _, _, _, _, _, _, u, w, du, dw = stresses(
            x, v, quaternions, rates, delay, length, c, values, slopes, weight
        )
        (n, m), (dn, dm), size = full_product(c, u, w), full_product(c, du, dw), weight * length
        stored = 0.5 * size * (dot(n, u) + dot(m, w))
        return 0.0 * stored, stored, -delay * size * (dot(dn, du) + dot(dm, dw))

    def at_point(g):
        """The forces and the energies of a point of the points."""
        section, weight, values, slopes = POINTS[g], points.weights[g], points.values[g], points.slopes[g]

        @inlined
        def add(x, v, quaternions, rates, p, forces, r):
            add_strains(x, v, quaternions, rates, p.delay, p.length, forces, r, section(p), values, slopes, weight)

        @inlined
        def energies(x, v, quaternions, rates, p):
            return strain_energies(x, v, quaternions, rates, p.delay, p.length, section(p), values, slopes, weight)

        return add, energies

    parts = [at_point(g) for g in range(degree)]
    return Part(_in_turn([add for add, _ in parts]), _summed([energies for _, energies in parts]))


def _heavy(degree: int) -> Part:
    """The inertia and the weight, and their energies."""
    nodes, points = degree + 1, rule(degree, degree + 1)

    @inlined
    def momenta(a, first, masses, values):
        """Momenta of a section on r, d2 and d3: P times their rates; ``first`` is that of r."""
        mass, first_2, first_3, second_22, second_23, second_33 = masses
        second, third = _line(values, a, 6), _line(values, a, 9)
        return (
            plus(times(mass, first), plus(times(first_2, second), times(first_3, third))),
            plus(times(first_2, first), plus(times(second_22, second), times(second_23, third))),
            plus(times(first_3, first), plus(times(second_23, second), times(second_33, third))),
        )

    @inner
    def add_inertia(v, a, drag, length, gravity, r, masses, values, weight):
        """Inertia and weight of a point, and damping by mass, proportional to the momenta themselves."""
        origin, second, third = momenta(a, minus(_line(values, a, 0), gravity), masses, values)
        slow_origin, slow_second, slow_third = momenta(v, _line(values, v, 0), masses, values)
        for i in range(nodes):
            size, k = weight * length * values[i], SLOTS * i
            add_at(r, k, times(size, plus(origin, times(drag, slow_origin))))
            add_at(r, k + 6, times(size, plus(second, times(drag, slow_second))))
            add_at(r, k + 9, times(size, plus(third, times(drag, slow_third))))

    @inner
    def inertia_energies(x, v, drag, length, gravity, masses, values, weight):
        """Kinetic energy, energy of the weight, power of the damping by mass."""
        rates, size = (_line(values, v, 0), _line(values, v, 6), _line(values, v, 9)), weight * length
        origin, second, third = momenta(v, rates[0], masses, values)
        moving = size * (dot(origin, rates[0]) + dot(second, rates[1]) + dot(third, rates[2]))
        centre = plus(times(masses[0], _line(values, x, 0)), times(masses[1], _line(values, x, 6)))
        centre = plus(centre, times(masses[2], _line(values, x, 9)))
        return 0.5 * moving, -size * dot(gravity, centre), -drag * moving

    def at_point(g):
        """The forces and the energies of a point of the inertia."""
        mass, values, weight = INERTIAS[g], points.values[g], points.weights[g]

        @inlined
        def add(v, a, p, gravity, r):
            add_inertia(v, a, p.mass_damping, p.length, gravity, r, mass(p), values, weight)

        @inlined
        def energies(x, v, p, gravity):
            return inertia_energies(x, v, p.mass_damping, p.length, gravity, mass(p), values, weight)

        return add, energies

    parts = [at_point(g) for g in range(degree + 1)]
    return Part(_in_turn([add for add, _ in parts]), _summed([energies for _, energies in parts]))


def _functions(degree: int) -> Part:
    """The residual and the energies of an element of a degree."""
    nodes, middle, entries = degree + 1, degree // 2, 4 * (degree + 1)
    fill_quaternions, fill_rates = _quaternions(degree)
    add_strains, strain_energies = _strained(degree)
    add_inertia, inertia_energies = _heavy(degree)

    @inner
    def residual(x, v, a, p, m, inputs, r):
        """M a + elastic and damping forces - weight."""
        quaternions, rates, forces = stack(x, entries), stack(x, entries), stack(x, entries)
        fill_quaternions(x, quaternions)
        if not is_zero(p.delay):
            fill_rates(x, v, quaternions, rates)
        for k in range(entries):
            forces[k] = 0.0 * p.length
        add_strains(x, v, quaternions, rates, p, forces, r)
        for i in range(nodes):
            if i != middle:
                _to_directors(x, i, middle, forces[4 * i : 4 * i + 4], r)
        add_inertia(v, a, p, (p.gravity_x, p.gravity_y, p.gravity_z), r)

    @inner
    def energy(x, v, p, m, inputs):
        """Kinetic energy, strain and gravity energy, power of the damping."""
        quaternions, rates = stack(x, entries), stack(x, entries)
        fill_quaternions(x, quaternions)
        if not is_zero(p.delay):
            fill_rates(x, v, quaternions, rates)
        stored = strain_energies(x, v, quaternions, rates, p)
        return plus(stored, inertia_energies(x, v, p, (p.gravity_x, p.gravity_y, p.gravity_z)))

    return Part(residual, energy)


def _kind(degree: int) -> Kind:
    """The kind of elements of a degree."""
    functions = _functions(degree)
    return Kind(
        f"beam_in_space_{degree}",
        coordinates=SLOTS * (degree + 1),
        numbers=("length", *columns(degree), "delay", "mass_damping", "gravity_x", "gravity_y", "gravity_z"),
        residual=functions.add,
        energy=functions.energies,
        lengths=("length",),
        gravity=("gravity_x", "gravity_y", "gravity_z"),
        dissipates=("delay", "mass_damping"),
        charts=POSE * (degree + 1),
        strains=partial(element_strains, degree),
        references=reference_columns(degree),
        is_usual=degree in USUAL,
        home=__name__,
    )


LINEAR, QUADRATIC, CUBIC, QUARTIC = BEAMS = tuple(map(_kind, range(1, MOST_DEGREE + 1)))
"""Kinds of beam elements by their degree, less one."""
