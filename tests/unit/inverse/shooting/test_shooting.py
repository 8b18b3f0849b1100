"""Multiple shooting: segments and their gaps against closed forms, continuity, merging, refusals."""

import numpy as np
import pytest

from conclusions import codes, only
from dalembert.data import Measurements
from dalembert.errors import InputError
from dalembert.forward import PythonModel
from dalembert.inverse import Experiment, Fit, MultipleShooting, ShootingState, identify, predict, profile
from dalembert.inverse.experiments.tracks import tracks
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import pose
from dalembert.inverse.shooting.continuity import Chain
from dalembert.inverse.shooting.cuts import Cut, SegmentNode, guess, segments
from dalembert.inverse.shooting.shooting import first_cuts
from support import says

TIMES = np.linspace(0, 4, 41)


def swing(place, speed, stiffness):
    own = np.sqrt(stiffness)
    x = place * np.cos(own * TIMES) + speed / own * np.sin(own * TIMES)
    v = speed * np.cos(own * TIMES) - place * own * np.sin(own * TIMES)
    return np.stack([x, v], axis=1)


SWING = PythonModel(swing, {"place": (-2.0, 2.0), "speed": (-3.0, 3.0), "stiffness": (2.0, 30.0)}, ["x", "v"], TIMES)
STATES = {"place": ShootingState("x", -2.0, 2.0), "speed": ShootingState("v", -9.0, 9.0)}
TRUE = np.array([1.0, -0.5, 9.0])


def measured(noise=0.0, **options):
    exact = swing(*TRUE)[:, 0]
    return Measurements.of(TIMES, {"x": exact + noise * np.random.default_rng(0).standard_normal(41)}, **options)


def together():
    """The parameters with which all segments are of one motion."""
    motion = swing(*TRUE)
    return np.concatenate([TRUE, motion[10], motion[21]])


def chain(noise=0.01, states=STATES, cuts=(10, 21)):
    """Segments of the swing between given samples, and their problem."""
    problem = pose(SWING, measured(noise, deviations=0.01), None, Journal(41))
    (track,) = tracks(problem)
    lower, upper = (np.array([getattr(state, side) for state in states.values()]) for side in ("lower", "upper"))
    nodes = [SegmentNode(cut, tuple(states), ("", ""), np.zeros(2), lower, upper, upper - lower) for cut in cuts]
    return Chain(problem, segments(problem, [Cut(track, tuple(nodes), states)]))


def test_segments_of_one_motion_are_that_motion_and_meet():
    pieces = chain().segments
    assert pieces.parameters.names[3:] == ("place at 10", "speed at 10", "place at 21", "speed at 21")
    response = pieces.evaluate(together())
    np.testing.assert_allclose(response.values, swing(*TRUE)[:, :1], atol=1e-12)
    np.testing.assert_allclose(response.gaps, 0, atol=1e-12)
    rows = np.concatenate([piece.rows for piece in pieces.pieces])
    np.testing.assert_array_equal(rows, np.arange(41))  # a sample at which segments meet counts once


def test_a_gap_is_the_end_of_a_segment_less_the_beginning_of_the_next():
    apart = together()
    apart[3] += 0.25
    assert chain().segments.evaluate(apart).gaps[0] == pytest.approx(-0.25 / 4)  # in parts of the state's range


def test_derivatives_are_those_of_differences():
    pieces, vector, step = chain().segments, together() + 0.1, 1e-6
    moved = [(pieces.evaluate(vector + step * way), pieces.evaluate(vector - step * way)) for way in np.eye(7)]
    at = pieces.linearise(vector)
    of_values = np.stack([(up.values - down.values) / (2 * step) for up, down in moved], axis=2)
    of_gaps = np.stack([(up.gaps - down.gaps) / (2 * step) for up, down in moved], axis=1)
    np.testing.assert_allclose(pieces.jacobian(at), of_values, atol=1e-7)
    np.testing.assert_allclose(pieces.slopes_of_gaps(at), of_gaps, atol=1e-7)
    np.testing.assert_allclose(at.response.values, pieces.evaluate(vector).values, atol=1e-14)


def test_gaps_are_closed_and_the_misfit_is_that_of_one_run():
    own = chain()
    found = own.closed(own.search.points(together() + 0.05))
    one = identify(SWING, measured(0.01, deviations=0.01), start=TRUE, starts=1)
    assert found.gap < 1e-8
    assert found.misfit == pytest.approx(one.misfit, rel=1e-6)
    np.testing.assert_allclose(own.search.vectors(found.point)[:3], one.values, rtol=1e-5)


