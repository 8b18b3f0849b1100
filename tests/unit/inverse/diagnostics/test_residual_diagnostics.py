"""What residual diagnostics find in noise with one known fault, and that they find nothing in white noise."""

from dataclasses import replace

import numpy as np
import pytest
from inline_snapshot import snapshot

import dalembert as da
from correlated_noise import autoregressive
from dalembert.data import Measurements
from dalembert.forward import PythonModel
from dalembert.inverse import Experiment, Fit, identify
from dalembert.optimize import ParticleSwarm

TIMES = np.linspace(0, 2, 201)
LINE = PythonModel(lambda a, b: a + b * TIMES, {"a": (-5.0, 5.0), "b": (-5.0, 5.0)}, ["x"], TIMES)
SIZE = 0.1


def noise(seed, number=201):
    return SIZE * np.random.default_rng(seed).standard_normal(number)


def fitted(errors, model=LINE, **options):
    data = Measurements.of(model.coordinate, {"x": 1 + 2 * model.coordinate.values + errors}, missing="leave-out")
    return identify(model, data, starts=1, horizon=None, **options)


def linear_fits(fit, errors):
    """The fit of a linear model with other noise, repeatedly, without a search."""
    slopes = fit.jacobian[:, 0]
    for own in errors:
        values = np.array([1 + 2 * TIMES + own]).T
        found = np.linalg.lstsq(slopes, values[:, 0], rcond=None)[0]
        response = (slopes @ found)[:, None]
        data = replace(fit.data, values=values)
        yield replace(fit, data=data, values=found, response=response, misfit=float(np.sum((response - values) ** 2)))


def codes(found):
    return [item.code for item in found.findings]


def test_white_noise_is_rarely_taken_for_something_else():
    fit = fitted(noise(0))
    errors = SIZE * np.random.default_rng(1).standard_normal((400, 201))
    tried = [item.diagnostics() for item in linear_fits(fit, errors)]
    alarms = sum(bool(codes(found)) for found in tried)
    assert alarms <= 7  # 2 of 400 are expected
    for test in ("runs", "normality", "period", "size over response", "size over coordinate"):
        small = np.mean([found.series[0].p_values[test] < 0.05 for found in tried])
        assert 0.015 < small < 0.09, test


def test_an_outlier_is_named_with_its_time_and_its_effect():
    errors = noise(0)
    errors[140] += 1.0
    fit = fitted(errors)
    (outlier,) = fit.diagnostics().outliers
    assert (outlier.channel, outlier.experiment, outlier.unit) == ("x", "", "s")
    assert outlier.at == pytest.approx(1.4)
    assert outlier.size < -8  # computed minus measured
    weights = np.ones((201, 1))
    weights[140] = 0
    without = identify(LINE, fit.data, weights=weights, starts=1, horizon=None)
    moved = (fit.values - without.values) / without.deviations
    assert outlier.parameter == "b"
    assert outlier.change == pytest.approx(moved[1], rel=0.01)
    assert str(next(item for item in fit.findings if item.code == "outlying-samples")) == snapshot(
        "1 sample is an outlier: 'x' at 1.4 s (11 standard deviations). Without the largest, 'b' changes by 0.52 standard deviations. Check these samples. Leave out wrong ones, or use a robust loss such as 'huber'."
    )


def test_a_robust_fit_notes_its_outliers():
    errors = noise(0)
    errors[[20, 140]] += 1.0
    found = fitted(errors, loss="huber", loss_scale=0.15).diagnostics()
    assert sorted(round(item.at, 2) for item in found.outliers) == [0.2, 1.4]
    assert [(item.code, item.severity) for item in found.findings] == [("outlying-samples", "note")]


@pytest.mark.parametrize(
    ("errors", "code"),
    [
        (noise(3) * (0.2 + TIMES), "unequal-variance"),
        (noise(4) + 0.1 * np.sin(2 * np.pi * 7.3 * TIMES), "periodic-residuals"),
        (0.15 * (np.random.default_rng(5).exponential(size=201) - 1), "non-normal-residuals"),
    ],
    ids=["variance", "hum", "skewed"],
)
def test_a_fault_of_the_noise_is_found(errors, code):
    assert code in codes(fitted(errors).diagnostics())


