"""identify by response sensitivity: the account of its steps in events, history, files, figures and study files."""

import json

import numpy as np
import pytest

from dalembert.inverse import Fit, as_record, identify
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import pose
from dalembert.inverse.starts.spread import SPREADS, spread_points
from dalembert.optimize import ParticleSwarm, ResponseSensitivity
from dalembert.report import figures, report
from dalembert.report.charts.identification.regularisation import accounts
from dalembert.study import load, run_study
from dalembert.study.run.events import read_events
from pages import read_page
from small_models import DECAY, LINE, TIMES, measured

STUDY = """
[study]
title = "Decay"
[parameters]
size = { lower = 0.5, upper = 4.0 }
rate = { lower = 0.1, upper = 3.0 }
[model]
forward = "decay.py:decay"
[data]
file = "decay.csv"
columns = { x = "x" }
[identify]
method = { kind = "response-sensitivity", regularisation = "discrepancy", noise = 0.01, agreement = 0.25 }
starts = 2
spread = "sobol"
"""


@pytest.fixture(scope="module")
def told():
    """A fit from noisy data, and its events."""
    events = []
    data = measured(DECAY, [2.0, 0.8], noise=0.02)
    fit = identify(
        DECAY, data, method=ResponseSensitivity(), start=[0.6, 2.9], starts=1, horizon=None, on_event=events.append
    )
    return fit, events


def test_it_ends_where_least_squares_ends(told):
    fit, _ = told
    usual = identify(DECAY, fit.data)
    np.testing.assert_allclose(fit.values, usual.values, rtol=1e-5)
    np.testing.assert_allclose(fit.deviations, usual.deviations, rtol=1e-4)
    assert fit.method == "ResponseSensitivity"
    assert fit.provenance["method"]["settings"]["growth"] == 2.0
    assert fit.success


def test_the_account_of_every_step_is_in_history_and_events(told):
    fit, events = told
    for start in range(len(fit.starts)):
        first, *others = [step for step in fit.history if step.start == start]
        assert first.regularised is None
        assert all(step.regularised.trials >= 1 for step in others)
        for before, step in zip([first, *others], others, strict=False):
            assert step.regularised.residual == pytest.approx(np.sqrt(before.best))
            fall = step.regularised.agreement
            assert fall >= 0.5
            assert step.best < before.best
    records = [json.loads(json.dumps(as_record(event), allow_nan=False)) for event in events]
    steps = [record["regularised"] for record in records if record["event"] == "iteration" and record["regularised"]]
    assert len(steps) >= sum(step.regularised is not None for step in fit.history)
    assert len(steps[0]["weights"]) == len(steps[0]["step_norms"]) == len(steps[0]["residual_norms"]) > 20


def test_the_account_comes_back_from_a_file_bit_for_bit(told, tmp_path):
    fit, _ = told
    fit.save(tmp_path / "fit.nc")
    back = Fit.load(tmp_path / "fit.nc")
    assert any(step.regularised for step in fit.history)
    for one, same in zip(fit.history, back.history, strict=True):
        if one.regularised is None:
            assert same.regularised is None
            continue
        for name, value in vars(one.regularised).items():
            np.testing.assert_array_equal(getattr(same.regularised, name), value, strict=isinstance(value, np.ndarray))


def test_other_methods_store_no_such_account():
    fit = identify(DECAY, measured(DECAY, [2.0, 0.8]), method=ParticleSwarm(5, 4))
    assert not [name for name in fit.to_xarray().variables if name in ("step_mu", "step_weights")]
    assert "l-curve" not in figures(fit)


def test_figures_show_the_curves_with_their_corners_and_the_steps(told):
    fit, _ = told
    drawn = figures(fit)
    best = accounts(fit)
    traces = {trace.name: trace for trace in drawn["l-curve"].data}
    last = traces[f"step {len(best)}"]
    np.testing.assert_array_equal(last.x, best[-1].residual_norms)
    np.testing.assert_array_equal(last.y, best[-1].step_norms)
    bent = [number for number, step in enumerate(best, 1) if step.chosen > step.weights[0]]
    assert traces[f"step {bent[-1]}"].showlegend
    assert sum(trace.showlegend is True for trace in traces.values() if trace.mode == "lines") == 1
    assert traces["taken"].y[0] == pytest.approx(best[0].length, rel=0.05)
    rows = {trace.name: trace for trace in drawn["steps"].data}
    assert list(rows["agreement"].y) == [step.agreement for step in best]
    assert list(rows["weight taken"].y) == [step.mu for step in best]
    assert list(rows["weight chosen"].y) == [step.chosen for step in best]
    assert list(rows["residual before the step"].y) == [step.residual for step in best]


def test_the_report_holds_both_figures(told, tmp_path):
    fit, _ = told
    page = read_page(report(fit, tmp_path / "fit.html"))
    names = [attrs["data-name"] for attrs, _ in page.scripts if "data-name" in attrs]
    assert names[names.index("convergence") :][:3] == ["convergence", "l-curve", "steps"]


def test_a_study_file_names_method_settings_and_spread(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "decay.py").write_text(
        "import numpy as np\nfrom dalembert.forward import PythonModel\n\n"
        "def decay(parameters):\n    times = np.linspace(0, 4, 41)\n"
        "    return PythonModel(lambda size, rate: size * np.exp(-rate * times), parameters, ['x'], times)\n"
    )
    data = measured(DECAY, [2.0, 0.8], noise=0.01)
    np.savetxt("decay.csv", np.column_stack([TIMES, data.values]), delimiter=",", header="t,x", comments="")
    (tmp_path / "decay.toml").write_text(STUDY)
    folder, outcome = run_study(load("decay.toml"))
    settings = outcome.result.provenance["method"]["settings"]
    assert (settings["regularisation"], settings["noise"], settings["agreement"]) == ("discrepancy", 0.01, 0.25)
    assert outcome.result.provenance["spread"] == "sobol"
    np.testing.assert_allclose(outcome.result.values, [2.0, 0.8], atol=0.05)
    steps = [event for event in read_events(folder.events) if event["event"] == "iteration"]
    assert any(step["regularised"] for step in steps)


@pytest.mark.parametrize("number", [1, 7, 16, 33])
@pytest.mark.parametrize("spread", SPREADS)
def test_points_are_spread_over_the_box_and_follow_from_the_seed(spread, number):
    problem = pose(LINE, measured(LINE, [1.0, 2.0]), None, Journal(41))
    points = spread_points(problem, number, 3, spread)
    assert points.shape == (number, 2)
    assert np.all((points >= problem.search.lower) & (points <= problem.search.upper))
    assert points.tobytes() == spread_points(problem, number, 3, spread).tobytes()
    assert points.tobytes() != spread_points(problem, number, 4, spread).tobytes()


def test_a_power_of_two_of_sobols_points_has_one_in_every_cell():
    problem = pose(LINE, measured(LINE, [1.0, 2.0]), None, Journal(41))
    low, high = problem.search.lower, problem.search.upper
    cells = np.floor((spread_points(problem, 64, 0, "sobol") - low) / (high - low) * 8).astype(int)
    assert len({tuple(cell) for cell in cells}) == 64


def test_the_spread_changes_which_points_are_screened():
    data = measured(DECAY, [2.0, 0.8], noise=0.1)
    best = []
    for spread in SPREADS:
        events = []
        identify(DECAY, data, spread=spread, on_event=events.append)
        best += [event.best for event in events if event.kind == "screened"]
    assert len(set(best)) == 2