def test_segments_that_meet_have_the_jacobian_of_one_run():
    own = chain()
    at = own.linearised(own.search.points(together()))
    response, jacobian = SWING.linearise(TRUE)
    np.testing.assert_allclose(at.response, response[:, :1], atol=1e-12)
    np.testing.assert_allclose(at.jacobian, jacobian[:, :1], atol=1e-12)


def test_segments_that_meet_have_the_covariance_of_one_run():
    own = chain(noise=0.0)
    spread = own.spread(own.search.points(together()))
    slopes = SWING.jacobian(TRUE)[:, 0] / 0.01
    np.testing.assert_allclose(spread @ spread.T, np.linalg.inv(slopes.T @ slopes), rtol=1e-9)


def test_growth_is_that_of_the_state_from_the_beginning_to_the_last_node():
    own = chain()
    begins, gaps = own.met(own.search.points(together()))
    growth = own.growth(own.search.points(together()), [np.array([0, 1])])
    ranges = np.array([4.0, 18.0])
    exact = SWING.jacobian(TRUE)[21][:, :2] * ranges / ranges[:, None]
    np.testing.assert_allclose(begins, swing(*TRUE)[[10, 21]].ravel())
    np.testing.assert_allclose(gaps, 0, atol=1e-12)
    assert growth == pytest.approx(np.linalg.norm(exact, 2))


@pytest.mark.parametrize("segments", [2, 4, 7])
def test_merged_segments_end_as_one_run(segments):
    data = measured(0.01, deviations=0.01)
    fit = identify(SWING, data, shooting=MultipleShooting(STATES, segments), start=[0.5, 0.5, 5.0])
    one = identify(SWING, data, start=TRUE, starts=1)
    assert fit.success
    np.testing.assert_allclose(fit.values, one.values, rtol=1e-6)
    np.testing.assert_allclose(fit.deviations, one.deviations, rtol=1e-4)
    assert fit.nodes is not None
    assert fit.nodes.segments == 1
    assert fit.nodes.gap < 1e-8
    np.testing.assert_allclose(fit.nodes.ends, fit.nodes.begins, atol=1e-7)
    assert only(fit, "segments-merged").values["segments"] == 1
    gaps = [step.gap for step in fit.history]
    assert gaps[0] > 0.01
    assert min(gap for gap in gaps if gap) < 1e-8


def first_guess(noise, states, values):
    problem = pose(SWING, measured(noise, deviations=0.01), None, Journal(41))
    cuts, values = first_cuts(problem, MultipleShooting(states, 4), np.array(values))
    return guess(values, cuts)


def test_the_first_guess_is_measured_or_follows_from_the_segment_before():
    exact = swing(*TRUE)
    found = first_guess(0.0, STATES, [0.0, -0.5, 9.0])
    np.testing.assert_allclose(found[[0, 3, 5, 7]], exact[[0, 10, 20, 30], 0])
    np.testing.assert_allclose(found[4], exact[10, 1])  # the true parameters lead there from the true beginning
    rate = {**STATES, "speed": ShootingState("v", -9.0, 9.0, rate_of="x")}
    found = first_guess(0.0, rate, [0.0, 3.0, 20.0])
    np.testing.assert_allclose(found[[1, 4, 6]], np.clip(exact[[0, 10, 20], 1], -9, 9), atol=0.3)


def test_wrapping_angles_are_taken_near_the_initial_state():
    turn = 2 * np.pi
    turning = lambda place, speed: np.stack([place + speed * TIMES, speed + 0 * TIMES], axis=1)  # noqa: E731
    model = PythonModel(turning, {"place": (0.0, 9.0), "speed": (-3.0, 3.0)}, ["x", "v"], TIMES)
    exact = turning(7.0, 2.0)[:, 0]
    wrapped = Measurements.of(TIMES, {"x": (exact + np.pi) % turn - np.pi}, deviations=0.01, wraps=["x"])
    states = {"place": ShootingState("x", -30.0, 30.0), "speed": ShootingState("v", -9.0, 9.0)}
    fit = identify(model, wrapped, shooting=MultipleShooting(states, 4), start=[6.5, 1.0])
    np.testing.assert_allclose(fit.values, [7.0, 2.0], atol=1e-8)


