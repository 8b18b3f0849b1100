"""Segments of multiple shooting continue the whole turns of angles, in space and on nodes of beams in the plane."""

import numpy as np
import pytest

import dalembert as da
from dalembert.inverse import MultipleShooting
from dalembert.multibody.spatial import Inertia, RevoluteJoint, RigidBody, SpatialSystem, Torque

MOMENT = 0.5
TIMES = np.linspace(0.0, 2.0, 41)
BOX = {"drag": (0.01, 0.5), "rate": (5.0, 40.0)}
TRUE = np.array([0.1, 20.0])


def wheel(drag, rate) -> SpatialSystem:
    """A wheel that turns by five turns against a torque of 10 drag, N m."""
    system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    disc = system.add(RigidBody("disc", Inertia(1.0, (0.3, 0.3, MOMENT)), angular_velocity=(0.0, 0.0, rate)))
    system.add(RevoluteJoint("pin", system.ground, disc.point("origin")))
    system.add(Torque("load", disc.point("origin"), z=-10.0 * drag))
    return system


def rod(drag, rate) -> da.System:
    """A stiff cable in the plane that turns about its start."""
    system = da.System(gravity=(0.0, 0.0))
    cable = system.add(da.AncfCable("rod", 0.6, 1, 1e7, 1000.0, 0.08, 0.08, angular_velocity=rate))
    system.add(da.RevoluteJoint("pin", system.ground, cable.start))
    system.add(da.TorsionSpring("coil", system.ground, cable.start, 0.2, drag))
    return system


def model(build, tolerance=1e-8) -> da.TimeResponse:
    return da.TimeResponse(build, BOX, ["pin.angle"], TIMES, da.RadauIIA(tolerance=tolerance))


@pytest.mark.parametrize("build", [wheel, rod])
def test_a_segment_begins_with_the_turns_of_its_state(build) -> None:
    whole = model(build)
    values = whole.evaluate(TRUE[None]).only()[0, :, 0]
    assert values.max() > 6 * np.pi
    ends = whole.state_chart(TRUE, whole=True)
    assert ends.names[-1] == "pin.angle turns"
    states = whole.restarted(0.0, TIMES, None, ends).evaluate(TRUE[None]).only()[0, :, 1:]
    for place in (11, 23, 35):  # the second one from the state of the first one's end
        chart = whole.state_chart(TRUE, states[place])
        rest = whole.restarted(TIMES[place], TIMES[place:] - TIMES[place], chart, ends)
        found = rest.evaluate(np.append(TRUE, chart.values)).only()[0]
        np.testing.assert_allclose(found[:, 0], values[place:], atol=1e-5)
        np.testing.assert_array_equal(found[:, -1], states[place:, -1])


def test_turns_are_those_nearest_to_the_state_of_the_chart() -> None:
    """A start just beyond half a turn, from a chart just below it, is no turn away."""
    whole = model(wheel)
    below = np.pi - 0.01
    states = whole.restarted(0.0, [0.0, below / 20.0], None, whole.state_chart(TRUE, whole=True))
    state = states.evaluate(TRUE[None]).only()[0, -1, 1:]
    chart = whole.state_chart(TRUE, state)
    shift = np.zeros(len(chart.values))
    shift[chart.names.index("disc.rotation z")] = 0.2
    rest = whole.restarted(below / 20.0, [0.0, 0.01], chart, None)
    before, after = (rest.evaluate(np.append(TRUE, chart.values + s)).only()[0, 0, 0] for s in (0.0 * shift, shift))
    assert before < np.pi < after
    assert after - before == pytest.approx(0.2, abs=1e-6)


def test_a_fit_by_shooting_counts_the_turns() -> None:
    whole = model(wheel, 1e-6)
    exact = whole.evaluate(TRUE[None]).only()[0]
    values = exact + 1e-3 * np.random.default_rng(5).standard_normal(exact.shape)
    data = da.Measurements.of(TIMES, {"pin.angle": values[:, 0]})
    fit = da.identify(whole, data, shooting=MultipleShooting(), starts=1, start=[0.2, 30.0])
    assert fit.success
    assert np.all(np.abs(fit.values - TRUE) < 4 * fit.deviations)
    assert fit.nodes is not None
    assert fit.nodes.gap < 1e-8


def test_a_chart_takes_more_turns() -> None:
    whole = model(wheel)
    chart = whole.state_chart(TRUE)
    assert chart.turning == ("pin.angle",)
    rest = whole.restarted(0.0, [0.0, 0.01], chart.turned(np.array([3.0])), None)
    angle = rest.evaluate(np.append(TRUE, chart.values)).only()[0, 0, 0]
    assert angle == pytest.approx(6 * np.pi, abs=1e-9)
