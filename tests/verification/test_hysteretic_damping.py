"""Hysteretic damping against direct solutions with a complex stiffness."""

import numpy as np
import pytest
from scipy.sparse import csc_array

from dalembert.structure import Dofs, Structure, lumped
from dalembert.vibration import (
    CubicSpring,
    FrequencyResponse,
    Gap,
    HarmonicBalance,
    HarmonicForce,
    StaticForce,
    VibrationSystem,
    frequency_response,
)
from dalembert.vibration.interface import condensation

TOPIC = "Hysteretic damping"
DIRECT = "direct solution with a complex stiffness, by the test itself"
FREQUENCIES = np.array([0.05, 0.1, 0.2, 0.3, 0.45])
MASS = np.diag([1.0, 2.0, 1.5])
STIFFNESS = np.array([[5.0, -2.0, 0.0], [-2.0, 5.0, -3.0], [0.0, -3.0, 4.0]])
LOSS = np.array([[0.5, -0.1, 0.0], [-0.1, 0.3, -0.2], [0.0, -0.2, 0.25]])
DAMPING = np.diag([0.02, 0.0, 0.01])
DOFS = Dofs(("a.x", "b.x", "c.x"))


def direct(omega: float, phasors: np.ndarray) -> np.ndarray:
    """Phasors of the motion (n,) at ω > 0 under those of forces."""
    return np.linalg.solve(STIFFNESS + 1j * LOSS - omega**2 * MASS + 1j * omega * DAMPING, phasors)


def phasors(response: np.ndarray, harmonic: int) -> np.ndarray:
    """Of a curve's response (dofs, coefficients): cosine less i times sine."""
    return response[:, 2 * harmonic - 1] - 1j * response[:, 2 * harmonic]


def test_one_mass_by_the_closed_form(record_evidence) -> None:
    k, m, eta, force = 8.0, 2.0, 0.1, 3.0
    system = VibrationSystem(lumped({"m": m}, [("m", None, k, 0.0, eta)]))
    system.add(HarmonicForce("m", force))
    resonance = np.sqrt(k / m) / (2 * np.pi)
    curve = frequency_response(system, np.array([0.5, 1.0, 2.0]) * resonance, HarmonicBalance(3))
    r = np.array([0.5, 1.0, 2.0])
    exact = force / k / np.sqrt((1 - r**2) ** 2 + eta**2)
    for ratio, expected, found in zip(r, exact, curve.amplitude("m", "harmonic 1"), strict=True):
        record_evidence(
            f"one mass, loss factor 0.1, at {ratio:g} times its frequency: amplitude",
            expected, found, tolerance=1e-12, topic=TOPIC, unit="m", kind="closed form", source="F / (k sqrt((1 - r²)² + η²))",
        )  # fmt: skip


@pytest.mark.parametrize("kind", ["dense", "sparse", "sparse and factorised"])
@pytest.mark.parametrize("retained", [False, True])
def test_three_masses_with_two_harmonics_and_a_static_force(
    record_evidence, monkeypatch, kind: str, retained: bool
) -> None:
    turned = np.array if kind == "dense" else csc_array
    if kind == "sparse and factorised":
        monkeypatch.setattr(condensation, "DENSE", 0)
    structure = Structure(turned(MASS), turned(STIFFNESS), DOFS, turned(DAMPING), loss=turned(LOSS))
    system = VibrationSystem(structure)
    system.add(HarmonicForce("a", 1.0, phase=0.3))
    system.add(HarmonicForce("c", 0.5, phase=-1.0, harmonic=2))
    system.add(StaticForce("b", 0.7))
    if retained:  # a stop out of reach, so that a coordinate is retained and the others are condensed
        system.add(Gap("stop", "b", stiffness=1.0, gap=1e6))
    curve = frequency_response(system, FREQUENCIES, HarmonicBalance(3))
    assert curve.converged.all()
    first, second = np.array([np.exp(0.3j), 0.0, 0.0]), np.array([0.0, 0.0, 0.5 * np.exp(-1.0j)])
    errors = []
    for frequency, response in zip(FREQUENCIES, curve.response, strict=True):
        omega = 2 * np.pi * frequency
        for harmonic, force in ((1, first), (2, second)):
            exact = direct(harmonic * omega, force)
            errors.append(np.abs(phasors(response, harmonic) - exact).max() / np.abs(exact).max())
        mean = np.linalg.solve(STIFFNESS, [0.0, 0.7, 0.0])  # without the loss
        errors.append(np.abs(response[:, 0] - mean).max() / np.abs(mean).max())
    record_evidence(
        f"three masses ({kind}{', one retained' * retained}), harmonics 0, 1 and 2: largest error of a motion",
        0.0, max(errors), tolerance=1e-12, topic=TOPIC, unit="", kind="other method", source=DIRECT,
    )  # fmt: skip


def damped(stiffness: complex, eta: complex) -> VibrationSystem:
    structure = Structure(MASS, stiffness * STIFFNESS, DOFS, DAMPING).with_loss(eta)
    system = VibrationSystem(structure)
    system.add(HarmonicForce("a", 1.0))
    system.add(CubicSpring("cubic", "b", stiffness=0.05))
    return system


def test_sensitivities_by_the_loss_factor_and_the_stiffness(record_evidence) -> None:
    model = FrequencyResponse(
        damped, {"stiffness": (0.5, 2.0), "eta": (0.01, 0.2)}, ["c harmonic 1"], FREQUENCIES,
        HarmonicBalance(5, tolerance=1e-13),
    )  # fmt: skip
    at, step = np.array([1.0, 0.1]), 1e-4
    jacobian = model.jacobian(at)[:, 0]
    for column, name in enumerate(("stiffness", "eta")):
        moved = np.array([at + shift * step * np.eye(2)[column] for shift in (-2, -1, 1, 2)])
        values = model.evaluate(moved).values[:, :, 0]
        differences = (values[0] - 8 * values[1] + 8 * values[2] - values[3]) / (12 * step)
        record_evidence(
            f"three masses with a cubic spring: derivatives by the {name}, largest difference as part of the largest",
            0.0, np.abs(jacobian[:, column] - differences).max() / np.abs(differences).max(),
            tolerance=1e-7, topic=TOPIC, unit="", kind="other method", source="central differences of fourth order",
        )  # fmt: skip
