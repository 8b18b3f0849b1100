"""The gradient-deficient planar ANCF cable element (Gerstmayr and Shabana 2006): an Euler-Bernoulli beam.

Local coordinates: (r, r') at both nodes, 8 in all. Axial strain |r'| - 1 at Lobatto's three points, where a bent
element leaves it at zero, so that it does not lock; curvature (r' x r'')/|r'|^2 at Gauss' three points.

Numbers: length h, axial stiffness EA, bending stiffness EI, mass, retardation time of the material damping, gravity.
"""

from dalembert.kernels.kernel import inlined, inner
from dalembert.multibody.components import hermite
from dalembert.multibody.components.hermite import A1, A2, A5, AW, B1, B2, B5, BW, C1, C2, C5
from dalembert.multibody.components.planar.line_bending import curvature
from dalembert.multibody.kernels.elementary import is_zero, reciprocal, root
from dalembert.multibody.kernels.kind import Kind

WIDTH = 8


@inlined
def _line(s1, s2, s5, x):
    """s1 (r1 - r2) + s2 r1' + s5 r2', both components."""
    return s1 * (x[0] - x[4]) + s2 * x[2] + s5 * x[6], s1 * (x[1] - x[5]) + s2 * x[3] + s5 * x[7]


@inlined
def residual(x, v, a, p, m, inputs, r):
    """M a + elastic and damping forces - weight."""
    h, axial, bending, mass, delay = p.length, p.axial, p.bending, p.mass, p.delay
    across = reciprocal(h)
    # Sums over points of the force against r1 - r2, r1' and r2'; in local variables, which is twice as fast.
    nothing = 0.0 * h
    fx, fy, gx, gy, kx, ky = nothing, nothing, nothing, nothing, nothing, nothing
    dx, dy, ax, ay, bx, by = x[0] - x[4], x[1] - x[5], x[2], x[3], x[6], x[7]
    for g in range(3):
        s1, s2, s5 = A1[g] * across, A2[g], A5[g]
        tx, ty = s1 * dx + s2 * ax + s5 * bx, s1 * dy + s2 * ay + s5 * by
        inverse = reciprocal(root(tx * tx + ty * ty))
        force = AW[g] * h * axial * (1.0 - inverse)
        if not is_zero(delay):
            ux, uy = _line(s1, s2, s5, v)
            force += AW[g] * h * axial * delay * (tx * ux + ty * uy) * inverse * inverse
        px, py = force * tx, force * ty
        fx, fy, gx, gy, kx, ky = fx + s1 * px, fy + s1 * py, gx + s2 * px, gy + s2 * py, kx + s5 * px, ky + s5 * py
    for g in range(3):
        s1, s2, s5 = B1[g] * across, B2[g], B5[g]
        c1, c2, c5 = C1[g] * across * across, C2[g] * across, C5[g] * across
        tx, ty = s1 * dx + s2 * ax + s5 * bx, s1 * dy + s2 * ay + s5 * by
        cx, cy = c1 * dx + c2 * ax + c5 * bx, c1 * dy + c2 * ay + c5 * by
        kappa, px, py, square = curvature(tx, ty, cx, cy)
        moment = kappa
        if not is_zero(delay):
            ux, uy = _line(s1, s2, s5, v)
            wx, wy = _line(c1, c2, c5, v)
            moment += delay * (px * ux + py * uy + (tx * wy - ty * wx) * square)
        moment *= BW[g] * h * bending
        px, py, qx, qy = moment * px, moment * py, -moment * ty * square, moment * tx * square
        fx, fy = fx + s1 * px + c1 * qx, fy + s1 * py + c1 * qy
        gx, gy = gx + s2 * px + c2 * qx, gy + s2 * py + c2 * qy
        kx, ky = kx + s5 * px + c5 * qx, ky + s5 * py + c5 * qy
    r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7] = fx, fy, gx, gy, -fx, -fy, kx, ky
    hermite.inertia(mass, h, 0, 2, 4, 6, a, r)
    hermite.inertia(mass, h, 1, 3, 5, 7, a, r)
    hermite.weight(mass, h, p.gravity_x, 0, 2, 4, 6, r)
    hermite.weight(mass, h, p.gravity_y, 1, 3, 5, 7, r)


@inner
def energy(x, v, p, m, inputs):
    """Kinetic energy, strain and gravity energy, power of the material damping."""
    h, axial, bending, mass, delay = p.length, p.axial, p.bending, p.mass, p.delay
    kinetic = hermite.kinetic(mass, h, 0, 2, 4, 6, v) + hermite.kinetic(mass, h, 1, 3, 5, 7, v)
    potential = -mass * (
        p.gravity_x * hermite.centre(h, 0, 2, 4, 6, x) + p.gravity_y * hermite.centre(h, 1, 3, 5, 7, x)
    )
    power = 0.0 * h
    across = 1.0 / h
    for g in range(3):
        s1, s2, s5 = A1[g] * across, A2[g], A5[g]
        tx, ty = _line(s1, s2, s5, x)
        ux, uy = _line(s1, s2, s5, v)
        length = root(tx * tx + ty * ty)
        rate = (tx * ux + ty * uy) / length
        potential += 0.5 * AW[g] * h * axial * (length - 1.0) * (length - 1.0)
        power -= AW[g] * h * axial * delay * rate * rate
    for g in range(3):
        s1, s2, s5 = B1[g] * across, B2[g], B5[g]
        c1, c2, c5 = C1[g] * across * across, C2[g] * across, C5[g] * across
        tx, ty = _line(s1, s2, s5, x)
        ux, uy = _line(s1, s2, s5, v)
        cx, cy = _line(c1, c2, c5, x)
        wx, wy = _line(c1, c2, c5, v)
        kappa, px, py, square = curvature(tx, ty, cx, cy)
        rate = px * ux + py * uy + (tx * wy - ty * wx) * square
        potential += 0.5 * BW[g] * h * bending * kappa * kappa
        power -= BW[g] * h * bending * delay * rate * rate
    return kinetic, potential, power


CABLE = Kind(
    "ancf_cable",
    coordinates=WIDTH,
    numbers=("length", "axial", "bending", "mass", "delay", "gravity_x", "gravity_y"),
    residual=residual,
    energy=energy,
    lengths=("length",),
    gravity=("gravity_x", "gravity_y"),
    dissipates="delay",
)
