"""Structures that only contacts hold: their motions are found, and what no contact balances is named."""

import numpy as np
import pytest

from dalembert.structure import lumped
from dalembert.vibration import (
    Elastic,
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

FREQUENCIES = np.array([0.5, 0.8, 1.2, 2.0, 3.0]) / (2 * np.pi)
LAWS = {
    "elastic": Elastic(1.0, 1.0),
    "stiff": Elastic(100.0, 100.0),
    "rigid": Rigid(penalty=1.0),
    "rigid, velocity": Rigid(penalty=1.0, kind="velocity"),
}


def held_together(law: Elastic | Rigid, force: float, on: str = "a", preload: float = 2.0) -> VibrationSystem:
    """Two masses: a slider alone holds the second."""
    system = VibrationSystem(lumped({"a": 1.0, "b": 1.0}, [("a", None, 1.0, 0.05)]))
    system.add(HarmonicForce(on, force))
    system.add(FrictionContact("slider", "a", "b", friction=0.5, preload=preload, law=law))
    return system


def on_the_ground(law: Elastic | Rigid, force: float, spring: float = 0.0) -> VibrationSystem:
    """A block that its weight presses on the ground."""
    springs = [("A.x", None, spring, 0.02)] if spring else []
    system = VibrationSystem(lumped({"A.x": 1.0, "A.z": 1.0}, springs))
    system.add(StaticForce("A.z", 10.0))
    system.add(HarmonicForce("A.x", force))
    system.add(FrictionContact("foot", "A", normal="z", friction=0.5, law=law))
    return system


def pushed(law: Elastic | Rigid) -> VibrationSystem:
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


def test_a_point_that_newton_does_not_find_is_a_finding() -> None:
    system = MOTIONS["block on a spring"](LAWS["elastic"])
    curve = frequency_response(system, FREQUENCIES[:1], HarmonicBalance(5, iterations=1, halvings=0))
    assert [finding.code for finding in curve.findings] == ["points-not-found"]
    assert curve.doubts[0].startswith("1 of 1 points were not found. The largest residual is ")
