"""What is kept for validation is not fitted, but predicted and told."""

import numpy as np
import pytest

from dalembert.data import Measurements
from dalembert.errors import InputError
from dalembert.forward import PythonModel
from dalembert.inverse import Experiment, Fit, identify, predict
from pages import read_page
from small_models import DECAY, LINE, TIMES, measured
from support import says


def test_a_share_at_the_end_does_not_touch_the_fit():
    data = measured(DECAY, [2.0, 0.8], 0.02, deviations=0.02)
    whole = identify(DECAY, data, validation=0.25)
    part = identify(DECAY.first(31), data.first(31))
    np.testing.assert_allclose(whole.values, part.values, rtol=1e-9)
    assert whole.misfit == pytest.approx(part.misfit, rel=1e-12)
    assert whole.response.shape == (41, 1)
    np.testing.assert_allclose(whole.response[:31], part.response, rtol=1e-9)
    assert not whole.weights[31:].any()
    np.testing.assert_array_equal(whole.validation.weights[:31], 0)
    scaled = whole.residuals[:, 0] / 0.02
    assert whole.validation.misfit == pytest.approx(np.sqrt(np.mean(scaled[31:] ** 2)))
    assert whole.validation.fitted == pytest.approx(np.sqrt(np.mean(scaled[:31] ** 2)))
    assert whole.validation.misfit == pytest.approx(1.0, abs=0.5)
    assert "Not fitted: the last 10 of 41 samples." in whole.summary()


def test_a_model_that_lacks_something_predicts_worse_than_it_fits():
    bent = 2 * np.exp(-0.8 * TIMES) + 0.05 * TIMES**2
    fit = identify(DECAY, Measurements.of(TIMES, {"x": bent}, 0.01), validation=0.5)
    assert fit.validation.misfit > 3 * fit.validation.fitted
    ratio = fit.validation.misfit / fit.validation.fitted
    assert str(fit.validation).startswith(
        f"Not fitted: the last 20 of 41 samples. There the weighted residuals are {fit.validation.misfit:.3g} in the "
        f"root mean square, {ratio:.3g} times those of the fit; the model lacks something that shows there, or the "
        "fitted data do not determine all parameters."
    )


def experiments():
    return [
        Experiment(name, DECAY, measured(DECAY, [2.0, 0.8], 0.02, seed, deviations=0.02))
        for seed, name in enumerate(["a", "b", "c"])
    ]


def test_whole_experiments_are_predicted(tmp_path):
    fit = identify(experiments(), validation="b")
    without = identify([experiments()[0], experiments()[2]])
    np.testing.assert_allclose(fit.values, without.values, rtol=1e-9)
    assert fit.misfit == pytest.approx(without.misfit, rel=1e-12)
    assert [item.fitted for item in fit.experiments] == [True, False, True]
    np.testing.assert_allclose(fit.experiments[1].response, fit.experiments[0].response)
    assert fit.validation.what == "the experiment 'b'"
    assert fit.validation.misfit == pytest.approx(np.sqrt(np.mean((fit.experiments[1].residuals / 0.02) ** 2)))
    assert any(line.split()[-1] == "predicted" for line in fit.summary().splitlines() if line.startswith("b "))
    fit.save(tmp_path / "fit.nc")
    back = Fit.load(tmp_path / "fit.nc")
    assert str(back.validation) == str(fit.validation)
    assert back.validation.weights.tobytes() == fit.validation.weights.tobytes()


def test_the_first_of_several_experiments_is_predicted_although_residuals_are_correlated():
    """The growth of errors was looked for in channels of experiments that are not among the fitted data."""
    data = Measurements.of(TIMES, {"x": 2 * np.exp(-0.8 * TIMES) + 0.05 * TIMES**2}, 0.01)
    fit = identify([Experiment(name, DECAY, data) for name in "abc"], validation="a")
    assert {item.record for item in fit.validation.explained} == {"a"}
    assert {item.channel for item in fit.correlated.processes} == {"b.x", "c.x"}


def test_the_ends_of_all_experiments_are_predicted():
    fit = identify(experiments(), validation=0.25)
    assert fit.validation.what == "what comes after 75 % of each experiment's time"
    assert [int(np.count_nonzero(item.weights)) for item in fit.experiments] == [31, 31, 31]


def shares(fit):
    return {(item.record, item.channel): item.share for item in fit.validation.explained}


