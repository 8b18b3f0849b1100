"""Write motion.csv and truth.csv: a pendulum that is pushed twice, by SciPy, with noise; nothing of dalembert.

The bar of length 1 m and mass 2 kg hangs at rest. A horizontal force acts at its end.
"""

from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

FOLDER = Path(__file__).parent
LENGTH, MASS, GRAVITY, NOISE = 1.0, 2.0, 9.81, 0.5e-3
TIMES = np.arange(1, 201) * 0.01


def force(time):
    """A long push to the right, then a short one to the left, in N."""
    return 8.0 * np.exp(-(((time - 0.6) / 0.15) ** 2)) - 5.0 * np.exp(-(((time - 1.4) / 0.08) ** 2))


def rates(time, state):
    """Rates of the angle from the vertical and of its rate: m L²/3 φ'' = -m g L/2 sin φ + F L cos φ."""
    angle, rate = state
    moment = -MASS * GRAVITY * LENGTH / 2 * np.sin(angle) + force(time) * LENGTH * np.cos(angle)
    return rate, moment / (MASS * LENGTH**2 / 3)


def main():
    """Write the files."""
    motion = solve_ivp(rates, (0.0, TIMES[-1]), (0.0, 0.0), "DOP853", TIMES, rtol=1e-11, atol=1e-12, max_step=0.02)
    position = LENGTH * np.stack([np.sin(motion.y[0]), -np.cos(motion.y[0])], axis=1)
    position += NOISE * np.random.default_rng(5).standard_normal(position.shape)
    for name, columns, head in (("motion", position, "t,x,y"), ("truth", force(TIMES)[:, None], "t,force")):
        table = np.column_stack([TIMES, columns])
        np.savetxt(FOLDER / f"{name}.csv", table, fmt="%.6f", delimiter=",", header=head, comments="")


if __name__ == "__main__":
    main()
