"""Harmonic balance with friction beside integration in time, with steps and from one change of state to the next."""

import numpy as np
import pytest

from dalembert.vibration import (
    ElasticSlider,
    HarmonicBalance,
    Newmark,
    Rigid,
    VibrationSystem,
    compare_in_time,
    frequency_response,
    steady_state,
)
from event_driven import Rubbing
from vibrating_systems import chain, duffing, heavy_foot, one_mass, pressed, two_masses

TOPIC = "Friction in frequency and in time"
TURN = 2 * np.pi
IN_TIME = "integration in time, 4096 steps of a period"
EVENTS = "integration from one change of stick and slip to the next"


@pytest.mark.parametrize(
    ("system", "omegas", "mass"),
    [
        (one_mass(), [1.12], "m"),
        (two_masses(), [0.88], "m2"),
        (chain(), [*np.arange(0.8, 1.6, 0.1), 1.625], "m3"),
        (duffing(), [0.8, 1.0, 1.1, 1.2], "m"),
    ],
    ids=["one mass", "two masses", "three masses", "Duffing"],
)
def test_the_references_in_time(record_evidence, request, system: VibrationSystem, omegas: list, mass: str) -> None:
    """At the last of the frequencies, on the branch on which they lead there."""
    curve = frequency_response(system, np.array(omegas) / TURN, HarmonicBalance(29, samples=2048))
    comparison = compare_in_time(system, curve, points=[len(curve) - 1], method=Newmark(4096), way="shooting")
    assert comparison.converged.all()
    row = curve.dofs.index(f"{mass}.x")
    record_evidence(
        f"reference system {request.node.callspec.id}, 29 harmonics: largest displacement at {omegas[-1]} rad/s",
        comparison.time[0, row], comparison.balance[0, row],
        tolerance=2e-5, topic=TOPIC, kind="other method", source=IN_TIME, unit="m", relative=True,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("size", "normal", "states", "tolerance"),
    [
        (10.0, 0.1, {1}, 2e-6),
        (30.0, 0.1, {1, 2}, 5e-6),
        (100.0, 0.1, {1, 2}, 1e-5),
        (300.0, 0.1, {1, 2}, 2e-5),
        (100.0, 1.0, {0, 1, 2}, 3e-5),
        (300.0, 1.0, {0, 1, 2}, 1e-4),
    ],
)
def test_a_pressed_mass_under_a_variable_normal_load(
    record_evidence, size: float, normal: float, states: set[int], tolerance: float
) -> None:
    """Where it moves most, by two routes; with the larger normal force it lifts off."""
    system = pressed(size, normal)
    curve = frequency_response(system, np.arange(3.0, 4.6, 0.05) / TURN, HarmonicBalance(8, samples=1024))
    assert curve.converged.all()
    top = int(curve.amplitude("m.x").argmax())
    assert set(np.unique(curve.states[top])) == states
    comparison = compare_in_time(system, curve, points=[top], method=Newmark(4096), way="shooting")
    assert comparison.converged.all()
    what = f"pressed mass driven by {size:g} N along and {normal * size:g} N across"
    for row, direction in enumerate(("along", "across")):
        record_evidence(
            f"{what}: largest displacement {direction}, at {TURN * curve.frequencies[top]:.2f} rad/s",
            comparison.time[0, row], comparison.balance[0, row],
            tolerance=tolerance, topic=TOPIC, kind="other method", source=IN_TIME, unit="m", relative=True,
        )  # fmt: skip


def test_an_elastic_contact_that_lifts_off_with_the_samples(record_evidence) -> None:
    """Half of the period apart; 40 harmonics, so that the samples at which forces are evaluated make the difference."""
    motion = steady_state(pressed(300.0, 1.0), 2.0 / TURN, Newmark(16384), way="shooting")
    assert motion.converged
    assert 0.4 < np.mean(motion.states == 0) < 0.5
    size = np.abs(motion.motion("m.x")).max()
    for samples, tolerance in ((512, 1.8e-3), (4096, 1.7e-4)):
        curve = frequency_response(pressed(300.0, 1.0), np.array([2.0]) / TURN, HarmonicBalance(40, samples=samples))
        moved = curve.motion("m.x", 0, TURN * np.arange(16384) / 16384)
        record_evidence(
            f"elastic contact that lifts off, {samples} samples of a period: largest difference at any instant, as "
            "part of the largest displacement",
            0.0, np.abs(moved - motion.motion("m.x")).max() / size,
            tolerance=tolerance, topic=TOPIC, kind="other method", source="integration in time, 16384 steps of a period",
        )  # fmt: skip


