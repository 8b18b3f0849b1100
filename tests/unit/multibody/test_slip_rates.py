"""Smoothed friction that a motion crosses in too few steps, and creep where friction should hold."""

import numpy as np
import pytest

from dalembert.multibody import GeneralizedAlpha, RevoluteJoint, RigidBar, System, TimeResponse, simulate
from dalembert.multibody.slip_rates import slip_findings

TIMES = np.linspace(0, 6, 61)


def pendulum(coulomb, slip_rate, friction=True):
    system = System()
    rod = system.add(RigidBar("rod", length=0.4, mass=0.8, angle=-0.4))
    law = {"coulomb": coulomb, "viscous": 0.003, "slip_rate": slip_rate} if friction else {}
    system.add(RevoluteJoint("pin", system.ground, rod.start, **law))
    return system


def finding(coulomb, slip_rate, step):
    findings = simulate(pendulum(coulomb, slip_rate), 6.0, GeneralizedAlpha(step)).findings
    assert [one.code for one in findings] in ([], ["slip-rate"])
    return findings[0] if findings else None


def test_a_crossing_in_less_than_a_step_is_noted_with_a_slip_rate_that_takes_three():
    noted = finding(0.04, 1e-3, 6e-3)
    assert noted.severity == "note"
    assert noted.values["joint"] == "pin"
    # The zone is 2e-3 rad/s wide. A step changes the rate by at most 3 g / (2 L) · 6 ms = 0.22 rad/s, and friction.
    assert noted.values["steps"] == pytest.approx(2e-3 / 0.2, rel=0.2)
    assert noted.values["proposed"] == pytest.approx(1.5 * 0.2, rel=0.2)
    assert "set slip_rate to 0.3 rad/s" in noted.advice
    assert finding(0.04, noted.values["proposed"], 6e-3) is None


def test_the_proposed_step_is_smaller_where_friction_holds_the_joint():
    noted = finding(0.15, 5e-4, 6e-3)
    assert noted.severity == "note"
    assert noted.values["proposed"] < 1e-3
    assert f"use steps of {noted.values['step']:.2g} s" in noted.advice
    assert finding(0.15, noted.values["proposed"], noted.values["step"]) is None


def test_creep_of_a_joint_that_friction_holds_is_a_warning():
    warning = finding(0.15, 0.1, 6e-3)
    assert warning.doubtful
    held, crept = (simulate(pendulum(0.15, slip), 6.0, GeneralizedAlpha(1e-3)) for slip in (1e-4, 0.1))
    angles = held.channels(["pin.angle"]), crept.channels(["pin.angle"])
    apart = np.max(np.abs(angles[0] - angles[1])) / np.ptp(angles[0])
    assert apart > 0.02
    assert 2e-3 < warning.values["creep"] < 2 * apart
    assert finding(0.15, warning.values["proposed"], 2e-5) is None


def test_a_joint_at_rest_or_without_friction_has_no_finding():
    assert list(slip_findings("pin", 1e-3, TIMES, np.zeros(61), 0.1)) == []
    assert simulate(pendulum(0.0, 1e-3), 1.0).findings == ()
    assert simulate(pendulum(0.0, 1e-3, friction=False), 1.0).findings == ()


def test_solvers_that_choose_their_steps_are_judged_by_creep_only():
    rates = np.where(np.arange(61) % 2, 5.0, -5.0)
    assert list(slip_findings("pin", 1e-3, TIMES, rates, None)) == []
    assert len(list(slip_findings("pin", 1e-3, TIMES, rates, 0.1))) == 1


def test_a_time_response_has_the_findings_of_its_motion():
    model = TimeResponse(
        lambda coulomb: pendulum(coulomb, 1e-3), {"coulomb": (0.0, 0.1)}, ["pin.angle"], TIMES, GeneralizedAlpha(6e-3)
    )
    (noted,) = model.findings(np.array([0.04]))
    assert noted.values == finding(0.04, 1e-3, 6e-3).values
    assert model.findings(np.array([0.0])) == ()
    assert noted.message in simulate(pendulum(0.04, 1e-3), 6.0, GeneralizedAlpha(6e-3)).summary()


def test_the_misfit_is_rough_at_the_noted_slip_rate_and_smooth_at_the_proposed_one():
    noted = finding(0.04, 1e-3, 6e-3)
    coulombs = 0.04 * (1 + np.linspace(-1e-3, 1e-3, 41))
    rough, smooth = (misfit(coulombs, slip) for slip in (1e-3, noted.values["proposed"]))
    assert rough > 100 * smooth


def misfit(coulombs, slip):
    """Deviation of a misfit from its parabola, as a part of its range."""
    model = TimeResponse(
        lambda coulomb: pendulum(coulomb, slip), {"coulomb": (0.0, 0.1)}, ["pin.angle"], TIMES, GeneralizedAlpha(6e-3)
    )
    values = model.evaluate(coulombs[:, None]).values[:, :, 0]
    data = values[20] + 2e-3 * np.random.default_rng(0).standard_normal(len(TIMES))
    squares = np.sum((values - data) ** 2, axis=1)
    axis = np.linspace(-1, 1, len(coulombs))
    return np.std(squares - np.polyval(np.polyfit(axis, squares, 2), axis)) / np.ptp(squares)
