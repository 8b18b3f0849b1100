"""Harmonic balance with friction against independent codes, closed forms, and limits of the laws."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from dalembert.structure import lumped
from dalembert.vibration import (
    ElasticSlider,
    FrictionContact,
    HarmonicBalance,
    HarmonicForce,
    Rigid,
    VibrationSystem,
    frequency_response,
)
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.laws.contact_sums import Shape, contact_sums
from dalembert.vibration.laws.friction_law import SLIPPING, STUCK
from vibrating_systems import chain, duffing, massless_foot, one_mass, two_masses

TOPIC = "Friction in frequency"
CODES = "the same equations in independent harmonic balance codes"
TURN = 2 * np.pi


@pytest.mark.parametrize(
    ("harmonics", "published"), [(1, 3.6405013685), (5, 3.6251784738), (7, 3.6247259686), (9, 3.6247415284)]
)
def test_one_mass_with_a_slider(record_evidence, harmonics: int, published: float) -> None:
    method = HarmonicBalance(harmonics, samples=1024, events=False)
    curve = frequency_response(one_mass(), np.array([1.12]) / TURN, method)
    record_evidence(
        f"one mass with a slider, {harmonics} harmonics: largest displacement at 1.12 rad/s",
        published, curve.amplitude("m")[0], tolerance=5e-11, topic=TOPIC, kind="other code", source=CODES, unit="m",
    )  # fmt: skip


@pytest.mark.parametrize(
    ("harmonics", "published"), [(1, 4.8150033694), (5, 4.6653328247), (7, 4.6635200230), (9, 4.6647671962)]
)
def test_two_masses_with_a_slider(record_evidence, harmonics: int, published: float) -> None:
    method = HarmonicBalance(harmonics, samples=1024, events=False)
    curve = frequency_response(two_masses(), np.array([0.88]) / TURN, method)
    record_evidence(
        f"two masses with a slider, {harmonics} harmonics: largest displacement at 0.88 rad/s",
        published, curve.amplitude("m2")[0], tolerance=5e-11, topic=TOPIC, kind="other code", source=CODES, unit="m",
    )  # fmt: skip


EXACT = {
    "m": ((1, 3.6404880841), (5, 3.6251839247), (7, 3.6247393277), (9, 3.6247543381)),
    "m2": ((1, 4.8149850598), (5, 4.6654096960), (7, 4.6634858311), (9, 4.6646731246)),
}


@pytest.mark.parametrize(
    ("mass", "samples", "tolerance"), [("m", 128, 3e-9), ("m", 1024, 1e-10), ("m2", 128, 6e-8), ("m2", 1024, 1e-10)]
)
def test_sums_corrected_at_events_leave_no_error_of_sampling(
    record_evidence, mass: str, samples: int, tolerance: float
) -> None:
    system, omega = (one_mass(), 1.12) if mass == "m" else (two_masses(), 0.88)
    for harmonics, exact in EXACT[mass]:
        curve = frequency_response(
            system, np.array([omega]) / TURN, HarmonicBalance(harmonics, samples=samples, tolerance=1e-13)
        )
        record_evidence(
            f"slider on {mass}, {harmonics} harmonics, {samples} samples corrected at events: largest displacement",
            exact, curve.amplitude(mass)[0], tolerance=tolerance, topic=TOPIC, unit="m",
            kind="other method", source="independent event-driven evaluation, 1,024 corrected samples",
        )  # fmt: skip


@pytest.mark.slow
def test_three_masses_with_sliders_cubic_springs_and_a_stop(record_evidence) -> None:
    omegas = np.arange(0.8, 1.7001, 0.005)
    curve = frequency_response(chain(), omegas / TURN, HarmonicBalance(7, samples=1024, events=False))
    assert curve.converged.all()
    for mass, at, published in (("m1", 1.635, 0.20274), ("m2", 1.610, 0.23301), ("m3", 1.625, 0.71153)):
        sizes = curve.amplitude(mass, "rms")
        record_evidence(
            f"three masses with sliders, cubic springs and a stop: largest rms of {mass}",
            published, sizes.max(), tolerance=5e-6, topic=TOPIC, kind="other code", source=CODES, unit="m",
        )  # fmt: skip
        assert omegas[sizes.argmax()] == pytest.approx(at, abs=1e-9)


def test_duffing_oscillator_past_its_folds(record_evidence) -> None:
    method = HarmonicBalance(7, resolution=0.01)
    curve = frequency_response(duffing(), (0.5 / TURN, 2.0 / TURN), method, continuation="arc-length")
    assert curve.converged.all()
    for folds, published in zip(curve.folds * TURN, (1.269602, 1.115700), strict=True):
        record_evidence(
            "Duffing oscillator: frequency of a fold", published, folds,
            tolerance=1e-6, topic=TOPIC, kind="other code", source=CODES, unit="rad/s",
        )  # fmt: skip
    record_evidence(
        "Duffing oscillator: largest first harmonic", 2.83019, curve.peak("m", "harmonic 1").amplitude,
        tolerance=1e-5, topic=TOPIC, kind="other code", source=CODES, unit="m",
    )  # fmt: skip
    up = frequency_response(duffing(), np.append(np.arange(0.8, 1.265, 0.02), 1.26878) / TURN, method)
    record_evidence(
        "Duffing oscillator: first harmonic at 1.26878 rad/s, where the published curve is largest", 2.83019,
        up.amplitude("m", "harmonic 1")[-1], tolerance=5e-6, topic=TOPIC, kind="other code", source=CODES, unit="m",
    )  # fmt: skip


def largest(system: VibrationSystem, omega: float, harmonics: int, dof: str = "m") -> float:
    curve = frequency_response(system, np.array([omega]) / TURN, HarmonicBalance(harmonics, samples=1024))
    assert curve.converged.all()
    return float(curve.amplitude(dof)[0])


@pytest.mark.parametrize("harmonics", [1, 9])
def test_a_rigid_contact_on_a_massless_foot_is_the_elastic_one_with_the_stiffness_behind_it(
    record_evidence, harmonics: int
) -> None:
    record_evidence(
        f"rigid contact of a massless foot against the elastic law, {harmonics} harmonics: largest displacement",
        largest(one_mass(), 1.12, harmonics), largest(massless_foot(Rigid()), 1.12, harmonics),
        tolerance=1e-13, topic=TOPIC, kind="other method", source="elastic law with the same stiffness", unit="m", noisy=True,
    )  # fmt: skip


def test_a_rigid_contact_forgets_its_penalty_as_harmonics_are_added(record_evidence) -> None:
    """Over three decades of the penalty, 0.025 to 25 beside a stiffness of 0.8 behind the contact.

    Forces above the highest harmonic act on a compliance 1/penalty instead of the structure's. A contact that slips for
    a part of the period has a force with kinks, whose harmonics fall as 1/h²; so does what the penalty changes.
    """
    exact, harmonics = largest(massless_foot(Rigid()), 1.12, 39), (9, 19, 39)
    spread = [
        max(abs(largest(massless_foot(Rigid(penalty)), 1.12, number) / exact - 1) for penalty in (0.025, 0.8, 25.0))
        for number in harmonics
    ]
    source = "the rigid law without a penalty"
    for number, size in zip(harmonics, spread, strict=True):
        record_evidence(
            f"rigid contact, {number} harmonics: largest change of the response, as part of it, by a penalty over "
            "three decades",
            0.0, size, tolerance=2.5 / number**2, topic=TOPIC, kind="other method", source=source,
        )  # fmt: skip
    record_evidence(
        "rigid contact: order in the harmonics of what a penalty over three decades changes",
        2.0, -np.polyfit(np.log(harmonics), np.log(spread), 1)[0], tolerance=0.25, topic=TOPIC, kind="other method", source=source,
    )  # fmt: skip
    record_evidence(
        "rigid contact, 19 harmonics, with the penalty that is chosen: difference from the limit, as part of it",
        0.0, largest(massless_foot(Rigid()), 1.12, 19) / exact - 1, tolerance=2e-5, topic=TOPIC, kind="other method", source=source,
    )  # fmt: skip


@pytest.mark.parametrize("second", [None, "b"])
@pytest.mark.parametrize("kind", ["displacement", "velocity"])
def test_the_penalty_does_not_matter_where_a_rigid_contact_sticks(second: str | None, kind: str) -> None:
    """A contact that sticks is a clamp, whatever the penalty, to the ground and between two masses alike."""
    results = []
    for penalty in (1.0, 30.0, 1000.0):
        springs = [("a", None, 1.0, 0.02), ("a", "b", 2.0, 0.04), ("b", None, 0.5, 0.01)]
        system = VibrationSystem(lumped({"a": 1.0, "b": 1.5}, springs))
        system.add(HarmonicForce("a", 1.0))
        system.add(HarmonicForce("b", 0.5))
        system.add(FrictionContact("joint", "a", second, friction=1.0, preload=50.0, law=Rigid(penalty, kind)))
        curve = frequency_response(system, np.array([0.5, 0.9]) / TURN, HarmonicBalance(5, samples=256))
        assert np.all(curve.states == 1)
        results.append(curve.amplitude("b"))
    moving, mass, stiffness, damping = (1.5, 2.5, 1.5, 0.03) if second else (0.5, 1.5, 2.5, 0.05)
    for omega, *found in zip((0.5, 0.9), *results, strict=True):
        clamped = abs(moving / (stiffness - omega**2 * mass + 1j * omega * damping))
        np.testing.assert_allclose(found, clamped, rtol=1e-6)


def test_the_elastic_law_tends_to_the_rigid_one(record_evidence) -> None:
    """With the contact's stiffness as the penalty, the difference falls as the inverse of the stiffness."""
    stiffnesses = (15.0, 150.0, 1500.0)
    differences = [
        abs(largest(two_masses(ElasticSlider(k)), 0.88, 5, "m2") - largest(two_masses(Rigid(k)), 0.88, 5, "m2"))
        for k in stiffnesses
    ]
    record_evidence(
        "elastic contact against the rigid one: order in the inverse of its stiffness",
        1.0, np.log10(differences[1] / differences[2]), tolerance=0.05, topic=TOPIC, kind="closed form", source="series of springs",
    )  # fmt: skip
    assert differences[0] > differences[1] > differences[2]


