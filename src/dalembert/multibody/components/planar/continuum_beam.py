"""The fully parametrised planar ANCF beam element as a continuum (Omar and Shabana 2001). It locks where it is thin.

Local coordinates: (r, r_x, r_y) at both nodes, two components each, 12 in all. With xi = x/h along the element and y
across it, r_x = s1'(r1 - r2) + s2' r1_x + s5' r2_x + y d and r_y = (1 - xi) r1_y + xi r2_y, d = (r2_y - r1_y)/h.
Green-Lagrange strain, Saint-Venant-Kirchhoff material, Gauss points 3 along by 2 across.

Numbers: length h, height, width, mass, rotatory mass (density x second moment of area x length), stiffnesses C11, C12
and G, retardation time of the material damping, gravity.
"""

import numpy as np

from dalembert.kernels.kernel import inlined, inner
from dalembert.multibody.components.planar.section_inertia import (
    WIDTH,
    inertia_and_weight,
    kinetic_and_weight,
)
from dalembert.multibody.kernels.elementary import is_zero, reciprocal
from dalembert.multibody.kernels.kind import Kind

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(3)
XI, W = (_POINTS + 1) / 2, _WEIGHTS / 2
ACROSS = np.array([-0.5, 0.5]) / np.sqrt(3.0)
S1, S2, S5 = 6 * XI * (XI - 1), 1 - 4 * XI + 3 * XI**2, 3 * XI**2 - 2 * XI


@inlined
def residual(x, v, a, p, m, inputs, r):
    """M a + elastic and damping forces - weight."""
    h, height = p.length, p.height
    c11, c12, shear, delay = p.c11, p.c12, p.shear, p.delay
    across = reciprocal(h)
    dx, dy = (x[10] - x[4]) * across, (x[11] - x[5]) * across
    for g in range(3):
        xi = XI[g]
        s1, s2, s5 = S1[g] * across, S2[g], S5[g]
        cx = s1 * (x[0] - x[6]) + s2 * x[2] + s5 * x[8]
        cy = s1 * (x[1] - x[7]) + s2 * x[3] + s5 * x[9]
        nx, ny = (1 - xi) * x[4] + xi * x[10], (1 - xi) * x[5] + xi * x[11]
        eyy = 0.5 * (nx * nx + ny * ny - 1.0)
        sx, sy, tx, ty, ux, uy = 0.0 * h, 0.0 * h, 0.0 * h, 0.0 * h, 0.0 * h, 0.0 * h
        for b in range(2):
            y = ACROSS[b] * height
            fx, fy = cx + y * dx, cy + y * dy
            exx = 0.5 * (fx * fx + fy * fy - 1.0)
            twice = fx * nx + fy * ny
            sxx, syy, sxy = c11 * exx + c12 * eyy, c12 * exx + c11 * eyy, shear * twice
            if not is_zero(delay):
                rates = _strain_rates(v, xi, s1, s2, s5, y * across, fx, fy, nx, ny)
                sxx += delay * (c11 * rates[0] + c12 * rates[1])
                syy += delay * (c12 * rates[0] + c11 * rates[1])
                sxy += delay * shear * rates[2]
            px, py = sxx * fx + sxy * nx, sxx * fy + sxy * ny
            sx, sy = sx + px, sy + py
            tx, ty = tx + y * px, ty + y * py
            ux, uy = ux + sxy * fx + syy * nx, uy + sxy * fy + syy * ny
        w = 0.5 * W[g] * h * height * p.width
        sx, sy, tx, ty, ux, uy = w * sx, w * sy, w * tx * across, w * ty * across, w * ux, w * uy
        r[0] += s1 * sx
        r[1] += s1 * sy
        r[2] += s2 * sx
        r[3] += s2 * sy
        r[4] += (1 - xi) * ux - tx
        r[5] += (1 - xi) * uy - ty
        r[6] -= s1 * sx
        r[7] -= s1 * sy
        r[8] += s5 * sx
        r[9] += s5 * sy
        r[10] += xi * ux + tx
        r[11] += xi * uy + ty
    inertia_and_weight(p, a, r)


@inlined
def _strain_rates(v, xi, s1, s2, s5, y_over_h, fx, fy, nx, ny):
    """Rates of (E_xx, E_yy, 2 E_xy) at one Gauss point."""
    gx = s1 * (v[0] - v[6]) + s2 * v[2] + s5 * v[8] + y_over_h * (v[10] - v[4])
    gy = s1 * (v[1] - v[7]) + s2 * v[3] + s5 * v[9] + y_over_h * (v[11] - v[5])
    mx, my = (1 - xi) * v[4] + xi * v[10], (1 - xi) * v[5] + xi * v[11]
    return fx * gx + fy * gy, nx * mx + ny * my, fx * mx + fy * my + gx * nx + gy * ny


@inner
def energy(x, v, p, m, inputs):
    """Kinetic energy, strain and gravity energy, power of the material damping."""
    h, height = p.length, p.height
    c11, c12, shear, delay = p.c11, p.c12, p.shear, p.delay
    kinetic, potential = kinetic_and_weight(x, v, p)
    power = 0.0 * h
    across = 1.0 / h
    for g in range(3):
        xi = XI[g]
        s1, s2, s5 = S1[g] * across, S2[g], S5[g]
        nx, ny = (1 - xi) * x[4] + xi * x[10], (1 - xi) * x[5] + xi * x[11]
        for b in range(2):
            y = ACROSS[b] * height * across
            fx = s1 * (x[0] - x[6]) + s2 * x[2] + s5 * x[8] + y * (x[10] - x[4])
            fy = s1 * (x[1] - x[7]) + s2 * x[3] + s5 * x[9] + y * (x[11] - x[5])
            exx, eyy, twice = 0.5 * (fx * fx + fy * fy - 1), 0.5 * (nx * nx + ny * ny - 1), fx * nx + fy * ny
            w = 0.5 * W[g] * h * height * p.width
            potential += 0.5 * w * (c11 * (exx * exx + eyy * eyy) + 2 * c12 * exx * eyy + shear * twice * twice)
            dxx, dyy, dxy = _strain_rates(v, xi, s1, s2, s5, y, fx, fy, nx, ny)
            power -= delay * w * (c11 * (dxx * dxx + dyy * dyy) + 2 * c12 * dxx * dyy + shear * dxy * dxy)
    return kinetic, potential, power


CONTINUUM = Kind(
    "continuum_beam",
    coordinates=WIDTH,
    numbers=(
        "length", "height", "width", "mass", "rotatory", "c11", "c12", "shear", "delay", "gravity_x", "gravity_y",
    ),
    residual=residual,
    energy=energy,
    lengths=("length",),
    gravity=("gravity_x", "gravity_y"),
    dissipates="delay",
)  # fmt: skip
