"""The record of a plate that turns on three wires: ``python tools/wires.py FOLDER``.

It is the data of the template ``spatial``. The wires have the same length and hang from points that form the same
triangle as those of the plate, so the plate turns about the vertical axis by an angle a and rises, its height being
z(a) = -sqrt(L^2 - 2 R^2 (1 - cos a)). Lagrange's equation of this one coordinate, with a torque drag a' of the air, is
integrated by SciPy, apart from the package. A camera sees one point with 0.2 mm of noise.
"""

import sys
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

from dalembert.files import write_text

WIRE, RADIUS, MASS, GRAVITY = 1.2, 0.15, 3.2, 9.81  # m, m, kg, m/s^2
MOMENT, DRAG, TWIST = 0.071, 0.02, np.deg2rad(25.0)  # kg m^2, N m s, rad
NOISE = 2e-4  # m
TIMES = np.arange(151) * 0.02  # s


def angle() -> np.ndarray:
    """Angle of the plate at the times, rad."""

    def rates(time: float, state: np.ndarray) -> list[float]:
        a, rate = state
        height = -np.sqrt(WIRE**2 - 2.0 * RADIUS**2 * (1.0 - np.cos(a)))
        slope = -(RADIUS**2) * np.sin(a) / height  # dz/da, from z z' = -R^2 sin a
        curvature = -(RADIUS**2 * np.cos(a) + slope**2) / height
        force = -MASS * slope * curvature * rate**2 - MASS * GRAVITY * slope - DRAG * rate
        return [rate, force / (MOMENT + MASS * slope**2)]

    return solve_ivp(rates, (0.0, TIMES[-1]), [TWIST, 0.0], t_eval=TIMES, rtol=1e-10, atol=1e-12).y[0]


def main(folder: Path) -> None:
    """Write the record into a folder."""
    draw, turned = np.random.default_rng(11), angle()
    seen = RADIUS * np.column_stack([np.cos(turned), np.sin(turned)]) + NOISE * draw.standard_normal((TIMES.size, 2))
    rows = [f"{t:.2f},{x:.5f},{y:.5f}" for t, (x, y) in zip(TIMES, seen, strict=True)]
    write_text(folder / "wires.csv", "\n".join(["t,x,y", *rows]) + "\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
