"""Planar shear-deformable beam element with the coordinates of the fully parametrised ANCF element, free of locking.

Local coordinates: (r, r_x, r_y) at both nodes, two components each, 12 in all; r is cubic along the element. With
f = r_x, n = r_y and the length h, the strains are sampled where a bent element leaves them at zero:

- shear gamma = f . n at the nodes, linear between them;
- thickness eta = (n . n - 1)/2 at the nodes, linear between them;
- stretch epsilon = (f . f - 1)/2 at Lobatto's three points, coupled with eta by the law of the material;
- bending kappa = (f x f')/(f . f) - (gamma_2 - gamma_1)/h at Gauss' three points: the change of the section's angle,
  which is that of the line less the shear angle.

The section vector follows the line between the nodes: n(xi) = (1 - xi) n_1 + xi n_2 + 3 xi (1 - xi) J B, where
B = 2 (r_2 - r_1)/h - f_1 - f_2 and J is a quarter turn. So the rotatory inertia is as accurate as the bending, and the
mass matrix is constant.

Strains and inertia are products that a rotation does not change. Numbers: length h, mass, rotatory mass, stiffnesses
C11 A and C12 A of stretch and thickness, k G A of shear and E I of bending, retardation time of the material damping,
gravity.
"""

import math

from dalembert.kernels.kernel import inlined, inner
from dalembert.multibody.components.planar.line_bending import curvature
from dalembert.multibody.components.planar.section_inertia import (
    WIDTH,
    inertia_and_weight,
    kinetic_and_weight,
)
from dalembert.multibody.kernels.elementary import is_zero, reciprocal
from dalembert.multibody.kernels.kind import Kind

AT, WEIGHT = math.sqrt(0.15), (5 / 18, 8 / 18, 5 / 18)  # Gauss' three points: the middle -+ AT lengths, and weights


@inlined
def _line(x, across):
    """Return m, D and B of coordinates or velocities: at z from the middle, r_x = m + z D - 3 z^2 B."""
    ux, uy = (x[6] - x[0]) * across, (x[7] - x[1]) * across
    sx, sy = x[2] + x[8], x[3] + x[9]
    return 1.5 * ux - 0.25 * sx, 1.5 * uy - 0.25 * sy, x[8] - x[2], x[9] - x[3], 2 * ux - sx, 2 * uy - sy


@inlined
def _at(line, z):
    """Return f = r_x and c = h r_xx at z from the middle."""
    mx, my, dx, dy, bx, by = line
    return mx + z * dx - 3 * z * z * bx, my + z * dy - 3 * z * z * by, dx - 6 * z * bx, dy - 6 * z * by


@inlined
def _bend(line, z):
    """Return h times the line's curvature, and its derivatives by f and by c."""
    fx, fy, cx, cy = _at(line, z)
    kappa, px, py, square = curvature(fx, fy, cx, cy)
    return kappa, px, py, -fy * square, fx * square


@inlined
def _bend_rate(bend, line, z):
    """Return the time derivative of a bend; ``line`` is that of the velocities."""
    fx, fy, cx, cy = _at(line, z)
    return bend[1] * fx + bend[2] * fy + bend[3] * cx + bend[4] * cy


@inlined
def _strains(x, line, first, middle, last):
    """Return stretch at the start, middle and end, thickness and shear at both nodes, and the three bends."""
    mx, my, _, _, _, _ = line
    return (
        0.5 * (x[2] * x[2] + x[3] * x[3] - 1.0),
        0.5 * (mx * mx + my * my - 1.0),
        0.5 * (x[8] * x[8] + x[9] * x[9] - 1.0),
        0.5 * (x[4] * x[4] + x[5] * x[5] - 1.0),
        0.5 * (x[10] * x[10] + x[11] * x[11] - 1.0),
        x[2] * x[4] + x[3] * x[5],
        x[8] * x[10] + x[9] * x[11],
        first[0],
        middle[0],
        last[0],
    )


@inlined
def _rates(x, v, line, first, middle, last, across):
    """Return the time derivatives of the strains."""
    rates = _line(v, across)
    return (
        x[2] * v[2] + x[3] * v[3],
        line[0] * rates[0] + line[1] * rates[1],
        x[8] * v[8] + x[9] * v[9],
        x[4] * v[4] + x[5] * v[5],
        x[10] * v[10] + x[11] * v[11],
        x[2] * v[4] + x[3] * v[5] + v[2] * x[4] + v[3] * x[5],
        x[8] * v[10] + x[9] * v[11] + v[8] * x[10] + v[9] * x[11],
        _bend_rate(first, rates, -AT),
        _bend_rate(middle, rates, 0.0),
        _bend_rate(last, rates, AT),
    )


