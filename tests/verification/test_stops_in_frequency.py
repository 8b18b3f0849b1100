"""Whole paths of two published systems with stops and friction, with their turning points and their stability.

The systems are examples 03 and 07 of NLvib (Krack, Gross: "Harmonic Balance for Nonlinear Vibration Problems", 2019).
"""

from itertools import pairwise

import numpy as np
import pytest

from dalembert.structure import lumped
from dalembert.vibration import (
    BilinearStop,
    Gap,
    HarmonicBalance,
    HarmonicForce,
    StaticForce,
    VibrationSystem,
    backbone,
    frequency_response,
)
from random_vibrations import ACCEPTED, Law, RandomSystem, unbalanced
from sliders_in_time import Periodic, Sliders
from stops_in_time import Stops
from vibrating_systems import chain

TOPIC = "Friction in frequency"
TIME = "shooting with exact flows between the instants at which the stop changes"
SHOOTING = "shooting by fourth-order Runge-Kutta steps that end where sliders and stops change"
TURN = 2 * np.pi
CLOSE = 0.01
"""Distance of the largest multiplier from the unit circle within which a point may be judged wrongly."""


def stopped() -> tuple[VibrationSystem, Stops]:
    """Two masses, the first of which meets a stop."""
    system = VibrationSystem(lumped({"m1": 1.0, "m2": 1.0}, [("m1", "m2", 1.0, 0.03), ("m2", None, 1.0, 0.03)]))
    system.add(HarmonicForce("m2", 0.1))
    system.add(Gap("stop", "m1", stiffness=100.0, gap=1.0))
    own, stop = system.structure, (np.array([1.0, 0.0]), 100.0, 1.0)
    return system, Stops(own.mass, own.damping, own.stiffness, np.array([0.0, 0.1]), (stop,))


def state(curve, point: int) -> np.ndarray:
    """Displacements and velocities where the force is largest."""
    orders, x = np.arange(1, len(curve.orders)), curve.response[point]
    return np.append(x[:, 0] + x[:, 1::2].sum(axis=1), TURN * curve.frequencies[point] * (x[:, 2::2] @ orders))


def test_the_path_of_a_mass_that_meets_a_stop_has_two_turning_points(record_evidence) -> None:
    system, reference = stopped()
    curve = frequency_response(system, (0.8 / TURN, 0.5 / TURN), HarmonicBalance(21), continuation="arc-length")
    assert curve.converged.all()
    np.testing.assert_allclose(curve.frequencies[-1] * TURN, 0.5)
    grazing, last = TURN * curve.folds
    touching = next(omega for omega in np.linspace(0.66, 0.64, 20_001) if _linear(reference, omega) >= 1.0)
    record_evidence(
        "two masses with a stop: frequency at which it is touched and the path turns, rad/s", touching, grazing,
        tolerance=2e-6, topic=TOPIC, kind="closed form", source="motion without contact",
    )  # fmt: skip
    # Beyond the last turning point shooting finds none of the motions on the branch, and before it all.
    found = [reference.periodic(state(curve, point), TURN * curve.frequencies[point]) for point in range(len(curve))]
    kept = np.array([one is not None for one in found])
    assert np.all(np.abs(TURN * curve.frequencies[~kept] - last) < 1e-5)
    signs = [np.linalg.slogdet(np.eye(4) - one[1])[0] for one in found if one is not None]
    assert np.sum(np.diff(signs) != 0) == 2


def _linear(reference: Stops, omega: float) -> float:
    """Largest displacement of the first mass without contact."""
    stiffness = reference.stiffness - omega**2 * reference.mass + 1j * omega * reference.damping
    return float(np.abs(np.linalg.solve(stiffness, reference.force)[0]))