def test_one_harmonic_of_a_slider_is_the_closed_form(record_evidence) -> None:
    r"""Loop of Jenkins: with cos θ = 1 - 2 μN/(k X), Λc = kX/π (θ - sin θ cos θ), Λs = -(4 μN/π) (1 - μN/(k X))."""
    curve = frequency_response(one_mass(), np.array([1.12]) / TURN, HarmonicBalance(1, samples=4096))
    size, limit, stiffness = curve.amplitude("m", "harmonic 1")[0], 1.0, 0.8
    theta = np.arccos(1 - 2 * limit / (stiffness * size))
    spring = stiffness * size / np.pi * (theta - np.sin(theta) * np.cos(theta))
    loss = 4 * limit / np.pi * (1 - limit / (stiffness * size))
    balance = np.hypot((1 - 1.12**2) * size + spring, 0.04 * 1.12 * size + loss)
    record_evidence(
        "one harmonic of a slider: force that balances the response", 1.0, balance,
        tolerance=1e-6, topic=TOPIC, kind="closed form", source="Jenkins' element", unit="N",
    )  # fmt: skip
    record_evidence(
        "energy that a slider takes in a period of full slip", 4 * limit * (size - limit / stiffness),
        curve.dissipated("slider.x")[0], tolerance=1e-5, topic=TOPIC, kind="closed form", source="4 μN (X - μN/k)", unit="J",
    )  # fmt: skip


