"""Missing samples do not count, and differences of angles count modulo a turn."""

import numpy as np
import pytest

from conclusions import only
from dalembert.data import Measurements
from dalembert.errors import DataError
from dalembert.forward import PythonModel
from dalembert.inverse import Fit, identify
from dalembert.inverse.noise.noise_floor import noise_floor
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import pose
from dalembert.inverse.problem.random_residuals import random_residuals
from dalembert.inverse.starts.multistart import horizons
from dalembert.optimize import ParticleSwarm
from dalembert.report.charts import responses
from dalembert.report.section import by_name
from small_models import DECAY, LINE, TIMES, line, measured

TURN = 2 * np.pi
DESIGN = np.stack([line(1.0, 0.0), line(0.0, 1.0)], axis=-1)


def angle(rate, growth):
    return rate * TIMES + growth * TIMES**2


SPIN = PythonModel(angle, {"rate": (1.0, 9.0), "growth": (-1.0, 1.0)}, ["angle"], TIMES)


def gappy(data, share=0.3, seed=1):
    """The data with a share of their values gone."""
    gone = np.random.default_rng(seed).random(data.values.shape) < share
    values = np.where(gone, np.nan, data.values)
    return Measurements(data.coordinate, data.channels, values, data.deviations, "leave-out", data.wraps)


def wrapped(values, **more):
    return Measurements.of(TIMES, {"angle": (values + np.pi) % TURN - np.pi}, wraps=["angle"], **more)


@pytest.mark.parametrize("deviations", [None, {"x": 0.1, "y": 0.3}], ids=["unknown noise", "known noise"])
def test_a_fit_with_gaps_is_the_least_squares_of_what_is_there(deviations):
    data = gappy(measured(LINE, [1.0, 2.0], 0.1, deviations=deviations))
    fit = identify(LINE, data)
    root = np.where(data.present, 1.0 if deviations is None else 1 / data.deviations, 0.0)
    values, squares, *_ = np.linalg.lstsq(
        (root[..., None] * DESIGN).reshape(-1, 2), (root * np.nan_to_num(data.values)).ravel(), rcond=None
    )
    np.testing.assert_allclose(fit.values, values, rtol=0, atol=1e-5 * fit.deviations.min())  # a gain below 1e-13
    assert fit.misfit == pytest.approx(squares.item(), rel=1e-9)
    np.testing.assert_array_equal(fit.weights == 0, ~data.present)
    np.testing.assert_array_equal(np.isnan(fit.residuals), ~data.present)
    assert fit.facts()["fitted values"] == str(data.present.sum())


def test_the_noise_is_told_from_the_values_that_are_there():
    data = gappy(measured(LINE, [1.0, 2.0], 0.1))
    fit = identify(LINE, data)
    inverse = np.linalg.inv(DESIGN[data.present].T @ DESIGN[data.present])
    variance = fit.misfit / (data.present.sum() - 2)
    np.testing.assert_allclose(fit.deviations, np.sqrt(variance * np.diag(inverse)), rtol=1e-6)


def test_the_weights_of_present_values_are_as_given():
    fit = identify(LINE, gappy(measured(LINE, [1.0, 2.0], 0.1)), weights=[4.0, 1.0])
    np.testing.assert_array_equal(fit.weights, np.where(np.isnan(fit.residuals), 0.0, [4.0, 1.0]))


def test_a_swarm_leaves_gaps_out_too():
    data = gappy(measured(DECAY, [2.0, 0.8]))
    fit = identify(DECAY, data, method=ParticleSwarm(10, 20), polish=True)
    np.testing.assert_allclose(fit.values, [2.0, 0.8], rtol=1e-6)


def test_a_channel_that_begins_late_shortens_no_horizon_to_nothing():
    values = measured(LINE, [1.0, 2.0]).values.copy()
    values[:12] = np.nan
    data = Measurements.of(TIMES, {"x": values[:, 0], "y": values[:, 1]}, missing="leave-out")
    problem = pose(LINE, data, None, Journal(41, None))
    assert horizons(problem, "growing") == [20, 41]
    np.testing.assert_allclose(identify(LINE, data).values, [1.0, 2.0], rtol=1e-9)


def test_rounding_is_seen_through_gaps():
    exact = measured(DECAY, [2.0, 0.8])
    rounded = gappy(Measurements.of(TIMES, {"x": np.round(exact.values[:, 0], 4)}))
    fit = identify(DECAY, rounded)
    assert only(fit, "misfit-at-noise").values == {"source": "rounded"}
    assert fit.success


