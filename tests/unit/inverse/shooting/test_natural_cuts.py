"""Multiple shooting of mechanisms: states from the joints, growth of errors, uneven, missing and driven records."""

import numpy as np
import pytest

import dalembert as da
from conclusions import only
from dalembert.errors import InputError
from dalembert.inverse import MultipleShooting, identify
from dalembert.inverse.checks.error_growth import error_growth
from dalembert.inverse.experiments.tracks import tracks
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import pose
from dalembert.inverse.shooting.natural_cuts import natural_cuts

RNG = np.random.default_rng(7)
EVEN = np.linspace(0.0, 4.0, 201)
UNEVEN = np.concatenate([[0.0], np.sort(RNG.uniform(0.01, 3.99, 199)), [4.0]])
SOLVER = da.RungeKutta4(step=4e-3)
DRIVE = da.signals.Table(np.linspace(0.0, 4.0, 41), 0.4 * np.random.default_rng(1).standard_normal(41))


def driven(length, friction, angle, rate):
    """A pendulum with a measured torque."""
    system = da.System()
    bar = system.add(da.RigidBar("bar", length=length, mass=1.0, angle=angle, angular_velocity=rate))
    system.add(da.RevoluteJoint("pin", system.ground, bar.start, viscous=friction))
    system.add(da.Torque("motor", bar.centre, DRIVE))
    return system


def loop(length, friction, angle, rate):
    """A closed loop: a rod on two bars of equal length."""
    system = da.System()
    left = system.add(da.RigidBar("left", length=length, mass=1.0, angle=angle, angular_velocity=rate))
    rod = system.add(da.RigidBar("rod", start=left.end, length=1.0, mass=0.5))
    right = system.add(da.RigidBar("right", start=(1.0, 0.0), length=length, mass=1.0, angle=angle))
    system.add(da.RevoluteJoint("A", system.ground, left.start, viscous=friction))
    system.add(da.RevoluteJoint("B", left.end, rod.start))
    system.add(da.RevoluteJoint("C", rod.end, right.end))
    system.add(da.RevoluteJoint("D", system.ground, right.start))
    return system


BOX = {"length": (0.2, 0.6), "friction": (0.0, 0.2), "angle": (-2.0, 1.5), "rate": (-5.0, 5.0)}
TRUE = np.array([0.35, 0.03, -0.9, 1.0])


def record(builder, channels, times, noise=2e-3, missing=()):
    model = da.TimeResponse(builder, BOX, channels, times, SOLVER)
    exact = model.evaluate(TRUE[None]).only()[0]
    values = exact + noise * np.random.default_rng(2).standard_normal(exact.shape)
    values[list(missing)] = np.nan
    data = da.Measurements.of(times, dict(zip(channels, values.T, strict=True)), missing="leave-out")
    return model, data


@pytest.mark.parametrize(
    "missing", [pytest.param((), marks=pytest.mark.slow), (20, *range(70, 90))], ids=["whole", "missing"]
)
@pytest.mark.parametrize("times", [pytest.param(EVEN, marks=pytest.mark.slow), UNEVEN], ids=["even", "uneven"])
@pytest.mark.parametrize(
    ("builder", "channels"),
    [
        (driven, ["bar.end.angle"]),
        pytest.param(driven, ["bar.end.x", "bar.end.y"], marks=pytest.mark.slow),
        pytest.param(loop, ["rod.centre.x", "rod.centre.y"], marks=pytest.mark.slow),
    ],
    ids=["angle", "point", "loop"],
)
def test_records_as_they_come_are_fitted_without_named_states(builder, channels, times, missing):
    model, data = record(builder, channels, times, missing=missing)
    fit = identify(model, data, shooting=MultipleShooting(), start=[0.3, 0.1, -0.5, 0.0])
    assert fit.success, fit.status
    assert np.all(np.abs(fit.values - TRUE) < 4 * fit.deviations)
    assert only(fit, "misfit-at-noise").values == {"source": "smoothed"}
    assert fit.nodes.segments == 1
    body = fit.nodes.states[0].partition(".")[0]
    assert body in ("bar", "left", "right")
    assert fit.nodes.states == (f"{body}.angle", f"{body}.angle rate")
    assert fit.nodes.units == ("rad", "rad/s")
    np.testing.assert_array_equal(fit.nodes.times, times[fit.nodes.samples])
    np.testing.assert_allclose(fit.nodes.ends, fit.nodes.begins, atol=1e-6)
    one = identify(model, data, weights=1 / np.array([*noise_of(fit).values()]) ** 2, start=TRUE, starts=1)
    np.testing.assert_allclose(fit.values, one.values, rtol=1e-5)
    np.testing.assert_allclose(fit.deviations, one.deviations, rtol=1e-2)


