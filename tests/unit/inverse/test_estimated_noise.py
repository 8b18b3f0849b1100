"""Identification with noise that is estimated with the parameters."""

import numpy as np
import pytest

import dalembert as da
from correlated_noise import autoregressive, exponential

TIMES = np.linspace(0.0, 3.0, 61)
BOX = {"height": (0.2, 8.0), "rate": (0.05, 4.0)}
GAPS = [3, 4, 10, 25, 26, 27, 40]


def decay(times=TIMES, bounds=BOX, names=("x",)):
    def response(height, rate):
        return np.stack([(1 + k) * height * np.exp(-rate * times) for k in range(len(names))], axis=1)

    return da.PythonModel(response, bounds, list(names), times)


EXACT = 2.0 * np.exp(-0.8 * TIMES)


def measured(noise, **settings):
    return da.Measurements.of(TIMES, {"x": EXACT + noise}, **settings)


def normal(seed, scale=0.1):
    return scale * np.random.default_rng(seed).standard_normal(len(TIMES))


def fitted(data, noise, **settings):
    return da.identify(decay(), data, noise=noise, starts=1, horizon=None, **settings)


def test_one_unknown_deviation_is_the_plain_fit():
    data = measured(normal(1))
    plain, fit = fitted(data, None), fitted(data, da.ConstantNoise())
    assert fit.values == pytest.approx(plain.values, rel=1e-7)
    assert fit.deviations == pytest.approx(plain.deviations, rel=1e-6)
    assert fit.correlation == pytest.approx(plain.correlation, abs=1e-6)
    assert fit.intervals()["rate"] == pytest.approx(plain.intervals()["rate"], rel=1e-6)
    size = np.sqrt(plain.residual_variance)
    assert fit.noise.estimates == pytest.approx({"noise.x.deviation": size})
    assert fit.noise.deviations == pytest.approx([size / np.sqrt(2 * 59)], rel=1e-4)
    assert fit.weights == pytest.approx(size**-2)
    assert fit.misfit == pytest.approx(59)
    assert not fit.noise_is_known
    assert da.predict(decay(), fit).noise == pytest.approx([size])


@pytest.mark.parametrize(
    "noise",
    [
        da.MixedNoise(relative=0.0),
        da.AutoregressiveNoise(partial=(0.0,)),
        da.AutoregressiveNoise(order=0),
        da.OrnsteinUhlenbeckNoise(time=1e-6),
    ],
)
def test_noise_that_contains_the_plain_one_has_its_deviations(noise):
    data = measured(normal(2))
    plain, fit = fitted(data, None), fitted(data, noise)
    assert fit.values == pytest.approx(plain.values, rel=1e-7)
    assert fit.deviations == pytest.approx(plain.deviations, rel=1e-6)


def test_known_noise_has_the_deviations_of_the_data():
    data = measured(normal(3), deviations=0.1)
    plain, fit = fitted(data, None), fitted(data, "known")
    assert fit.deviations == pytest.approx(plain.deviations, rel=1e-7)
    assert fit.noise_is_known
    assert fit.noise.known
    assert fit.misfit == pytest.approx(plain.misfit)
    assert [item.code for item in fit.findings if item.code == "noise-estimated"] == ["noise-estimated"]
    assert "Noise, estimated" not in fit.summary()


def test_proportional_and_mixed_noise():
    for noise, model, truth in (
        (EXACT * normal(4, 0.05), da.ProportionalNoise(), {"noise.x.relative": 0.05}),
        (
            np.hypot(0.02, 0.05 * EXACT) * normal(4, 1.0),
            da.MixedNoise(),
            {"noise.x.deviation": 0.02, "noise.x.relative": 0.05},
        ),
    ):
        fit = fitted(measured(noise), model)
        assert fit.success
        apart = fit.noise.values - np.array(list(truth.values()))
        assert np.all(np.abs(apart) < 3 * fit.noise.deviations)
        assert np.all(np.abs(fit.values - [2.0, 0.8]) < 3 * fit.deviations)
        bands = da.predict(decay(), fit)
        estimates = fit.noise.estimates
        sizes = np.hypot(estimates.get("noise.x.deviation", 0.0), estimates["noise.x.relative"] * bands.response[:, 0])
        assert bands.noise_of_samples[:, 0] == pytest.approx(sizes)
        assert (bands.measured_upper - bands.response)[:, 0] == pytest.approx(
            bands.quantile * np.hypot(bands.deviations[:, 0], sizes)
        )


