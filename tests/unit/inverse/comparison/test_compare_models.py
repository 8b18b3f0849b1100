"""Which of several models predicts best, when the difference means nothing, and what cannot be compared."""

from dataclasses import replace

import numpy as np
import pytest
from inline_snapshot import snapshot

import dalembert as da
from correlated_noise import autoregressive
from dalembert.data import Measurements
from dalembert.errors import InputError
from dalembert.forward import PythonModel
from dalembert.inverse import (
    AffineInvariant,
    CrossValidation,
    Experiment,
    ModelComparison,
    compare_models,
    cross_validate,
    identify,
    sample,
)  # fmt: skip
from support import says

TIMES = np.linspace(0, 2, 81)
BOX = (-9.0, 9.0)
LINE = PythonModel(lambda a, b: a + b * TIMES, {"a": BOX, "b": BOX}, ["x"], TIMES)
PARABOLA = PythonModel(lambda a, b, c: a + b * TIMES + c * TIMES**2, {"a": BOX, "b": BOX, "c": BOX}, ["x"], TIMES)
ALONE = (
    "compare_models: 'late' cannot predict values that are left out, as they alone determine a parameter; leave out "
    "smaller groups"
)
UNDETERMINED = (
    "cross_validate: without one group, the other data do not determine all parameters; leave out smaller blocks, or fix "
    "the parameters that only this group determines"
)
MODELS = {"line": LINE, "parabola": PARABOLA}


def recorded(bend, noise=None, deviations=None):
    noise = np.random.default_rng(0).standard_normal(81) if noise is None else noise
    return Measurements.of(TIMES, {"x": 1 + 2 * TIMES + bend * TIMES**2 + 0.1 * noise}, deviations)


def fitted(data, **options):
    return {name: identify(model, data, starts=1, horizon=None, **options) for name, model in MODELS.items()}


def codes(found):
    return [(item.code, item.severity) for item in found.findings]


def test_the_model_of_the_data_predicts_best():
    found = compare_models(fitted(recorded(0.5)))
    assert found.models == ("parabola", "line")
    assert codes(found)[0] == ("best-model", "note")
    assert found.akaike_weights[0] > 0.99
    assert found.difference[1] < -2 * found.difference_deviation[1]
    assert found.summary() == snapshot("""\
model     parameters  rms residual  AIC       AICc      BIC       elpd      difference  deviation of the difference
───────────────────────────────────────────────────────────────────────────────────────────────────────────────────
parabola  4           0.0944369     −144.423  −143.897  −134.846  70.3005   0           0
line      3           0.176296      −45.2973  −44.9856  −38.114   −8.46516  −78.77      24

best               parabola
models             2
values             81
elpd               leave-out predictions of the linearised models
left out together  blocks of neighbouring samples

'parabola' predicts best: its log predictive density is larger than that of the next, 'line', by 78.8 ± 23.6.
The residuals of 'line' are correlated. AIC, AICc and BIC take values for independent, so their differences are too large.
Only 5 groups were left out: the standard deviation of a difference is uncertain. Leave out more, smaller groups.\
""")


def test_a_difference_that_means_nothing_is_said():
    found = compare_models(fitted(recorded(0.0)))
    assert codes(found) == [("equal-models", "warning")]
    assert str(found.findings[0]) == snapshot(
        "The data do not distinguish 'line' and 'parabola': the log predictive density of 'line' is larger by 0.945 ± 0.429, which means nothing. Prefer the simplest, 'line', or measure where their responses differ."
    )


def test_correlated_residuals_are_left_out_in_blocks():
    noise = autoregressive(1, 81, 0.8)
    fits = fitted(recorded(0.0, noise))
    assert fits["line"].correlated is not None
    found = compare_models(fits)
    assert found.left_out == "blocks"
    assert ("correlated-comparison", "note") in codes(found)
    assert found.densities.shape[1] < 20
    alone = compare_models(fits, leave_out="values")
    assert ("correlated-comparison", "warning") in codes(alone)