def test_fewer_values_scatter_more_before_they_are_no_noise():
    residual = np.zeros(400)
    residual[:40] = np.sin(np.arange(40) / 0.9)
    present = np.arange(400)[:, None] < 40
    assert random_residuals(residual, (400, 1), present) != random_residuals(residual, (400, 1))


def test_neighbours_are_the_values_that_are_there():
    trend, present = np.repeat(np.sin(np.arange(40) / 5), 2), np.arange(80)[:, None] % 2 == 0
    residual = np.where(present[:, 0], trend, 0.0)
    assert random_residuals(residual, (80, 1))
    assert not random_residuals(residual, (80, 1), present)


@pytest.mark.parametrize("noise", [0.0, 0.05], ids=["exact", "noisy"])
def test_an_angle_that_wraps_identifies_what_it_would_without_wrapping(noise):
    scatter = noise * np.random.default_rng(0).standard_normal(len(TIMES))
    straight = identify(SPIN, Measurements.of(TIMES, {"angle": angle(4.0, 0.5) + scatter}))
    fit = identify(SPIN, wrapped(angle(4.0, 0.5) + scatter))
    np.testing.assert_allclose(fit.values, straight.values, rtol=1e-7)
    np.testing.assert_allclose(fit.residuals, straight.residuals, atol=1e-6)
    np.testing.assert_allclose(fit.deviations, straight.deviations, rtol=1e-4, atol=1e-9)
    assert straight.values == pytest.approx([4.0, 0.5], abs=10 * noise + 1e-9)


def test_without_the_word_the_same_angles_identify_something_else():
    data = wrapped(angle(4.0, 0.5))
    fit = identify(SPIN, Measurements(data.coordinate, data.channels, data.values))
    assert abs(fit.values[0] - 4.0) > 0.5


def test_wraps_and_gaps_together():
    fit = identify(SPIN, gappy(wrapped(angle(4.0, 0.5)), share=0.5))
    np.testing.assert_allclose(fit.values, [4.0, 0.5], rtol=1e-9)


def test_an_angle_that_hovers_at_half_a_turn_has_a_small_signal():
    """Its jumps by a turn are none of it, so that coarse noise cannot pass for small."""
    small = PythonModel(lambda size: np.pi + size * np.sin(9 * TIMES), {"size": (0.0, 0.1)}, ["angle"], TIMES)
    data = wrapped(np.pi + 1e-3 * np.sin(9 * TIMES), deviations=1e-4)
    floor = noise_floor(pose(small, data, None, Journal(41, None)))
    assert not floor.conclusive


def test_a_fit_with_gaps_and_wraps_comes_back_from_its_file(tmp_path):
    fit = identify(SPIN, gappy(wrapped(angle(4.0, 0.5))), starts=1)
    fit.save(tmp_path / "fit.nc")
    back = Fit.load(tmp_path / "fit.nc")
    assert (back.data.missing, back.data.wraps) == ("leave-out", ("angle",))
    assert back.data.fingerprint == fit.data.fingerprint
    assert back.residuals.tobytes() == fit.residuals.tobytes()
    assert back.summary() == fit.summary()


def test_the_report_draws_the_computed_angle_at_the_turn_of_the_measured_one(tmp_path):
    data = gappy(wrapped(angle(4.0, 0.5)))
    fit = identify(SPIN, data, starts=1)
    (computed,) = (np.asarray(trace.y) for trace in responses(fit).data if trace.name.endswith("computed"))
    there = data.present[:, 0]
    np.testing.assert_allclose(computed[there], data.values[there, 0], atol=1e-6)
    np.testing.assert_allclose(computed[~there], angle(4.0, 0.5)[~there], atol=1e-6)
    fit.report(tmp_path / "report.html")
    (row,) = by_name(fit.tables())["residuals"][0].rows
    assert row[1].value < 1e-8


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (
            Measurements.of(TIMES, {"x": np.full(41, np.nan)}, missing="leave-out"),
            "channel 'x': not one value is there; expected at least one; leave out the channel",
        ),
        (
            Measurements.of(TIMES, {"x": [np.inf, *TIMES[1:]]}, missing="leave-out"),
            "channel 'x', sample 0 (time 0 s): inf; expected a finite number (1 are not); "
            "leave out these samples or the channel",
        ),
    ],
)
def test_what_cannot_be_left_out_is_refused(data, sentence):
    with pytest.raises(DataError) as error:
        identify(DECAY, data)
    assert str(error.value) == sentence