OMEGA, INSTANTS = 0.4, 2048


@pytest.fixture(scope="module")
def sticking() -> tuple[np.ndarray, float]:
    """Motion (instants, 2) of two masses, one of which rubs rigidly, and the part of the period in which it sticks."""
    stiffness = np.array([[2.0, -1.0], [-1.0, 1.5]])
    rubbing = Rubbing(np.eye(2), 0.1 * stiffness, stiffness, np.array([1.0, 0.0]), {1: 0.5}, OMEGA)
    start = rubbing.steady(np.zeros(4))
    _, seen, stuck = rubbing.period(start, TURN / OMEGA * np.arange(INSTANTS) / INSTANTS)
    return np.array(seen), stuck


def off(moved: np.ndarray, motion: np.ndarray) -> float:
    """Root mean square of a difference, as part of that of the motion."""
    return float(np.linalg.norm(moved - motion) / np.linalg.norm(motion))


@pytest.mark.parametrize(
    ("kind", "penalty", "leading", "most"), [("velocity", None, 0.1, 79), ("displacement", 15.0, 0.7, 39)]
)
def test_rigid_friction_with_long_sticking(
    record_evidence, sticking: tuple[np.ndarray, float], kind: str, penalty: float | None, leading: float, most: int
) -> None:
    """The force jumps where a slip turns or begins, so its harmonics fall as 1/h, and so does the error: leading/h."""
    motion, stuck = sticking
    assert 0.5 < stuck < 0.6
    errors, harmonics = [], [number for number in (5, 9, 19, 39, 79) if number <= most]
    for number in harmonics:
        method = HarmonicBalance(number, samples=1024, odd_only=True)
        curve = frequency_response(heavy_foot(Rigid(penalty, kind)), np.array([OMEGA]) / TURN, method)
        phases = TURN * np.arange(INSTANTS) / INSTANTS
        errors.append(off(np.stack([curve.motion(mass, 0, phases) for mass in ("m1", "m2")], axis=1), motion))
    for number in (9, 39):
        record_evidence(
            f"rigid contact of {kind} kind that sticks for {stuck:.0%} of the period, {number} harmonics: error of the "
            "motion (root mean square)",
            0.0, errors[harmonics.index(number)], tolerance=leading / number, topic=TOPIC, kind="other method", source=EVENTS,
        )  # fmt: skip
    record_evidence(
        f"rigid contact of {kind} kind that sticks for {stuck:.0%} of the period: order of the error in the harmonics",
        1.0, -np.polyfit(np.log(harmonics), np.log(errors), 1)[0], tolerance=0.3, topic=TOPIC, kind="other method", source=EVENTS,
    )  # fmt: skip


def test_the_elastic_law_in_time_tends_to_the_rigid_one(record_evidence, sticking: tuple[np.ndarray, float]) -> None:
    motion, _ = sticking
    errors, stiffnesses = [], (500.0, 1500.0, 5000.0)
    for stiffness in stiffnesses:
        system = heavy_foot(ElasticSlider(stiffness))
        own = steady_state(system, OMEGA / TURN, Newmark(4 * INSTANTS, 0.8))
        assert own.converged
        errors.append(off(own.displacements[::4], motion))
    record_evidence(
        "elastic contact in time against the rigid one: order in the inverse of its stiffness",
        1.0, -np.polyfit(np.log(stiffnesses), np.log(errors), 1)[0], tolerance=0.1, topic=TOPIC, kind="other method", source=EVENTS,
    )  # fmt: skip