@pytest.mark.parametrize(("shape", "width", "sticks"), [("wide", 1.1, False), ("narrow", 0.1, True)])
def test_slip_in_two_directions(record_evidence, shape: str, width: float, sticks: bool) -> None:
    """A foot moves along an ellipse under a load that varies, and sticks in part if that is narrow."""
    numbers, load = np.array([[2.0, 3.0, 0.0, 0.5, 2.0]]), 0.3
    place = np.array([[[0.1, 1.0, 0.2], [-0.2, 0.3, width], [0.0, load, 0.1]]])
    exact, stuck = _in_time(place[0], numbers[0])
    force, states = contact_sums(numbers, Shape(2, True, True), Fourier((0, 1), 128), True).forces(place)
    assert np.any(states == SLIPPING)
    assert np.any(states == STUCK) == stuck == sticks
    record_evidence(
        f"slip in two directions along a {shape} ellipse: largest error of the force's coefficients, 128 samples",
        0.0, np.abs(force[0, :2] - exact).max(), tolerance=1e-6, topic=TOPIC, unit="N", noisy=True,
        kind="other code", source="the slider's place integrated in time, between its stops, by DOP853",
    )  # fmt: skip


def _in_time(place: np.ndarray, numbers: np.ndarray) -> tuple[np.ndarray, bool]:
    """Coefficients of the tangential forces in the sixth period, and whether the slider rests in it."""
    stiffness, normal, _, friction, load = numbers

    def at(tau: float, order: int = 0) -> np.ndarray:
        c, s = np.cos(tau), np.sin(tau)
        return place @ (np.array([1.0, c, s]) if order == 0 else np.array([0.0, -s, c]))

    def limit(tau: float, order: int = 0) -> float:
        return friction * (normal * at(tau, order)[2] + (load if order == 0 else 0.0))

    def rate(tau: float, z: np.ndarray) -> float:
        force = stiffness * (at(tau)[:2] - z)
        return at(tau, 1)[:2] @ force / np.linalg.norm(force) - limit(tau, 1) / stiffness

    def excess(tau: float, z: np.ndarray) -> float:
        return float(np.linalg.norm(stiffness * (at(tau)[:2] - z)) - limit(tau))

    def slide(tau: float, z: np.ndarray) -> np.ndarray:
        force = stiffness * (at(tau)[:2] - z)
        return rate(tau, z) * force / np.linalg.norm(force)

    rate.terminal, excess.terminal, rate.direction, excess.direction = True, True, -1, 1  # type: ignore[attr-defined]
    tau, z, sliding, pieces, end = 0.0, np.zeros(2), False, [], 12 * np.pi
    if excess(tau, z) > 0:
        force = stiffness * (at(tau)[:2] - z)
        z, sliding = at(tau)[:2] - limit(tau) * force / np.linalg.norm(force) / stiffness, True
    while tau < end:
        own, event = (slide, rate) if sliding else (lambda _, z: 0.0 * z, excess)
        piece = solve_ivp(
            own, (tau, end), z, method="DOP853", events=event, rtol=1e-12, atol=1e-13, max_step=0.05, dense_output=True
        )
        pieces.append((tau, piece.t[-1], piece.sol, sliding))
        tau, z, sliding = piece.t[-1], piece.y[:, -1], not sliding
    nodes, weights = np.polynomial.legendre.leggauss(60)
    result = np.zeros((2, 3))
    for begin, stop, solution, _ in pieces:
        for low, high in pairwise(np.linspace(max(begin, 10 * np.pi), max(stop, 10 * np.pi), 5)):
            for node, weight in zip(nodes, weights * (high - low) / 2, strict=True):
                t = (low + high) / 2 + node * (high - low) / 2
                force = stiffness * (at(t)[:2] - solution(t))
                result += weight * np.outer(force, [0.5, np.cos(t), np.sin(t)]) / np.pi
    return result, any(not moves for _, stop, _, moves in pieces if stop > 10 * np.pi)