def test_the_share_explained_is_that_of_the_held_out_values(tmp_path):
    data = measured(LINE, [1.0, -0.5], 0.05, deviations=0.05)
    fit = identify(LINE, data, validation=0.5)
    later, response = data.values[21:], fit.response[21:]
    expected = 1 - np.sum((response - later) ** 2, axis=0) / np.sum((later - later.mean(axis=0)) ** 2, axis=0)
    assert list(shares(fit)) == [("", "x"), ("", "y")]
    np.testing.assert_allclose(list(shares(fit).values()), expected, rtol=1e-9)
    assert not fit.findings
    total = 1 - np.sum((response - later) ** 2) / np.sum((later - later.mean(axis=0)) ** 2)
    x, y = (f"{100 * share:.4g} %" for share in expected)
    sentence = f"Explained there of the data's variation: {100 * total:.4g} % ('x' {x}, 'y' {y})."
    assert sentence in fit.summary()
    fit.save(tmp_path / "fit.nc")
    back = Fit.load(tmp_path / "fit.nc")
    assert back.validation.explained == fit.validation.explained
    fit.report(tmp_path / "a.html")
    assert sentence in read_page(tmp_path / "a.html").text


def swing(rate, size):
    return np.stack([size * np.sin(rate * TIMES), size * np.cos(rate * TIMES)], axis=1)


def test_a_record_of_which_little_is_explained_is_a_finding_although_residuals_grow_little():
    """Both records are fitted badly, so that the ratio of their residuals says nothing."""
    model = PythonModel(swing, {"rate": (1.0, 3.0), "size": (0.5, 2.0)}, ["x", "y"], TIMES)
    rng, items = np.random.default_rng(0), []
    for name, other in (("a", 0.55), ("b", 0.75)):
        values = swing(2.0, 1.0) + other * swing(5.3, 1.0) + 0.02 * rng.standard_normal((len(TIMES), 2))
        items.append(Experiment(name, model, Measurements.of(TIMES, dict(zip("xy", values.T, strict=True)), 0.02)))
    fit = identify(items, validation="b", start=[2.0, 1.0], starts=1)
    assert fit.validation.misfit < 1.5 * fit.validation.fitted
    finding = next(item for item in fit.findings if item.code == "validation-unexplained")
    assert finding.doubtful
    assert finding.values["record"] == "b"
    assert 0.2 < finding.values["explained"] < 0.9
    assert "held-out record 'b'" in finding.message
    assert {record for record, _ in shares(fit)} == {"b"}


def test_a_noisy_record_that_is_predicted_to_its_noise_is_no_finding():
    items = [
        Experiment(name, DECAY, measured(DECAY, [2.0, 0.8], 0.6, seed, deviations=0.6))
        for seed, name in enumerate("abc")
    ]
    fit = identify(items, validation="c")
    assert shares(fit)["c", "x"] < 0.8
    assert "validation-unexplained" not in {item.code for item in fit.findings}


def test_a_record_that_does_not_vary_has_no_share():
    flat = Measurements.of(TIMES, {"x": np.where(TIMES < 2.05, 2 * np.exp(-0.8 * TIMES), 0.4)}, 0.02)
    fit = identify(DECAY, flat, validation=0.4875)
    assert np.isnan(shares(fit)["", "x"])
    assert "undefined (constant data)" in fit.summary()


def test_own_parameters_come_from_the_first_part_of_a_record_that_is_predicted(tmp_path):
    sizes = {"a": 2.0, "b": 3.0}
    items = [
        Experiment(name, DECAY, measured(DECAY, [size, 0.8], 0.02, seed, deviations=0.02), local=("size",))
        for seed, (name, size) in enumerate(sizes.items())
    ]
    fit = identify(items, validation={"b": 1.0})
    assert abs(fit.estimates["b.size"] - 3.0) < 0.05
    shorter = [items[0], Experiment("b", DECAY.first(11), items[1].data.first(11), local=("size",))]
    np.testing.assert_allclose(fit.values, identify(shorter).values, rtol=1e-6)
    assert fit.validation.what == "the experiment 'b' after its first 1 s"
    weights = fit.experiments[1].weights
    assert weights[:11].all()
    assert not weights[11:].any()
    rest = fit.experiments[1].residuals[11:] / 0.02
    assert fit.validation.misfit == pytest.approx(np.sqrt(np.mean(rest**2)))
    assert fit.validation.misfit < 1.5
    fit.save(tmp_path / "fit")
    assert Fit.load(tmp_path / "fit").validation.what == fit.validation.what