def test_noise_that_grows_with_the_response_has_a_proposal_that_cures_it():
    plain = fitted(noise(3) * (1 + 2 * TIMES))
    (finding,) = (item for item in plain.findings if item.code == "unequal-variance")
    assert finding.values["noise"] == "mixed"
    assert 'noise="mixed"' in finding.advice
    assert 'noise = "mixed"' in finding.advice
    cured = identify(LINE, plain.data, starts=1, horizon=None, noise=finding.values["noise"])
    assert "unequal-variance" not in codes(cured.diagnostics())


def test_noise_that_shrinks_with_the_response_has_no_proposed_model():
    plain = fitted(noise(3) * (2.2 - TIMES))
    (finding,) = (item for item in plain.findings if item.code == "unequal-variance")
    assert finding.values["correlation"] < 0
    assert "noise" not in finding.values


def test_the_period_of_a_hum_is_that_of_the_finding():
    found = fitted(noise(4) + 0.1 * np.sin(2 * np.pi * 7.3 * TIMES)).diagnostics()
    (finding,) = (item for item in found.findings if item.code == "periodic-residuals")
    assert finding.values["period"] == pytest.approx(1 / 7.3, rel=0.05)
    assert str(finding) == snapshot(
        "The residuals of 'x' have a periodic part: 25 % of their power has the period 0.133 s. Look for its source, such as mains voltage, a motor, or a mode that the model lacks."
    )


@pytest.mark.parametrize(("share", "reported"), [(0.005, False), (0.02, True)])
def test_a_periodic_part_is_reported_from_a_hundredth_of_the_power(share, reported):
    """A sine of amplitude a has the power a² / 2; of 10,001 samples, a part of 0.005 is significant."""
    times = np.linspace(0, 2, 10001)
    model = PythonModel(lambda a, b: a + b * times, {"a": (-5.0, 5.0), "b": (-5.0, 5.0)}, ["x"], times)
    amplitude = SIZE * np.sqrt(2 * share / (1 - share))
    found = fitted(noise(4, 10001) + amplitude * np.sin(2 * np.pi * 50 * times), model).diagnostics()
    assert found.series[0].p_values["period"] < 1e-5
    items = [item for item in found.findings if item.code == "periodic-residuals"]
    assert bool(items) is reported
    assert [item.values["share"] for item in items] == pytest.approx([share] * reported, rel=0.2)


def test_heavy_tails_that_hide_a_drift_have_few_runs():
    rng = np.random.default_rng(8)
    errors = 0.04 * rng.standard_cauchy(201).clip(-40, 40) + 0.06 * np.sign(np.sin(9 * TIMES))
    assert "runs-of-signs" in codes(fitted(errors).diagnostics())


def test_a_sample_that_decides_the_fit_is_named():
    times = np.concatenate([np.linspace(0, 0.1, 30), [2.0]])
    model = PythonModel(lambda a, b: a + b * times, {"a": (-5.0, 5.0), "b": (-5.0, 5.0)}, ["x"], times)
    found = fitted(noise(1, 31), model).diagnostics()
    (finding,) = (item for item in found.findings if item.code == "influential-sample")
    assert finding.values["at"] == 2.0
    assert finding.values["leverage"] == pytest.approx(0.99, abs=0.02)
    assert str(finding) == snapshot(
        "The sample of 'x' at 2 s decides the fit (Cook's distance 188): without it 'b' changes by 20 standard deviations. Check this sample for a mistake, and measure more samples under similar conditions."
    )


def test_missing_values_uneven_samples_and_wrapping_channels():
    times = np.sort(np.random.default_rng(2).uniform(0, 6, 150))
    model = PythonModel(lambda w: w * times, {"w": (0.5, 3.0)}, [da.Channel("angle", "rad")], times)
    angle = (2 * times + 0.05 * np.random.default_rng(3).standard_normal(150) + np.pi) % (2 * np.pi) - np.pi
    angle[[10, 50, 51]] = np.nan
    angle[90] += 0.6
    data = Measurements.of(times, {"angle": angle}, wraps=["angle"], missing="leave-out")
    found = identify(model, data, start=[2.0], starts=1, horizon=None).diagnostics()
    (series,) = found.series
    assert len(series.residuals) == 147
    assert np.max(np.abs(series.residuals)) < 1
    assert [item.at for item in found.outliers] == [times[90]]
    assert "period" not in series.p_values  # the samples are uneven
    lags, correlations, limits = series.autocorrelation()
    assert lags[0] == pytest.approx(np.median(np.diff(times[np.isfinite(angle)])))
    assert np.mean(np.abs(correlations) < limits) > 0.8
    frequencies, power = series.spectrum()
    assert np.mean(power) == pytest.approx(1)
    assert len(frequencies) == 73


