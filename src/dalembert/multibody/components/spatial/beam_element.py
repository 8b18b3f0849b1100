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
from dalembert.multibody.components.spatial.beam_geometry import (
    add_to_line,
    add_to_quaternions,
    directors_of,
    fill_quaternion,
    full_product,
    in_middle_frame,
    line_sum,
    on_directors,
    on_products,
    products,
    strain_rates,
    strains_of,
    weighed,
)
from dalembert.multibody.components.spatial.beam_kinematics import element_strains
from dalembert.multibody.components.spatial.beam_mean_forces import MeanForces, mean_forces
from dalembert.multibody.components.spatial.beam_shapes import rule
from dalembert.multibody.components.spatial.directors import POSE
from dalembert.multibody.components.spatial.function_chains import in_turn, summed
from dalembert.multibody.components.spatial.spatial_markers import SLOTS
from dalembert.multibody.components.spatial.vectors import add_at, at, cross, dot, minus, plus, times
from dalembert.multibody.kernels.elementary import is_zero, reciprocal
from dalembert.multibody.kernels.kind import Kind

MOST_DEGREE = 4
USUAL = (2, 3)
"""Degrees whose kernels are compiled ahead."""


class Part(NamedTuple):
    """Functions of an element that add forces, and that return kinetic energy, potential energy and power."""

    add: Callable[..., Any]
    energies: Callable[..., Any]


def _quaternions(degree: int) -> Part:
    """Functions that fill the quaternions of the nodes, and their rates."""
    nodes, middle = degree + 1, degree // 2

    @inlined
    def fill_quaternions(x, quaternions):
        for i in range(nodes):
            fill_quaternion(products(x, i, middle), i, quaternions)

    @inlined
    def fill_rates(x, v, quaternions, rates):
        # The middle frame is held: strains do not see a rigid motion, so each node may turn against it by its spin.
        for i in range(nodes):
            (a1, a2, a3), (b1, b2, b3) = directors_of(x, i), directors_of(v, i)
            w = in_middle_frame(x, times(0.5, plus(plus(cross(a1, b1), cross(a2, b2)), cross(a3, b3))), middle)
            p0, p = quaternions[4 * i], at(quaternions, 4 * i + 1)
            rates[4 * i] = -0.5 * dot(p, w)
            rates[4 * i + 1], rates[4 * i + 2], rates[4 * i + 3] = times(0.5, minus(times(p0, w), cross(p, w)))

    return Part(fill_quaternions, fill_rates)


def _strained(degree: int) -> Part:
    """The forces and the energies of the strains."""
    middle, points = degree // 2, rule(degree, degree)

    # Each function is compiled once for all points: the points differ in its last arguments, which are constants.

    @inlined
    def stresses(x, v, quaternions, rates, delay, length, c, values, slopes, weight):
        """Strains at a point with what they follow from; rates; stress resultants times the weight."""
        across, size = 2.0 * reciprocal(length), weight * length
        p0, p = weighed(values, quaternions)
        q0, q = weighed(slopes, quaternions)
        q0, q = across * q0, times(across, q)
        line = times(across, line_sum(slopes, x, 0))
        rho = in_middle_frame(x, line, middle)
        gamma, kappa, inverse, turned = strains_of(rho, p0, p, q0, q)
        u, w = minus(gamma, (c[21], c[22], c[23])), minus(kappa, (c[24], c[25], c[26]))
        du, dw = times(0.0, gamma), times(0.0, kappa)
        if not is_zero(delay):
            dp0, dp = weighed(values, rates)
            dq0, dq = weighed(slopes, rates)
            dq0, dq = across * dq0, times(across, dq)
            drho = in_middle_frame(x, times(across, line_sum(slopes, v, 0)), middle)
            du, dw = strain_rates(rho, p0, p, q0, q, drho, dp0, dp, dq0, dq, inverse, turned, kappa)
        n, m = full_product(c, plus(u, times(delay, du)), plus(w, times(delay, dw)))
        return p0, p, q0, q, line, rho, inverse, gamma, kappa, times(size, n), times(size, m), u, w, du, dw

    @inner
    def add_strains(x, v, quaternions, rates, delay, length, forces, r, c, values, slopes, weight):
        """Forces on positions and on quaternions of a point of the strains."""
        p0, p, q0, q, line, rho, inverse, gamma, kappa, n, m, _, _, _, _ = stresses(
            x, v, quaternions, rates, delay, length, c, values, slopes, weight
        )
        across = 2.0 * reciprocal(length)
        on_line = add_to_quaternions(p0, p, q0, q, rho, inverse, gamma, kappa, n, m, across, forces, values, slopes)
        add_to_line(x, on_line, line, across, r, slopes, middle)

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
    return Part(in_turn([add for add, _ in parts]), summed([energies for _, energies in parts]))


