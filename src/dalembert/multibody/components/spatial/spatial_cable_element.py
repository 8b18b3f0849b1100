"""The cable element in space: a line that stretches and bends, without shear, torsion and inertia of its sections.

It is the planar gradient-deficient element (Gerstmayr and Shabana 2006) with a vector of curvature. Local coordinates:
(r, r') at both nodes, 12 in all. With f = r' and c = r'', the stretch is |f| - 1 - its value without stress, and the
curvature kappa = (f x c) / f.f is across the line; the stored energy is the integral of EA stretch^2 / 2 and
EI kappa.kappa / 2.

Material damping: stress = C (strain + tau strain rate). The rate of curvature is taken in sections that do not spin
about the line, which is kappa' without its part along f. Its virtual work is that of kappa itself, since a moment m
across the line does none along it: m.(delta kappa) = [delta f.(c x m - 2 (m.kappa) f) + delta c.(m x f)] / f.f. A spin
about the line is damped: without torsion nothing says whether sections follow it. As if guides held the sections, the
damping then has a moment tau EI kappa.kappa times the spin, about the line.
"""

import numpy as np

from dalembert.kernels.kernel import inlined, inner
from dalembert.kernels.views import stack
from dalembert.multibody.components import hermite
from dalembert.multibody.components.hermite import A1, A2, A5, AW, B1, B2, B5, BW, C1, C2, C5
from dalembert.multibody.components.spatial.discrete_gradient import along_change
from dalembert.multibody.components.spatial.vectors import add_at, at, cross, dot, minus, plus, times
from dalembert.multibody.kernels.elementary import is_zero, reciprocal, root
from dalembert.multibody.kernels.kind import Kind

NODE = 6
"""Coordinates of a node."""
WIDTH = 2 * NODE


@inlined
def _line(s1, s2, s5, x):
    """s1 (r1 - r2) + s2 r1' + s5 r2'."""
    return plus(plus(times(s1, minus(at(x, 0), at(x, 6))), times(s2, at(x, 3))), times(s5, at(x, 9)))


@inlined
def _curvature(f, c):
    """Curvature, and 1 / f.f."""
    square = reciprocal(dot(f, f))
    return times(square, cross(f, c)), square


@inlined
def _curvature_rate(f, c, df, dc, kappa, square):
    """Rate of the curvature across the line: (f' x c + f x c') / f.f - 2 kappa f.f' / f.f + f (f'.kappa) / f.f."""
    turning = plus(plus(cross(df, c), cross(f, dc)), times(dot(df, kappa), f))
    return times(square, minus(turning, times(2.0 * dot(f, df), kappa)))


@inlined
def _spread(first, second, fifth, r):
    """Pass forces against r1 - r2, r1' and r2' to the nodes."""
    add_at(r, 0, first)
    add_at(r, 3, second)
    add_at(r, 6, times(-1.0, first))
    add_at(r, 9, fifth)


@inlined
def _gathered(total, s, on_slope, c, on_bend):
    """A sum over points with forces on r' and r'' at one more."""
    return plus(total, plus(times(s, on_slope), times(c, on_bend)))


@inlined
def _bent(moment, f, c, kappa):
    """Forces on f and on c of a moment over f.f."""
    return minus(cross(c, moment), times(2.0 * dot(moment, kappa), f)), cross(moment, f)


@inlined
def _add_inertia(v, a, p, r):
    """M (a + drag v) - weight."""
    gravity = (p.gravity_x, p.gravity_y, p.gravity_z)
    for i in range(3):
        hermite.inertia(p.mass, p.length, i, i + 3, i + 6, i + 9, a, r)
        hermite.inertia(p.mass * p.mass_damping, p.length, i, i + 3, i + 6, i + 9, v, r)
        hermite.weight(p.mass, p.length, gravity[i], i, i + 3, i + 6, i + 9, r)