def test_the_order_is_chosen_and_gaps_are_allowed():
    noise = 0.1 * autoregressive(5, len(TIMES), 0.6)
    values = EXACT + noise
    values[GAPS] = np.nan
    data = da.Measurements.of(TIMES, {"x": values}, missing="leave-out")
    fit = fitted(data, "autoregressive")
    assert fit.noise.models == {"x": da.AutoregressiveNoise(order=1)}
    assert abs(fit.noise.estimates["noise.x.partial1"] - 0.6) < 3 * fit.noise.deviations[1]
    assert np.isnan(fit.noise.whitened[GAPS, 0]).all()
    assert fit.correlated is None
    assert not {"correlated-residuals", "noise-model-too-simple"} & {item.code for item in fit.findings}
    white = fitted(measured(normal(5)), "autoregressive")
    assert white.noise.models == {"x": da.AutoregressiveNoise(order=0)}


def test_uneven_samples_have_a_correlation_time():
    times = np.sort(np.random.default_rng(6).uniform(0.0, 3.0, 120))
    exact = 2.0 * np.exp(-0.8 * times)
    data = da.Measurements.of(times, {"x": exact + 0.1 * exponential(6, times, 0.06)})
    fit = da.identify(decay(times), data, noise="ornstein-uhlenbeck", starts=1)
    assert fit.noise.estimates["noise.x.time"] == pytest.approx(0.06, rel=0.7)
    plain = da.identify(decay(times), data, noise="constant", starts=1)
    assert np.all(fit.deviations > 1.3 * plain.deviations)
    assert "noise-model-too-simple" in {item.code for item in plain.findings}


def test_noise_that_lasts_as_long_as_the_motion_is_a_lack_of_the_model():
    swing = da.PythonModel(lambda height: height * np.cos(4 * TIMES), {"height": (0.1, 3.0)}, ["x"], TIMES)
    data = da.Measurements.of(TIMES, {"x": np.cos(4 * TIMES) + 0.3 * np.sin(4.5 * TIMES) + normal(7, 0.01)})
    fit = da.identify(swing, data, noise="ornstein-uhlenbeck", starts=1)
    assert "systematic-residuals" in {item.code for item in fit.findings}


def test_channels_have_different_noise():
    data = da.Measurements.of(TIMES, {"x": EXACT + normal(8), "y": 2 * EXACT * (1 + normal(9, 0.02))})
    model = decay(names=("x", "y"))
    fit = da.identify(model, data, noise={"y": da.ProportionalNoise()}, starts=1)
    assert set(fit.noise.estimates) == {"noise.x.deviation", "noise.y.relative"}
    assert fit.noise.estimates["noise.y.relative"] == pytest.approx(0.02, rel=0.3)
    together = da.identify(model, data, starts=1)
    assert np.all(fit.deviations < together.deviations)


def test_experiments_share_noise_or_have_local_noise():
    def run(name, seed, scale):
        return da.Experiment(name, decay(), measured(normal(seed, scale)), local=("height",))

    runs = [run("one", 10, 0.05), run("two", 11, 0.2)]
    shared = da.identify(runs, noise="constant", starts=1)
    local = da.identify(runs, noise=da.ConstantNoise(local=True), starts=1)
    assert set(shared.noise.estimates) == {"noise.x.deviation"}
    assert local.noise.estimates["noise.one.x.deviation"] == pytest.approx(0.05, rel=0.3)
    assert local.noise.estimates["noise.two.x.deviation"] == pytest.approx(0.2, rel=0.3)
    assert "noise.two.x.deviation" in local.summary()


def test_an_experiment_that_is_predicted_has_the_noise_of_the_others():
    runs = [da.Experiment(name, decay(), measured(normal(seed))) for name, seed in (("one", 10), ("two", 11))]
    fit = da.identify(runs, noise="constant", validation="two", starts=1)
    assert np.isnan(fit.noise.whitened[:, 1]).all()
    assert 0.8 < fit.validation.covered <= 1.0


def test_held_out_samples_are_not_part_of_the_noise():
    fit = fitted(measured(normal(13)), da.MixedNoise(), validation=0.25)
    assert np.isnan(fit.noise.whitened[46:]).all()
    assert np.all(fit.weights[46:] == 0)
    assert 0.8 < fit.validation.covered <= 1.0