def _heavy(degree: int) -> Part:
    """The inertia and the weight, and their energies."""
    nodes, points = degree + 1, rule(degree, degree + 1)

    @inlined
    def momenta(a, first, masses, values):
        """Momenta of a section on r, d2 and d3: P times their rates; ``first`` is that of r."""
        mass, first_2, first_3, second_22, second_23, second_33 = masses
        second, third = line_sum(values, a, 6), line_sum(values, a, 9)
        return (
            plus(times(mass, first), plus(times(first_2, second), times(first_3, third))),
            plus(times(first_2, first), plus(times(second_22, second), times(second_23, third))),
            plus(times(first_3, first), plus(times(second_23, second), times(second_33, third))),
        )

    @inner
    def add_inertia(v, a, drag, length, gravity, r, masses, values, weight):
        """Inertia and weight of a point, and damping by mass, proportional to the momenta themselves."""
        origin, second, third = momenta(a, minus(line_sum(values, a, 0), gravity), masses, values)
        slow_origin, slow_second, slow_third = momenta(v, line_sum(values, v, 0), masses, values)
        for i in range(nodes):
            size, k = weight * length * values[i], SLOTS * i
            add_at(r, k, times(size, plus(origin, times(drag, slow_origin))))
            add_at(r, k + 6, times(size, plus(second, times(drag, slow_second))))
            add_at(r, k + 9, times(size, plus(third, times(drag, slow_third))))

    @inner
    def inertia_energies(x, v, drag, length, gravity, masses, values, weight):
        """Kinetic energy, energy of the weight, power of the damping by mass."""
        rates, size = (line_sum(values, v, 0), line_sum(values, v, 6), line_sum(values, v, 9)), weight * length
        origin, second, third = momenta(v, rates[0], masses, values)
        moving = size * (dot(origin, rates[0]) + dot(second, rates[1]) + dot(third, rates[2]))
        centre = plus(times(masses[0], line_sum(values, x, 0)), times(masses[1], line_sum(values, x, 6)))
        centre = plus(centre, times(masses[2], line_sum(values, x, 9)))
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
    return Part(in_turn([add for add, _ in parts]), summed([energies for _, energies in parts]))


def _functions(degree: int) -> tuple[Part, MeanForces]:
    """The residual and the energies of an element of a degree, and its mean forces in a step."""
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
                on_directors(x, i, middle, on_products(products(x, i, middle), forces[4 * i : 4 * i + 4]), r)
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

    return Part(residual, energy), mean_forces(degree, add_inertia, inertia_energies)


def _kind(degree: int) -> Kind:
    """The kind of elements of a degree."""
    functions, mean = _functions(degree)
    return Kind(
        f"beam_in_space_{degree}",
        coordinates=SLOTS * (degree + 1),
        numbers=("length", *columns(degree), "delay", "mass_damping", "gravity_x", "gravity_y", "gravity_z"),
        residual=functions.add,
        energy=functions.energies,
        mean=mean.add,
        mean_power=mean.power,
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