def test_robust_losses_and_gaps_in_the_data_are_kept():
    exact = swing(*TRUE)[:, 0]
    exact[[7, 30]] += 2.0
    exact[[10, 15]] = np.nan  # one of them where segments meet
    data = Measurements.of(TIMES, {"x": exact}, deviations=0.01, missing="leave-out")
    fit = identify(SWING, data, shooting=MultipleShooting(STATES, 4), loss="cauchy", start=[0.5, 0.5, 5.0])
    np.testing.assert_allclose(fit.values, TRUE, atol=1e-3)


def test_simulations_of_all_fits_are_counted_as_runs_over_all_samples():
    calls = 0

    def counted(**values):
        nonlocal calls
        calls += 1
        return swing(**values)

    model = PythonModel(counted, SWING.parameters, ["x", "v"], TIMES)
    model.jacobian(model.parameters.start)  # which compares the complex step with differences, once
    calls = 0
    data, told = measured(0.01, deviations=0.01), []
    fit = identify(model, data, shooting=MultipleShooting(STATES, 4), starts=1, on_event=told.append)
    assert fit.simulations == told[-1].simulations
    assert calls / 4 < fit.simulations < calls  # a segment is a call of its own, and a part of a run


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"segments": 32}, "shooting: 41 samples are too few for 32 segments; expected more than two each"),
        ({"segments": 1}, "MultipleShooting: segments is 1; expected a whole number of at least 2"),
        (
            {"states": {}},
            "MultipleShooting: no states were given; expected all parameters of the initial state, each with the "
            "channel that it is later; or leave states out for a mechanism",
        ),
        (
            {"states": None},
            "shooting: the model cannot begin at a later state; leave out sensors and an unknown start, or name "
            "its states: MultipleShooting({parameter: ShootingState(channel, lower, upper)})",
        ),
        (
            {"states": {"plac": ShootingState("x", -2, 2)}},
            "shooting, states: unknown parameter 'plac'; did you mean 'place'?",
        ),
        ({"states": {"place": ShootingState("y", -2, 2)}}, "shooting, state 'place': unknown channel 'y'; known: v, x"),
        (
            {"states": STATES | {"speed": ShootingState("v", -9, 9, rate_of="v")}},
            "shooting, state 'speed', rate_of: unknown channel 'v'; known: x",
        ),
        (
            {"states": {"place": ShootingState("v", -2, 2), "speed": STATES["speed"]}},
            "shooting, state 'place': the motion begins with 'v' at 0.5 where the parameter is 1; expected the same; "
            "name the channel that begins with the parameter, and give bodies velocities that go together",
        ),
        (
            {"states": {"place": STATES["place"]}},
            "shooting: a segment that begins with the states at sample 10 does not continue the motion: 'x' differs by "
            "0.472; expected a model that does not depend on time but through its state, and all of its state in "
            "states, which are 'place'",
        ),
        (
            {"method": "Nelder-Mead"},
            "shooting: method is Minimiser; multiple shooting is a way of least squares; leave one out",
        ),
        (
            {"validation": 0.25},
            "shooting: validation was given, but a chaotic motion cannot be predicted; leave one of the two out",
        ),
    ],
)
def test_what_cannot_be_cut_is_told(change, sentence):
    given = {"data": measured(deviations=0.1), "states": STATES, "segments": 4} | change
    data, states, segments = given.pop("data"), given.pop("states"), given.pop("segments")
    with pytest.raises(InputError, match=says(sentence)):
        identify(SWING, data, shooting=MultipleShooting(states, segments), start=[1.0, 0.5, 9.0], **given)


def test_bounds_of_a_state_in_order():
    with pytest.raises(InputError, match=says("ShootingState 'x': bounds are (2, -2); expected lower < upper")):
        ShootingState("x", 2, -2)


def test_experiments_are_cut_each_for_itself():
    other = PythonModel(swing, SWING.parameters, ["x", "v"], TIMES)
    true = {"first": TRUE, "second": np.array([-0.7, 1.2, 9.0])}
    noise = 0.01 * np.random.default_rng(3).standard_normal((2, 41))
    experiments = [
        Experiment(name, other, Measurements.of(TIMES, {"x": swing(*own)[:, 0] + wrong}, 0.01), ("place", "speed"))
        for (name, own), wrong in zip(true.items(), noise, strict=True)
    ]
    fit = identify(experiments, shooting=MultipleShooting(STATES, 4))
    one = identify(experiments)
    np.testing.assert_allclose(fit.values, one.values, rtol=1e-6)
    np.testing.assert_allclose(fit.deviations, one.deviations, rtol=1e-4)
    assert fit.nodes.experiments == ("first",) * 3 + ("second",) * 3
    assert "segments-merged" in codes(fit)