def test_wrapping_channels():
    data = da.Measurements.of(TIMES, {"x": EXACT + normal(14) + 2 * np.pi}, wraps=["x"])
    fit, plain = fitted(data, "constant"), fitted(measured(normal(14)), None)
    assert fit.values == pytest.approx(plain.values, rel=1e-6)


def test_priors_need_no_deviations_of_the_data():
    bounds = {"height": da.Parameter("height", 0.2, 8.0, start=2.1, deviation=0.05), "rate": BOX["rate"]}
    fit = da.identify(decay(bounds=bounds), measured(normal(15)), noise="constant", starts=1)
    plain = fitted(measured(normal(15)), None)
    assert fit.deviations[0] < plain.deviations[0]
    narrow = {**bounds, "height": da.Parameter("height", 0.2, 8.0, start=2.1, deviation=1e-6)}
    pinned = da.identify(decay(bounds=narrow), measured(normal(15)), noise="constant", starts=1)
    assert pinned.values[0] == pytest.approx(2.1, abs=1e-5)


def test_the_file_keeps_the_noise(tmp_path):
    noise = {"x": da.AutoregressiveNoise(order=1, deviation=da.MixedNoise(relative=(1e-6, 1.0)))}
    fit = fitted(measured(0.1 * autoregressive(16, 61, 0.6)), noise)
    fit.save(tmp_path / "fit.nc")
    again = da.Fit.load(tmp_path / "fit.nc")
    assert again.noise.models == fit.noise.models == noise
    assert again.noise.estimates == fit.noise.estimates
    assert np.array_equal(again.noise.whitened, fit.noise.whitened, equal_nan=True)
    assert again.summary() == fit.summary()
    assert again.noise.log_likelihood == fit.noise.log_likelihood
    bands = da.predict(decay(), again)
    bands.save(tmp_path / "bands.nc")
    assert np.array_equal(da.Prediction.load(tmp_path / "bands.nc").noise_of_samples, bands.noise_of_samples)


def test_the_noise_of_a_fit_describes_a_likelihood():
    data = measured(0.1 * autoregressive(17, 61, 0.6))
    fit = fitted(data, "autoregressive")
    found = da.likelihood(decay(), data, noise=fit.noise.models)
    vector = np.concatenate([fit.values, fit.noise.values])
    assert found.evaluate(vector) == pytest.approx([fit.noise.log_likelihood], rel=1e-9)
    assert found.whitened(vector) == pytest.approx(fit.noise.whitened[:, 0], rel=1e-6)


def test_profiles_estimate_the_noise_again():
    line = da.PythonModel(
        lambda level, slope: level + slope * TIMES, {"level": (-5, 5), "slope": (-5, 5)}, ["x"], TIMES
    )
    data = da.Measurements.of(TIMES, {"x": 1 + 0.5 * TIMES + normal(18)})
    fit = da.identify(line, data, noise="constant", starts=1)
    told = da.profile(line, data, fit, names=["slope"])
    assert told.intervals["slope"] == pytest.approx(fit.intervals()["slope"], rel=1e-6)
    known = da.identify(line, data, noise=da.ConstantNoise(deviation=0.1), starts=1)
    told = da.profile(line, data, known, names=["slope"])
    assert told.intervals["slope"] == pytest.approx(known.intervals()["slope"], rel=1e-6)


def test_the_noise_at_a_bound_is_a_finding():
    fit = fitted(measured(normal(19)), da.ConstantNoise(deviation=(0.5, 1.0)))
    found = next(item for item in fit.findings if item.code == "noise-parameter-at-bound")
    assert found.values == {"parameter": "noise.x.deviation", "side": "lower", "bound": 0.5}


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        (
            {"weights": [0.5]},
            "weights: 0.5 was given beside a noise model, from which the weights follow; expected 1, or 0 for a value to leave out",
        ),
        (
            {"loss": "huber", "loss_scale": 1.0},
            "loss: a noise model was given, whose likelihood is that of normal noise; leave the loss 'huber' or the noise out",
        ),
        (
            {"shooting": da.MultipleShooting()},
            "shooting: a noise model was given, but segments that must meet leave no likelihood of one run; leave one of the two out",
        ),
    ],
)
def test_what_cannot_be_combined_is_refused(settings, message):
    with pytest.raises(da.InputError) as refused:
        da.identify(decay(), measured(normal(20)), noise="constant", **settings)
    assert str(refused.value) == message