@pytest.mark.slow
@pytest.mark.parametrize(("harmonics", "unjudged"), [(5, 20), (9, 12), (15, 7), (21, 7)])
def test_stability_of_a_mass_that_meets_a_stop_is_that_of_shooting(
    record_evidence, harmonics: int, unjudged: int
) -> None:
    """Every point that is judged, however close to the unit circle, and also those where stability changes."""
    system, reference = stopped()
    method = HarmonicBalance(harmonics)
    curve = frequency_response(
        system, (0.8 / TURN, 0.5 / TURN), method, continuation="arc-length", stability=True, check=False
    )
    if harmonics == 21:
        kinds = [kind for kind, _ in curve.markers]
        assert kinds == ["fold", "fold", "period doubling", "period doubling", "torus", "torus"]
    points = np.flatnonzero(~curve.fold & (curve.stable >= 0))
    assert np.sum(curve.stable < 0) <= unjudged
    right = []
    for point in points:
        found = reference.periodic(state(curve, point), TURN * curve.frequencies[point])
        assert found is not None
        right.append((curve.stable[point] == 1) == (np.abs(np.linalg.eigvals(found[1])).max() < 1))
    record_evidence(
        f"two masses with a stop, {harmonics} harmonics: share of judged points with the right stability", 1.0,
        np.mean(right), tolerance=0.0, topic=TOPIC, kind="other method", source=TIME,
    )  # fmt: skip


def gear_pair(stop: type[BilinearStop | Gap]) -> VibrationSystem:
    """The relative motion of two gears with backlash under a mean torque: stops alone hold it."""
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 0.0, 0.1)]))
    system.add(StaticForce("m", 0.1))
    system.add(HarmonicForce("m", 0.05))
    system.add(stop("teeth", "m", stiffness=1.0, gap=1.0))
    return system


@pytest.mark.parametrize("stop", [BilinearStop, Gap])
def test_a_gear_pair_with_backlash_under_a_mean_torque_moves_as_in_time(record_evidence, stop) -> None:
    omegas = np.linspace(0.3, 1.6, 14)
    curve = frequency_response(gear_pair(stop), omegas / TURN, HarmonicBalance(31), check=False)
    assert curve.converged.all()
    # A spring of 1e-6 N/m in the reference keeps its flow without contact regular; it moves the motion by 1e-6 of it.
    one, stops = np.eye(1), ((np.ones(1), 1.0, 1.0), (-np.ones(1), 1.0, 1.0))
    reference = Stops(one, 0.1 * one, 1e-6 * one, np.array([0.05]), stops, mean=np.array([0.1]))
    errors = []
    for point, omega in enumerate(omegas.tolist()):
        own = state(curve, point)
        found = reference.periodic(own, omega)
        assert found is not None, omega
        errors.append(float(np.abs(found[0] - own).max() / np.hypot(*curve.response[point, 0, 1:3])))
    record_evidence(
        f"gear pair with backlash held by stops alone ({stop.__name__}): largest error of 14 points, as part of the "
        "motion", 0.0, max(errors), tolerance=1e-4, topic=TOPIC, kind="other method", source=TIME,
    )  # fmt: skip


def frequency_on_a_side(k: float, gap: float, size: float) -> float:
    """Of a unit mass on a unit spring, beyond a gap on springs of 1 + k, from -size on the free side, rad/s."""
    inner, centre = np.sqrt(1 + k), k * gap / (1 + k)
    free = np.pi - np.arccos(gap / size)
    return np.pi / (free + np.arctan2(np.sqrt(size**2 - gap**2) / inner, gap - centre) / inner)


def frequency_between_stops(k: float, gap: float, size: float) -> float:
    """The same with a stop on both sides."""
    inner, centre = np.sqrt(1 + k), k * gap / (1 + k)
    angle = np.arccos((gap - centre) / (size - centre))
    speed = (size - centre) * inner * np.sin(angle)
    return np.pi / 2 / (angle / inner + np.arctan2(gap, speed))