def test_noise_that_is_not_given_is_estimated_and_said():
    fit = identify(SWING, measured(0.01), shooting=MultipleShooting(STATES, 4))
    (finding,) = [one for one in fit.findings if one.code == "smoothed-noise"]
    assert finding.values["x"] == pytest.approx(0.01, rel=0.4)
    assert "Their noise was estimated by local polynomials: 'x' 0.0" in str(finding)
    assert only(fit, "misfit-at-noise").values == {"source": "smoothed"}
    given = identify(SWING, measured(0.01, deviations=0.01), shooting=MultipleShooting(STATES, 4))
    np.testing.assert_allclose(fit.values, given.values, rtol=1e-6)


def test_progress_tells_what_is_minimised():
    told = []
    identify(SWING, measured(0.01, deviations=0.01), shooting=MultipleShooting(STATES, 4), on_event=told.append)
    steps = [event for event in told if event.kind == "iteration" and event.gap is not None]
    assert all(step.minimised >= step.best for step in steps)
    assert steps[0].minimised > steps[0].best


def test_uneven_samples_are_told():
    times = TIMES.copy()
    times[-1] = 4.1
    model = PythonModel(swing, SWING.parameters, ["x", "v"], times)
    data = Measurements.of(times, {"x": np.ones(41)}, 0.1)
    sentence = (
        "shooting: the samples are between 0.1 and 0.2 s apart; expected even ones, so that each segment is like the "
        "beginning; resample the data"
    )
    with pytest.raises(InputError, match=says(sentence)):
        identify(model, data, shooting=MultipleShooting(STATES, 4))


def test_the_nodes_come_back_from_a_file_bit_for_bit(tmp_path):
    fit = identify(SWING, measured(0.01, deviations=0.01), shooting=MultipleShooting(STATES, 4))
    fit.save(tmp_path / "fit.nc")
    back = Fit.load(tmp_path / "fit.nc")
    for name, value in vars(fit.nodes).items():
        np.testing.assert_array_equal(getattr(back.nodes, name), value)
    assert [step.gap for step in back.history] == [step.gap for step in fit.history]
    assert back.summary() == fit.summary()


SHIFT = 3.9


def doubling(start, ratio):
    """The logistic map, which forgets a binary digit of its beginning in each of 100 steps; and a channel to fit."""
    x = [start]
    for _ in range(100):
        x.append(ratio * x[-1] * (1 - x[-1]))
    return np.array(x)[:, None]


@pytest.mark.slow
def test_what_no_single_run_can_follow_is_fitted_in_segments_and_says_so():
    steps = np.arange(101.0)
    model = PythonModel(doubling, {"start": (0.1, 0.9), "ratio": (3.5, 4.0)}, ["x"], steps)
    noise = 0.001
    exact = doubling(0.3, SHIFT)[:, 0]
    data = Measurements.of(steps, {"x": exact + noise * np.random.default_rng(0).standard_normal(101)}, noise)
    shooting = MultipleShooting({"start": ShootingState("x", 0.0, 1.0)}, segments=40)
    fit = identify(model, data, shooting=shooting, starts=1, start=[0.4, 3.7])
    assert fit.success
    assert fit.nodes.segments > 1
    assert fit.nodes.growth > 1e12
    assert fit.misfit < 1.5 * 101
    assert fit.estimates["ratio"] == pytest.approx(SHIFT, abs=1e-4)
    assert only(fit, "segments-separate").values["segments"] == fit.nodes.segments
    assert model.evaluate(fit.values[None]).only()[0, :, 0] != pytest.approx(fit.response[:, 0], abs=0.1)
    for name, refused in (
        ("predict", lambda: predict(model, fit)),
        ("profile", lambda: profile(model, data, fit)),
    ):
        sentence = (
            f"{name}: the fit is of {fit.nodes.segments} segments that did not merge into one run, which {name} would "
            "simulate; fit fewer samples"
        )
        with pytest.raises(InputError, match=says(sentence)):
            refused()