def test_each_channel_of_each_experiment_is_judged_by_its_own_noise():
    experiments = []
    for seed, (name, size) in enumerate({"quiet": 0.01, "loud": 1.0}.items()):
        errors = size * np.random.default_rng(seed).standard_normal(201)
        errors[60] += 10 * size
        experiments.append(Experiment(name, LINE, Measurements.of(TIMES, {"x": 1 + 2 * TIMES + errors}, size)))
    found = identify(experiments, starts=1, horizon=None).diagnostics()
    assert [one.name for one in found.series] == ["quiet.x", "loud.x"]
    assert {(item.experiment, item.channel, round(item.at, 2)) for item in found.outliers} == {
        ("quiet", "x", 0.6),
        ("loud", "x", 0.6),
    }


def test_known_deviations_priors_and_bounds():
    parameters = {"a": da.Parameter("a", -5.0, 5.0, start=1.0, deviation=0.01), "b": da.Parameter("b", -5.0, 1.9)}
    model = PythonModel(lambda a, b: a + b * TIMES, parameters, ["x"], TIMES)
    data = Measurements.of(TIMES, {"x": 1 + 2 * TIMES + noise(0)}, deviations=SIZE)
    fit = identify(model, data, starts=1, horizon=None)
    (series,) = fit.diagnostics().series
    expected = (1 / SIZE**2) / (201 / SIZE**2 + 1 / 0.01**2)  # b is on its bound
    np.testing.assert_allclose(series.leverage, expected, rtol=1e-6)
    np.testing.assert_array_equal(series.changes[:, 1], 0.0)


def test_held_out_samples_do_not_count():
    fit = fitted(noise(0), validation=0.25)
    (series,) = fit.diagnostics().series
    assert len(series.residuals) == 151
    assert fit.jacobian.shape == (201, 1, 2)
    assert np.all(np.isfinite(fit.jacobian))
    assert np.sum(series.leverage) == pytest.approx(2)


def test_exact_data_and_fits_that_did_not_converge_are_not_tested():
    assert not fitted(np.zeros(201)).diagnostics().tested
    assert not replace(fitted(noise(0)), success=False).diagnostics().tested


def test_a_fit_without_a_jacobian_has_tests_but_no_leverages():
    model = PythonModel(lambda a: float(np.real(a)) * TIMES, {"a": (0.0, 4.0)}, ["x"], TIMES)
    data = Measurements.of(TIMES, {"x": 2 * TIMES + noise(0)})
    fit = identify(model, data, method=ParticleSwarm(10, 20), polish=False)
    found = replace(fit, success=True).diagnostics()
    assert fit.jacobian is None
    assert np.all(np.isnan(found.series[0].leverage))
    assert found.series[0].p_values["normality"] > 0.01


def test_correlated_residuals_that_grow_have_a_finding():
    """Noise that shrinks with a decay leaves few values that count: tests take it for correlated more often."""
    model = PythonModel(
        lambda height, rate: height * np.exp(-rate * TIMES), {"height": (0.2, 8.0), "rate": (0.05, 4.0)}, ["x"], TIMES
    )
    exact = 2 * np.exp(-0.8 * TIMES)
    shrinking = exact * (1 + 0.1 * autoregressive(4, len(TIMES), 0.5))
    found = identify(model, Measurements.of(TIMES, {"x": shrinking}), starts=1).diagnostics()
    assert found.series[0].correlated
    (finding,) = (item for item in found.findings if item.code == "unequal-variance")
    assert finding.values["noise"] == "mixed"


def test_correlated_residuals_are_not_tested_for_what_needs_independence():
    slow = np.convolve(noise(0, 221), np.ones(21) / 5, mode="valid")
    found = fitted(slow).diagnostics()
    assert found.series[0].correlated
    assert list(found.series[0].p_values) == ["autocorrelation", "period", "size over response", "size over coordinate"]


def test_a_file_gives_back_the_diagnostics(tmp_path):
    errors = noise(0)
    errors[140] += 1.0
    fit = fitted(errors)
    fit.save(tmp_path / "fit.nc")
    loaded = Fit.load(tmp_path / "fit.nc")
    assert loaded.diagnostics().outliers == fit.diagnostics().outliers
    assert str(loaded.diagnostics()) == str(fit.diagnostics())


