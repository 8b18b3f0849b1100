"""Prior distributions: densities, quantiles, derivatives, and what is refused."""

from typing import Any

import numpy as np
import pytest
from inline_snapshot import snapshot
from scipy import stats

from dalembert.errors import InputError
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters
from dalembert.priors import CorrelatedNormal, HalfNormal, LogNormal, LogUniform, Normal, Prior, SquarePrior, Uniform
from dalembert.stored_fields import encoded

PRIORS = [
    (Normal(2.0, 0.5), stats.norm(2.0, 0.5)),
    (LogNormal(2.0, 0.3), stats.lognorm(0.3, scale=2.0)),
    (HalfNormal(1.5), stats.halfnorm(scale=1.5)),
    (Uniform(1.0, 4.0), stats.uniform(1.0, 3.0)),
    (LogUniform(0.5, 5.0), stats.loguniform(0.5, 5.0)),
]
VALUES = np.array([1.1, 1.7, 2.0, 3.9])


@pytest.mark.parametrize(("prior", "peer"), PRIORS)
def test_a_prior_is_the_distribution_of_scipy(prior: Prior, peer: Any) -> None:
    parts = np.array([0.01, 0.3, 0.5, 0.99])
    np.testing.assert_allclose(prior.log_density(VALUES), peer.logpdf(VALUES), rtol=1e-12)
    np.testing.assert_allclose(prior.cumulative(VALUES), peer.cdf(VALUES), rtol=1e-12)
    np.testing.assert_allclose(prior.quantile(parts), peer.ppf(parts), rtol=1e-12)
    if isinstance(prior, SquarePrior):
        np.testing.assert_allclose(prior.spread, peer.std(), rtol=1e-12)


@pytest.mark.parametrize(("prior", "peer"), PRIORS)
def test_slopes_are_those_of_differences(prior: Prior, peer: Any) -> None:
    step = 1e-6
    differences = (prior.log_density(VALUES + step) - prior.log_density(VALUES - step)) / (2 * step)
    np.testing.assert_allclose(prior.slope(VALUES), differences, rtol=1e-7, atol=1e-7)
    if isinstance(prior, SquarePrior):
        differences = (prior.residual(VALUES + step) - prior.residual(VALUES - step)) / (2 * step)
        np.testing.assert_allclose(prior.residual_slope(VALUES), differences, rtol=1e-7)


def test_nothing_lies_outside_the_support() -> None:
    assert Uniform(1.0, 4.0).log_density([0.9, 4.1]).tolist() == [-np.inf, -np.inf]
    assert LogUniform(1.0, 4.0).log_density([0.9, 4.1]).tolist() == [-np.inf, -np.inf]
    assert HalfNormal(1.0).log_density([-0.1]).tolist() == [-np.inf]


def test_bounds_truncate_a_prior() -> None:
    quantiles = Normal(0.0, 1.0).within(np.array([0.0, 0.5, 1.0]), 0.0, 10.0)
    np.testing.assert_allclose(quantiles, [0.0, stats.halfnorm.median(), 10.0], rtol=1e-9, atol=1e-12)


def test_a_parameter_has_a_distribution_in_any_case() -> None:
    assert Parameter("a", 0.0, 2.0).distribution == Uniform(0.0, 2.0)
    assert Parameter("a", 0.0, 2.0, deviation=0.1).distribution == Normal(1.0, 0.1)
    assert Parameter("a", 0.0, 2.0, prior=HalfNormal(1.0)).distribution == HalfNormal(1.0)


@pytest.mark.parametrize("prior", [prior for prior, _ in PRIORS])
def test_a_file_gives_back_the_same_parameter(prior: Prior) -> None:
    item = Parameter("a", 1.0, 3.0, prior=prior)
    assert Parameter(**encoded(item)) == item


def test_a_file_gives_back_correlated_parameters() -> None:
    joint = CorrelatedNormal(("a", "b"), (1.0, 2.0), ((1.0, 0.5), (0.5, 1.0)))
    items = tuple(Parameter(name, 0.0, 3.0, prior=joint) for name in joint.names)
    assert Parameters(tuple(Parameter(**encoded(item)) for item in items)) == Parameters(items)


