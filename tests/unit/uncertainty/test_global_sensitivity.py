"""Sobol indices of models: sums over samples, what is refused, and the report."""

import numpy as np
import pytest
from inline_snapshot import snapshot

import dalembert as da
from dalembert.surrogate import Adaptive, Tensor

TIMES = np.linspace(0.0, 2.0, 9)
BOX = {"gain": (0.5, 1.5), "rate": (0.5, 2.0), "idle": (0.0, 1.0)}
MODEL = da.PythonModel(
    lambda gain, rate, idle: np.stack([gain * np.exp(-rate * TIMES), gain * TIMES + 0 * idle], axis=1),
    dict.fromkeys(BOX, (0.0, 3.0)),
    ["x", "y"],
    TIMES,
)


@pytest.fixture(scope="module")
def found():
    return da.global_sensitivity(MODEL, BOX, Adaptive(1e-6))


def test_indices_over_time_and_of_whole_channels(found):
    np.testing.assert_allclose(found.first[0, 0], [1.0, 0.0, 0.0], atol=1e-9)  # at first only the gain acts
    assert np.isnan(found.first[0, 1]).all()  # at first y is 0
    np.testing.assert_allclose(found.aggregated_first[1], [1.0, 0.0, 0.0], atol=1e-9)
    variances = found.deviations[:, 0] ** 2
    np.testing.assert_allclose(found.aggregated_total[0], variances @ found.total[:, 0] / variances.sum(), rtol=1e-9)
    assert np.all(found.aggregated_total[0] >= found.aggregated_first[0] - 1e-12)
    assert found.aggregated_total[0, 2] == pytest.approx(0.0, abs=1e-9)


def test_samples_without_a_variance_are_named(found):
    (finding,) = (item for item in found.findings if item.code == "samples-without-indices")
    assert (finding.severity, finding.values) == ("note", {"y": 1})  # y is 0 at first
    assert str(finding) == snapshot(
        "Samples without indices, where the response does not vary: 1 of 9 of 'y'. The indices there are NaN."
    )
    rising = da.PythonModel(lambda a, b: a + b * TIMES, {"a": (0.0, 1.0), "b": (0.0, 1.0)}, ["x"], TIMES)
    assert "samples-without-indices" not in [item.code for item in da.global_sensitivity(rising).findings]


def test_a_channel_without_a_variance_is_named_once():
    still = da.PythonModel(
        lambda a: np.stack([a * TIMES + a, 1 + 0 * a * TIMES], 1), {"a": (0.0, 1.0)}, ["x", "y"], TIMES
    )
    codes = {item.code: item.values for item in da.global_sensitivity(still).findings}
    assert codes["constant-response"] == {"channels": "y"}
    assert "samples-without-indices" not in codes


def test_total_index_of_a_product_is_that_of_its_moments(found):
    """Var(g h) of independent factors: V_g = μ_h² v_g, V_h = μ_g² v_h, interaction v_g v_h."""
    low, high = BOX["rate"]

    def moment(factor):
        """Mean of exp(−factor · rate · t) · t."""
        ends = np.exp(-factor * low * TIMES) - np.exp(-factor * high * TIMES)
        return ends[1:] / (factor * (high - low))

    mean, square = moment(1) / TIMES[1:], moment(2) / TIMES[1:]
    of_rate, of_gain = square - mean**2, 1 / 12
    whole = mean**2 * of_gain + of_rate + of_gain * of_rate
    np.testing.assert_allclose(found.first[1:, 0, 0], mean**2 * of_gain / whole, atol=1e-4)
    np.testing.assert_allclose(found.total[1:, 0, 1], (of_rate + of_gain * of_rate) / whole, atol=1e-4)


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"tolerance": 2.0}, snapshot("global_sensitivity: tolerance is 2.0; expected a number between 0 and 1")),
        ({"checks": 1}, snapshot("global_sensitivity: checks is 1; expected a whole number, at least 2")),
        (
            {"intervals": {**BOX, "rate": da.Normal(9.0, 0.1)}},
            snapshot(
                "global_sensitivity: the distribution of 'rate', Normal(mean=9.0, deviation=0.1), has the probability 0 between the bounds of the parameter (0, 3). Correct the distribution or the bounds."
            ),
        ),
        (
            {"intervals": {"gain": (0.5, 1.5)}},
            snapshot(
                "intervals: none is given for parameter 'rate'; expected an interval, or a number if it is known exactly, for each of gain, rate, idle"
            ),
        ),
    ],
    ids=["tolerance", "checks", "distribution", "intervals"],
)
def test_what_is_refused(options, sentence):
    with pytest.raises(da.InputError) as refused:
        da.global_sensitivity(MODEL, **{"intervals": BOX, **options})
    assert str(refused.value) == sentence


