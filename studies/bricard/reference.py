"""Print points of Bricard's mechanism from an integration of its one degree of freedom, apart from the package.

The joints turn by angles u. With the twist of each joint, the loop is closed where the sum of twist k times u'_k is
zero: six equations of rank five, so u' = s n(u) with their null vector n and a speed s. With A(u) = 2 T / s^2 and the
potential energy V(u), A s' = -(dA s^2 / 2 + dV), with the derivatives along n, here central differences.
"""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

POINTS = np.array([(0, 0, 0), (1, 0, 0), (1, -1, 0), (1, -1, 1), (0, -1, 1), (0, 0, 1)], float)
AXES = np.array([(0, 1, 0), (0, 0, 1), (1, 0, 0)] * 2, float)
EDGES = np.diff(POINTS, axis=0)
ACROSS, ALONG, GRAVITY = 1 / 12, 1e-5, np.array([0, -9.81, 0])  # kg m², kg m², m/s²
TIMES, STEP = np.array([0, 1, 2, 5]), 1e-5  # s, rad


def chain(angles: np.ndarray) -> tuple[np.ndarray, ...]:
    """Positions and axes of the joints, (6, 3) each, and rotation matrices of the rods, (5, 3, 3)."""
    turned, place, places, axes, rods = np.eye(3), POINTS[0], [], [], []
    for joint, angle in enumerate(angles):
        places.append(place)
        axes.append(turned @ AXES[joint])
        turned = turned @ Rotation.from_rotvec(angle * AXES[joint]).as_matrix()
        if joint < 5:
            place = place + turned @ EDGES[joint]
            rods.append(turned)
    return np.array(places), np.array(axes), np.array(rods)


def direction(angles: np.ndarray) -> np.ndarray:
    """Null vector n of the closed loop, of length 1, with a positive first component."""
    places, axes, _ = chain(angles)
    null = np.linalg.svd(np.vstack([axes.T, np.cross(places, axes).T]))[2][-1]
    return null * np.sign(null[0])


def energies(angles: np.ndarray, rates: np.ndarray) -> np.ndarray:
    """Twice the kinetic energy at these rates, and the potential energy."""
    places, axes, rods = chain(angles)
    double, potential = 0.0, 0.0
    for rod, turned in enumerate(rods):
        spin = rates[: rod + 1] @ axes[: rod + 1]
        arm = turned @ EDGES[rod]
        centre = places[rod] + arm / 2
        velocity = rates[: rod + 1] @ np.cross(axes[: rod + 1], centre - places[: rod + 1])
        double += velocity @ velocity + ACROSS * (spin @ spin - (spin @ arm) ** 2) + ALONG * (spin @ arm) ** 2
        potential -= GRAVITY @ centre
    return np.array([double, potential])


def rates(time: float, state: np.ndarray) -> np.ndarray:
    """Rates of the angles and of the speed s."""
    angles, speed = state[:6], state[6]
    null = direction(angles)
    moved = [angles + sign * STEP * null for sign in (1, -1)]
    ahead, back = (energies(one, direction(one)) for one in moved)
    inertia_slope, force = (ahead - back) / (2 * STEP)
    inertia = energies(angles, null)[0]
    return np.append(speed * null, -(0.5 * inertia_slope * speed**2 + force) / inertia)


def main() -> None:
    """Print the point between the second and the third rod."""
    states = solve_ivp(rates, (0, TIMES[-1]), np.zeros(7), "DOP853", TIMES, rtol=1e-11, atol=1e-11).y.T
    for time, state in zip(TIMES, states, strict=True):
        places = chain(state[:6])[0]
        print(f"{time} s:", places[2].round(8).tolist(), "open by", np.abs(places[5] - POINTS[5]).max().round(12))


if __name__ == "__main__":
    main()
