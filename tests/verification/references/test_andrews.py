"""Andrews' mechanism as 21 absolute coordinates of bodies with named points: the geometry that a user would enter.

Joints on the level of accelerations, integrated by SciPy; the end values of the test set come out.
"""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.integrate import solve_ivp


@dataclass(frozen=True)
class Plane:
    """Bodies by name (the ground is number 0); ``points[name]`` is (body, place against its centre of mass)."""

    points: dict[str, tuple[int, np.ndarray]]
    inertias: np.ndarray
    joints: list[tuple[str, str]]
    names: list[str]
    load: dict

    @classmethod
    def of(cls, data: dict) -> "Plane":
        points = {f"ground.{name}": (0, np.array(place)) for name, place in data["ground"].items()}
        for number, body in enumerate(data["bodies"], start=1):
            for name, place in body["points"].items():
                points[f"{body['name']}.{name}"] = (number, np.array(place) - body["centre"])
        inertias = np.array([[body["mass"], body["mass"], body["inertia"]] for body in data["bodies"]])
        names = [body["name"] for body in data["bodies"]]
        return cls(points, inertias, list(data["joints"].values()), names, data["load"])

    def arm(self, bodies: np.ndarray, point: str) -> tuple[int, np.ndarray]:
        """Body of a point, and the vector to it from the centre of mass in fixed axes."""
        body, place = self.points[point]
        return body, turn(bodies[body, 2]) @ place

    def at(self, bodies: np.ndarray, point: str) -> np.ndarray:
        body, arm = self.arm(bodies, point)
        return bodies[body, :2] + arm

    def accelerations(self, bodies: np.ndarray, rates: np.ndarray) -> tuple[np.ndarray, dict[tuple, np.ndarray]]:
        """Accelerations (8, 3), the ground's included, and the force of each joint on its second body."""
        count = len(self.joints)
        forces = np.zeros_like(bodies)
        forces[1, 2] = self.load["torque"]
        spring = np.subtract(*(self.at(bodies, point) for point in reversed(self.load["spring"])))
        length = np.hypot(*spring)
        pull = -self.load["stiffness"] * (length - self.load["free_length"]) * spring / length
        body, arm = self.arm(bodies, self.load["spring"][1])
        forces[body] += [*pull, arm[0] * pull[1] - arm[1] * pull[0]]

        jacobian, right = np.zeros((count, 2, *bodies.shape)), np.zeros((count, 2))
        for row, sides in enumerate(self.joints):
            for sign, point in zip((-1.0, 1.0), sides, strict=True):
                body, arm = self.arm(bodies, point)
                jacobian[row, :, body] = sign * np.array([[1.0, 0.0, -arm[1]], [0.0, 1.0, arm[0]]])
                right[row] += sign * arm * rates[body, 2] ** 2
        jacobian = jacobian[:, :, 1:].reshape(2 * count, -1)
        corner = np.zeros((2 * count, 2 * count))
        matrix = np.block([[np.diag(self.inertias.ravel()), -jacobian.T], [jacobian, corner]])
        solution = np.linalg.solve(matrix, np.concatenate([forces[1:].ravel(), right.ravel()]))
        accelerations = np.vstack([np.zeros(3), solution[: self.inertias.size].reshape(-1, 3)])
        multipliers = solution[self.inertias.size :].reshape(-1, 2)
        return accelerations, {tuple(sides): force for sides, force in zip(self.joints, multipliers, strict=True)}


def turn(angle: float) -> np.ndarray:
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def placed(data: dict, plane: Plane) -> np.ndarray:
    """Coordinates (x, y, angle) of ground and bodies at first, shape (8, 3)."""
    bodies = np.zeros((len(plane.names) + 1, 3))
    bodies[1:, 2] = factors(data) @ data["initial"]["q"]
    for number, body in enumerate(data["bodies"], start=1):
        own, carrier = body["anchor"]
        _, arm = plane.arm(bodies, f"{body['name']}.{own}")
        bodies[number, :2] = plane.at(bodies, carrier) - arm
    return bodies


def factors(data: dict) -> np.ndarray:
    """Angles of the bodies are these factors times the seven coordinates of the test set."""
    return np.array([body["angle"] for body in data["bodies"]], dtype=float)


def multipliers(forces: dict[tuple, np.ndarray]) -> np.ndarray:
    """Those of the test set: forces at E on K3, K4 and K6."""
    return np.concatenate([forces["K2.E", f"{body}.E"] for body in ("K3", "K4", "K6")])


@pytest.fixture
def data(reference) -> dict:
    return reference("andrews")


def test_initial_values(data) -> None:
    plane = Plane.of(data)
    bodies = placed(data, plane)
    gaps = [plane.at(bodies, second) - plane.at(bodies, first) for first, second in plane.joints]
    np.testing.assert_allclose(gaps, 0.0, atol=1e-16)
    acceleration, forces = plane.accelerations(bodies, np.zeros_like(bodies))
    relative = np.linalg.solve(factors(data), acceleration[1:, 2])
    np.testing.assert_allclose(relative, data["initial"]["acceleration"], rtol=1e-12, atol=1e-8)
    np.testing.assert_allclose(multipliers(forces), data["initial"]["multipliers"], rtol=1e-12, atol=1e-10)


def test_end_values(data) -> None:
    plane, end = Plane.of(data), data["end"]

    def motion(_: float, y: np.ndarray) -> np.ndarray:
        bodies, rates = y.reshape(2, -1, 3)
        return np.concatenate([rates.ravel(), plane.accelerations(bodies, rates)[0].ravel()])

    bodies = placed(data, plane)
    start = np.concatenate([bodies.ravel(), np.zeros(bodies.size)])
    solution = solve_ivp(motion, (0.0, end["time"]), start, method="DOP853", rtol=1e-12, atol=1e-13)
    assert solution.success, solution.message
    bodies, rates = solution.y[:, -1].reshape(2, -1, 3)
    accelerations, forces = plane.accelerations(bodies, rates)
    q, velocity, acceleration = np.linalg.solve(
        factors(data), np.column_stack([bodies[1:, 2], rates[1:, 2], accelerations[1:, 2]])
    ).T
    assert q == pytest.approx(end["q"], rel=1e-8)
    assert velocity == pytest.approx(end["velocity"], rel=1e-7)
    # The test set's own accelerations and multipliers (index 3) are good to 1.3e-6 of each: here they stand still from
    # a tolerance of 1e-11 on.
    assert acceleration == pytest.approx(end["acceleration"], rel=2e-6)
    assert multipliers(forces) == pytest.approx(end["multipliers"], rel=2e-6)