def test_a_noise_model_is_judged_with_its_parameters():
    noise = autoregressive(1, 81, 0.8)
    data = recorded(0.0, noise)
    plain, constant = (identify(LINE, data, starts=1, horizon=None, noise=one) for one in (None, "constant"))
    process = fitted(data, noise=da.AutoregressiveNoise(order=1))
    found = compare_models({"plain": plain, "constant": constant, **process}, leave_out="values")
    assert set(found.models[:2]) == {"line", "parabola"}
    assert found.findings[0].code == "equal-models"
    assert "Prefer the simplest, 'line'" in str(found.findings[0])
    elpd = dict(zip(found.models, found.elpd, strict=True))
    assert elpd["constant"] == pytest.approx(elpd["plain"], abs=0.05)
    assert elpd["line"] > elpd["plain"] + 20
    assert dict(zip(found.models, found.parameters, strict=True)) == {
        "plain": 3, "constant": 3, "line": 4, "parabola": 5
    }  # fmt: skip


def test_correlated_noise_is_left_out_in_blocks_longer_than_its_correlation():
    process = fitted(recorded(0.0, autoregressive(1, 81, 0.8)), noise=da.AutoregressiveNoise(order=1))
    found = compare_models(process)
    assert found.left_out == "blocks"
    assert found.densities.shape[1] < 10
    again = compare_models(
        {name: cross_validate(MODELS[name], fit.data, fit=fit) for name, fit in process.items()}, leave_out="blocks"
    )
    assert again.elpd == pytest.approx(found.elpd, abs=2.0)


def test_noise_of_experiments_that_are_left_out():
    experiments = [
        Experiment(name, LINE, recorded(0.0, autoregressive(seed, 81, 0.6)))
        for seed, name in enumerate(("one", "two", "three", "four"))
    ]
    shared, local = (
        identify(experiments, starts=1, horizon=None, noise=da.AutoregressiveNoise(order=1, local=local))
        for local in (False, True)
    )
    found = compare_models({"a": shared, "b": shared}, leave_out="experiments")
    checked = cross_validate(experiments, fit=shared, leave_out="experiments")
    assert np.sum(checked.log_densities) == pytest.approx(found.elpd[0], abs=4.0)
    with pytest.raises(InputError, match=says(ALONE.replace("late", "a"))):
        compare_models({"a": local, "b": shared}, leave_out="experiments")
    with pytest.raises(InputError) as refused:
        cross_validate(experiments, fit=local, leave_out="experiments")
    assert str(refused.value) == (
        "cross_validate: only experiment 'one' has 'noise.one.x.deviation', so that its noise cannot be predicted; "
        "share the noise of the experiments, or leave out blocks"
    )


@pytest.mark.parametrize("noise", [da.ConstantNoise(), da.MixedNoise(), da.AutoregressiveNoise(order=1)])
def test_an_experiment_with_other_noise_is_predicted_as_by_refits(noise):
    """Without it, the noise is many standard deviations away from that of all experiments."""
    experiments = [
        Experiment(name, LINE, recorded(0.0, size * np.random.default_rng(seed).standard_normal(81)))
        for seed, (name, size) in enumerate({"one": 1.0, "two": 1.1, "three": 0.9, "loud": 5.0}.items())
    ]
    fit = identify(experiments, starts=1, horizon=None, noise=noise)
    found = compare_models({"a": fit, "b": fit}, leave_out="experiments")
    checked = cross_validate(experiments, fit=fit, leave_out="experiments")
    assert checked.log_densities[3] < -500
    # the size of mixed noise follows the response, which stays that of all experiments
    near = 2e-2 if isinstance(noise, da.MixedNoise) else 5e-3
    assert found.densities[0] == pytest.approx(checked.log_densities, rel=near, abs=0.2)


def test_fits_with_and_without_a_noise_model_have_the_same_density():
    experiments = [
        Experiment(str(seed), LINE, recorded(0.0, np.random.default_rng(seed).standard_normal(81))) for seed in range(3)
    ]
    fits = {
        name: identify(experiments, starts=1, horizon=None, noise=noise)
        for name, noise in {"plain": None, "constant": "constant"}.items()
    }
    found = compare_models(fits, leave_out="experiments")
    assert found.difference[1] == pytest.approx(0.0, abs=0.1)  # by Student's t it is 12
    checked = {name: cross_validate(experiments, fit=fit, leave_out="experiments") for name, fit in fits.items()}
    with pytest.raises(InputError) as refused:
        compare_models(checked)
    assert str(refused.value) == (
        "compare_models: 'plain' has no noise model, but 'constant' has one, so that their predictive densities differ; "
        "identify 'plain' with noise='constant', and cross-validate it again"
    )