@inner
def residual(x, v, a, p, m, inputs, r):
    """M (a + drag v) + elastic and damping forces - weight."""
    h, delay = p.length, p.delay
    across, rests = reciprocal(h), (p.rest_1, p.rest_2, p.rest_3)
    # Sums over points of the force against r1 - r2, r1' and r2'.
    zero = times(0.0, at(x, 0))
    first, second, fifth = zero, zero, zero
    # Stretch at Lobatto's points; its force acts along the line.
    for g in range(3):
        s1, s2, s5 = A1[g] * across, A2[g], A5[g]
        f = _line(s1, s2, s5, x)
        inverse = reciprocal(root(dot(f, f)))
        # (|f| - 1 - rest) / |f|, so that the force along f needs no division by |f|.
        strain = 1.0 - (1.0 + rests[g]) * inverse
        if not is_zero(delay):
            strain += delay * dot(f, _line(s1, s2, s5, v)) * inverse * inverse
        force = times(AW[g] * h * p.axial * strain, f)
        first = plus(first, times(s1, force))
        second, fifth = plus(second, times(s2, force)), plus(fifth, times(s5, force))
    # Bending at Gauss' points; its moment acts on r' and on r''.
    for g in range(3):
        s1, s2, s5 = B1[g] * across, B2[g], B5[g]
        c1, c2, c5 = C1[g] * across * across, C2[g] * across, C5[g] * across
        f, c = _line(s1, s2, s5, x), _line(c1, c2, c5, x)
        kappa, square = _curvature(f, c)
        moment = kappa
        if not is_zero(delay):
            rate = _curvature_rate(f, c, _line(s1, s2, s5, v), _line(c1, c2, c5, v), kappa, square)
            moment = plus(kappa, times(delay, rate))
        # 1 / f.f of the virtual work goes into the moment once, for both forces.
        on_slope, on_bend = _bent(times(BW[g] * h * p.bending * square, moment), f, c, kappa)
        first = _gathered(first, s1, on_slope, c1, on_bend)
        second, fifth = _gathered(second, s2, on_slope, c2, on_bend), _gathered(fifth, s5, on_slope, c5, on_bend)
    _spread(first, second, fifth, r)
    _add_inertia(v, a, p, r)


@inner
def energy(x, v, p, m, inputs):
    """Kinetic energy, strain and gravity energy, power of the damping."""
    h, delay, mass = p.length, p.delay, p.mass
    across, rests = reciprocal(h), (p.rest_1, p.rest_2, p.rest_3)
    gravity = (p.gravity_x, p.gravity_y, p.gravity_z)
    kinetic = 0.0 * h * x[0]
    potential, power = kinetic, kinetic
    for i in range(3):
        kinetic += hermite.kinetic(mass, h, i, i + 3, i + 6, i + 9, v)
        potential -= mass * gravity[i] * hermite.centre(h, i, i + 3, i + 6, i + 9, x)
    power -= 2.0 * p.mass_damping * kinetic
    for g in range(3):
        s1, s2, s5 = A1[g] * across, A2[g], A5[g]
        f, df = _line(s1, s2, s5, x), _line(s1, s2, s5, v)
        size = root(dot(f, f))
        strain, rate = size - 1.0 - rests[g], dot(f, df) / size
        stiffness = AW[g] * h * p.axial
        potential += 0.5 * stiffness * strain * strain
        power -= delay * stiffness * rate * rate
    for g in range(3):
        s1, s2, s5 = B1[g] * across, B2[g], B5[g]
        c1, c2, c5 = C1[g] * across * across, C2[g] * across, C5[g] * across
        f, c = _line(s1, s2, s5, x), _line(c1, c2, c5, x)
        kappa, square = _curvature(f, c)
        rate = _curvature_rate(f, c, _line(s1, s2, s5, v), _line(c1, c2, c5, v), kappa, square)
        stiffness = BW[g] * h * p.bending
        potential += 0.5 * stiffness * dot(kappa, kappa)
        power -= delay * stiffness * dot(rate, rate)
    return kinetic, potential, power


@inlined
def _invariants(f, c, h):
    """f.f, f.c h and c.c h^2, which are quadratic in the coordinates; h^2 kappa.kappa, their function."""
    a, b, d = dot(f, f), h * dot(f, c), h * h * dot(c, c)
    return (a, b, d), (a * d - b * b) / (a * a)


@inlined
def _discrete_gradient(start, end, before, after):
    """Gradient of h^2 kappa.kappa whose product with the change of the invariants is its change (Gonzalez 1996)."""
    change = minus(end, start)
    a, b, d = times(0.5, plus(start, end))
    inverse = reciprocal(a * a)
    mean = ((d - 2.0 * (a * d - b * b) * reciprocal(a)) * inverse, -2.0 * b * inverse, a * inverse)
    missing = after - before - dot(mean, change)
    return plus(mean, times(along_change(missing, dot(change, change)), change))


@inlined
def _fill_ends(x, v, step, x0, x1):
    """Coordinates of both ends of a step, by those of its middle."""
    for i in range(WIDTH):
        x0[i], x1[i] = x[i] - 0.5 * step * v[i], x[i] + 0.5 * step * v[i]


