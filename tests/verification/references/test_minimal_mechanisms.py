"""The published mechanisms in minimal coordinates, by SciPy alone: is what the reference files say the right model?"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

TIGHT = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-12}


def integrate(function, start, times) -> np.ndarray:
    """States at the times, shape (times, states)."""
    solution = solve_ivp(function, (0.0, times[-1]), start, t_eval=times, **TIGHT)
    assert solution.success, solution.message
    return solution.y.T


def test_simple_pendulum(reference) -> None:
    data = reference("simple_pendulum")
    model, values = data["model"], data["values"]
    states = integrate(
        lambda _, y: (y[1], -model["gravity"] / model["length"] * np.cos(y[0])), (np.pi, 0.0), values["times"]
    )
    position = model["length"] * np.column_stack([np.cos(states[:, 0]), np.sin(states[:, 0])])
    np.testing.assert_allclose(position, values["position"], atol=2e-9)


@pytest.mark.parametrize("case", range(3))
def test_n_four_bar(reference, case: int) -> None:
    """All uprights stay parallel: one angle; a rod across moves without turning, as fast as the upper ends."""
    data = reference("n_four_bar")
    model, values = data["model"], data["values"]
    windows, length = values["windows"][case], model["length"]
    inertia = ((windows + 1) / 3 + windows) * length**2
    weight = ((windows + 1) / 2 + windows) * model["gravity"] * length
    states = integrate(
        lambda _, y: (y[1], -weight / inertia * np.cos(y[0])),
        (model["angle"], -model["velocity"] / length),
        [values["time"]],
    )
    position = length * np.array([np.cos(states[0, 0]), np.sin(states[0, 0])])
    np.testing.assert_allclose(position, values["position"][case], atol=2e-9)


def test_two_link_arm(reference) -> None:
    data = reference("two_link_arm")
    model, values = data["model"], data["values"]
    (m1, m2), (l1, l2), g = model["mass"], model["length"], model["gravity"]
    coupling = m2 * l1 * l2 / 2

    def mass(angles: np.ndarray) -> np.ndarray:
        beside = coupling * np.cos(angles[0] - angles[1])
        return np.array([[(m1 / 3 + m2) * l1**2, beside], [beside, m2 * l2**2 / 3]])

    def motion(_: float, y: np.ndarray) -> np.ndarray:
        turn = coupling * np.sin(y[0] - y[1])
        moments = [
            -turn * y[3] ** 2 - (m1 / 2 + m2) * g * l1 * np.cos(y[0]),
            turn * y[2] ** 2 - m2 / 2 * g * l2 * np.cos(y[1]),
        ]
        return np.concatenate([y[2:], np.linalg.solve(mass(y[:2]), moments)])

    def energy(y: np.ndarray) -> float:
        height = (m1 / 2 + m2) * l1 * np.sin(y[0]) + m2 / 2 * l2 * np.sin(y[1])
        return y[2:] @ mass(y[:2]) @ y[2:] / 2 + g * height

    start = np.array([*model["angle"], 0.0, 0.0])
    states = integrate(motion, start, values["times"])
    assert energy(start) == pytest.approx(values["energy"], abs=1e-11)
    assert energy(states[-1]) == pytest.approx(values["energy"], abs=1e-9)
    np.testing.assert_allclose(states[:, :2], values["angles"], atol=1e-8)


def test_slider_crank(reference) -> None:
    data = reference("slider_crank")
    model, values = data["model"], data["values"]
    a, b = model["crank_length"], model["rod_length"]

    def slider_speed(theta: float) -> float:
        """Speed of the slider, for a crank that turns at 1 rad/s."""
        sin_rod = a / b * np.sin(theta)
        return -a * np.sin(theta) - a * np.cos(theta) * sin_rod / np.sqrt(1 - sin_rod**2)

    def inertia(theta: float) -> float:
        slider = slider_speed(theta)
        # A uniform rod: 1/3 of the mass times (v1.v1 + v1.v2 + v2.v2) of its two ends.
        crank_pin = np.array([-a * np.sin(theta), a * np.cos(theta)])
        slider_pin = np.array([slider, 0.0])
        ends = crank_pin @ crank_pin + crank_pin @ slider_pin + slider_pin @ slider_pin
        return model["crank_mass"] * a**2 / 3 + model["rod_mass"] * ends / 3 + model["slider_mass"] * slider**2

    def motion(torque: float, y: np.ndarray) -> tuple[float, float]:
        slope = (inertia(y[0] + 1e-30j) / 1e-30).imag
        return y[1], (torque - slope * y[1] ** 2 / 2) / inertia(y[0])

    driven = integrate(lambda _, y: motion(model["torque"], y), (0.0, 0.0), [1.0, model["torque_end"]])
    free = integrate(lambda _, y: motion(0.0, y), driven[-1], [values["times"][-1] - model["torque_end"]])
    np.testing.assert_allclose([*driven[:, 0], free[0, 0]], values["crank_angle"], rtol=1e-9)