MISTAKES = {
    "improper": lambda: Uniform(0.0, np.inf),
    "improper-normal": lambda: Normal(0.0, np.inf),
    "improper-order": lambda: LogUniform(0.0, 1.0),
    "singular": lambda: CorrelatedNormal(("a", "b"), (0.0, 0.0), ((1.0, 1.0), (1.0, 1.0))),
    "asymmetric": lambda: CorrelatedNormal(("a", "b"), (0.0, 0.0), ((1.0, 0.1), (0.0, 1.0))),
    "shapes": lambda: CorrelatedNormal(("a", "b"), (0.0,), ((1.0, 0.0), (0.0, 1.0))),
    "infinite": lambda: CorrelatedNormal(("a", "b"), (0.0, 0.0), ((np.inf, 0.0), (0.0, 1.0))),
    "texts": lambda: CorrelatedNormal(("a", "b"), ("x", 0.0), ((1.0, 0.0), (0.0, 1.0))),
    "one name": lambda: CorrelatedNormal(("a", "a"), (0.0, 0.0), ((1.0, 0.0), (0.0, 1.0))),
    "no number": lambda: Normal("1", 0.5),
    "reversed": lambda: Uniform(2.0, 1.0),
    "texts of ends": lambda: Uniform("1", 1.0),
    "not a prior": lambda: Parameter("a", 0.0, 1.0, prior=0.5),
    "twice": lambda: Parameter("a", 0.0, 1.0, deviation=0.1, prior=Normal(0.5, 0.1)),
    "fixed": lambda: Parameter("a", 1.0, 1.0, prior=Normal(0.5, 0.1)),
    "other names": lambda: Parameter(
        "c", 0.0, 1.0, prior=CorrelatedNormal(("a", "b"), (0.0, 0.0), ((1.0, 0.0), (0.0, 1.0)))
    ),
    "excluded": lambda: Parameter("a", 10.0, 20.0, prior=Normal(0.0, 1.0)),
    "narrow": lambda: Parameter("a", 0.0, 20.0, prior=Uniform(0.0, 1.0)),
    "zero": lambda: Parameter("a", 0.0, 20.0, prior=LogNormal(1.0, 1.0)),
    "negative": lambda: Parameter("a", -1.0, 20.0, prior=HalfNormal(1.0)),
    "unknown kind": lambda: Parameter("a", 0.0, 1.0, prior={"kind": "normall", "mean": 1.0}),
    "arguments": lambda: Parameter("a", 0.0, 1.0, prior={"kind": "normal", "mean": 1.0}),
    "alone": lambda: Parameters.of(
        [
            Parameter("a", 0.0, 1.0, prior=CorrelatedNormal(("a", "b"), (0.0, 0.0), ((1.0, 0.0), (0.0, 1.0)))),
            Parameter("b", 0.0, 1.0),
        ]
    ),
}  # fmt: skip


def test_wrong_priors_are_explained() -> None:
    told = {}
    for name, mistake in MISTAKES.items():
        with pytest.raises(InputError) as error:
            mistake()
        told[name] = str(error.value)
    assert told == snapshot(
        {
            "improper": "Uniform: it extends from 0 to inf, which makes the prior improper; expected two finite numbers",
            "improper-normal": "Normal: deviation is inf, which makes the prior improper; expected a positive number",
            "improper-order": "LogUniform: lower is 0, which makes the prior improper; expected a positive number",
            "singular": "CorrelatedNormal: covariance is not positive definite, which makes the prior improper; expected positive variances, and correlations between −1 and 1 that are possible together",
            "asymmetric": "CorrelatedNormal: covariance is not symmetric; expected equal entries on both sides of its diagonal",
            "shapes": "CorrelatedNormal: mean has the shape (1,) and covariance (2, 2); expected (2,) and (2, 2) for a, b",
            "infinite": "CorrelatedNormal: mean or covariance is not finite, which makes the prior improper; expected finite numbers",
            "texts": "CorrelatedNormal: mean or covariance are no numbers; expected 2 means and 2 rows of 2 covariances",
            "one name": "CorrelatedNormal: names are ('a', 'a'); expected two or more different names",
            "no number": "Normal: mean is '1'; expected a finite number",
            "reversed": "Uniform: it extends from 2 to 1; expected two numbers, the lower one first",
            "texts of ends": "Uniform: lower and upper are '1' and 1.0; expected two numbers",
            "not a prior": "parameter 'a': prior is 0.5; expected a prior such as Normal(mean, deviation)",
            "twice": "parameter 'a': it has a deviation and a prior, which both say what is known of it; leave one of them out",
            "fixed": "parameter 'a': both bounds are 1.0, so it is fixed and has no prior; leave the prior out",
            "other names": "parameter 'c': its prior is that of a, b; expected its name among them",
            "excluded": "parameter 'a': its prior has the probability 0 between the bounds (10, 20). Correct the prior or the bounds",
            "narrow": "parameter 'a': its prior is uniform from 0 to 1, narrower than its bounds (0, 20). Use the ends of the prior as bounds",
            "zero": "parameter 'a': its prior is log-normal, but its lower bound is 0. Raise the bound above 0",
            "negative": "parameter 'a': its prior is half-normal, but its lower bound is -1. Raise the bound to 0 or more",
            "unknown kind": "unknown prior 'normall'; did you mean 'normal' or 'log-normal'?",
            "arguments": "the prior 'normal' has mean; expected mean, deviation",
            "alone": "parameter 'a': its prior is that of a, b, but 'b' has another one or none. Give all of them the same prior",
        }
    )
