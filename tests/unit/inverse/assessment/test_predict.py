"""Prediction bands against closed forms, in channels that were not measured, for experiments, and in a file."""

import numpy as np
import pytest
from inline_snapshot import snapshot
from scipy.stats import norm, t

from conclusions import codes, only
from dalembert.data import Measurements
from dalembert.errors import InputError
from dalembert.forward import PythonModel
from dalembert.inverse import Experiment, Prediction, identify, predict
from dalembert.inverse.assessment.predict import band_end
from dalembert.report import charts
from small_models import DECAY, LINE, TIMES, line, measured
from support import says

ONE = PythonModel(lambda offset, slope: line(offset, slope)[:, 0], LINE.parameters, ["x"], TIMES)


@pytest.mark.parametrize("known", [True, False])
def test_a_straight_line_has_the_textbook_bands(known):
    """Var R(t) = s² (1/n + (t − t̄)²/Σ(t − t̄)²), and s² more for a measurement."""
    data = measured(ONE, [1.0, -0.5], noise=0.2, deviations=0.2 if known else None)
    fit = identify(ONE, data)
    told = predict(ONE, fit, 0.9)
    variance = 0.04 if known else fit.misfit / 39
    quantile = norm.ppf(0.95) if known else t.ppf(0.95, 39)
    around = TIMES - TIMES.mean()
    own = variance * (1 / 41 + around**2 / np.sum(around**2))
    np.testing.assert_allclose(told.upper[:, 0] - told.response[:, 0], quantile * np.sqrt(own), rtol=1e-9)
    np.testing.assert_allclose(
        told.response[:, 0] - told.measured_lower[:, 0], quantile * np.sqrt(own + variance), rtol=1e-9
    )
    assert told.success


def test_a_channel_that_was_not_measured_has_a_band_but_no_noise():
    fit = identify(ONE, measured(ONE, [1.0, -0.5], noise=0.2, deviations=0.2))
    told = predict(LINE, fit)
    np.testing.assert_allclose(told.deviations[0, 1], fit.deviations[0], rtol=1e-9)  # y = −offset at t = 0
    assert np.isnan(told.measured_upper[:, 1]).all()
    (table,) = told.tables()
    assert table.rows[1][-1].text == "–"


def test_another_horizon_needs_no_data_there():
    later = np.linspace(0, 8, 17)
    model = PythonModel(lambda offset, slope: offset + slope * later, LINE.parameters, ["x"], later)
    told = predict(model, identify(ONE, measured(ONE, [1.0, -0.5], noise=0.2, deviations=0.2)))
    assert told.response.shape == (17, 1)
    assert np.all(np.diff(told.deviations[6:, 0]) > 0)


def test_what_the_data_did_not_see_leaves_the_band_infinite_and_the_sum_does_not():
    together = PythonModel(lambda a, b: (a + b) * TIMES, {"a": (0.0, 2.0), "b": (0.0, 2.0)}, ["x"], TIMES)
    apart = PythonModel(
        lambda a, b: np.stack([(a + b) * TIMES, a * TIMES], axis=1), together.parameters, ["x", "y"], TIMES
    )
    fit = identify(together, measured(together, [0.5, 1.0], noise=0.1, deviations=0.1))
    told = predict(apart, fit)
    np.testing.assert_allclose(told.deviations[-1, 0], 4 * 0.1 / np.sqrt(np.sum(TIMES**2)), rtol=1e-6)
    assert np.isinf(told.deviations[1:, 1]).all()
    assert not told.success
    assert only(told, "infinite-band").values == {"channels": "y"}
    assert only(told, "infinite-band").message == snapshot(
        "The band of 'y' is infinitely wide: it depends on a combination of the parameters that the data do not identify."
    )


def test_one_of_several_experiments_is_predicted():
    experiments = [
        Experiment(name, DECAY, measured(DECAY, [size, 0.8], 0.05, seed, deviations=0.05), local=("size",))
        for seed, (name, size) in enumerate({"first": 1.0, "second": 2.0}.items())
    ]
    told = predict(experiments[1], identify(experiments))
    assert told.data is experiments[1].data
    assert told.noise.tolist() == [0.05]
    assert told.response[0, 0] == pytest.approx(2.0, abs=0.1)
    assert np.mean(np.abs(told.response[:, 0] - 2 * np.exp(-0.8 * TIMES)) < 3 * told.deviations[:, 0]) == 1


def test_a_file_gives_back_the_same_bits(tmp_path):
    data = measured(ONE, [1.0, -0.5], noise=0.2, deviations=0.2)
    told = predict(LINE, identify(ONE, data))
    told.save(tmp_path / "a.nc")
    back = Prediction.load(tmp_path / "a.nc")
    for name in ("response", "deviations", "noise", "lower", "measured_upper"):
        assert getattr(back, name).tobytes() == getattr(told, name).tobytes()
    assert back.data is not None
    assert back.data.fingerprint == data.fingerprint
    assert back.summary() == told.summary()


def test_a_prediction_without_data_in_its_channels_is_kept_too(tmp_path):
    other = PythonModel(lambda offset, slope: offset + slope * TIMES, LINE.parameters, ["other"], TIMES)
    told = predict(other, identify(ONE, measured(ONE, [1.0, -0.5], noise=0.2, deviations=0.2)))
    told.save(tmp_path / "a.nc")
    assert told.data is None
    assert Prediction.load(tmp_path / "a.nc").data is None


