"""Write run-down.csv: angle of the crank (degrees) and position of the slider (mm), with noise.

In the crank's angle a, T = A(a) a'^2 / 2 and V(a), so A a'' = -A'(a) a'^2 / 2 - V'(a) - viscous a' - x'(a) F, with
the way x(a) of the slider and its friction F = dry tanh(x'(a) a' / slip). SciPy integrates it, apart from the package.
"""

from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

FOLDER = Path(__file__).parent
CRANK, ROD, PIN_Y, PIN_Z = 0.08, 0.3, 0.1, 0.12  # m
CRANK_INERTIA, ROD_MASS, SLIDER_MASS, GRAVITY, RATE = 1e-3, 0.5, 2.0, 9.81, 6.0  # kg m², kg, kg, m/s², rad/s
VISCOUS, DRY, SLIP = 0.002, 0.4, 0.02  # N m s, N, m/s
TIMES, NOISE = np.arange(401) * 0.01, np.array([0.2, 0.2])  # s, degrees and mm


def place(angle):
    """The way x of the slider, x'(a), A and V, for a complex angle too."""
    s, c = np.sin(angle), np.cos(angle)
    y, z = PIN_Y - CRANK * s, PIN_Z + CRANK * c
    x = np.sqrt(ROD**2 - y * y - z * z)
    slope = (y * c + z * s) * CRANK / x
    squares = CRANK**2 + slope**2  # of the velocities of the rod's ends, which are perpendicular
    inertia = CRANK_INERTIA + ROD_MASS * squares / 3 + SLIDER_MASS * slope**2
    return x, slope, inertia, ROD_MASS * GRAVITY * z / 2


def motion(times: np.ndarray, viscous: float, dry: float) -> tuple[np.ndarray, np.ndarray]:
    """Angle of the crank, rad, and way of the slider, m."""

    def rates(time: float, state: np.ndarray) -> list[float]:
        angle, rate = state
        _, slope, inertia, _ = place(angle)
        turned, force = (np.imag(value) / 1e-30 for value in place(angle + 1e-30j)[2:])
        friction = viscous * rate + slope * dry * np.tanh(slope * rate / SLIP)
        return [rate, -(0.5 * turned * rate**2 + force + friction) / inertia]

    angle = solve_ivp(rates, (0, times[-1]), [0, RATE], "DOP853", times, rtol=1e-12, atol=1e-12).y[0]
    return angle, place(angle)[0]


def main() -> None:
    """Write the file."""
    free = motion(np.array([0.0, 1.0, 5.0]), 0.0, 0.0)
    print("free, at 1 and 5 s:", [one[1:].round(9).tolist() for one in free])
    angle, way = motion(TIMES, VISCOUS, DRY)
    print("run-down, at 1 and 4 s:", [one[[100, 400]].round(9).tolist() for one in (angle, way)])
    seen = np.column_stack([np.rad2deg(angle), 1e3 * way])
    rows = np.column_stack([TIMES, seen + NOISE * np.random.default_rng(0).standard_normal(seen.shape)])
    form = ["%.2f", "%.2f", "%.2f"]
    np.savetxt(FOLDER / "run-down.csv", rows, fmt=form, delimiter=",", header="t,angle,way", comments="")


if __name__ == "__main__":
    main()