def test_correlated_parameters_are_refused():
    both = da.CorrelatedNormal(("a", "b"), (1.0, 1.0), ((0.01, 0.005), (0.005, 0.01)))
    box = [da.Parameter(name, 0.0, 2.0, prior=both) for name in "ab"]
    model = da.PythonModel(lambda a, b: a * TIMES + b, box, ["x"], TIMES)
    with pytest.raises(da.InputError) as refused:
        da.global_sensitivity(model)
    assert str(refused.value) == snapshot(
        "global_sensitivity: the distribution of 'a' is correlated with others, and indices of correlated parameters are not defined. Use an interval or a distribution of it alone in intervals."
    )


def test_priors_of_parameters_are_the_distributions_if_no_intervals_are_given():
    """Var(a t) = t² var(a): the truncation of ± 4.3 deviations leaves 0.9996 of the variance."""
    parameters = [da.Parameter("a", -5.0, 5.0, prior=da.Normal(1.0, 0.3)), da.Parameter("b", 0.0, 1.0)]
    known = da.global_sensitivity(da.PythonModel(lambda a, b: a * TIMES + b, parameters, ["x"], TIMES))
    np.testing.assert_allclose(known.deviations[:, 0] ** 2, 0.09 * TIMES**2 + 1 / 12, rtol=1e-3)
    assert known.distributions == ("Normal(mean=1.0, deviation=0.3)", "uniform")
    assert known.box["b"] == da.Interval(0.0, 1.0)


@pytest.mark.parametrize(
    ("prior", "variance"),
    [(da.Uniform(1.0, 2.0), 1 / 12), (da.HalfNormal(0.5), 0.25 * (1 - 2 / np.pi)), (da.LogUniform(1.0, 1e3), None)],
    ids=["uniform", "half-normal", "log-uniform"],
)
def test_distributions_have_their_variance(prior, variance):
    model = da.PythonModel(lambda a: np.array([a]), {"a": (0.0, 2e3)}, ["x"], TIMES[:1])
    known = da.global_sensitivity(model, {"a": prior})
    log = np.log(1e3)
    expected = (1e6 - 1) / (2 * log) - (999 / log) ** 2 if variance is None else variance
    assert known.deviations[0, 0] ** 2 == pytest.approx(expected, rel=1e-3)


def test_a_surrogate_that_is_too_coarse_is_refused():
    step = da.PythonModel(lambda at: np.tanh(40 * (at - TIMES)), {"at": (0.0, 2.0)}, ["x"], TIMES)
    with pytest.raises(
        da.SolveError, match=r"leaves the indices of channel 'x' uncertain by .* Improve the surrogate \("
    ):
        da.global_sensitivity(step, {"at": (0.0, 2.0)}, Tensor(3))


def test_a_scheme_that_ended_at_its_tolerance_is_to_have_a_smaller_one():
    with pytest.raises(da.SolveError, match=r"allow less error by Adaptive\(tolerance=\.\.\.\), now 0\.2"):
        da.global_sensitivity(MODEL, BOX, Adaptive(0.2), tolerance=1e-6)


def test_it_is_stored_and_reported(found, tmp_path):
    found.save(tmp_path / "indices.nc")
    again = da.SensitivityIndices.load(tmp_path / "indices.nc")
    assert again.summary() == found.summary()
    found.report(tmp_path / "report.html")
    text = (tmp_path / "report.html").read_text(encoding="utf-8")
    for words in ("Global sensitivity", "Sobol indices", "first-order index", "gain"):
        assert words in text
    assert list(found.figures()) == ["indices-1", "shares-1", "indices-2", "shares-2"]


def ratios(scale: float) -> list[np.ndarray]:
    """Indices, lengths of variation and ratios of screened effects of a response with a scale."""
    times = np.linspace(0.0, 1.0, 3)
    model = da.PythonModel(
        lambda a, b, c: scale * np.exp(-a * times) * (1 + 0.3 * b) + scale * b * c,
        dict.fromkeys("abc", (0.1, 1.0)),
        ["x"],
        times,
    )
    found, screened = da.global_sensitivity(model), da.screen(model)
    gaps = [value for finding in found.findings for name, value in finding.values.items() if "variation" in name]
    effects = [
        screened.effects,
        screened.spread,
        screened.aggregated_effects,
        screened.aggregated_spread,
        screened.errors,
    ]
    indices = [found.first, found.total, found.aggregated_first, found.aggregated_total]
    return [*indices, np.array(gaps), *(np.asarray(one) / scale for one in effects)]


@pytest.mark.parametrize("power", [500, 664, 1000])
def test_indices_do_not_depend_on_the_scale_of_a_response(power):
    """A power of two does not round, so the numbers are the same to the last bit; 2^664 is 8e199."""
    for scaled, usual in zip(ratios(2.0**power), ratios(1.0), strict=True):
        np.testing.assert_array_equal(scaled, usual)
