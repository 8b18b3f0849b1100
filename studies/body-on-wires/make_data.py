"""Write swing1.csv to swing6.csv: two points of the plate (mm) in six swings, with noise.

Plate and part are one rigid body with the origin x in the plate's centre and the rotation matrix R. The tensions of the
wires follow from the second derivative of |x + R s - h|^2 = L^2. SciPy integrates x, R and their rates, apart from the
package.
"""

from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

FOLDER = Path(__file__).parent
ORIENTATIONS = [(0, 0, 0), (90, 0, 0), (0, 90, 0), (45, 0, 0), (0, 45, 0), (90, 0, 45)]  # of the part, degrees
TWISTS = [25.0, 22.0, 27.0, 25.0, 24.0, 26.0]  # degrees
WIRE, DRAG, GRAVITY = 1.2, 0.01, np.array([0.0, 0.0, -9.81])  # m, N m s, m/s²
HOOKS = 0.15 * np.array([[1, 0, 0], [-0.5, 0.75**0.5, 0], [-0.5, -(0.75**0.5), 0]])  # m
PLATE, PART, SEAT = 2.0, 4.1, np.array([0.0, 0.0, 0.06])  # kg, kg, m
DISC = PLATE * np.diag([0.17**2 / 4 + 0.008**2 / 12] * 2 + [0.17**2 / 2])  # kg m²
CENTRE = np.array([0.012, -0.008, 0.015])  # of the part, m
TENSOR = np.array([[0.031, -0.004, 0.003], [-0.004, 0.022, 0.005], [0.003, 0.005, 0.038]])  # kg m²
TIMES, NOISE = np.arange(101) * 0.04, 0.5  # s, mm


def slope(axes: np.ndarray) -> np.ndarray:
    """Derivative of the angle atan2(R_21, R_11) about the vertical by a rotation, along the axes of the plate."""
    x, y, _ = axes[:, 0]
    return axes.T @ np.cross(axes[:, 0], (-y, x, 0.0)) / (x * x + y * y)


def swing(angles: tuple[float, float, float], twist: float) -> np.ndarray:
    """Positions of the first two points of the plate, m, (samples, 2, 3)."""
    turned = Rotation.from_euler("XYZ", angles, degrees=True).as_matrix()
    centre = SEAT + turned @ CENTRE
    mass, first = PLATE + PART, PART * centre
    inertia = DISC + turned @ TENSOR @ turned.T + PART * (centre @ centre * np.eye(3) - np.outer(centre, centre))

    def rates(time: float, state: np.ndarray) -> np.ndarray:
        x, axes, v, w = state[:3], state[3:12].reshape(3, 3), state[12:15], state[15:]  # w in the axes of the plate
        cross = np.array([[0, -first[2], first[1]], [first[2], 0, -first[0]], [-first[1], first[0], 0]])
        matrix = np.block([[mass * np.eye(3), -axes @ cross], [cross @ axes.T, inertia]])
        force = mass * GRAVITY - axes @ np.cross(w, np.cross(w, first))
        torque = np.cross(first, axes.T @ GRAVITY) - np.cross(w, inertia @ w) - DRAG * slope(axes) * (slope(axes) @ w)
        along = (x + HOOKS @ axes.T - HOOKS) / WIRE
        gradient = np.hstack([along, np.cross(HOOKS, along @ axes)])
        speeds = v + np.cross(w, HOOKS) @ axes.T
        bias = np.sum(speeds**2, axis=1) / WIRE + np.sum(along * (np.cross(w, np.cross(w, HOOKS)) @ axes.T), axis=1)
        whole = np.block([[matrix, -gradient.T], [gradient, np.zeros((3, 3))]])
        acceleration = np.linalg.solve(whole, np.concatenate([force, torque, -bias]))[:6]
        return np.concatenate([v, np.cross(axes, w).ravel(), acceleration])

    start = Rotation.from_euler("z", twist, degrees=True).as_matrix()
    height = -np.sqrt(WIRE**2 - np.sum(((start - np.eye(3)) @ HOOKS[0]) ** 2))
    state = np.concatenate([[0, 0, height], start.ravel(), np.zeros(6)])
    states = solve_ivp(rates, (0, TIMES[-1]), state, "DOP853", TIMES, rtol=1e-11, atol=1e-12).y.T
    return np.array([one[:3] + HOOKS[:2] @ one[3:12].reshape(3, 3).T for one in states])


def main() -> None:
    """Write the files."""
    draw = np.random.default_rng(1)
    for number, (angles, twist) in enumerate(zip(ORIENTATIONS, TWISTS, strict=True), start=1):
        points = swing(angles, twist)
        if number == 4:
            print("swing 4, first point at 2 and 4 s:", points[[50, 100], 0].round(9).tolist())
        seen = 1e3 * points[:, :, :2].reshape(-1, 4) + NOISE * draw.standard_normal((len(TIMES), 4))
        form, head = ["%.2f", *["%.2f"] * 4], "t,x1,y1,x2,y2"
        rows = np.column_stack([TIMES, seen])
        np.savetxt(FOLDER / f"swing{number}.csv", rows, fmt=form, delimiter=",", header=head, comments="")


if __name__ == "__main__":
    main()
