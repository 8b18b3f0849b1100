"""Robust losses: against SciPy's, their slopes, outliers, efficiency, every method, refusals."""

import numpy as np
import pytest
from scipy.optimize import least_squares

from conclusions import codes, only
from dalembert.data import Measurements
from dalembert.errors import InputError
from dalembert.inverse import identify
from dalembert.inverse.problem.loss import LOSSES, Loss
from dalembert.optimize import LeastSquares, Minimiser, ParticleSwarm
from small_models import DECAY, LINE, TIMES, line, measured
from support import says

NAMES = list(LOSSES)


def spoilt(outliers=6, size=1.0, noise=0.02):
    """Data of a decay with a few readings that are far off."""
    data = measured(DECAY, [2.0, 0.8], noise, seed=5)
    values = data.values.copy()
    values[np.random.default_rng(1).choice(41, outliers, replace=False)] += size
    return Measurements.of(TIMES, {"x": values[:, 0]}, 0.02)


@pytest.mark.parametrize("name", NAMES)
def test_transformed_residuals_have_the_losses_of_scipy_as_squares_and_exact_slopes(name):
    residual = np.array([-30.0, -2.0, -0.7, -1e-9, 0.0, 1e-3, 1.0, 5.0])
    loss, step = Loss(name, 1.4), 1e-6
    cost = [
        2 * least_squares(lambda x, r=r: r + 0 * x, [0.0], loss=name.replace("-", "_"), f_scale=1.4, max_nfev=1).cost
        for r in residual
    ]
    np.testing.assert_allclose(loss.residual(residual) ** 2, cost, rtol=1e-9, atol=1e-15)
    slopes = (loss.residual(residual + step) - loss.residual(residual - step)) / (2 * step)
    np.testing.assert_allclose(loss.slope(residual), slopes, rtol=1e-5)
    assert (np.sign(loss.residual(residual)) == np.sign(residual)).all()


@pytest.mark.parametrize("name", NAMES)
def test_the_minimum_is_scipys(name):
    data = spoilt()
    fit = identify(DECAY, data, loss=name, loss_scale=1.5)
    theirs = least_squares(
        lambda p: (p[0] * np.exp(-p[1] * TIMES) - data.values[:, 0]) / 0.02,
        [1.9, 0.7],
        loss=name.replace("-", "_"),
        f_scale=1.5,
        xtol=1e-13,
        ftol=1e-13,
        gtol=1e-13,
    )
    np.testing.assert_allclose(fit.values, theirs.x, rtol=1e-5)
    assert fit.misfit == pytest.approx(2 * theirs.cost, rel=1e-8)


@pytest.mark.parametrize("name", NAMES)
def test_outliers_pull_less_than_their_squares_would(name):
    robust, plain = identify(DECAY, spoilt(), loss=name), identify(DECAY, spoilt())
    assert np.max(np.abs(robust.values - [2.0, 0.8])) < 0.25 * np.max(np.abs(plain.values - [2.0, 0.8]))
    assert np.max(np.abs(robust.values - [2.0, 0.8]) / robust.deviations) < 4
    values = only(robust, "outlying-residuals").values
    assert (values["of"], values["scale"]) == (41, LOSSES[name][3])


@pytest.mark.parametrize("method", [LeastSquares(), ParticleSwarm(30, 60), Minimiser("Nelder-Mead"), "L-BFGS-B"])
def test_every_method_minimises_the_same_loss(method):
    fit = identify(DECAY, spoilt(), method=method, loss="huber", start=[1.8, 1.0])
    best = identify(DECAY, spoilt(), loss="huber")
    assert fit.misfit == pytest.approx(best.misfit, rel=1e-3)
    np.testing.assert_allclose(fit.values, best.values, rtol=1e-2)


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_the_usual_scale_costs_five_per_cent_of_the_efficiency_and_deviations_say_so(name):
    """Over 400 normal data sets of a linear model."""
    design = np.stack([line(1.0, 0.0), line(0.0, 1.0)], axis=-1).reshape(-1, 2)
    plain, robust, told = [], [], []
    for seed in range(400):
        data = measured(LINE, [1.0, 2.0], 0.1, seed, deviations=0.1)
        fit = identify(LINE, data, loss=name, starts=1, horizon=None, start=[1.0, 2.0])
        plain.append(np.linalg.lstsq(design, data.values.ravel(), rcond=None)[0])
        robust.append(fit.values)
        told.append(fit.deviations)
    efficiency = np.var(plain, axis=0) / np.var(robust, axis=0)
    np.testing.assert_allclose(efficiency, 0.95, atol=0.05)
    np.testing.assert_allclose(np.mean(told, axis=0), np.std(robust, axis=0), rtol=0.1)


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"loss": "hubr"}, "unknown loss 'hubr'; did you mean 'huber'?"),
        ({"loss_scale": 1.0}, "loss_scale was given, but the loss is 'linear', which has none; leave it out"),
        ({"loss": "huber", "loss_scale": 0.0}, "loss_scale is 0.0; expected a positive number"),
        (
            {"loss": "cauchy"},
            "loss 'cauchy' needs to know which residuals are large; give the data's deviations, or loss_scale, the "
            "weighted residual from which one counts as an outlier",
        ),
    ],
)
def test_losses_that_cannot_be_meant_are_told(options, sentence):
    with pytest.raises(InputError, match=says(sentence)):
        identify(DECAY, measured(DECAY, [2.0, 0.8]), **options)


def test_the_status_of_a_robust_fit_does_not_count_outliers():
    fit = identify(DECAY, spoilt(outliers=2), loss="huber")
    assert "residuals-as-given" in codes(fit)
    wrong = Measurements.of(TIMES, {"x": spoilt().values[:, 0]}, 0.004)
    assert "misfit-above-noise" in codes(identify(DECAY, wrong, loss="huber"))
