"""Laws with a memory: energies of cycles in closed form, motions by a solver of ordinary differential equations."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from dalembert.structure import lumped
from dalembert.vibration import (
    BoucWen,
    FourParameterIwan,
    HarmonicBalance,
    HarmonicForce,
    LawElement,
    Newmark,
    UserLaw,
    VibrationSystem,
    compare_in_time,
    floquet_multipliers,
    frequency_response,
)
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.interface.lowering import lower

TOPIC = "Hysteretic laws in frequency"
TURN = 2 * np.pi


def alone(element: LawElement, force: float = 0.5) -> VibrationSystem:
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 0.5, 0.02)]))
    system.add(HarmonicForce("m", force))
    system.add(element)
    return system


def energy(element: LawElement, amplitude: float, samples: int = 4096) -> float:
    """Energy that an element takes in a cycle of u = amplitude cos τ."""
    (block,) = lower(alone(element)).real.laws
    force = block.sums(Fourier((0, 1), samples)).forces(np.array([[[0.0, amplitude, 0.0]]]), 1.0)
    return float(-np.pi * amplitude * force[0, 0, 2])


@pytest.mark.parametrize("amplitude", [0.02, 0.1, 0.28])
@pytest.mark.parametrize(("exponent", "ratio"), [(-0.6, 1.2), (-0.2, 0.3), (0.0, 0.0)])
def test_the_joint_dissipates_by_the_power_law(
    amplitude: float, exponent: float, ratio: float, record_evidence
) -> None:
    element = FourParameterIwan("joint", "m", force_limit=0.4, stiffness=2.0, exponent=exponent, ratio=ratio)
    assert amplitude < element.reach.real
    softening = element.numbers["softening"]
    density = softening * (exponent + 1) * (exponent + 2)
    record_evidence(
        f"four-parameter Iwan model, χ = {exponent:g}, β = {ratio:g}: energy of a cycle of {amplitude:g} m",
        4 * density * amplitude ** (exponent + 3) / ((exponent + 2) * (exponent + 3)),
        energy(element, amplitude),
        tolerance=1e-5,
        relative=True,
        unit="J",
        topic=TOPIC,
        kind="closed form",
        source="Segalman (2005), equation 16",
    )


def test_a_joint_beyond_its_limit_dissipates_as_its_sliders_do(record_evidence) -> None:
    element = FourParameterIwan("joint", "m", force_limit=0.4, stiffness=2.0, exponent=-0.6, ratio=1.2)
    reach, chi = element.reach, element.exponent
    density = element.numbers["softening"] * (chi + 1) * (chi + 2)
    strong = element.force_limit / reach * element.ratio / (element.ratio + (chi + 1) / (chi + 2))
    amplitude = 1.7 * reach
    # ∫ 4 φ (u - φ) ρ(φ) dφ over all sliders
    whole = 4 * density * (amplitude * reach ** (chi + 2) / (chi + 2) - reach ** (chi + 3) / (chi + 3))
    record_evidence(
        "four-parameter Iwan model beyond its limit: energy of a cycle",
        whole + 4 * strong * reach * (amplitude - reach),
        energy(element, amplitude),
        tolerance=1e-5,
        relative=True,
        unit="J",
        topic=TOPIC,
        kind="closed form",
        source="integral over the sliders' density",
    )


@pytest.mark.parametrize("amplitude", [0.3, 1.0, 4.0])
def test_bouc_wen_cycles_take_the_energy_in_closed_form(amplitude: float, record_evidence) -> None:
    element = BoucWen("mount", "m", stiffness=2.0, ratio=0.2, yield_displacement=0.5)
    x = amplitude / 0.5
    z = 1.0
    for _ in range(200):  # z at the turns: 1 - exp(-(2x - z)), where the loop closes
        z = 1 - np.exp(-(2 * x - z))
    area = 2 * (-(z**2) / 2 + (2 * x - z) - z)
    record_evidence(
        f"Bouc-Wen model, n = 1: energy of a cycle of {x:g} yield displacements",
        0.8 * 2.0 * 0.5**2 * area,
        energy(element, amplitude),
        tolerance=1e-5,
        relative=True,
        unit="J",
        topic=TOPIC,
        kind="closed form",
        source="exponential branches for β = γ = 1/2",
    )


def after(element: BoucWen, omega: float, state: np.ndarray, part: float = 1.0) -> np.ndarray:
    """State (u, v, z) a part of a period after one at the start of a period, by DOP853."""
    alpha, k, yields = element.ratio, element.stiffness, element.yield_displacement

    def rates(t: float, y: np.ndarray) -> list[float]:
        u, v, z = y
        force = 0.5 * u + 0.02 * v + k * (alpha * u + (1 - alpha) * yields * z)
        slope = 1 - abs(z) ** element.exponent * (element.gamma + element.beta * np.sign(z * v))
        return [v, 0.5 * np.cos(omega * t) - force, slope * v / yields]

    return solve_ivp(rates, (0, part * TURN / omega), state, method="DOP853", rtol=1e-11, atol=1e-13).y[:, -1]


def settled(element: BoucWen, omega: float, periods: int) -> np.ndarray:
    """State at the start of a period, after many from rest."""
    state = np.zeros(3)
    for _ in range(periods):
        state = after(element, omega, state)
    return state


@pytest.mark.slow
@pytest.mark.parametrize(("exponent", "beta", "gamma"), [(1.0, 0.5, 0.5), (2.0, 0.7, 0.2)])
def test_bouc_wen_motions_are_those_of_its_differential_equations(exponent, beta, gamma, record_evidence) -> None:
    element = BoucWen(
        "mount", "m", stiffness=0.5, ratio=0.1, yield_displacement=0.3, exponent=exponent, beta=beta, gamma=gamma
    )
    omega = TURN * 0.13
    curve = frequency_response(alone(element), np.array([0.13]), HarmonicBalance(21, samples=2048))
    start = settled(element, omega, 60)
    motion = np.array([after(element, omega, start, part)[0] for part in np.arange(32) / 32])
    ours = Fourier(curve.orders, 32).synthesis @ curve.response[0, 0]
    record_evidence(
        f"mass on a Bouc-Wen spring, n = {exponent:g}: motion over a period",
        motion,
        ours,
        tolerance=1e-4,
        relative=True,
        unit="m",
        topic=TOPIC,
        kind="other code",
        source="DOP853 of SciPy on the differential equations of the model, 60 periods",
    )


LAWS = {
    "Bouc-Wen": BoucWen("law", "m", stiffness=0.5, ratio=0.1, yield_displacement=0.3, exponent=2.0),
    "four-parameter Iwan": FourParameterIwan("law", "m", force_limit=0.3, stiffness=0.8, exponent=-0.5, ratio=1.0),
}


def drag(u, v, z, numbers, force):
    force[0] = numbers[0] * v[0] * (v[0] if v[0].real > 0 else -v[0])


@pytest.mark.parametrize("name", [*LAWS, "drag"])
def test_harmonic_balance_and_steps_in_time_agree(name: str, record_evidence) -> None:
    system = alone(LAWS[name] if name in LAWS else UserLaw("law", "m", function=drag, values=[0.3]))
    curve = frequency_response(system, np.array([0.1, 0.16]), HarmonicBalance(21, samples=1024))
    comparison = compare_in_time(system, curve, points=[0, 1], method=Newmark(4096))
    assert comparison.converged.all()
    record_evidence(
        f"mass with the law {name}: amplitudes at two frequencies, relative to integration in time",
        np.zeros(2),
        comparison.differences[:, 0],
        tolerance=1e-4,
        topic=TOPIC,
        kind="other method",
        source="integration in time, 4,096 steps of a period",
    )


def test_quadratic_drag_at_resonance_has_the_amplitude_of_its_mean_power(record_evidence) -> None:
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.0)]))
    system.add(HarmonicForce("m", 0.5, phase=np.pi / 2))
    system.add(UserLaw("law", "m", function=drag, values=[0.3]))
    curve = frequency_response(system, np.array([0.95, 1.0]) / TURN, HarmonicBalance(1, samples=4096))
    # at resonance the force F balances the first harmonic of c v|v|: 8/(3 π) c (ω a)²
    record_evidence(
        "quadratic drag at resonance, one harmonic: amplitude",
        np.sqrt(0.5 * 3 * np.pi / (8 * 0.3)),
        float(curve.amplitude("m")[1]),
        tolerance=1e-6,
        relative=True,
        unit="m",
        topic=TOPIC,
        kind="closed form",
        source="first harmonic 8/(3 π) of v|v|",
    )


def test_multipliers_with_a_memory_are_those_of_the_differential_equations(record_evidence) -> None:
    element = LAWS["Bouc-Wen"]
    assert isinstance(element, BoucWen)
    omega = TURN * 0.13
    curve = frequency_response(alone(element), np.array([0.13]), HarmonicBalance(15, samples=2048))
    ours = np.sort(np.abs(floquet_multipliers(alone(element), curve, 0)))[::-1]
    state = settled(element, omega, 40)
    matrix = np.empty((3, 3))
    for column in range(3):
        step = 1e-6 * np.eye(3)[column]
        matrix[:, column] = (after(element, omega, state + step) - after(element, omega, state - step)) / 2e-6
    theirs = np.sort(np.abs(np.linalg.eigvals(matrix)))[::-1]
    record_evidence(
        "mass on a Bouc-Wen spring: sizes of its two largest multipliers",
        theirs[:2],
        ours[:2],
        tolerance=2e-3,
        topic=TOPIC,
        kind="other code",
        source="differences of DOP853 of SciPy over a period",
    )
