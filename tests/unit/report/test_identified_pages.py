"""Headline, search and telling of fits that identify made."""

from dataclasses import replace

import pytest

import dalembert as da
from dalembert.data import Measurements
from dalembert.forward import PythonModel
from dalembert.optimize import ParticleSwarm
from dalembert.report import report
from pages import read_page
from small_models import DECAY, TIMES, measured

GREW = "Fewer samples were fitted first"
SLOPE = PythonModel(lambda slope: slope * TIMES, {"slope": (0.0, 2.0)}, ["x"], TIMES)


def _text(fit, folder):
    return read_page(report(fit, folder / "a.html")).text


@pytest.fixture(scope="module")
def bent():
    """A line through a bend."""
    return da.identify(SLOPE, Measurements.of(TIMES, {"x": TIMES + (TIMES - 2) ** 2}), starts=1)


def test_residuals_that_are_no_noise_are_a_doubt(bent, tmp_path):
    assert bent.success
    codes = {finding.code for finding in bent.findings if finding.severity in ("warning", "error")}
    assert codes == {"systematic-residuals", "model-misfit", "parameters-drift"}
    assert len(bent.doubts) == 3
    assert bent.doubts[0].code == "systematic-residuals"
    text = _text(bent, tmp_path)
    assert "? identified, with doubts" in text
    assert text.count(bent.doubts[0].message) == 2  # beside the verdict, and with the advice among the findings


def test_a_fit_that_nothing_speaks_against_has_no_doubts(tmp_path):
    fit = da.identify(DECAY, measured(DECAY, [2.0, 0.8]))
    assert fit.doubts == ()
    assert "✓ identified" in _text(fit, tmp_path)


def test_a_parameter_on_its_bound_is_a_doubt():
    fit = da.identify(SLOPE, Measurements.of(TIMES, {"x": 2.5 * TIMES}), starts=1)
    (doubt,) = [item for item in fit.doubts if item.code == "parameter-at-bound"]
    assert doubt.values == {"parameter": "slope", "side": "upper", "bound": 2.0}


def test_parameters_that_are_not_told_apart_are_a_doubt():
    model = PythonModel(lambda a, b: a * b * TIMES, {"a": (0.5, 2.0), "b": (0.5, 2.0)}, ["x"], TIMES)
    fit = da.identify(model, Measurements.of(TIMES, {"x": 1.1 * TIMES}))
    assert [(item.code, item.values["parameters"]) for item in fit.doubts] == [("unidentifiable-combination", "a, b")]


def test_without_sensitivities_what_is_unknown_is_no_doubt(bent):
    lost = bent.singular_values * float("nan")
    fit = replace(bent, singular_values=lost, outcome=(), findings=())
    assert [item.code for item in fit.identifiability().findings] == ["no-sensitivities"]
    assert fit.doubts == ()


def test_one_parameter_has_no_correlation_and_no_spectrum(bent, tmp_path):
    page = read_page(report(bent, tmp_path / "a.html"))
    drawn = {attrs.get("data-name") for _, attrs in page.tags}
    assert "convergence" in drawn
    assert not drawn & {"correlation", "singular-values"}


def test_a_horizon_that_grew_is_said_beside_the_convergence(bent, tmp_path):
    data = bent.data
    assert GREW in _text(bent, tmp_path)
    assert GREW not in _text(da.identify(SLOPE, data, starts=1, horizon=None), tmp_path)
    assert GREW not in _text(da.identify(SLOPE, data, method=ParticleSwarm(iterations=3)), tmp_path)


def test_data_too_short_for_another_horizon_are_compared_whole_at_once(tmp_path):
    times = TIMES[:4]
    model = PythonModel(lambda slope: slope * times, {"slope": (0.0, 2.0)}, ["x"], times)
    fit = da.identify(model, Measurements.of(times, {"x": times + 0.1 * times**2}), starts=1)
    assert GREW not in _text(fit, tmp_path)
