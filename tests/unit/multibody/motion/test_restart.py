"""Segments of motions that begin at a later state: they continue the motion, with exact derivatives by the state."""

import pickle

import numpy as np
import pytest

import dalembert as da
from dalembert.errors import SolveError
from dalembert.forward import Checkpoint, Recorded, Restartable, restartable, restarted

TIMES = np.array([0.0, 0.13, 0.2, 0.41, 0.5, 0.66, 0.8])
BEGIN = 3  # sample at which a segment begins anew
SOLVER = da.RungeKutta4(step=1e-3)


def double_pendulum(length, drag, angle):
    system = da.System()
    upper = system.add(da.RigidBar("upper", length=length, mass=1.0, angle=angle))
    lower = system.add(da.RigidBar("lower", start=upper.end, length=0.5, mass=1.0, angle=0.5, angular_velocity=3.0))
    system.add(da.RevoluteJoint("shoulder", system.ground, upper.start, viscous=drag))
    system.add(da.RevoluteJoint("elbow", upper.end, lower.start, viscous=drag))
    return system


def four_bar(length, drag, angle):
    system = da.System()
    crank = system.add(da.RigidBar("crank", length=length, mass=1.0, angle=angle, angular_velocity=6.0))
    rod = system.add(da.RigidBar("rod", start=crank.end, length=0.9, mass=1.0, angle=0.2))
    rocker = system.add(da.RigidBar("rocker", start=(1.0, 0.0), length=0.7, mass=1.0, angle=1.2))
    system.add(da.RevoluteJoint("A", system.ground, crank.start, viscous=drag))
    system.add(da.RevoluteJoint("B", crank.end, rod.start))
    system.add(da.RevoluteJoint("C", rod.end, rocker.end))
    system.add(da.RevoluteJoint("D", system.ground, rocker.start))
    return system


def driven(length, drag, angle):
    system = double_pendulum(length, drag, angle)
    (upper, _) = system.bodies
    table = da.signals.Table(np.linspace(0.0, 0.8, 9), [0.0, 3.0, -2.0, 4.0, 5.0, -3.0, 2.0, 6.0, 1.0])
    system.add(da.Torque("motor", upper.centre, table))
    return system


def cranked(length, drag, angle):
    """Its first bar turns as prescribed."""
    system = da.System()
    upper = system.add(da.RigidBar("upper", length=length, mass=1.0, angle=angle))
    lower = system.add(da.RigidBar("lower", start=upper.end, length=0.5, mass=1.0, angle=0.5))
    system.add(da.RevoluteJoint("shoulder", system.ground, upper.start))
    system.add(da.PrescribedMotion("turn", system.ground, upper.start, "angle", da.signals.Polynomial([0.0, 4.0, 3.0])))
    system.add(da.RevoluteJoint("elbow", upper.end, lower.start, viscous=drag))
    return system


BUILDERS = {
    double_pendulum: ("upper.angle", "lower.angle"),
    four_bar: 1,
    driven: ("upper.angle", "lower.angle"),
    cranked: ("lower.angle",),
}
BOX = {"length": (0.2, 0.4), "drag": (0.0, 0.1), "angle": (0.5, 1.5)}
AT = np.array([0.3, 0.05, 1.1])


def model(builder):
    body = "rocker" if builder is four_bar else "lower"
    return da.TimeResponse(builder, BOX, [f"{body}.end.x", f"{body}.end.rate"], TIMES, SOLVER)


@pytest.fixture(params=BUILDERS, ids=lambda builder: builder.__name__)
def cut(request):
    """A model, a segment of its motion, and the numbers that it begins at."""
    builder = request.param
    whole = model(builder)
    first = whole.restarted(0.0, TIMES[: BEGIN + 1], None, whole.state_chart(AT, whole=True))
    state = first.evaluate(AT[None]).values[0, -1, 2:]
    chart = whole.state_chart(AT, state)
    expected = BUILDERS[builder]
    if isinstance(expected, tuple):
        assert chart.names == (*expected, *(f"{name} rate" for name in expected))
    else:
        assert len(chart.names) == 2 * expected
    segment = whole.restarted(TIMES[BEGIN], TIMES[BEGIN:] - TIMES[BEGIN], chart, chart)
    return whole, segment, np.concatenate([AT, chart.values])