def test_noise_in_proportion_to_zero_is_refused():
    line = da.PythonModel(lambda slope: slope * TIMES, {"slope": (0.1, 3.0)}, ["x"], TIMES)
    with pytest.raises(da.InputError) as refused:
        da.identify(line, da.Measurements.of(TIMES, {"x": TIMES + normal(21)}), noise="proportional")
    assert str(refused.value) == (
        "noise of channel 'x': ProportionalNoise was given, but the response is 0 at 0 s, where it allows no noise; "
        "take MixedNoise()"
    )


def test_a_model_without_sensitivities_is_refused():
    def response(height):
        return np.abs(complex(height).real) * EXACT

    model = da.PythonModel(response, {"height": (0.1, 3.0)}, ["x"], TIMES)
    with pytest.raises(da.DalembertError):
        da.identify(model, measured(normal(22)), noise="constant", method="Nelder-Mead")


@pytest.mark.parametrize("noise", ["autoregressive", "ornstein-uhlenbeck", "mixed"])
def test_exact_data_leave_noise_at_its_bounds(noise):
    times = np.linspace(0.0, 5.0, 30)
    line = da.PythonModel(lambda a, b: a + b * times, {"a": (-20.0, 20.0), "b": (-20.0, 20.0)}, ["x"], times)
    fit = da.identify(line, da.Measurements.of(times, {"x": 2 + times}), noise=noise)
    np.testing.assert_allclose(fit.values, [2.0, 1.0], atol=1e-9)


def test_a_combination_that_the_data_do_not_determine_is_found_beside_noise():
    times = np.linspace(0.0, 5.0, 60)
    noise = 0.1 * np.random.default_rng(23).standard_normal(60)
    both = da.PythonModel(lambda a, b: (a + b) * times, {"a": (-20.0, 20.0), "b": (-20.0, 20.0)}, ["x"], times)
    fit = da.identify(both, da.Measurements.of(times, {"x": 2 * times + noise}), noise="autoregressive")
    assert np.sum(fit.values) == pytest.approx(2.0, abs=0.05)


@pytest.mark.parametrize("noise", ["constant", "proportional", "mixed"])
def test_as_many_values_as_parameters_leave_no_noise_to_estimate(noise):
    times = np.array([0.0, 1.0])
    model = da.PythonModel(lambda a, b: a + b * times, {"a": (-9.0, 9.0), "b": (-9.0, 9.0)}, ["x"], times)
    fit = da.identify(model, da.Measurements.of(times, {"x": [1.0, 2.5]}), noise=noise, starts=1)
    assert np.all(np.isnan(fit.deviations))
    assert "too-few-data" in {finding.code for finding in fit.doubts}


def test_a_value_with_all_of_the_misfit_changes_no_parameter_by_infinity():
    times = np.linspace(0, 2, 41)
    model = da.PythonModel(lambda a: a * (times - 1.03), {"a": (0.1, 9.0)}, ["x"], times)
    values = 2 * (times - 1.03) * (1 + 0.1 * np.random.default_rng(0).standard_normal(41))
    values[20] = 3.0  # where the response is nearly zero, and with it the noise
    fit = da.identify(model, da.Measurements.of(times, {"x": values}), noise="proportional", starts=1)
    finding = next(one for one in fit.conclusions if one.code == "influential-sample")
    assert finding.message.endswith("decides the fit (Cook's distance 1.06).")
    assert not any("e+308" in str(one) for one in fit.conclusions)


def test_the_noise_of_a_fit_is_a_noise_model():
    data = measured(0.1 * autoregressive(3, 61, 0.6))
    open_order = da.identify(decay(), data, noise="autoregressive", starts=1)
    again = da.identify(decay(), data, noise=open_order.noise, starts=1)
    np.testing.assert_allclose(again.noise.values, open_order.noise.values, rtol=1e-4)
    likely = da.inverse.likelihood(decay(), data, noise=open_order.noise)
    assert likely.noise_parameters.names == open_order.noise.parameters.names


def test_fewer_values_than_parameters_are_refused():
    line = da.PythonModel(lambda a, b: a + b * np.ones(1), {"a": (-9.0, 9.0), "b": (-9.0, 9.0)}, ["x"], np.ones(1))
    with pytest.raises(
        da.InputError, match="1 value cannot determine 2 parameters and the noise; measure more samples"
    ):
        da.identify(line, da.Measurements.of(np.ones(1), {"x": [1.0]}), noise="constant")
