"""Reports on several experiments, and on what was kept for validation."""

import numpy as np
import pytest

from dalembert.inverse import Experiment, identify
from dalembert.report import figures, report
from pages import read_page
from small_models import DECAY, measured


def experiments():
    return [
        Experiment(name, DECAY, measured(DECAY, [2.0, 0.8], 0.02, seed, deviations=0.02), own)
        for seed, (name, own) in enumerate([("warm", ("size",)), ("cold <b>", ())])
    ]


@pytest.fixture(scope="module")
def fit():
    return identify(experiments(), validation=0.25)


def test_each_experiment_has_its_figure_with_its_own_data(fit):
    drawn = figures(fit)
    assert {"experiment-1-1", "experiment-2-1"} <= set(drawn)
    assert "responses-1" not in drawn
    by_name = {trace.name: trace for trace in drawn["experiment-1-1"].data}
    np.testing.assert_array_equal(by_name["x measured"].y, fit.experiments[0].data.values[:, 0])
    np.testing.assert_array_equal(by_name["x computed"].y, fit.experiments[0].response[:, 0])
    shaded = [shape for shape in drawn["experiment-1-1"].layout.shapes if shape.type == "rect"]
    assert [(shape.x0, shape.x1) for shape in shaded] == [(pytest.approx(3.05), 4.0)] * len(shaded) != []


def test_the_page_names_experiments_and_what_was_not_fitted(fit, tmp_path):
    page = read_page(report(fit, tmp_path / "fit.html"))
    assert str(fit.validation) in page.text
    assert "The shaded part was not fitted." in page.text
    assert "warm: x" in page.text
    assert "cold <b>: x" in page.text
    assert "Download all samples of warm as CSV" in page.text


def test_a_predicted_experiment_is_marked(tmp_path):
    items = [Experiment(name, item.model, item.data) for name, item in zip("ab", experiments(), strict=True)]
    fit = identify(items, validation="b")
    page = read_page(report(fit, tmp_path / "fit.html"))
    assert "b (predicted): x" in page.text
    assert "Not fitted: the experiment 'b'." in page.text
    assert not [shape for shape in figures(fit)["experiment-2-1"].layout.shapes if shape.type == "rect"]


def test_a_share_of_one_experiment_is_shaded(tmp_path):
    fit = identify(DECAY, measured(DECAY, [2.0, 0.8], 0.02), validation=0.5)
    page = read_page(report(fit, tmp_path / "fit.html"))
    assert "Not fitted: the last 20 of 41 samples." in page.text
    assert next(shape.x1 for shape in figures(fit)["responses-1"].layout.shapes if shape.type == "rect") == 4.0