def test_a_segment_continues_the_motion(cut):
    whole, segment, numbers = cut
    values = segment.evaluate(numbers[None]).only()[0]
    np.testing.assert_allclose(values[:, :2], whole.evaluate(AT[None]).only()[0][BEGIN:], atol=1e-9)
    np.testing.assert_allclose(values[0, 2:], numbers[3:], atol=1e-12)  # the state that it begins at


def test_derivatives_are_those_of_differences(cut):
    _, segment, numbers = cut
    response, jacobian = segment.linearise(numbers)
    np.testing.assert_allclose(response, segment.evaluate(numbers[None]).only()[0], atol=1e-12)
    step = 1e-6
    for column, unit in enumerate(np.eye(len(numbers))):
        ahead, behind = (segment.evaluate((numbers + sign * step * unit)[None]).only()[0] for sign in (1, -1))
        np.testing.assert_allclose(jacobian[:, :, column], (ahead - behind) / (2 * step), atol=2e-6, rtol=1e-6)


def test_the_first_segment_begins_as_the_builder_says():
    whole = model(double_pendulum)
    segment = whole.restarted(0.0, TIMES, None, None)
    response, jacobian = segment.linearise(AT)
    expected = whole.linearise(AT)
    np.testing.assert_array_equal(response, expected[0])
    np.testing.assert_array_equal(jacobian, expected[1])


def test_initial_angles_do_not_matter_to_a_later_segment(cut):
    _, segment, numbers = cut
    if segment.model.builder is not cranked:  # whose prescribed angle starts there
        assert not np.any(segment.jacobian(numbers)[:, :, 2])


def test_coordinates_are_kept_where_they_determine_the_others():
    whole = model(four_bar)
    crank = whole.state_chart(AT)
    again = whole.state_chart(AT, crank.near, like=crank)
    assert again.names == crank.names
    rocker = [name for name in whole.state_chart(AT, whole=True).names if name == "rocker.angle"]
    assert rocker  # named among all numbers


def test_a_state_where_the_joints_do_not_close_is_told():
    whole = model(four_bar)
    chart = whole.state_chart(AT)
    away = np.concatenate([AT, chart.values])
    away[0] = 3.0  # a crank that is longer than the others together
    failure = whole.restarted(0.1, [0.1], chart, None).evaluate(away[None]).failures[0]
    assert "its joints do not close at the state" in str(failure)
    with pytest.raises(SolveError, match="its joints do not close at the state"):
        whole.restarted(0.1, [0.1], chart, None).linearise(away)


def test_wrapped_models_begin_anew_too(tmp_path):
    whole = model(double_pendulum)
    assert isinstance(whole, Restartable)
    with Checkpoint(tmp_path / "kept.db") as kept:
        recorded = Recorded(whole, kept)
        assert restartable(recorded) is whole
        chart = whole.state_chart(AT)
        segment = restarted(recorded, 0.2, [0.1, 0.2], chart, chart)
        assert isinstance(segment, Recorded)
        numbers = np.concatenate([AT, chart.values])
        plain = whole.restarted(0.2, [0.1, 0.2], chart, chart).linearise(numbers)
        for _ in range(2):  # computed, then recalled
            np.testing.assert_array_equal(segment.linearise(numbers)[1], plain[1])
        other = restarted(recorded, 0.3, [0.1, 0.2], chart, chart)
        assert other.fingerprint != segment.fingerprint


def test_a_segment_can_be_sent_to_another_process(cut):
    _, segment, numbers = cut
    there = pickle.loads(pickle.dumps(segment))
    np.testing.assert_array_equal(there.evaluate(numbers[None]).values, segment.evaluate(numbers[None]).values)