def test_known_deviations_with_correlated_noise_of_several_channels():
    times = np.linspace(0, 2, 41)
    two = PythonModel(lambda a: np.stack([a * times, np.cos(a * times)], axis=1), {"a": (0.5, 2.0)}, ["x", "y"], times)
    random = np.random.default_rng(2)
    values = np.stack([times, np.cos(times)], axis=1) + [0.1, 0.3] * random.standard_normal((41, 2))
    data = Measurements.of(times, dict(zip("xy", values.T, strict=True)), {"x": 0.1, "y": 0.3})
    known, process = (
        identify(two, data, starts=1, horizon=None, noise=noise)
        for noise in (None, {"y": da.AutoregressiveNoise(deviation=da.KnownNoise(), order=1, partial=[1e-9])})
    )
    found = compare_models({"known": known, "process": process}, leave_out="values")
    assert found.elpd[0] == pytest.approx(found.elpd[1], rel=1e-6)


def test_few_groups_are_noted():
    assert ("few-groups", "note") in codes(compare_models(fitted(recorded(0.5)), leave_out="blocks", blocks=4))


def test_a_criterion_that_prefers_a_worse_prediction_is_a_doubt():
    found = compare_models(fitted(recorded(0.5)))
    from dalembert.inverse.comparison.comparison_findings import comparison_findings

    made = comparison_findings(replace(found, bic=found.bic[::-1]), (), {})
    (finding,) = (item for item in made.findings if item.code == "criteria-disagree")
    assert finding.values == {"BIC": "line"}


def test_a_file_gives_back_the_comparison(tmp_path):
    found = compare_models(fitted(recorded(0.5)))
    found.save(tmp_path / "comparison.nc")
    loaded = ModelComparison.load(tmp_path / "comparison.nc")
    assert loaded.summary() == found.summary()
    np.testing.assert_array_equal(loaded.densities, found.densities)


def test_a_file_gives_back_the_cross_validation(tmp_path):
    data = recorded(0.5)
    found = cross_validate(PARABOLA, data, fit=identify(PARABOLA, data, starts=1, horizon=None), blocks=4)
    found.save(tmp_path / "checked.nc")
    loaded = CrossValidation.load(tmp_path / "checked.nc")
    assert loaded.summary() == found.summary()
    assert loaded.fit.summary() == found.fit.summary()
    assert found.rms == pytest.approx(np.sqrt(np.mean(found.rms_of_groups**2)), rel=1e-2)  # groups of 20 and 21 values
    np.testing.assert_array_equal(loaded.errors, found.errors)
    assert compare_models({"a": loaded, "b": found}).difference[1] == 0
    assert found.tables()[0].columns == ("group", "rms error", "log density", "a", "b", "c")


def test_experiments_are_left_out_as_a_whole(tmp_path):
    experiments = {
        name: [Experiment(str(k), model, recorded(0.5, np.random.default_rng(k).standard_normal(81))) for k in range(4)]
        for name, model in MODELS.items()
    }
    fits = {name: identify(own, starts=1, horizon=None) for name, own in experiments.items()}
    linear = compare_models(fits, leave_out="experiments")
    assert linear.densities.shape == (2, 4)
    again = {name: cross_validate(experiments[name], fit=fit, leave_out="experiments") for name, fit in fits.items()}
    found = compare_models(again)
    assert found.how == "cross-validation by fits without each group"
    np.testing.assert_allclose(found.densities, linear.densities, rtol=1e-6)
    assert again["line"].rms > again["parabola"].rms
    again["line"].save(tmp_path / "line.nc")
    assert CrossValidation.load(tmp_path / "line.nc").summary() == again["line"].summary()
    again["line"].report(tmp_path / "report.html")
    assert "Response and data" not in (tmp_path / "report.html").read_text(encoding="utf-8")


