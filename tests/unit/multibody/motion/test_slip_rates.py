"""Smoothed friction that a motion crosses in too few steps, and creep where friction should hold."""

import numpy as np
import pytest

from dalembert.multibody import (
    DistanceJoint,
    GeneralizedAlpha,
    PrismaticJoint,
    RevoluteJoint,
    RigidBar,
    RigidBody,
    Spring,
    System,
    TimeResponse,
    simulate,
)
from dalembert.multibody.components.base_joint import Smoothing
from dalembert.multibody.motion.slip_rates import slip_findings

TIMES = np.linspace(0, 6, 61)
PIN = Smoothing("rate", "slip_rate", 1e-3, "rad/s")


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
    assert list(slip_findings("pin", PIN, TIMES, np.zeros(61), 0.1)) == []
    assert simulate(pendulum(0.0, 1e-3), 1.0).findings == ()
    assert simulate(pendulum(0.0, 1e-3, friction=False), 1.0).findings == ()


def test_a_joint_that_chatters_where_friction_holds_it_is_named():
    rates = np.concatenate([np.full(30, 20.0), 0.01 * (-1.0) ** np.arange(31)])
    (chatter,) = slip_findings("pin", PIN, TIMES, rates, None)
    assert (chatter.code, chatter.severity) == ("stick-chatter", "warning")
    assert chatter.values == {"joint": "pin", "slip_rate": 1e-3, "reversals": 30}
    assert list(slip_findings("pin", PIN, TIMES, np.abs(rates), None)) == []


def test_solvers_that_choose_their_steps_are_judged_by_creep_only():
    rates = np.where(np.arange(61) % 2, 5.0, -5.0)
    assert list(slip_findings("pin", PIN, TIMES, rates, None)) == []
    assert len(list(slip_findings("pin", PIN, TIMES, rates, 0.1))) == 1


def block(slip_velocity, stiffness=0.0):
    """A block that slides down a slope of 0.3 rad, which friction of 5 N stops."""
    system = System()
    body = system.add(RigidBody("block", 1.0, 1.0, velocity=np.array([np.cos(0.3), -np.sin(0.3)])))
    slope = {"angle": -0.3, "coulomb": 5.0, "slip_velocity": slip_velocity}
    system.add(PrismaticJoint("slide", system.ground.point(0.0, 0.0), body.centre, **slope))
    if stiffness:
        end = system.ground.point(10 * np.cos(0.3), -10 * np.sin(0.3))
        system.add(Spring("spring", end, body.centre, stiffness, free_length=9.0))
    return system


def test_a_slide_that_creeps_down_a_slope_is_a_warning_in_its_units():
    motion = simulate(block(1e-2), 6.0, GeneralizedAlpha(2e-3))
    (warning,) = motion.findings
    assert (warning.code, warning.severity) == ("slip-rate", "warning")
    # The block stops after 1 m/s / (5 N / kg - g sin 0.3) and creeps at 1e-2 m/s artanh(g sin 0.3 / 5 N / kg).
    pull = 9.81 * np.sin(0.3)
    stop = 1 / (5 - pull)
    crept = 1e-2 * np.arctanh(pull / 5) * (6 - stop)
    assert warning.values["creep"] == pytest.approx(crept / (stop / 2 + crept), rel=0.05)
    assert "its slip_velocity 0.01 m/s is too large" in warning.message
    assert warning.advice == f"Set slip_velocity to {warning.values['proposed']:.2g} m/s or less."
    assert simulate(block(warning.values["proposed"]), 6.0, GeneralizedAlpha(2e-4)).findings == ()


def test_a_slide_that_turns_within_a_step_is_noted():
    (noted,) = simulate(block(1e-4, stiffness=400.0), 0.3, GeneralizedAlpha(2e-3)).findings
    assert (noted.code, noted.severity, noted.values["slip_velocity"]) == ("slip-rate", "note", 1e-4)
    assert "set slip_velocity to" in noted.advice


def test_the_sliding_velocity_is_an_output_along_the_line():
    motion = simulate(block(1e-3), 0.2, GeneralizedAlpha(1e-3))
    along = motion.channels(["block.centre.vx", "block.centre.vy"]) @ [np.cos(0.3), -np.sin(0.3)]
    np.testing.assert_allclose(motion.channels(["slide.sliding_velocity"])[:, 0], along, atol=1e-12)


def test_a_joint_without_coulomb_friction_declares_none():
    system = System()
    rod = system.add(RigidBar("rod", 1.0, 1.0))
    joints = [DistanceJoint("rod joint", system.ground, rod.end), PrismaticJoint("slide", system.ground, rod.start)]
    assert [joint.smoothing for joint in joints] == [None, None]


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
