"""Andrews' mechanism as 21 absolute coordinates of bodies with named points: the geometry that a user would enter.

Joints on the level of accelerations, integrated by SciPy; the end values of the test set come out.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

# Joint by joint: body and point, body and point (body 0 is the ground).
JOINTS = (
    ((0, "O"), (1, "O")),
    ((1, "F"), (2, "F")),
    ((0, "B"), (3, "B")),
    ((2, "E"), (3, "E")),
    ((2, "E"), (4, "E")),
    ((2, "E"), (6, "E")),
    ((4, "G"), (5, "G")),
    ((0, "A"), (5, "A")),
    ((6, "H"), (7, "H")),
    ((0, "A"), (7, "A")),
)


def points(data: dict) -> list[dict[str, tuple[float, float]]]:
    """Points of each body (0: the ground) in its own axes, from its centre of mass."""
    s = data["geometry"]
    placed = [
        {"O": (0.0, 0.0), "F": (s["rr"], 0.0), "centre": (s["ra"], 0.0)},
        {"F": (0.0, 0.0), "E": (-s["d"], 0.0), "centre": (-s["da"], 0.0)},
        {"B": (0.0, 0.0), "E": (s["ss"], 0.0), "D": (s["sc"], s["sd"]), "centre": (s["sa"], s["sb"])},
        {"G": (0.0, 0.0), "E": (s["e"], 0.0), "centre": (s["e"] - s["ea"], 0.0)},
        {"A": (0.0, 0.0), "G": (s["zt"], 0.0), "centre": (s["ta"], s["tb"])},
        {"H": (0.0, 0.0), "E": (s["zf"], 0.0), "centre": (s["zf"] - s["fa"], 0.0)},
        {"A": (0.0, 0.0), "H": (s["u"], 0.0), "centre": (s["ua"], -s["ub"])},
    ]
    ground = {"O": (0.0, 0.0)} | {name: tuple(place) for name, place in data["ground"].items()}
    return [ground] + [
        {name: (x - own["centre"][0], y - own["centre"][1]) for name, (x, y) in own.items()} for own in placed
    ]


def angles(q: np.ndarray) -> np.ndarray:
    """Angles of the seven bodies, along their x axes, from the seven relative coordinates of the test set."""
    beta, theta, gamma, phi, delta, omega, epsilon = q
    return np.array(
        [beta, beta + theta, gamma - np.pi / 2, phi + delta - np.pi / 2, delta, omega + epsilon, epsilon - np.pi / 2]
    )


def placed(data: dict) -> np.ndarray:
    """Initial coordinates (x, y, angle) of the seven bodies, each hung on one that is placed already, shape (7, 3)."""
    own, turned = points(data), angles(np.array(data["initial"]["q"]))
    state = np.zeros((8, 3))
    state[1:, 2] = turned
    hung = ((0, 1, "O"), (1, 2, "F"), (0, 3, "B"), (0, 5, "A"), (5, 4, "G"), (0, 7, "A"), (7, 6, "H"))
    for carrier, body, name in hung:
        state[body, :2] = at(state[carrier], own[carrier][name]) - turn(state[body, 2]) @ own[body][name]
    return state[1:]


def turn(angle: float) -> np.ndarray:
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def at(body: np.ndarray, point: tuple[float, float]) -> np.ndarray:
    return body[:2] + turn(body[2]) @ point


def accelerations(data: dict, own: list, state: np.ndarray, speed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Accelerations (7, 3) and forces of the joints (10, 2) on their second bodies."""
    bodies, speeds = np.vstack([np.zeros(3), state]), np.vstack([np.zeros(3), speed])
    inertia, load = data["inertia"], data["load"]
    masses = np.column_stack([inertia["mass"], inertia["mass"], inertia["moment"]]).ravel()
    forces = np.zeros((8, 3))
    forces[1, 2] = load["torque"]
    arm = turn(bodies[3, 2]) @ own[3]["D"]
    spring = bodies[3, :2] + arm - own[0]["C"]
    length = np.hypot(*spring)
    pull = -load["stiffness"] * (length - load["free_length"]) * spring / length
    forces[3] = [*pull, arm[0] * pull[1] - arm[1] * pull[0]]

    jacobian, right = np.zeros((20, 24)), np.zeros(20)
    for row, sides in enumerate(JOINTS):
        for sign, (body, name) in zip((-1.0, 1.0), sides, strict=True):
            arm = turn(bodies[body, 2]) @ own[body][name]
            jacobian[2 * row : 2 * row + 2, 3 * body : 3 * body + 3] = sign * np.array(
                [[1.0, 0.0, -arm[1]], [0.0, 1.0, arm[0]]]
            )
            right[2 * row : 2 * row + 2] += sign * arm * speeds[body, 2] ** 2
    jacobian = jacobian[:, 3:]
    matrix = np.block([[np.diag(masses), -jacobian.T], [jacobian, np.zeros((20, 20))]])
    solution = np.linalg.solve(matrix, np.concatenate([forces[1:].ravel(), right]))
    return solution[:21].reshape(7, 3), solution[21:].reshape(10, 2)


def relative(turned: np.ndarray) -> np.ndarray:
    """The seven coordinates of the test set (or their rates) from angles (or angular rates) of the bodies."""
    one, two, three, four, five, six, seven = turned
    return np.array([one, two - one, three, four - five, five, six - seven, seven])


def multipliers(forces: np.ndarray) -> np.ndarray:
    """Those of the test set: forces at E on bodies 3, 4 and 6."""
    return forces[3:6].ravel()


def test_initial_values(reference) -> None:
    data = reference("andrews")
    own, state = points(data), placed(data)
    bodies = np.vstack([np.zeros(3), state])
    gaps = [at(bodies[b], own[b][q]) - at(bodies[a], own[a][p]) for (a, p), (b, q) in JOINTS]
    np.testing.assert_allclose(gaps, 0.0, atol=1e-16)
    acceleration, forces = accelerations(data, own, state, np.zeros((7, 3)))
    np.testing.assert_allclose(relative(acceleration[:, 2]), data["initial"]["acceleration"], rtol=1e-12, atol=1e-8)
    np.testing.assert_allclose(multipliers(forces), data["initial"]["multipliers"], rtol=1e-12, atol=1e-10)


def test_end_values(reference) -> None:
    data = reference("andrews")
    own, end = points(data), data["end"]

    def motion(_: float, y: np.ndarray) -> np.ndarray:
        state, speed = y.reshape(2, 7, 3)
        return np.concatenate([y[21:], accelerations(data, own, state, speed)[0].ravel()])

    start = np.concatenate([placed(data).ravel(), np.zeros(21)])
    solution = solve_ivp(motion, (0.0, end["time"]), start, method="DOP853", rtol=1e-12, atol=1e-13)
    assert solution.success, solution.message
    state, speed = solution.y[:, -1].reshape(2, 7, 3)
    acceleration, forces = accelerations(data, own, state, speed)
    q = relative(state[:, 2] - angles(np.zeros(7)))
    assert q == pytest.approx(end["q"], rel=1e-8)
    assert relative(speed[:, 2]) == pytest.approx(end["velocity"], rel=1e-7)
    # The test set's own accelerations and multipliers (index 3) are good to 1.3e-6 of each: here they stand still from
    # a tolerance of 1e-11 on.
    assert relative(acceleration[:, 2]) == pytest.approx(end["acceleration"], rel=2e-6)
    assert multipliers(forces) == pytest.approx(end["multipliers"], rel=2e-6)