def test_models_that_cannot_be_compared():
    fits = fitted(recorded(0.5))
    other = identify(LINE, recorded(0.4), starts=1, horizon=None)
    robust = identify(LINE, recorded(0.5), starts=1, horizon=None, loss="huber", loss_scale=0.2)
    weighted = identify(LINE, recorded(0.5), starts=1, horizon=None, weights=[2.0])
    line = fits["line"]
    for models, sentence in (
        ({"line": line}, "compare_models: 1 model was given; expected at least two, by their names"),
        (
            {"line": line, "b": other},
            "compare_models: 'b' was fitted to other data than 'line'; fit both models to the same samples and channels",
        ),
        (
            {"line": line, "b": weighted},
            "compare_models: 'b' was fitted with other weights or other held-out samples than 'line'; use the same for both",
        ),
        (
            {"line": line, "b": robust},
            "'b' was fitted with a robust loss, which is not a likelihood; fit it with loss='linear', without the outliers",
        ),
        (
            {"line": line, "b": replace(line, jacobian=None)},
            "'b' has no Jacobian, since its model gives no derivatives; use a model with derivatives",
        ),
        (
            {"line": line, "b": 3.0},
            "compare_models: 'b' is 3.0; expected fits alone, cross-validations alone, or posteriors alone",
        ),
    ):
        with pytest.raises(InputError, match=says(sentence)):
            compare_models(models)
    with pytest.raises(
        InputError, match=says("leave_out is 'experiments', but the fit has one experiment; use 'blocks'")
    ):
        compare_models(fits, leave_out="experiments")
    with pytest.raises(
        InputError, match=says("blocks is 1; expected at least 2, and at most the 81 samples of a record")
    ):
        compare_models(fits, leave_out="blocks", blocks=1)


def test_values_that_nothing_else_determines_cannot_be_left_out():
    step = np.where(TIMES > 1.5, 1.0, 0.0)
    late = PythonModel(lambda a, b: a * TIMES + b * step, {"a": BOX, "b": BOX}, ["x"], TIMES)
    data = recorded(0.0)
    fits = {"late": identify(late, data, starts=1, horizon=None), "line": identify(LINE, data, starts=1, horizon=None)}
    with pytest.raises(InputError, match=says(ALONE)):
        compare_models(fits, leave_out="blocks", blocks=2)
    with pytest.raises(InputError, match=says(UNDETERMINED)):
        cross_validate(late, data, fit=fits["late"], blocks=2)


def test_draws_are_compared_by_importance_sampling():
    arviz = pytest.importorskip("arviz")
    data, rng = recorded(0.5, deviations=0.1), np.random.default_rng(3)
    fits, draws = fitted(data), {}
    for name, fit in fits.items():
        slopes = fit.jacobian[:, 0]
        vectors = (
            fit.values
            + rng.standard_normal((4, 500, len(fit.values)))
            @ np.linalg.cholesky(np.linalg.inv(slopes.T @ slopes / 0.01)).T
        )
        apart = (data.values[:, 0] - vectors @ slopes.T) / 0.1
        logs = -0.5 * apart**2 - np.log(0.1) - 0.5 * np.log(2 * np.pi)
        draws[name] = arviz.from_dict(
            posterior={"p": vectors}, log_likelihood={"x": logs}, observed_data={"x": data.values[:, 0]}
        )
    found, exact = compare_models(draws), compare_models(fits, leave_out="values")
    assert found.models == exact.models == ("parabola", "line")
    np.testing.assert_allclose(found.elpd, exact.elpd, atol=0.5)
    np.testing.assert_allclose(found.waic, exact.elpd, atol=0.5)
    del draws["line"]["log_likelihood"]
    with pytest.raises(
        InputError, match=says("compare_models: the draws of 'line' have no group log_likelihood; sample again with it")
    ):
        compare_models(draws)


def test_posteriors_are_compared_as_fits_of_the_same_noise():
    data = recorded(0.5, deviations=0.1)
    fits = fitted(data)
    posteriors = {
        name: sample(
            MODELS[name],
            data,
            sampler=AffineInvariant(thin=2),
            start=fit.values,
            chains=4,
            draws=150,
            warmup=80,
            seed=1,
        )
        for name, fit in fits.items()
    }
    found, exact = compare_models(posteriors), compare_models(fits, leave_out="values")
    assert found.models == exact.models == ("parabola", "line")
    np.testing.assert_allclose(found.elpd, exact.elpd, atol=0.6)