@pytest.mark.parametrize("k", [10.0, 100.0])
@pytest.mark.parametrize(
    ("stop", "gap", "exact", "tolerance"),
    [(Gap, 0.0, frequency_on_a_side, 1e-4), (Gap, 1.0, frequency_on_a_side, 1e-3),
     (BilinearStop, 1.0, frequency_between_stops, 1e-3)],
)  # fmt: skip
def test_backbones_of_a_bilinear_oscillator_are_those_in_closed_form(
    record_evidence, stop, gap: float, exact, tolerance: float, k: float
) -> None:
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.0)]))
    system.add(stop("stop", "m", stiffness=k, gap=gap))
    for amplitudes in (np.array([1.5, 3.0, 6.0, 12.0]), (1.5, 12.0)):
        found = backbone(system, amplitudes, 1, HarmonicBalance(31))
        assert found.converged.all()
        assert not found.findings
        waves = np.cos(np.outer(np.linspace(0, TURN, 721), range(32)))
        lowest = -np.min(found.shapes[:, 0][:, [0, *range(1, 63, 2)]] @ waves.T, axis=1)
        reference = np.array([exact(k, gap, float(size)) for size in lowest])
        record_evidence(
            f"bilinear oscillator, k = {k:g}, gap = {gap:g}, {stop.__name__}: frequencies of the backbone "
            f"({'given amplitudes' if isinstance(amplitudes, np.ndarray) else 'path'}), rad/s",
            reference, TURN * found.frequencies, tolerance=tolerance, relative=True, topic=TOPIC, kind="closed form",
            source="times of the free and the stopped part of a period",
        )  # fmt: skip


CHAIN = {"m1": [1.0, 0, 0], "12": [1.0, -1, 0], "m2": [0, 1.0, 0], "23": [0, 1.0, -1], "m3": [0, 0, 1.0]}
"""Rows of relative displacement in the chain of three masses."""


@pytest.mark.slow
def test_the_path_of_a_chain_with_sliders_and_a_stop_has_four_turning_points(record_evidence) -> None:
    way = {name: np.array(row) for name, row in CHAIN.items()}
    own = RandomSystem(chain(), np.zeros(0), laws=[
        Law(way["m1"], None, stiffness=20.0, friction=1.0, load=1.0),
        Law(way["12"], None, stiffness=20.0, friction=1.0, load=1.0),
        Law(None, way["m3"], normal_stiffness=1.0, gap=0.25),
    ], cubic=[(way["m2"], 1.0), (way["23"], 1.0)])  # fmt: skip
    method = HarmonicBalance(7, sampling=1e-9)
    curve = frequency_response(own.system, (0.5 / TURN, 2 / TURN), method, continuation="arc-length")
    assert curve.converged.all()
    np.testing.assert_allclose(curve.frequencies[-1] * TURN, 2.0)
    assert len(curve.folds) == 4
    worst = max(unbalanced(own, curve, point) for point in (*range(0, len(curve), 10), *np.flatnonzero(curve.fold)))
    record_evidence(
        "three masses with sliders and a stop: largest residual of the path, as part of the forces", 0.0, worst,
        tolerance=ACCEPTED, topic=TOPIC, kind="other method", source="the balance of forces in plain NumPy",
    )  # fmt: skip


def chain_in_time() -> Sliders:
    """The chain with sliders and a stop, to be integrated in time."""
    structure, way = chain().structure, {name: np.array(row) for name, row in CHAIN.items()}
    return Sliders(
        structure.mass, structure.damping, structure.stiffness, np.array([0.0, 1.0, 0.0]),
        sliders=((way["m1"], 20.0, 1.0), (way["12"], 20.0, 1.0)), stops=((way["m3"], 1.0, 0.25),),
        cubic=((way["m2"], 1.0), (way["23"], 1.0)),
    )  # fmt: skip