def noise_of(fit):
    (finding,) = [one for one in fit.findings if one.code == "smoothed-noise"]
    return finding.values


def test_first_states_are_those_of_the_motion():
    model, data = record(driven, ["bar.end.x", "bar.end.y"], EVEN, noise=1e-6)
    problem = pose(model, data, None, Journal(201))
    states = model.restarted(0.0, EVEN, None, model.state_chart(TRUE)).evaluate(TRUE[None]).only()[0][:, 2:]
    (cut,), values = natural_cuts(problem, tracks(problem), np.array([0.35, 0.03, 0.0, 0.0]), 10)
    np.testing.assert_allclose(values, TRUE, atol=0.05)  # the initial state is measured, with its rate
    for node in cut.nodes:
        np.testing.assert_allclose(node.values, states[node.sample], atol=0.05)


def double_pendulum(length, angle, rate):
    system = da.System()
    upper = system.add(da.RigidBar("upper", length=length, mass=1.0, angle=angle, angular_velocity=rate))
    lower = system.add(da.RigidBar("lower", start=upper.end, length=length, mass=1.0, angle=1.0))
    system.add(da.RevoluteJoint("shoulder", system.ground, upper.start))
    system.add(da.RevoluteJoint("elbow", upper.end, lower.start))
    return system


def chaotic(times):
    box = {"length": (0.2, 0.6), "angle": (0.0, 3.0), "rate": (-5.0, 5.0)}
    model = da.TimeResponse(double_pendulum, box, ["upper.end.angle", "lower.end.angle"], times, SOLVER)
    true = np.array([0.3, 1.5, 0.0])
    exact = model.evaluate(true[None]).only()[0]
    noisy = exact + 0.01 * np.random.default_rng(0).standard_normal(exact.shape)
    return model, true, da.Measurements.of(times, dict(zip(model.channel_names, noisy.T, strict=True)), 0.01)


def test_there_are_more_segments_where_errors_grow_more():
    counts = {}
    for name, (model, data) in {
        "driven": record(driven, ["bar.end.angle"], EVEN),
        "chaotic": chaotic(EVEN)[::2],
    }.items():
        problem = pose(model, data, None, Journal(201))
        (cut,), _ = natural_cuts(problem, tracks(problem), model.parameters.start, None)
        counts[name] = cut.count
    assert counts["chaotic"] > 1.5 * counts["driven"]


def test_growth_is_that_of_the_whole_motion():
    model, true, data = chaotic(EVEN)
    growth = error_growth(pose(model, data, None, Journal(201)), true)
    chart = model.state_chart(true)
    whole = model.restarted(0.0, EVEN, chart, chart)
    response, jacobian = whole.linearise(np.concatenate([true, chart.values]))
    ranges = np.ptp(response[:, 2:], axis=0)
    exact = np.linalg.norm(jacobian[-1, 2:, 3:] * ranges / ranges[:, None], 2)
    assert growth == pytest.approx(exact, rel=0.01)
    assert growth > 1e3


@pytest.mark.slow
def test_shooting_is_proposed_where_errors_grow_and_the_fit_is_doubtful():
    model, true, data = chaotic(EVEN)
    doubtful = identify(model, data, start=[0.5, 0.3, 3.0], starts=1)
    (finding,) = [one for one in doubtful.findings if one.code == "errors-grow"]
    assert finding.severity == "warning"
    assert "write shooting = true in [identify], or shooting=MultipleShooting() in Python" in finding.advice
    good = identify(model, data, start=true, starts=1)
    assert not [one for one in good.findings if one.code == "errors-grow"]
    shot = identify(model, data, start=[0.5, 0.3, 3.0], shooting=MultipleShooting())
    assert shot.success
    assert np.all(np.abs(shot.values - true) < 4 * shot.deviations)


def test_too_few_samples_are_told():
    model, data = record(driven, ["bar.end.angle"], np.linspace(0.0, 1.0, 7))
    with pytest.raises(InputError, match="shooting: 7 samples are too few for 2 segments; expected more than 4 each"):
        identify(model, data, shooting=MultipleShooting())