def drawn(model, data, **options):
    return sample(
        model,
        data,
        sampler=AffineInvariant(),
        start=options.pop("start", None),
        chains=2,
        draws=40,
        warmup=30,
        **options,
    )


def test_draws_with_correlated_noise_leave_out_blocks():
    data, noise = recorded(0.5), da.AutoregressiveNoise(order=1)
    posteriors = {name: drawn(model, data, noise=noise) for name, model in MODELS.items()}
    found = compare_models(posteriors)
    assert (found.left_out, found.densities.shape, found.values) == ("blocks", (2, 10), 81)
    assert compare_models(posteriors, leave_out="values").densities.shape == (2, 81)
    plain = compare_models({name: drawn(model, recorded(0.0, deviations=0.1)) for name, model in MODELS.items()})
    assert plain.left_out == "values"


def test_correlated_residuals_of_draws_are_left_out_in_blocks():
    data = recorded(0.0, autoregressive(1, 81, 0.8), deviations=0.1)
    assert compare_models({name: drawn(model, data) for name, model in MODELS.items()}).left_out == "blocks"


def test_draws_of_several_channels_and_experiments_are_compared():
    def runs(model):
        wide = PythonModel(
            lambda **values: np.stack([model.function(**values), 2 * model.function(**values)], axis=1),
            dict.fromkeys(model.parameters.names, BOX), ["x", "y"], TIMES,
        )  # fmt: skip
        values = np.stack([recorded(0.5).values[:, 0], 2 * recorded(0.5).values[:, 0]], axis=1)
        data = Measurements(recorded(0.5).coordinate, ("x", "y"), values, deviations=[0.1, 0.1])
        return [Experiment("first", wide, data), Experiment("second", wide.first(60), data.first(60))]

    posteriors = {name: drawn(runs(model), None) for name, model in MODELS.items()}
    for left_out, count in (("values", 2 * 141), ("blocks", 20), ("experiments", 2)):
        found = compare_models(posteriors, leave_out=left_out)
        assert found.models[0] == "parabola"
        assert found.densities.shape == (2, count)
    single = posteriors["line"]
    np.testing.assert_allclose(
        single.experiment_log_likelihood.sum(axis=1), single.log_likelihood.sum(axis=1), rtol=1e-10
    )
    np.testing.assert_allclose(
        single.block_log_likelihood[:, :10].sum(axis=1), single.experiment_log_likelihood[:, 0], rtol=1e-10
    )
    assert set(single.inference_data.log_likelihood) == {"first.x", "first.y", "second.x", "second.y"}
    assert compare_models({name: one.inference_data for name, one in posteriors.items()}).densities.shape == (2, 282)


def test_groups_that_draws_do_not_have_are_refused():
    posteriors = {name: drawn(model, recorded(0.5, deviations=0.1)) for name, model in MODELS.items()}
    other = {**posteriors, "line": drawn(LINE, recorded(0.5, deviations=0.1), blocks=5)}
    for models, options, sentence in (
        (posteriors, {"blocks": 5}, "compare_models: the blocks of draws are those of sample; leave blocks out here"),
        (
            posteriors, {"leave_out": "experiments"},
            "leave_out is 'experiments', but the posterior has one experiment; use 'blocks'",
        ),
        (
            other, {"leave_out": "blocks"},
            "compare_models: the draws of 'parabola' have other blocks than those of 'line'; sample both with the same number of blocks",
        ),
        (
            {name: one.inference_data for name, one in posteriors.items()}, {"leave_out": "blocks"},
            "compare_models: the draws of 'line' have log-likelihoods of single values only, so leave_out cannot be 'blocks'; use leave_out='values', or posteriors of sample",
        ),
    ):  # fmt: skip
        with pytest.raises(InputError, match=says(sentence)):
            compare_models(models, **options)


def test_it_is_in_the_package():
    assert da.compare_models is compare_models


def test_the_table_of_draws_has_no_empty_columns():
    made = compare_models(fitted(recorded(0.5)))
    nothing = np.full(2, np.nan)
    draws = replace(
        made, parameters=np.array([-1, -1]), rms=nothing, aic=nothing, aicc=nothing, bic=nothing, waic=made.elpd
    )
    assert draws.tables()[0].columns == ("model", "elpd", "difference", "deviation of the difference", "WAIC (elpd)")