@inlined
def _stresses(e, p, across):
    """Return the forces against the strains ``e``: the stiffness of an element times them."""
    h = p.length
    a, b, shear, bending = p.axial * h / 6, p.coupling * h / 6, p.shear * h / 6, p.bending * across
    turn = e[6] - e[5]
    first, middle, last = (
        WEIGHT[0] * bending * (e[7] - turn),
        WEIGHT[1] * bending * (e[8] - turn),
        WEIGHT[2] * bending * (e[9] - turn),
    )
    moment = first + middle + last
    return (
        a * e[0] + b * e[3],
        4 * a * e[1] + 2 * b * (e[3] + e[4]),
        a * e[2] + b * e[4],
        a * (2 * e[3] + e[4]) + b * (e[0] + 2 * e[1]),
        a * (2 * e[4] + e[3]) + b * (e[2] + 2 * e[1]),
        shear * (2 * e[5] + e[6]) + moment,
        shear * (2 * e[6] + e[5]) - moment,
        first,
        middle,
        last,
    )


@inlined
def residual(x, v, a, p, m, inputs, r):
    """M a + elastic and damping forces - weight."""
    across, delay = reciprocal(p.length), p.delay
    line = _line(x, across)
    first, middle, last = _bend(line, -AT), _bend(line, 0.0), _bend(line, AT)
    e = _strains(x, line, first, middle, last)
    if not is_zero(delay):
        d = _rates(x, v, line, first, middle, last, across)
        e = (
            e[0] + delay * d[0], e[1] + delay * d[1], e[2] + delay * d[2], e[3] + delay * d[3], e[4] + delay * d[4],
            e[5] + delay * d[5], e[6] + delay * d[6], e[7] + delay * d[7], e[8] + delay * d[8], e[9] + delay * d[9],
        )  # fmt: skip
    s = _stresses(e, p, across)
    # forces against m, D and B
    mx, my, dx, dy, bx, by = s[1] * line[0], s[1] * line[1], 0.0 * delay, 0.0 * delay, 0.0 * delay, 0.0 * delay
    for z, force, bend in ((-AT, s[7], first), (0.0, s[8], middle), (AT, s[9], last)):
        px, py, qx, qy = force * bend[1], force * bend[2], force * bend[3], force * bend[4]
        mx, my, dx, dy = mx + px, my + py, dx + z * px + qx, dy + z * py + qy
        bx, by = bx - 3 * z * z * px - 6 * z * qx, by - 3 * z * z * py - 6 * z * qy
    ux, uy = (1.5 * mx + 2 * bx) * across, (1.5 * my + 2 * by) * across
    sx, sy = 0.25 * mx + bx, 0.25 * my + by
    r[0] -= ux
    r[1] -= uy
    r[2] += s[0] * x[2] + s[5] * x[4] - sx - dx
    r[3] += s[0] * x[3] + s[5] * x[5] - sy - dy
    r[4] += s[3] * x[4] + s[5] * x[2]
    r[5] += s[3] * x[5] + s[5] * x[3]
    r[6] += ux
    r[7] += uy
    r[8] += s[2] * x[8] + s[6] * x[10] - sx + dx
    r[9] += s[2] * x[9] + s[6] * x[11] - sy + dy
    r[10] += s[4] * x[10] + s[6] * x[8]
    r[11] += s[4] * x[11] + s[6] * x[9]
    inertia_and_weight(p, a, r)
    _add_bulge_inertia(p, a, across, r)


@inlined
def _add_bulge_inertia(p, a, across, r):
    """Add to ``r`` the inertia of the part of the section vector along B; see the top of the file."""
    _, _, _, _, bx, by = _line(a, across)
    own, mixed = 0.3 * p.rotatory, 0.25 * p.rotatory
    nx, ny = a[4] + a[10], a[5] + a[11]
    fx, fy = own * bx + mixed * ny, own * by - mixed * nx
    r[0] -= 2 * across * fx
    r[1] -= 2 * across * fy
    r[6] += 2 * across * fx
    r[7] += 2 * across * fy
    for i in (2, 8):
        r[i] -= fx
        r[i + 1] -= fy
    for i in (4, 10):
        r[i] -= mixed * by
        r[i + 1] += mixed * bx


@inner
def energy(x, v, p, m, inputs):
    """Kinetic energy, strain and gravity energy, power of the material damping."""
    kinetic, potential = kinetic_and_weight(x, v, p)
    power = 0.0 * p.length
    across = reciprocal(p.length)
    _, _, _, _, bx, by = _line(v, across)
    turning = 0.3 * (bx * bx + by * by) + 0.5 * (bx * (v[5] + v[11]) - by * (v[4] + v[10]))
    kinetic += 0.5 * p.rotatory * turning
    line = _line(x, across)
    first, middle, last = _bend(line, -AT), _bend(line, 0.0), _bend(line, AT)
    e, d = _strains(x, line, first, middle, last), _rates(x, v, line, first, middle, last, across)
    s, t = _stresses(e, p, across), _stresses(d, p, across)
    for i in range(10):
        potential += 0.5 * s[i] * e[i]
        power -= p.delay * t[i] * d[i]
    return kinetic, potential, power


STRUCTURAL = Kind(
    "structural_beam",
    coordinates=WIDTH,
    numbers=(
        "length", "mass", "rotatory", "axial", "coupling", "shear", "bending", "delay", "gravity_x", "gravity_y",
    ),
    residual=residual,
    energy=energy,
    lengths=("length",),
    gravity=("gravity_x", "gravity_y"),
    dissipates="delay",
)  # fmt: skip
