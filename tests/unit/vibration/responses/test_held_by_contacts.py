"""Structures that only contacts hold: their motions are found, and what no contact balances is named."""

from dataclasses import replace

import numpy as np
import pytest

from dalembert.structure import lumped
from dalembert.vibration import (
    CubicSpring,
    ElasticSlider,
    FrequencyCurve,
    FrictionContact,
    HarmonicBalance,
    HarmonicForce,
    Newmark,
    Rigid,
    StaticForce,
    VibrationSystem,
    frequency_response,
    steady_state,
)
from dalembert.vibration.balance.arc_length import POINTS, Progress
from dalembert.vibration.paths.path_end import end_findings
from sliders_in_time import Sliders

FREQUENCIES = np.array([0.5, 0.8, 1.2, 2.0, 3.0]) / (2 * np.pi)
LAWS = {
    "elastic": ElasticSlider(1.0, 1.0),
    "stiff": ElasticSlider(100.0, 100.0),
    "rigid": Rigid(penalty=1.0),
    "rigid, velocity": Rigid(penalty=1.0, prediction="velocity"),
}


def held_together(law: ElasticSlider | Rigid, force: float, on: str = "a", preload: float = 2.0) -> VibrationSystem:
    """Two masses: a slider alone holds the second."""
    system = VibrationSystem(lumped({"a": 1.0, "b": 1.0}, [("a", None, 1.0, 0.05)]))
    system.add(HarmonicForce(on, force))
    system.add(FrictionContact("slider", "a", "b", friction=0.5, preload=preload, law=law))
    return system


def on_the_ground(law: ElasticSlider | Rigid, force: float, spring: float = 0.0) -> VibrationSystem:
    """A block that its weight presses on the ground."""
    springs = [("A.x", None, spring, 0.02)] if spring else []
    system = VibrationSystem(lumped({"A.x": 1.0, "A.z": 1.0}, springs))
    system.add(StaticForce("A.z", 10.0))
    system.add(HarmonicForce("A.x", force))
    system.add(FrictionContact("foot", "A", normal="z", friction=0.5, law=law))
    return system


def pushed(law: ElasticSlider | Rigid) -> VibrationSystem:
    """A mass on a slider, with a static force of three times the limit of friction."""
    system = VibrationSystem(lumped({"a": 1.0}, []))
    system.add(StaticForce("a", 3.0))
    system.add(HarmonicForce("a", 0.5))
    system.add(FrictionContact("slider", "a", friction=0.5, preload=2.0, law=law))
    return system


MOTIONS = {
    "two masses, stuck": lambda law: held_together(law, 0.3),
    "two masses, slipping": lambda law: held_together(law, 3.0),
    "bolted, stuck": lambda law: held_together(law, 1.0, "b", 10.0),
    "bolted, slipping": lambda law: held_together(law, 20.0, "b", 10.0),
    "block, stuck": lambda law: on_the_ground(law, 2.0),
    "block, slipping": lambda law: on_the_ground(law, 20.0),
    "block on a spring": lambda law: on_the_ground(law, 20.0, spring=1.0),
}


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", MOTIONS)
def test_each_point_is_found_with_finite_displacements(name: str, law: str) -> None:
    curve = frequency_response(MOTIONS[name](LAWS[law]), FREQUENCIES, HarmonicBalance(5))
    assert curve.converged.all()
    assert np.all(curve.residuals < 1e-8)
    assert np.abs(curve.unknowns).max() < 200
    assert {finding.code for finding in curve.findings} <= {"few-harmonics"}


@pytest.mark.parametrize(
    ("name", "dof", "way"),
    [
        ("two masses, slipping", "a.x", "long run"),
        ("bolted, slipping", "a.x", "long run"),
        ("block on a spring", "A.x", "shooting"),
    ],
)
def test_the_motion_is_that_of_integration_in_time(name: str, dof: str, way: str) -> None:
    system, frequency = MOTIONS[name](LAWS["elastic"]), 1.2 / (2 * np.pi)
    curve = frequency_response(system, np.array([frequency]), HarmonicBalance(15))
    motion = steady_state(system, frequency, Newmark(2048, periods=400), way=way)
    assert curve.amplitude(dof)[0] == pytest.approx(motion.amplitude(dof), rel=1e-4)


