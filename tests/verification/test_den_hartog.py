"""Den Hartog's block: one mass with rigid Coulomb friction, beside its exact motion from slip to stick and back."""

from functools import cache

import numpy as np
import pytest
from scipy.optimize import brentq

from dalembert.errors import listed
from dalembert.structure import lumped
from dalembert.vibration import (
    ElasticSlider,
    FrequencyCurve,
    FrictionContact,
    HarmonicBalance,
    HarmonicForce,
    Newmark,
    Rigid,
    VibrationSystem,
    frequency_response,
    steady_state,
)

TOPIC = "Friction in frequency"
GRID = [(friction, ratio) for friction in (0.1, 0.3, 0.5, 0.7, 0.75) for ratio in (0.4, 0.6, 0.8, 1.3, 1.7, 2.0)]
PERIODS = 300


def block(friction: float, law: ElasticSlider | Rigid, damper: float = 0.0) -> VibrationSystem:
    """Mass 1 kg, spring 1 N/m, force 1 N, limit of friction ``friction`` N."""
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, damper)]))
    system.add(HarmonicForce("m", 1.0))
    system.add(FrictionContact("foot", "m", friction=friction, preload=1.0, law=law))
    return system


def response(friction: float, ratio: float, law: ElasticSlider | Rigid, harmonics: int | str = 9) -> FrequencyCurve:
    return frequency_response(block(friction, law), np.array([ratio]) / (2 * np.pi), HarmonicBalance(harmonics))


def closed_form(friction: float, ratio: float) -> float:
    """Amplitude without stops, by V and U of den Hartog's paper of 1931; NaN if there is none."""
    v = 1 / (1 - ratio**2)
    u = np.sin(np.pi / ratio) / (ratio * (1 + np.cos(np.pi / ratio)))
    return float(np.sqrt(v**2 - (friction * u) ** 2)) if abs(v) > friction * abs(u) else np.nan


@cache
def exact(friction: float, ratio: float) -> tuple[float, int]:
    """Amplitude of the periodic motion, and its stops in the last period, by the solution of each phase."""
    period = 2 * np.pi / ratio
    now, place, stops, ends = 0.0, 0.5, 0, []
    while now < PERIODS * period:

        def excess(t: float, place: float = place) -> float:
            return abs(np.cos(ratio * t) - place) - friction

        if excess(now) <= 0:  # sticks until spring and force together exceed the limit
            times = now + np.linspace(0, period, 4001)
            beyond = np.flatnonzero([excess(t) > 0 for t in times])
            if not len(beyond):
                return 0.0, 0
            now = brentq(excess, times[beyond[0] - 1], times[beyond[0]]) + 1e-12
            stops += now > (PERIODS - 1) * period
        side = np.sign(np.cos(ratio * now) - place)
        size = 1 / (1 - ratio**2)
        first = place - size * np.cos(ratio * now) + side * friction
        second = size * ratio * np.sin(ratio * now)

        def speed(t: float, first: float = first, second: float = second, now: float = now) -> float:
            return -first * np.sin(t - now) + second * np.cos(t - now) - ratio * np.sin(ratio * t) / (1 - ratio**2)

        times = now + np.linspace(1e-9, period, 2001)
        turned = np.flatnonzero(speed(times) * side < 0)
        turned = turned[turned > 0]
        end = brentq(speed, times[turned[0] - 1], times[turned[0]])
        place = first * np.cos(end - now) + second * np.sin(end - now) + size * np.cos(ratio * end) - side * friction
        now = end
        ends.append(abs(place))
    return float(np.mean(ends[-4:])), stops


@pytest.mark.parametrize(("friction", "ratio"), [(0.1, 0.6), (0.3, 0.8), (0.5, 1.3), (0.3, 1.7)])
def test_the_reference_is_den_hartogs_closed_form_where_nothing_stops(friction: float, ratio: float) -> None:
    amplitude, stops = exact(friction, ratio)
    assert stops == 0
    assert amplitude == pytest.approx(closed_form(friction, ratio), rel=1e-9)


