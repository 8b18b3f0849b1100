"""Morris's screening: effects of known functions, SALib's statistics, and what is refused."""

import sys

import numpy as np
import pytest
from inline_snapshot import snapshot

import dalembert as da

TIMES = np.linspace(0.0, 2.0, 5)
NAMES = ("gain", "rate", "idle", "known")
MODEL = da.PythonModel(
    lambda gain, rate, idle, known: np.stack(
        [gain * np.exp(-rate * TIMES) + 0 * idle, known + gain * TIMES**2 - rate * TIMES], axis=1
    ),
    dict.fromkeys(NAMES, (0.0, 3.0)),
    ["x", "y"],
    TIMES,
)
BOX = {"gain": (0.5, 1.5), "rate": (0.5, 2.0), "idle": (0.0, 1.0), "known": 1.0}


@pytest.fixture(scope="module")
def found():
    return da.screen(MODEL, BOX, trajectories=8, seed=3)


def test_effects_of_a_linear_response_are_its_changes_over_the_intervals(found):
    np.testing.assert_allclose(found.effects[:, 1, 0], 1.0 * TIMES**2, atol=1e-12)
    np.testing.assert_allclose(found.mean[:, 1, 1], -1.5 * TIMES, atol=1e-12)
    np.testing.assert_allclose(found.spread[:, 1], 0.0, atol=1e-12)
    np.testing.assert_allclose(found.aggregated_effects[1, 1], 1.5 * np.sqrt(np.mean(TIMES**2)))
    assert not found.effects[..., 2:].any()  # an idle parameter, and one that is known exactly
    assert found.runs == 8 * 4
    assert found.ranking("x")[:2] == ("gain", "rate")


def test_statistics_are_those_of_salib(found):
    from SALib.analyze import morris as analysis
    from SALib.sample import morris as trajectories

    names = NAMES[:3]
    unit = {"num_vars": 3, "names": list(names), "bounds": [[0.0, 1.0]] * 3}
    parts = trajectories.sample(unit, 8, num_levels=4, seed=3)
    lower, upper = np.array([BOX[name] for name in names]).T
    values = np.array([MODEL.function(*point, 1.0)[2, 0] for point in lower + parts * (upper - lower)])
    theirs = analysis.analyze(unit, parts, values, num_levels=4, num_resamples=2, seed=1)
    np.testing.assert_allclose(found.mean[2, 0, :3], theirs["mu"], atol=1e-12)
    np.testing.assert_allclose(found.effects[2, 0, :3], theirs["mu_star"], atol=1e-12)
    np.testing.assert_allclose(found.spread[2, 0, :3], theirs["sigma"], atol=1e-12)


def test_steps_follow_the_probability_of_a_distribution():
    line = da.PythonModel(lambda a: np.array([a]), {"a": (-9.0, 9.0)}, ["x"], TIMES[:1])
    prior = da.Normal(0.0, 1.0)
    known = da.screen(line, {"a": prior}, trajectories=4)
    steps = [1.5 * (prior.quantile(2 / 3) - known.box.lower[0]), 1.5 * (known.box.upper[0] - prior.quantile(1 / 3))]
    assert known.effects[0, 0, 0] == pytest.approx(steps[0], rel=1e-3)
    assert steps[0] == pytest.approx(steps[1])


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"trajectories": 1}, snapshot("screen: trajectories is 1; expected a whole number, at least 2")),
        ({"levels": 5}, snapshot("screen: levels is 5; expected an even number, as 4")),
        (
            {"intervals": dict.fromkeys(NAMES, 1.0)},
            snapshot("screen: all intervals have the width 0. Give at least one parameter an interval."),
        ),
    ],
    ids=["trajectories", "levels", "width"],
)
def test_what_is_refused(options, sentence):
    with pytest.raises(da.InputError) as refused:
        da.screen(MODEL, **{"intervals": BOX, **options})
    assert str(refused.value) == sentence


def test_a_missing_extra_is_explained(monkeypatch):
    monkeypatch.setitem(sys.modules, "SALib.sample.morris", None)
    with pytest.raises(da.InputError, match=r"run: pip install 'dalembert\[sensitivity\]'"):
        da.screen(MODEL, BOX)


def test_trajectories_with_failed_runs_are_left_out():
    def fragile(a, b):
        if a > 0.9 and b > 0.9:
            raise RuntimeError("too large")
        return a + b + 0 * TIMES

    model = da.PythonModel(fragile, {"a": (0, 1), "b": (0, 1)}, ["x"], TIMES)
    known = da.screen(model, trajectories=10)
    assert 2 <= known.trajectories < 10
    assert not known.success
    np.testing.assert_allclose(known.effects, 1.0)
    with pytest.raises(da.SolveError, match="trajectories are without failed runs, the first: RuntimeError: too large"):
        da.screen(model, {"a": (0.95, 1.0), "b": (0.95, 1.0)})


def test_it_is_stored(found, tmp_path):
    found.save(tmp_path / "screening.nc")
    again = da.Screening.load(tmp_path / "screening.nc")
    assert again.summary() == found.summary()
    np.testing.assert_array_equal(again.effects, found.effects)