@pytest.mark.parametrize("law", LAWS)
def test_what_no_contact_balances_is_named_and_nothing_is_found(law: str, tmp_path) -> None:
    curve = frequency_response(pushed(LAWS[law]), FREQUENCIES, HarmonicBalance(5))
    assert not curve.converged.any()
    assert not curve.success
    (finding,) = curve.findings
    assert (finding.code, finding.severity) == ("unbalanced-mean", "error")
    assert finding.values["motion"] == "'slider.x'"
    assert 1.9 < finding.values["force"] < 3.1
    curve.save(tmp_path / "curve.nc")
    assert FrequencyCurve.load(tmp_path / "curve.nc").findings == curve.findings


@pytest.mark.parametrize(("continuation", "points"), [("natural", 21), ("arc-length", 1)])
def test_a_path_without_progress_ends_with_a_reason(continuation: str, points: int) -> None:
    ends = 0.5 / (2 * np.pi), 3.0 / (2 * np.pi)
    curve = frequency_response(pushed(LAWS["elastic"]), ends, HarmonicBalance(5), continuation=continuation)
    assert len(curve) == points
    assert [finding.code for finding in curve.findings] == ["unbalanced-mean", "end-not-reached"]
    assert curve.findings[1].values["reason"] == "stopped"
    assert curve.findings[1].values["end"] == pytest.approx(ends[1])


def test_a_path_whose_steps_lead_nowhere_has_a_reason() -> None:
    progress = Progress(longest=1.0)
    assert not any(progress.ends(1e-3) for _ in range(POINTS - 1))
    assert progress.ends(1e-3)
    assert not progress.ends(1.0)
    (finding,) = end_findings(np.array([1.0, 1.1]), np.array([True, True]), (1.0, 2.0), "frequency", "Hz")
    assert finding.values == {"reason": "no-progress", "last": 1.1, "farthest": 1.1, "end": 2.0}


def test_a_point_that_newton_does_not_find_is_a_finding() -> None:
    system = MOTIONS["block on a spring"](LAWS["elastic"])
    curve = frequency_response(system, FREQUENCIES[:1], HarmonicBalance(5, iterations=1, halvings=0))
    (finding,) = curve.findings
    assert finding.code == "points-not-found"
    assert finding.values["points"] == 1
    assert finding.values["residual"] > 0
    assert curve.doubts[0] == finding


@pytest.mark.parametrize("part", ["cubic", "slider"])
def test_two_masses_that_nothing_holds_move_as_in_time(part: str) -> None:
    structure, way = lumped({"a": 1.0, "b": 2.0}, [("a", "b", 1.0, 0.1)]), np.array([1.0, -1.0])
    system = VibrationSystem(structure)
    system.add(HarmonicForce("a", 1.0))
    reference = Sliders(structure.mass, structure.damping, structure.stiffness, np.array([1.0, 0.0]))
    if part == "slider":
        system.add(FrictionContact("slider", "a", "b", friction=0.3, preload=1.0, law=ElasticSlider(2.0)))
        reference = replace(reference, sliders=((way, 2.0, 0.3),))
    else:
        system.add(CubicSpring("cubic", "a", "b", stiffness=1.0))
        reference = replace(reference, cubic=((way, 1.0),))
    omegas = np.array([0.7, 1.3, 2.0])
    curve = frequency_response(system, omegas / (2 * np.pi), HarmonicBalance(25), stability=True, check=False)
    assert curve.converged.all()
    assert np.all(curve.stable == 1)
    np.testing.assert_allclose(curve.response[:, :, 0].sum(axis=1), 0.0, atol=1e-9)
    for omega, x, force in zip(omegas, curve.response, curve.forces[:, 0], strict=True):
        places = x[:, 0] + x[:, 1::2].sum(axis=1)
        slider = [way @ places - (force[0] + force[1::2].sum()) / 2.0] if part == "slider" else []
        begin = np.concatenate([places, x[:, 2::2] @ np.arange(1, 26), slider])
        end, _ = reference.period(begin, omega)
        np.testing.assert_allclose(end[:4], begin[:4], atol=2e-4 * np.abs(begin).max())
