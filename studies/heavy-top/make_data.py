"""Write path.csv: the position (mm) of a point of the top's axis at 100 Hz, with noise.

The angular momentum of a symmetric top about its fixed point is B n x n' + C spin n, with the axis n, the moments C
about it and B across it and a constant spin (Goldstein, Classical Mechanics, section 5.7); its rate is m l n x g. SciPy
integrates n'' = (m l n x g - C spin n') x n / B - |n'|^2 n, apart from the package.
"""

from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

FOLDER = Path(__file__).parent
MASS, LENGTH, AXIAL, TRANSVERSE = 15.0, 1.0, 0.46875, 0.234375  # kg, m, kg m²
SPIN, DOWN = 150.0, np.array([0.0, 0.0, -9.81])  # rad/s, m/s²
TIMES, NOISE = np.arange(101) * 0.01, 2.0  # s, mm


def path() -> np.ndarray:
    """Positions of the point, m, (samples, 3)."""
    across = TRANSVERSE + MASS * LENGTH**2

    def rates(time: float, state: np.ndarray) -> np.ndarray:
        axis, rate = state[:3], state[3:]
        torque = MASS * LENGTH * np.cross(axis, DOWN)
        turning = (torque - AXIAL * SPIN * rate) / across  # n x n''
        return np.concatenate([rate, np.cross(turning, axis) - rate @ rate * axis])

    axis = np.array([0.0, 1.0, 0.0])
    start = np.concatenate([axis, np.cross([0.0, SPIN, -4.61538], axis)])
    return LENGTH * solve_ivp(rates, (0, TIMES[-1]), start, "DOP853", TIMES, rtol=1e-12, atol=1e-12).y[:3].T


def main() -> None:
    """Write the file."""
    exact = path()
    print("at 0.2 and 1 s:", exact[[20, 100]].round(9).tolist())
    seen = 1e3 * exact + NOISE * np.random.default_rng(0).standard_normal(exact.shape)
    rows = np.column_stack([TIMES, seen])
    form = ["%.2f", *["%.1f"] * 3]
    np.savetxt(FOLDER / "path.csv", rows, fmt=form, delimiter=",", header="t,x,y,z", comments="")


if __name__ == "__main__":
    main()