@pytest.mark.parametrize(
    ("given", "validation", "sentence"),
    [
        ("one", 1.5, "validation is 1.5; expected a share of the samples between 0 and 1, such as 0.25"),
        (
            "one",
            0.01,
            "validation is 0.01, which leaves 41 of 41 samples to be fitted and 0 to be predicted; expected at least 2 "
            "and 1",
        ),
        ("one", "a", "validation is 'a', but there is one experiment; expected a share such as 0.25"),
        ("several", ["d"], "validation: unknown experiment 'd'; known: a, b, c"),
        (
            "several",
            ["a", "b", "c"],
            "validation: expected at least one experiment to be fitted, and one to be predicted",
        ),
        ("several", [], "validation: expected at least one experiment to be fitted, and one to be predicted"),
        (
            "own",
            "b",
            "parameter 'b.size' belongs to experiments for validation alone, so that nothing determines it. Fit the "
            "first part of one of them, as by validation={'b': 0.5}, or fix the parameter",
        ),
        (
            "own",
            {"b": 0.01},
            "validation: the first 0.01 s of experiment 'b' are to be fitted, which are 1 of its 41 samples. Give a "
            "length between 0.1 and 4 s",
        ),
        (
            "own",
            {"b": 4.5},
            "validation: the first 4.5 s of experiment 'b' are to be fitted, which are 41 of its 41 samples. Give a "
            "length between 0.1 and 4 s",
        ),
        (
            "own",
            {"b": 0.0},
            "parameter 'b.size' belongs to experiments for validation alone, so that nothing determines it. Fit the "
            "first part of one of them, as by validation={'b': 0.5}, or fix the parameter",
        ),
        ("own", {"d": 1.0}, "validation: unknown experiment 'd'; known: a, b"),
    ],
)
def test_what_cannot_be_kept_for_validation_is_told(given, validation, sentence):
    data = measured(DECAY, [2.0, 0.8])
    arguments = {
        "one": (DECAY, data),
        "several": (experiments(),),
        "own": ([Experiment(name, DECAY, data, ("size",)) for name in ("a", "b")],),
    }[given]
    with pytest.raises(InputError, match=says(sentence)):
        identify(*arguments, validation=validation)


def test_a_perfect_fit_is_told_without_a_ratio():
    model = PythonModel(lambda x: x * np.array([1.0, 1.0, 1.0]), {"x": (0.0, 2.0)}, ["y"], [0, 1, 2])
    fit = identify(model, Measurements.of([0.0, 1.0, 2.0], {"y": [1.0, 1.0, 1.0]}), validation=0.34, start=[1.0])
    assert str(fit.validation) == (
        "Not fitted: the last 1 of 3 samples. There the weighted residuals are 0 in the root mean square, those of the "
        "fit 0."
    )


def pieces(noise, damping=0.8, deviations=0.02):
    """Three records of a decay; the last one is not fitted, and decays at another rate."""
    true = [damping if name == "c" else 0.8 for name in "abc"]
    return [
        Experiment(name, DECAY, measured(DECAY, [2.0, rate], noise, seed, deviations=deviations))
        for seed, (name, rate) in enumerate(zip("abc", true, strict=True))
    ]


@pytest.mark.parametrize("deviations", [0.02, None], ids=["known noise", "unknown noise"])
def test_the_bands_of_a_right_model_contain_their_share_of_the_held_out_values(deviations):
    fit = identify(pieces(0.02, deviations=deviations), validation="c")
    assert 0.85 < fit.validation.covered <= 1.0
    assert [item.covered for item in fit.validation.explained] == [fit.validation.covered]
    assert "narrow-bands" not in {item.code for item in fit.findings}
    assert f"The 95 % bands contain {100 * fit.validation.covered:.3g} % of these values." in str(fit.validation)


def test_bands_that_contain_too_few_held_out_values_are_a_finding(tmp_path):
    fit = identify(pieces(0.02, damping=0.6), validation="c")
    finding = next(item for item in fit.findings if item.code == "narrow-bands")
    assert finding.doubtful
    assert finding.values["covered"] == fit.validation.covered < 0.7
    assert (finding.values["record"], finding.values["channel"]) == ("c", "x")
    fit.save(tmp_path / "fit.nc")
    assert Fit.load(tmp_path / "fit.nc").validation.covered == fit.validation.covered


def test_coverage_agrees_with_the_prediction_of_the_held_out_record():
    items = pieces(0.02, damping=0.75)
    fit = identify(items, validation="c")
    bands = predict(items[2], fit)
    values = items[2].data.values
    inside = (bands.measured_lower <= values) & (values <= bands.measured_upper)
    assert fit.validation.covered == pytest.approx(float(np.mean(inside)), abs=1e-12)