def chain_state(curve, point: int) -> np.ndarray:
    """Displacements, their rates by the phase, and positions of the sliders, where the force is largest."""
    orders, x = np.arange(1, len(curve.orders)), curve.response[point]
    places = x[:, 0] + x[:, 1::2].sum(axis=1)
    force = curve.forces[point, :2, 0] + curve.forces[point, :2, 1::2].sum(axis=1)
    moved = np.array([CHAIN["m1"], CHAIN["12"]]) @ places
    return np.concatenate([places, x[:, 2::2] @ orders, moved - np.clip(force, -1, 1) / 20])


@pytest.mark.slow
def test_the_turning_points_of_a_chain_with_sliders_and_a_stop_are_those_of_shooting(record_evidence) -> None:
    reference = chain_in_time()
    curve = frequency_response(
        chain(), (0.5 / TURN, 2 / TURN), HarmonicBalance(21), continuation="arc-length", check=False
    )
    assert curve.coordinates[:2] == ("to ground.x", "between.x")
    folds = np.flatnonzero(curve.fold)
    turned = [
        reference.fold(chain_state(curve, point), TURN * curve.frequencies[point], 3e-3) for point in folds.tolist()
    ]
    frequencies = np.array([one.omega for one in turned if one is not None])
    np.testing.assert_allclose(frequencies, [1.63507, 1.62971, 1.66746, 1.55930], atol=1e-5)
    worst = float(np.abs(TURN * curve.folds - frequencies).max())
    record_evidence(
        "three masses with sliders and a stop: largest error of the four turning points, rad/s", 0.0, worst,
        tolerance=2e-5, topic=TOPIC, kind="other method", source=SHOOTING,
    )  # fmt: skip
    # Two turns are folds, with a multiplier of 1. At the two others a slider begins to stick or to slip.
    nearest = [float(np.abs(one.multipliers - 1).min()) for one in turned if one is not None]
    assert max(nearest[0], nearest[3]) < 1e-6 < 0.01 < min(nearest[1], nearest[2])


@pytest.mark.slow
def test_points_between_the_turning_points_of_a_chain_are_those_of_shooting(record_evidence) -> None:
    reference = chain_in_time()
    curve = frequency_response(
        chain(), (0.5 / TURN, 2 / TURN), HarmonicBalance(21), continuation="arc-length", stability=True, check=False
    )
    folds = np.flatnonzero(curve.fold)
    apart = [point for point in range(5, len(curve), 9) if np.abs(folds - point).min() > 2]
    points = sorted({*apart, *(int(point) for point in np.append(folds - 3, folds + 3))})
    found: list[Periodic | None] = [
        reference.periodic(chain_state(curve, point), TURN * curve.frequencies[point]) for point in points
    ]
    errors, right, signs = [], [], []
    for point, one in zip(points, found, strict=True):
        assert one is not None, point
        places = one.state[:3]
        errors.append(np.abs(places - chain_state(curve, point)[:3]).max() / np.abs(places).max())
        signs.append(np.prod([np.sign(1 - own.real) for own in one.multipliers if own.imag == 0]))
        largest = float(np.abs(one.multipliers).max())
        if abs(largest - 1) > CLOSE and curve.stable[point] >= 0:
            right.append((curve.stable[point] == 1) == (largest < 1))
    record_evidence(
        "three masses with sliders and a stop: largest error of points of the path, as part of the motion", 0.0,
        max(errors), tolerance=1e-3, topic=TOPIC, kind="other method", source=SHOOTING,
    )  # fmt: skip
    record_evidence(
        "three masses with sliders and a stop: share of points with the right stability", 1.0, float(np.mean(right)),
        tolerance=0.0, topic=TOPIC, kind="other method", source=SHOOTING,
    )  # fmt: skip
    assert len(right) > 20
    # The determinant of I - M changes its sign at the turning points, and nowhere else.
    turns = [sum(int(fold) in range(a, b) for fold in folds) for a, b in pairwise(points)]
    assert [a * b for a, b in pairwise(signs)] == [(-1.0) ** turn for turn in turns]
