"""Mean and spread of specimens against closed forms, a published meta-analysis, and known truth."""

import numpy as np
import pytest

import dalembert as da
from dalembert.inverse.specimens.estimate_population import Estimates, estimated

TOPIC = "Several specimens"
TRIALS = np.array(
    [
        [4, 119, 11, 128], [6, 300, 29, 274], [3, 228, 11, 209], [62, 13536, 248, 12619], [33, 5036, 47, 5761],
        [180, 1361, 372, 1079], [8, 2537, 10, 619], [505, 87886, 499, 87892], [29, 7470, 45, 7232],
        [17, 1699, 65, 1600], [186, 50448, 141, 27197], [5, 2493, 3, 2338], [27, 16886, 29, 17825],
    ],
    dtype=float,
)  # fmt: skip
"""Positive and negative cases, with and without a vaccine, in 13 trials: Colditz et al. (1994)."""
PUBLISHED = "Colditz et al. (1994); Viechtbauer, Conducting meta-analyses in R with the metafor package (2010)"


def independent(values, deviations):
    values = np.asarray(values, dtype=float).reshape(len(values), -1)
    variances = np.broadcast_to(np.square(deviations), values.shape).ravel()
    names = tuple(f"p{k}" for k in range(values.shape[1]))
    return Estimates(names, ("",) * len(names), tuple(map(str, range(len(values)))), values, np.diag(variances))


def test_a_published_meta_analysis(record_evidence):
    positive, negative, without_positive, without_negative = TRIALS.T
    with_all, without_all = positive + negative, without_positive + without_negative
    ratios = np.log(positive / with_all / (without_positive / without_all))
    variances = 1 / positive - 1 / with_all + 1 / without_positive - 1 / without_all
    found = estimated(independent(ratios, np.sqrt(variances)[:, None]))
    for quantity, reference, ours in (
        ("mean", -0.7145, found.mean[0]),
        ("standard deviation of the mean", 0.1798, found.mean_deviations[0]),
        ("square of the spread", 0.3132, found.spread[0] ** 2),
    ):
        record_evidence(
            f"logarithms of risk ratios of 13 trials: {quantity}", reference, ours, tolerance=6e-5, topic=TOPIC,
            kind="published", source=PUBLISHED,
        )  # fmt: skip
    record_evidence(
        "logarithms of risk ratios of 13 trials: Cochran's Q", 152.2330, found.heterogeneity[0], tolerance=6e-5,
        topic=TOPIC, kind="published", source=PUBLISHED,
    )  # fmt: skip
    assert found.p_value[0] < 1e-10


RAILS = np.array(
    [[55, 53, 54], [26, 37, 32], [78, 91, 85], [92, 100, 96], [49, 51, 50], [80, 85, 83]], dtype=float
)  # fmt: skip
"""Three travel times of an ultrasonic wave in each of six rails, in ns above 36,100 ns."""
MIXED = "Pinheiro and Bates, Mixed-effects models in S and S-PLUS (2000), data of rails, restricted likelihood"


def test_published_mixed_effects_of_rails(record_evidence):
    """Repetitions on each specimen, all as exact as their pooled deviation says."""
    within = np.sqrt(np.sum((RAILS - RAILS.mean(axis=1, keepdims=True)) ** 2) / 12)
    found = estimated(independent(RAILS.mean(axis=1), within / np.sqrt(3)))
    for quantity, reference, ours, tolerance in (
        ("deviation within a rail", 4.020779, within, 1e-6),
        ("mean", 66.5, found.mean[0], 1e-6),
        ("standard deviation of the mean", 10.17104, found.mean_deviations[0], 1e-4),
        ("spread between rails", 24.80547, found.spread[0], 1e-4),
    ):
        record_evidence(
            f"travel times in six rails: {quantity}", reference, ours, tolerance=tolerance, topic=TOPIC,
            kind="published", source=MIXED, unit="ns",
        )  # fmt: skip


@pytest.mark.slow
def test_statsmodels_estimates_the_same_spread(record_evidence):
    """Specimens with unequal numbers of repetitions; the deviation of one of them is that of statsmodels."""
    mixed = pytest.importorskip("statsmodels.regression.mixed_linear_model")
    random = np.random.default_rng(11)
    counts = np.array([3, 12, 4, 7, 5, 9, 3, 6, 10, 4])
    groups = np.repeat(np.arange(len(counts)), counts)
    times = 20 + 2 * random.standard_normal(len(counts))[groups] + 3 * random.standard_normal(len(groups))
    theirs = mixed.MixedLM(times, np.ones((len(times), 1)), groups).fit(reml=True)
    means = np.array([times[groups == number].mean() for number in range(len(counts))])
    found = estimated(independent(means, np.sqrt(theirs.scale / counts)[:, None]))
    for quantity, reference, ours in (
        ("mean", theirs.fe_params[0], found.mean[0]),
        ("standard deviation of the mean", theirs.bse_fe[0], found.mean_deviations[0]),
        ("spread", np.sqrt(theirs.cov_re[0, 0]), found.spread[0]),
    ):
        record_evidence(
            f"ten specimens with 3 to 12 repetitions: {quantity}", reference, ours, tolerance=1e-3, topic=TOPIC,
            kind="other code", source="statsmodels, MixedLM by restricted maximum likelihood",
        )  # fmt: skip


