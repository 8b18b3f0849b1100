"""Mean forces of a beam element in a step: their work is the change of the strain energy, and what damping takes.

Between the ends of a step directors are shorter than one, so strains of its middle are off in proportion to the square
of the step, and stiff beams push back. The strains are functions of invariants pi, quadratic in the coordinates: the
products T of the outer nodes, and rho at the points. The discrete gradient (Gonzalez 1996) in these is

    f = C ((e1 + e0) / 2 - e_ref + delay (e1 - e0) / step),   D = f e'(pi_m) + s (pi1 - pi0),

with pi_m = (pi1 + pi0) / 2 and the number s for which D (pi1 - pi0) = f (e1 - e0), summed over the points. The forces
are D pi'(q_m): since pi is quadratic, pi'(q_m) (q1 - q0) = pi1 - pi0. Rigid motions change no invariant, so both
momenta are kept, too.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

from dalembert.kernels.kernel import inlined, inner
from dalembert.kernels.views import stack
from dalembert.multibody.components.spatial.beam_columns import POINTS
from dalembert.multibody.components.spatial.beam_geometry import (
    add_to_line,
    add_to_quaternions,
    fill_quaternion,
    full_product,
    in_middle_frame,
    line_sum,
    on_directors,
    on_products,
    products,
    strains_of,
    weighed,
)
from dalembert.multibody.components.spatial.beam_shapes import rule
from dalembert.multibody.components.spatial.discrete_gradient import along_change
from dalembert.multibody.components.spatial.function_chains import in_turn, summed
from dalembert.multibody.components.spatial.spatial_markers import SLOTS
from dalembert.multibody.components.spatial.vectors import at, dot, minus, plus, times
from dalembert.multibody.kernels.elementary import reciprocal


class MeanForces(NamedTuple):
    """Functions of a kind: the mean forces, and the power of those without a potential."""

    add: Callable[..., Any]
    power: Callable[..., Any]


class _Points(NamedTuple):
    """Functions that add up over the points of an element: forces, forces on the line, and power of the damping."""

    forces: Callable[..., Any]
    lines: Callable[..., Any]
    losses: Callable[..., Any]


def _points(degree: int) -> _Points:
    """The functions of the points of an element of a degree."""
    middle, points = degree // 2, rule(degree, degree)

    @inlined
    def strained(x, quaternions, across, values, slopes):
        """Strains at a point, with what they follow from."""
        p0, p = weighed(values, quaternions)
        q0, q = weighed(slopes, quaternions)
        q0, q = across * q0, times(across, q)
        rho = in_middle_frame(x, times(across, line_sum(slopes, x, 0)), middle)
        gamma, kappa, _, _ = strains_of(rho, p0, p, q0, q)
        return rho, gamma, kappa

    @inner
    def add_point(x0, x1, first, last, mean, delay, length, step, forces, on_lines, g, c, values, slopes, weight):
        """Forces on the quaternions, and on rho behind ``on_lines[3 g]``; what their work misses, |change of rho|^2."""
        across, size = 2.0 * reciprocal(length), weight * length
        rho0, gamma0, kappa0 = strained(x0, first, across, values, slopes)
        rho1, gamma1, kappa1 = strained(x1, last, across, values, slopes)
        du, dw = minus(gamma1, gamma0), minus(kappa1, kappa0)
        u = minus(times(0.5, plus(gamma1, gamma0)), (c[21], c[22], c[23]))
        w = minus(times(0.5, plus(kappa1, kappa0)), (c[24], c[25], c[26]))
        rate = delay / step
        n, m = full_product(c, plus(u, times(rate, du)), plus(w, times(rate, dw)))
        n, m = times(size, n), times(size, m)
        # The gradient of the strains is that at the mean of the invariants, where f is the mean stress.
        p0, p = weighed(values, mean)
        q0, q = weighed(slopes, mean)
        q0, q = across * q0, times(across, q)
        rho = times(0.5, plus(rho1, rho0))
        gamma, kappa, inverse, _ = strains_of(rho, p0, p, q0, q)
        on_line = add_to_quaternions(p0, p, q0, q, rho, inverse, gamma, kappa, n, m, across, forces, values, slopes)
        drho = minus(rho1, rho0)
        on_lines[3 * g], on_lines[3 * g + 1], on_lines[3 * g + 2] = on_line
        missing = dot(n, du) + dot(m, dw) - dot(on_line, drho)
        return missing, dot(drho, drho), 0.0 * missing

    @inner
    def add_line(x, x0, x1, length, on_lines, share, r, g, slopes):
        """Pass the force on rho at a point to the line, with its part along the change of rho."""
        across = 2.0 * reciprocal(length)
        line = times(across, line_sum(slopes, x, 0))
        rho0 = in_middle_frame(x0, times(across, line_sum(slopes, x0, 0)), middle)
        rho1 = in_middle_frame(x1, times(across, line_sum(slopes, x1, 0)), middle)
        force = plus(at(on_lines, 3 * g), times(share, minus(rho1, rho0)))
        add_to_line(x, force, line, across, r, slopes, middle)

    @inner
    def point_loss(x0, x1, first, last, delay, length, step, c, values, slopes, weight):
        """Power of the damping at a point, behind two zeros: -delay C (e1 - e0) . (e1 - e0) / step^2."""
        across = 2.0 * reciprocal(length)
        _, gamma0, kappa0 = strained(x0, first, across, values, slopes)
        _, gamma1, kappa1 = strained(x1, last, across, values, slopes)
        du, dw = minus(gamma1, gamma0), minus(kappa1, kappa0)
        n, m = full_product(c, du, dw)
        loss = -delay * weight * length / (step * step) * (dot(n, du) + dot(m, dw))
        return 0.0 * loss, 0.0 * loss, loss

    def at_point(g):
        section, weight, values, slopes = POINTS[g], points.weights[g], points.values[g], points.slopes[g]

        @inlined
        def forces_of(x0, x1, first, last, mean, p, step, forces, on_lines):
            return add_point(
                x0, x1, first, last, mean, p.delay, p.length, step, forces, on_lines, g, section(p), values, slopes,
                weight,
            )  # fmt: skip

        @inlined
        def lines_of(x, x0, x1, length, on_lines, share, r):
            add_line(x, x0, x1, length, on_lines, share, r, g, slopes)

        @inlined
        def loss_of(x0, x1, first, last, p, step):
            return point_loss(x0, x1, first, last, p.delay, p.length, step, section(p), values, slopes, weight)

        return forces_of, lines_of, loss_of

    forces, lines, losses = zip(*(at_point(g) for g in range(degree)), strict=True)
    return _Points(summed(list(forces)), in_turn(list(lines)), summed(list(losses)))


def mean_forces(degree: int, add_inertia: Callable[..., Any], inertia_energies: Callable[..., Any]) -> MeanForces:
    """The mean forces of elements of a degree.

    ``add_inertia`` and ``inertia_energies``: functions of their inertia and weight.
    """
    nodes, middle = degree + 1, degree // 2
    all_forces, all_lines, all_losses = _points(degree)
    width, entries, lines = SLOTS * nodes, 4 * nodes, 3 * degree

    @inlined
    def fill_ends(x, v, step, x0, x1):
        for i in range(width):
            # The midpoint rule moves coordinates by step v, so that both ends are known from its middle.
            x0[i], x1[i] = x[i] - 0.5 * step * v[i], x[i] + 0.5 * step * v[i]

    @inner
    def mean(x, v, a, p, m, inputs, step, r):
        """M a + mean elastic and damping forces of the step - weight."""
        x0, x1 = stack(x, width), stack(x, width)
        fill_ends(x, v, step, x0, x1)
        first, last, between = stack(x, entries), stack(x, entries), stack(x, entries)
        forces, on_lines = stack(x, entries), stack(x, lines)
        for k in range(entries):
            forces[k] = 0.0 * x[0]
        for i in range(nodes):
            (a1, a2, a3), (b1, b2, b3) = products(x0, i, middle), products(x1, i, middle)
            fill_quaternion((a1, a2, a3), i, first)
            fill_quaternion((b1, b2, b3), i, last)
            fill_quaternion((times(0.5, plus(a1, b1)), times(0.5, plus(a2, b2)), times(0.5, plus(a3, b3))), i, between)
        missing, change, _ = all_forces(x0, x1, first, last, between, p, step, forces, on_lines)
        # First what the gradient at the mean of the invariants misses of the work, then that part along their change.
        for i in range(nodes):
            if i != middle:
                (a1, a2, a3), (b1, b2, b3) = products(x0, i, middle), products(x1, i, middle)
                t = times(0.5, plus(a1, b1)), times(0.5, plus(a2, b2)), times(0.5, plus(a3, b3))
                y1, y2, y3 = on_products(t, forces[4 * i : 4 * i + 4])
                d1, d2, d3 = minus(b1, a1), minus(b2, a2), minus(b3, a3)
                missing -= dot(y1, d1) + dot(y2, d2) + dot(y3, d3)
                change += dot(d1, d1) + dot(d2, d2) + dot(d3, d3)
        share = along_change(missing, change)
        for i in range(nodes):
            if i != middle:
                (a1, a2, a3), (b1, b2, b3) = products(x0, i, middle), products(x1, i, middle)
                t = times(0.5, plus(a1, b1)), times(0.5, plus(a2, b2)), times(0.5, plus(a3, b3))
                y1, y2, y3 = on_products(t, forces[4 * i : 4 * i + 4])
                y1, y2 = plus(y1, times(share, minus(b1, a1))), plus(y2, times(share, minus(b2, a2)))
                on_directors(x, i, middle, (y1, y2, plus(y3, times(share, minus(b3, a3)))), r)
        all_lines(x, x0, x1, p.length, on_lines, share, r)
        add_inertia(v, a, p, (p.gravity_x, p.gravity_y, p.gravity_z), r)

    @inner
    def power(x, v, p, m, inputs, step):
        """Power of the damping by the material and by the mass, as the mean forces have it."""
        x0, x1, first, last = stack(x, width), stack(x, width), stack(x, entries), stack(x, entries)
        fill_ends(x, v, step, x0, x1)
        for i in range(nodes):
            fill_quaternion(products(x0, i, middle), i, first)
            fill_quaternion(products(x1, i, middle), i, last)
        _, _, by_material = all_losses(x0, x1, first, last, p, step)
        _, _, by_mass = inertia_energies(x, v, p, (p.gravity_x, p.gravity_y, p.gravity_z))
        return by_material + by_mass

    return MeanForces(mean, power)