def test_what_cannot_be_meant_is_refused():
    fit = identify(ONE, Measurements.of(TIMES, {"x": TIMES}))
    with pytest.raises(InputError, match=says("predict: level is 0; expected a number between 0 and 1, such as 0.95")):
        predict(ONE, fit, 0)
    sentence = "predict: the model has one that was not identified: unknown parameter 'size'; known: offset, slope"
    with pytest.raises(InputError, match=says(sentence)):
        predict(DECAY, fit)


def growing(rate, level):
    """A band that grows as that of chaotic motion, beside a response of amplitude 1."""
    return np.stack([level + np.sin(5 * LONG) + rate * (np.exp(LONG) - 1), level + 0 * LONG], axis=1)


LONG = np.linspace(0, 8, 161)
GROWING = PythonModel(growing, {"rate": (-1.0, 1.0), "level": (-9.0, 9.0)}, ["x", "y"], LONG)


def test_a_band_ends_where_it_is_as_wide_as_the_motion():
    short = GROWING.first(41)
    fit = identify(short, measured(short, [0.0, 0.0], noise=0.02, deviations=0.02), starts=1)
    told = predict(GROWING, fit)
    (finding,) = [finding for finding in told.findings if finding.code == "band-ends"]
    end = int(np.argmax(np.isnan(told.deviations[:, 0])))
    assert finding.values["channel"] == "x"
    assert finding.values["at"] == LONG[end]
    amplitude = np.ptp(told.response[:, 0]) / 2
    slopes = GROWING.jacobian(fit.values)[:, 0]
    half = told.quantile * np.linalg.norm(
        slopes @ np.diag(fit.deviations) @ np.linalg.cholesky(fit.correlation), axis=1
    )
    assert np.all(half[:end] < amplitude)
    assert half[end] >= amplitude
    assert np.isnan(told.deviations[end:, 0]).all()
    assert np.isfinite(told.deviations[:, 1]).all()  # wide against a level that does not move, but not growing
    assert not told.success
    assert "band-width" in codes(told)
    assert "The band of 'x' ends at" in told.summary()


def test_a_band_that_ends_is_drawn_up_to_its_end(tmp_path):
    short = GROWING.first(41)
    fit = identify(short, measured(short, [0.0, 0.0], noise=0.02, deviations=0.02), starts=1)
    told = predict(GROWING, fit)
    drawn = [trace.x for trace in charts.prediction(told).data if str(trace.name) == "x, 95 % of response"]
    assert drawn
    end = LONG[np.flatnonzero(np.isfinite(told.deviations[:, 0]))[-1]]
    assert all(np.max(np.array(along, dtype=float)) == end for along in drawn)
    told.report(tmp_path / "a.html")
    told.save(tmp_path / "a.nc")
    again = Prediction.load(tmp_path / "a.nc")
    np.testing.assert_array_equal(again.deviations, told.deviations)
    assert again.findings == told.findings


def test_a_wide_band_of_a_badly_known_level_does_not_end():
    assert band_end(np.full(5, 3.0), np.array([0.0, 1.0, 0.0, 1.0, 0.0])) is None
    assert band_end(np.array([0.0, 2.0, 4.0]), np.array([0.0, 5.0, 10.0])) is None
    assert band_end(np.array([0.0, 2.0, 4.0]), np.array([0.0, 5.0, 10.0]), wraps=True) == 2


def test_a_given_deviation_that_is_too_small_does_not_narrow_the_band_of_measurements():
    times = np.linspace(0, 4, 400)
    model = PythonModel(lambda slope: slope * times, {"slope": (0.0, 2.0)}, ["x"], times)
    noise = np.random.default_rng(0).standard_normal((2, 400))
    fit = identify(model, Measurements.of(times, {"x": times + 0.1 * noise[0]}, deviations=0.02))
    told = predict(model, fit)
    unseen = times + 0.1 * noise[1]
    assert 0.9 < np.mean((told.measured_lower[:, 0] <= unseen) & (unseen <= told.measured_upper[:, 0])) < 0.99
    assert told.noise[0] == pytest.approx(0.1, rel=0.1)


def test_outliers_of_a_robust_fit_do_not_widen_its_bands():
    data = measured(DECAY, [2.0, 0.8], 0.02, 3, deviations=0.02)
    values = data.values.copy()
    values[10] += 3.0
    spoilt = Measurements.of(data.coordinate.values, {"x": values[:, 0]}, 0.02)
    fit = identify(DECAY, spoilt, loss="huber")
    assert predict(DECAY, fit).noise[0] == 0.02
    rough = Measurements.of(data.coordinate.values, {"x": measured(DECAY, [2.0, 0.8], 0.06, 3).values[:, 0]}, 0.02)
    assert predict(DECAY, identify(DECAY, rough, loss="huber")).noise[0] == pytest.approx(0.06, rel=0.3)


def test_a_constant_response_has_no_relative_width():
    times = np.linspace(0, 1, 5)
    model = PythonModel(lambda a: a + 0 * times, {"a": (0.0, 9.0)}, ["x"], times)
    found = predict(model, identify(model, Measurements.of(times, {"x": [1.0, 1.1, 0.9, 1.0, 1.2]}), starts=1))
    assert "band-width" not in {finding.code for finding in found.outcome}
