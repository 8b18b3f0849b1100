"""The slider-crank with sensitivities in one coordinate, its gradient by complex step through SciPy's integrator."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

STEP = 1e-20


def kinetic_energy_integral(data: dict, stiffness: complex, damping: complex) -> complex:
    model = data["model"]
    a, b = model["crank_length"], model["rod_length"]

    def motion(_: float, y: np.ndarray) -> np.ndarray:
        q, rate, _ = y
        p = np.arcsin(-a / b * np.sin(q))
        turn = -a * np.cos(q) / (b * np.cos(p))  # dp/dq and its slope
        bend = (a * np.sin(q) + b * np.sin(p) * turn**2) / (b * np.cos(p))
        slide = -a * np.sin(q) - b * np.sin(p) * turn  # dx/dq and its slope
        curve = -a * np.cos(q) - b * np.cos(p) * turn**2 - b * np.sin(p) * bend
        inertia = model["crank_inertia"] + model["rod_inertia"] * turn**2 + model["rod_mass"] * slide**2
        slope = model["rod_inertia"] * turn * bend + model["rod_mass"] * slide * curve
        # The middles of crank and rod are level with each other, half the slider's distance apart.
        spring = (a * np.cos(q) + b * np.cos(p)) / 2
        pull = stiffness * (spring - model["free_length"]) + damping * slide * rate / 2
        force = model["force"] * (slide - model["force_point"] * np.sin(p) * turn)
        acceleration = (force - pull * slide / 2 - slope * rate**2) / inertia
        return np.array([rate, acceleration, inertia * rate**2 / 2])

    start = np.array([data["initial"]["crank_angle"], 0.0, 0.0], dtype=complex)
    solution = solve_ivp(motion, (0.0, data["values"]["end"]), start, method="DOP853", rtol=1e-12, atol=1e-12)
    assert solution.success, solution.message
    return solution.y[2, -1]


def test_kinetic_energy_integral_and_its_gradient(reference) -> None:
    data = reference("slider_crank_sensitivity")
    k, c, values = data["model"]["stiffness"], data["model"]["damping"], data["values"]
    by_stiffness = kinetic_energy_integral(data, k + STEP * 1j, c)
    by_damping = kinetic_energy_integral(data, k, c + STEP * 1j)
    assert by_stiffness.real == pytest.approx(values["kinetic_energy_integral"], abs=1e-10)
    assert by_stiffness.imag / STEP == pytest.approx(values["by_stiffness"], abs=1e-10)
    assert by_damping.imag / STEP == pytest.approx(values["by_damping"], abs=1e-10)