def test_nothing_found_is_said():
    assert str(fitted(noise(2)).diagnostics()) == snapshot(
        "The tests find nothing against independent normal residuals."
    )


PLANE = PythonModel(
    lambda a, b: np.stack([a + b * TIMES, a - b * TIMES], axis=1),
    {"a": (-5.0, 5.0), "b": (-5.0, 5.0)},
    ["x", "y"],
    TIMES,
)
TWICE = PythonModel(
    lambda a, b: np.stack(2 * [a + b * TIMES], axis=1), {"a": (-5.0, 5.0), "b": (-5.0, 5.0)}, ["x", "y"], TIMES
)


def fitted_pair(x, y, model=TWICE, **options):
    exact = model.function(1.0, 2.0)
    data = Measurements.of(TIMES, {"x": exact[:, 0] + x, "y": exact[:, 1] + y})
    return identify(model, data, starts=1, horizon=None, **options)


def of_code(fit, code):
    return [item for item in fit.findings if item.code == code]


@pytest.mark.parametrize("estimated", [None, "constant"])
def test_a_channel_that_is_there_twice_is_found(estimated):
    one = fitted_pair(noise(1), noise(1), noise=estimated)
    (finding,) = of_code(one, "correlated-channels")
    assert finding.severity == "warning"
    assert finding.values["correlation"] == pytest.approx(1.0)
    assert finding.values["largest_factor"] == pytest.approx(np.sqrt(2))
    single = fitted(noise(1))
    assert one.deviations * np.sqrt(2) == pytest.approx(single.deviations, rel=5e-3)  # of 400 and of 199 freedoms
    assert str(finding) == snapshot(
        "The residuals of 'x' and 'y' are correlated with each other (correlation 1.00). The standard deviations are those for independent channels. With this correlation they are 1.4 times as large. If a channel is a copy of another, or is calculated from it, leave it out. If they share their noise, multiply the standard deviations by this factor."
    )


def test_channels_that_share_noise_have_the_deviations_of_their_covariance():
    shared = noise(3)
    fit = fitted_pair(shared + 0.5 * noise(4), shared + 0.5 * noise(5), PLANE)
    (finding,) = of_code(fit, "correlated-channels")
    assert finding.values["correlation"] == pytest.approx(0.8, abs=0.05)
    size = finding.values["correlation"]  # the sum of the channels determines a, their difference b
    expected = np.sqrt([1 - size, 1 + size])
    assert [finding.values["smallest_factor"], finding.values["largest_factor"]] == pytest.approx(expected, rel=0.1)


def test_correlation_that_changes_no_deviation_is_a_note():
    apart = PythonModel(
        lambda a, b: np.stack([a + TIMES, b - TIMES], axis=1), {"a": (-5.0, 5.0), "b": (-5.0, 5.0)}, ["x", "y"], TIMES
    )
    shared = noise(6)
    (finding,) = of_code(fitted_pair(shared + noise(7), shared + noise(8), apart), "correlated-channels")
    assert finding.severity == "note"
    assert not finding.advice
    assert finding.values["largest_factor"] == pytest.approx(1.0)


def test_independent_channels_are_rarely_taken_for_correlated():
    fit = fitted_pair(noise(9), noise(10), PLANE)
    slopes = fit.jacobian.reshape(-1, 2)
    alarms = 0
    for errors in SIZE * np.random.default_rng(11).standard_normal((400, 201, 2)):
        values = PLANE.function(1.0, 2.0) + errors
        found = np.linalg.lstsq(slopes, values.ravel(), rcond=None)[0]
        response = (slopes @ found).reshape(-1, 2)
        other = replace(fit, data=replace(fit.data, values=values), values=found, response=response,
                        misfit=float(np.sum((response - values) ** 2)))  # fmt: skip
        alarms += "correlated-channels" in codes(other.diagnostics())
    assert alarms <= 4  # 0.4 of 400 are expected


def test_a_lack_of_the_model_is_no_correlation_of_channels():
    wave = 0.5 * np.sin(3 * TIMES)
    fit = fitted_pair(wave + noise(12), wave + noise(13))
    assert of_code(fit, "systematic-residuals")
    assert not of_code(fit, "correlated-channels")