@pytest.mark.parametrize("kind", ["displacement", "velocity"])
def test_the_amplitude_is_right_to_half_a_percent_or_refused(record_evidence, kind: str) -> None:
    accepted, errors = 0, []
    for friction, ratio in GRID:
        curve = response(friction, ratio, Rigid(prediction=kind))
        if curve.success:
            accepted += 1
            errors.append(abs(curve.amplitude("m")[0] / exact(friction, ratio)[0] - 1))
    record_evidence(
        f"den Hartog's block, rigid law of kind {kind}, 9 harmonics: largest error of the {accepted} amplitudes of "
        f"{len(GRID)} that are not refused", 0.0, max(errors, default=0.0), tolerance=5e-3, topic=TOPIC,
        kind="closed form", source="exact solution of each phase of slip and stick",
    )  # fmt: skip


def test_the_velocity_kind_is_accepted_with_more_harmonics(record_evidence) -> None:
    errors = []
    for friction, ratio in [(0.1, 0.4), (0.3, 0.6), (0.3, 1.3), (0.3, 2.0)]:
        curve = response(friction, ratio, Rigid(prediction="velocity"), harmonics=45)
        assert curve.success
        errors.append(abs(curve.amplitude("m")[0] / exact(friction, ratio)[0] - 1))
    record_evidence(
        "den Hartog's block, rigid law of kind velocity, 45 harmonics: largest error of amplitudes", 0.0, max(errors),
        tolerance=5e-3, topic=TOPIC, kind="closed form", source="exact solution of each phase of slip and stick",
    )  # fmt: skip


@pytest.mark.parametrize(
    ("reference", "cases"),
    [
        ("closed form without stops", [(0.1, 0.4), (0.1, 0.6), (0.3, 0.6), (0.3, 0.8), (0.3, 1.3), (0.5, 0.8)]),
        ("exact motion with stops", [(0.5, 0.4)]),
    ],
)
def test_chosen_harmonics_reach_the_exact_amplitude(record_evidence, reference: str, cases: list) -> None:
    errors, chosen = [], []
    for friction, ratio in cases:
        curve = response(friction, ratio, Rigid(prediction="velocity"), "auto")
        assert curve.success
        amplitude, stops = exact(friction, ratio)
        assert (stops > 0) == ("with stops" in reference)
        amplitude = amplitude if stops else closed_form(friction, ratio)
        errors.append(abs(curve.amplitude("m")[0] / amplitude - 1))
        chosen.append(curve.orders[-1])
    assert set(chosen) == {3, 15, 31, 63} if len(cases) > 1 else {63}
    record_evidence(
        f"den Hartog's block, {listed([str(one) for one in sorted(set(chosen))])} harmonics, chosen by the truncation "
        f"error, {reference}: largest error of amplitudes", 0.0, max(errors), tolerance=5e-3, topic=TOPIC, kind="closed form",
        source="den Hartog 1931" if "closed" in reference else "exact solution of each phase of slip and stick",
    )  # fmt: skip


@pytest.mark.parametrize("ratio", [0.6, 0.8, 1.3])
def test_the_elastic_slider_is_that_of_fine_integration_in_time(record_evidence, ratio: float) -> None:
    system = block(0.5, ElasticSlider(10.0), damper=0.02)
    curve = frequency_response(system, np.array([ratio]) / (2 * np.pi), HarmonicBalance(25))
    motion = steady_state(system, ratio / (2 * np.pi), Newmark(16384), way="shooting")
    record_evidence(
        f"elastic slider of 10 N/m on a mass, 25 harmonics: amplitude at {ratio} rad/s", motion.amplitude("m"),
        curve.amplitude("m")[0], tolerance=1e-3, relative=True, topic=TOPIC, kind="other method", source="integration in time, 16,384 steps",
    )  # fmt: skip