def test_equally_exact_specimens_have_the_covariance_of_their_values_less_that_of_their_fits(record_evidence):
    mixing = np.array([[1.0, 0.0, 0.0], [0.5, 1.0, 0.0], [-0.2, 0.3, 0.7]])
    values = np.random.default_rng(3).standard_normal((12, 3)) @ mixing.T
    found = estimated(independent(values, 0.1), correlated=True)
    expected = np.cov(values.T) - 0.01 * np.eye(3)
    source = "balanced one-way layout: Ω = S − C, covariance of the mean S/m"
    record_evidence(
        "12 equally exact specimens, spreads and correlations", expected,
        found.correlation * np.outer(found.spread, found.spread), tolerance=1e-6, relative=True, topic=TOPIC,
        kind="closed form", source=source,
    )  # fmt: skip
    record_evidence(
        "12 equally exact specimens, deviations of the means", np.sqrt(np.diag(np.cov(values.T)) / 12),
        found.mean_deviations, tolerance=1e-6, relative=True, topic=TOPIC, kind="closed form", source=source,
    )  # fmt: skip
    np.testing.assert_allclose(found.mean, values.mean(axis=0), rtol=1e-9)


@pytest.mark.slow
def test_95_percent_intervals_hold_mean_spread_and_new_specimen(record_evidence):
    """500 repetitions of 8 specimens of unequal exactness."""
    repetitions, spread, deviations = 500, 0.4, np.linspace(0.1, 0.5, 8)
    hits = np.zeros(3)
    for seed in range(repetitions):
        draws = np.random.default_rng(seed).standard_normal((2, 9))
        true = 2.0 + spread * draws[0]
        found = estimated(independent(true[:8] + deviations * draws[1, :8], deviations[:, None]))
        (low, high), (lowest, highest) = found.intervals["p0"], found.prediction["p0"]
        hits += [
            low <= 2.0 <= high,
            found.spread_lower[0] <= spread <= found.spread_upper[0],
            lowest <= true[8] <= highest,
        ]
    for quantity, share in zip(("mean", "spread", "value of a new specimen"), hits / repetitions, strict=True):
        record_evidence(
            f"coverage of 95 % intervals, 8 specimens: {quantity}", 0.95, share, tolerance=0.03, topic=TOPIC,
            kind="known truth", source="the definition of a confidence interval, 500 repetitions",
        )  # fmt: skip


def _model(times):
    return da.PythonModel(
        lambda rate, height: height * np.exp(-rate * times), {"rate": (0.1, 3.0), "height": (0.5, 2.0)}, ["x"], times
    )


def _data(times, rates):
    random = np.random.default_rng(7)
    return {
        f"part{number}": da.Measurements.of(
            times, {"x": np.exp(-rate * times) + 0.005 * random.standard_normal(len(times))}, deviations=0.005
        )
        for number, rate in enumerate(rates)
    }


def test_separate_fits_and_one_fit_with_local_parameters_agree():
    times = np.linspace(0.0, 2.0, 41)
    rates = 1.0 + 0.1 * np.random.default_rng(5).standard_normal(7)
    data = _data(times, rates)
    fits = {name: da.identify(_model(times), one, starts=1) for name, one in data.items()}
    separate = da.population(fits)
    own = [da.Experiment(name, _model(times), one, ("rate", "height")) for name, one in data.items()]
    joint = da.population(da.identify(own, starts=1))
    assert joint.names == separate.names == ("rate", "height")
    assert joint.specimens == separate.specimens
    for name in ("mean", "mean_deviations", "adjusted", "spread", "spread_upper"):
        np.testing.assert_allclose(getattr(joint, name), getattr(separate, name), rtol=2e-3, atol=1e-5)
    assert separate.spread_lower[0] < 0.1 < separate.spread_upper[0]
    assert separate.spread_lower[1] == 0
    assert [found.code for found in separate.findings] == ["no-spread-seen"]
    assert np.all(np.abs(separate.adjusted[:, 0] - rates) < 4 * separate.adjusted_deviations[:, 0])


@pytest.mark.parametrize("level", [0.5, 0.95])
def test_a_population_is_stored(tmp_path, level):
    values = np.random.default_rng(1).standard_normal((5, 2))
    found = estimated(independent(values, 0.1), level=level)
    found.save(tmp_path / "population.nc")
    again = da.Population.load(tmp_path / "population.nc")
    assert again.summary() == found.summary()
    np.testing.assert_array_equal(again.adjusted, found.adjusted)
