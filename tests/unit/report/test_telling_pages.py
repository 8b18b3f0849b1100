"""Reports and figures on what data can tell: profiles, predictions, designs."""

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.forward import PythonModel
from dalembert.inverse import design, identify, predict, profile
from dalembert.report import charts, figures, report
from pages import read_page
from small_models import DECAY, LINE, TIMES, measured
from support import says

DATA = measured(DECAY, [1.0, 0.8], noise=0.05, deviations=0.05)
FIT = identify(DECAY, DATA)
PROFILES = profile(DECAY, DATA, FIT)
PREDICTION = predict(DECAY, FIT)
DESIGNS = design(LINE, deviations=0.1, horizons=[1.0, 4.0])


def anchors(page):
    return [attrs["id"] for tag, attrs in page.tags if tag in ("section", "header")]


def traces(figure):
    return {trace.name: trace for trace in figure.data}


def test_profiles_have_their_report(tmp_path):
    page = read_page(PROFILES.report(tmp_path / "a.html"))
    assert anchors(page) == ["result", "profile-likelihood", "provenance"]
    assert "✓ profiled" in page.text
    rows = page.table("profiles")
    for row, (name, (lower, upper)) in zip(rows[1:], PROFILES.intervals.items(), strict=True):
        assert (row[0], float(row[2]), float(row[3])) == (name, lower, upper)
    assert list(PROFILES.figures()) == ["profile-1", "profile-2"]


def test_a_profile_shows_excess_threshold_parabola_and_the_others():
    figure = charts.profile(PROFILES, "rate")
    drawn = traces(figure)
    assert list(drawn) == ["profile", "by the standard deviation", "threshold of 95 %", "size"]
    np.testing.assert_array_equal(drawn["profile"].y, PROFILES["rate"].excess)
    assert set(drawn["threshold of 95 %"].y) == {PROFILES.threshold}
    parabola = ((drawn["by the standard deviation"].x - FIT.values[1]) / FIT.deviations[1]) ** 2
    np.testing.assert_allclose(drawn["by the standard deviation"].y, parabola)
    (shade,) = figure.layout.shapes
    assert (shade.x0, shade.x1) == PROFILES.intervals["rate"]
    with pytest.raises(InputError, match=says("profile: unknown parameter 'mass'; known: rate, size")):
        charts.profile(PROFILES, "mass")


def test_open_sides_are_marked_and_said(tmp_path):
    model = PythonModel(lambda a, b: (a + b) * TIMES, {"a": (0.0, 1.0), "b": (0.5, 3.0)}, ["x"], TIMES)
    data = measured(model, [0.5, 1.5], noise=0.01, deviations=0.01)
    told = profile(model, data, identify(model, data), names=["a"])
    page = read_page(report(told, tmp_path / "a.html"))
    assert page.table("profiles")[1][-1] == "open: lower and upper bound"
    assert "'a' is not identifiable: all values between its bounds" in page.text


def test_a_prediction_has_its_report(tmp_path):
    page = read_page(PREDICTION.report(tmp_path / "a.html"))
    assert anchors(page) == ["result", "prediction", "provenance"]
    assert float(page.table("prediction")[1][2]) == np.max((PREDICTION.upper - PREDICTION.lower) / 2)
    drawn = traces(figures(PREDICTION)["prediction-1"])
    assert list(drawn) == [
        "x, 95 % of measurement",
        "x, ± measurement",
        "x, 95 % of response",
        "x, ± response",
        "x predicted",
        "x measured",
    ]
    np.testing.assert_array_equal(drawn["x measured"].y, DATA.values[:, 0])
    np.testing.assert_allclose(drawn["x, ± response"].y, 1.959963984540054 * PREDICTION.deviations[:, 0])


def test_a_band_without_an_end_is_left_out():
    together = PythonModel(lambda a, b: (a + b) * TIMES, {"a": (0.0, 2.0), "b": (0.0, 2.0)}, ["x"], TIMES)
    apart = PythonModel(lambda a, b: a * TIMES, together.parameters, ["y"], TIMES)
    told = predict(apart, identify(together, measured(together, [0.5, 1.0], noise=0.1, deviations=0.1)))
    assert list(traces(charts.prediction(told))) == ["y predicted"]


def test_designs_have_their_report(tmp_path):
    page = read_page(DESIGNS.report(tmp_path / "a.html"))
    assert anchors(page) == ["result", "designs", "provenance"]
    rows = page.table("designs")
    assert [float(row[3]) for row in rows[1:]] == DESIGNS.scores.tolist()
    found = DESIGNS.figures()
    assert list(found) == ["ranking", "horizons"]
    (ranking,) = found["ranking"].data
    np.testing.assert_array_equal(ranking.x, DESIGNS.scores)
    for trace in found["horizons"].data:
        own = [place for place, sensors in enumerate(DESIGNS.sensors) if sensors == (trace.name,)]
        assert sorted(trace.y) == sorted(DESIGNS.scores[own])


def test_designs_of_one_horizon_are_only_ranked_and_the_unseen_are_marked(tmp_path):
    two = PythonModel(
        lambda a, b: np.stack([a * TIMES, (a + b) * TIMES], axis=1), {"a": (0, 2), "b": (0, 2)}, ["p", "q"], TIMES
    )
    designs = design(two, deviations=0.1, sensors=["p", ("p", "q")])
    assert list(designs.figures()) == ["ranking"]
    assert len(designs.figures()["ranking"].data[0].x) == 1
    page = read_page(designs.report(tmp_path / "a.html"))
    assert page.table("designs")[2][-1] == "1 unseen"


def test_a_fit_shows_its_profiles_and_prediction(tmp_path):
    page = read_page(report(FIT, tmp_path / "a.html", PROFILES, PREDICTION))
    assert anchors(page)[-4:] == ["identifiability", "profile-likelihood", "prediction", "provenance"]
    assert {"profile-1", "profile-2", "prediction-1"} <= set(figures(FIT, PROFILES, PREDICTION))