@inner
def mean_power(x, v, p, m, inputs, step):
    """Power of the damping, as the mean forces have it: of the stretch by its change in the step."""
    h, across, x0, x1 = p.length, reciprocal(p.length), stack(x, WIDTH), stack(x, WIDTH)
    _fill_ends(x, v, step, x0, x1)
    _, _, power = energy(x, v, p, m, inputs)
    for g in range(3):
        s1, s2, s5 = A1[g] * across, A2[g], A5[g]
        f, df, f0, f1 = _line(s1, s2, s5, x), _line(s1, s2, s5, v), _line(s1, s2, s5, x0), _line(s1, s2, s5, x1)
        rate, mean_rate = dot(f, df) / root(dot(f, f)), (root(dot(f1, f1)) - root(dot(f0, f0))) / step
        power += p.delay * AW[g] * h * p.axial * (rate * rate - mean_rate * mean_rate)
    return power


@inner
def mean(x, v, a, p, m, inputs, step, r):
    """As `residual`, with mean elastic forces in a step, whose work is the change of the strain energy.

    Stretch: (|f1| - |f0|) = 2 f_m.(f1 - f0) / (|f1| + |f0|). Bending: the discrete gradient in three invariants.
    """
    h, delay = p.length, p.delay
    across, rests = reciprocal(h), (p.rest_1, p.rest_2, p.rest_3)
    x0, x1 = stack(x, WIDTH), stack(x, WIDTH)
    _fill_ends(x, v, step, x0, x1)
    zero = times(0.0, at(x, 0))
    first, second, fifth = zero, zero, zero
    for g in range(3):
        s1, s2, s5 = A1[g] * across, A2[g], A5[g]
        f, f0, f1 = _line(s1, s2, s5, x), _line(s1, s2, s5, x0), _line(s1, s2, s5, x1)
        # |f1| - |f0| = (f1.f1 - f0.f0) / (|f1| + |f0|): no difference of roots in the force.
        size0, size1 = root(dot(f0, f0)), root(dot(f1, f1))
        strain = 0.5 * (size0 + size1) - 1.0 - rests[g] + delay / step * (size1 - size0)
        force = times(2.0 * AW[g] * h * p.axial * strain * reciprocal(size0 + size1), f)
        first = plus(first, times(s1, force))
        second, fifth = plus(second, times(s2, force)), plus(fifth, times(s5, force))
    for g in range(3):
        s1, s2, s5 = B1[g] * across, B2[g], B5[g]
        c1, c2, c5 = C1[g] * across * across, C2[g] * across, C5[g] * across
        f, c, size = _line(s1, s2, s5, x), _line(c1, c2, c5, x), BW[g] * h * p.bending
        start, before = _invariants(_line(s1, s2, s5, x0), _line(c1, c2, c5, x0), h)
        end, after = _invariants(_line(s1, s2, s5, x1), _line(c1, c2, c5, x1), h)
        by_a, by_b, by_d = times(0.5 * size * across * across, _discrete_gradient(start, end, before, after))
        on_slope = plus(times(2.0 * by_a, f), times(h * by_b, c))
        on_bend = plus(times(2.0 * h * h * by_d, c), times(h * by_b, f))
        # The damping of bending is that of the middle: its moment turns with the line, and no invariant has its rate.
        if not is_zero(delay):
            kappa, square = _curvature(f, c)
            rate = _curvature_rate(f, c, _line(s1, s2, s5, v), _line(c1, c2, c5, v), kappa, square)
            more_slope, more_bend = _bent(times(delay * size * square, rate), f, c, kappa)
            on_slope, on_bend = plus(on_slope, more_slope), plus(on_bend, more_bend)
        first = _gathered(first, s1, on_slope, c1, on_bend)
        second, fifth = _gathered(second, s2, on_slope, c2, on_bend), _gathered(fifth, s5, on_slope, c5, on_bend)
    _spread(first, second, fifth, r)
    _add_inertia(v, a, p, r)


def stretches(x: np.ndarray, length: np.ndarray) -> np.ndarray:
    """|r'| - 1 at the points of the stretch, (elements, 3), from coordinates (elements, 12) and lengths, m."""
    (r1, t1, r2, t2), h = np.moveaxis(x.reshape(len(x), 4, 3), 1, 0), np.asarray(length)[:, None]
    slopes = [A1[g] / h * (r1 - r2) + A2[g] * t1 + A5[g] * t2 for g in range(3)]
    return np.sqrt(np.stack([np.sum(slope * slope, axis=-1) for slope in slopes], axis=-1)) - 1.0


CABLE = Kind(
    "cable_in_space",
    coordinates=WIDTH,
    numbers=(
        "length", "axial", "bending", "rest_1", "rest_2", "rest_3", "mass", "delay", "mass_damping", "gravity_x",
        "gravity_y", "gravity_z",
    ),
    residual=residual,
    mean=mean,
    mean_power=mean_power,
    energy=energy,
    lengths=("length",),
    gravity=("gravity_x", "gravity_y", "gravity_z"),
    dissipates=("delay", "mass_damping"),
    strains=stretches,
    references=("rest_1", "rest_2", "rest_3"),
)  # fmt: skip
