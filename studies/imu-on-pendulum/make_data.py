"""Write first.csv and second.csv: noisy readings of an inertial sensor on a swinging box.

Euler's equations of a body with a fixed point, J w' = J w x w + m c x R^T g, and R' = R [w], are integrated by SciPy,
apart from the package. Readings: gain (w' x s + w x (w x s) - R^T g) + bias and gain w + bias, in the sensor's axes.
"""

from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

FOLDER = Path(__file__).parent
RELEASES = {"first": (50, -35), "second": (-20, 60)}  # roll and pitch of the box, degrees
MASS, SIDES, CENTRE = 2.4, np.array([0.25, 0.06, 0.4]), np.array([0.06, -0.01, -0.2])  # kg, m, m
PLACE = np.array([0.11, 0.035, -0.33])  # of the sensor on the box, m
AXES = Rotation.from_euler("ZYX", [25, -8, 4], degrees=True).as_matrix()  # of the sensor, as columns
GAINS, RATE_GAINS = np.array([1.02, 0.985, 1.01]), np.array([0.99, 1.015, 1.005])
BIASES, RATE_BIASES = np.array([0.15, -0.2, 0.3]), np.array([0.02, -0.035, 0.01])  # m/s², rad/s
NOISE = np.repeat([0.05, 0.005], 3)  # m/s², rad/s
GRAVITY = np.array([0.0, 0.0, -9.81])
TIMES = np.arange(301) * 0.01

SQUARES = SIDES**2
INERTIA = MASS * (np.diag(SQUARES.sum() - SQUARES) / 12 + CENTRE @ CENTRE * np.eye(3) - np.outer(CENTRE, CENTRE))


def acceleration(turned: np.ndarray, rate: np.ndarray) -> np.ndarray:
    """Angular acceleration in the axes of the box, rad/s²."""
    torque = MASS * np.cross(CENTRE, turned.T @ GRAVITY)
    return np.linalg.solve(INERTIA, np.cross(INERTIA @ rate, rate) + torque)


def readings(angles: tuple[float, float]) -> np.ndarray:
    """Readings without noise, (samples, 6)."""

    def rates(time: float, state: np.ndarray) -> np.ndarray:
        turned, rate = state[:9].reshape(3, 3), state[9:]
        return np.concatenate([np.cross(turned, rate).ravel(), acceleration(turned, rate)])

    start = np.concatenate([Rotation.from_euler("XY", angles, degrees=True).as_matrix().ravel(), np.zeros(3)])
    states = solve_ivp(rates, (0, TIMES[-1]), start, "DOP853", TIMES, rtol=1e-12, atol=1e-12).y.T
    rows = []
    for state in states:
        turned, rate = state[:9].reshape(3, 3), state[9:]
        force = np.cross(acceleration(turned, rate), PLACE) + np.cross(rate, np.cross(rate, PLACE)) - turned.T @ GRAVITY
        rows.append([*(GAINS * (AXES.T @ force) + BIASES), *(RATE_GAINS * (AXES.T @ rate) + RATE_BIASES)])
    return np.array(rows)


def main() -> None:
    """Write the files."""
    draw = np.random.default_rng(0)
    for name, angles in RELEASES.items():
        exact = readings(angles)
        if name == "first":
            print("first, at 1 and 3 s:", exact[[100, 300]].round(9).tolist())
        rows = np.column_stack([TIMES, exact + NOISE * draw.standard_normal((len(TIMES), 6))])
        form = ["%.2f", *["%.3f"] * 3, *["%.4f"] * 3]
        head = "t,a1,a2,a3,w1,w2,w3"
        np.savetxt(FOLDER / f"{name}.csv", rows, fmt=form, delimiter=",", header=head, comments="")


if __name__ == "__main__":
    main()
