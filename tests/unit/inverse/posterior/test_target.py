"""Coordinates, prior density and target: values and derivatives."""

import numpy as np
import pytest

from dalembert.inverse import likelihood
from dalembert.inverse.posterior.posed import with_priors
from dalembert.inverse.posterior.prior_density import PriorDensity
from dalembert.inverse.posterior.target import Target
from dalembert.inverse.posterior.unbounded import UnboundedCoordinates
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters
from dalembert.priors import CorrelatedNormal, HalfNormal, LogNormal, LogUniform, Normal
from posterior_models import DECAY, measured

JOINT = CorrelatedNormal(("e", "a"), (1.0, 2.0), ((0.25, 0.2), (0.2, 1.0)))
MIXED = Parameters(
    (
        Parameter("a", -1.0, 4.0, prior=JOINT),
        Parameter("b", 1e-3, 1e3, prior=LogNormal(2.0, 0.5)),
        Parameter("c", 0.0, 3.0, prior=HalfNormal(1.0)),
        Parameter("d", 1.0, 50.0),
        Parameter("e", -2.0, 3.0, prior=JOINT),
        Parameter("f", -2.0, 3.0, prior=Normal(0.0, 2.0)),
    )
)
POINT = np.array([0.3, -0.4, 1.2, 0.1, -2.0, 6.0])


def differences(function, point: np.ndarray, step: float = 1e-6) -> np.ndarray:
    moved = step * np.eye(len(point))
    return np.array([(function(point + one) - function(point - one)) / (2 * step) for one in moved])


def test_coordinates_there_and_back() -> None:
    coordinates = UnboundedCoordinates(MIXED)
    np.testing.assert_allclose(coordinates.points(coordinates.vectors(POINT)), POINT, rtol=1e-9)


def test_a_value_at_a_bound_is_moved_inside() -> None:
    coordinates = UnboundedCoordinates(MIXED)
    assert np.all(np.isfinite(coordinates.points(np.stack([MIXED.lower, MIXED.upper]))))


def test_slopes_of_coordinates_are_those_of_differences() -> None:
    coordinates = UnboundedCoordinates(MIXED)
    slopes = differences(coordinates.vectors, POINT)
    np.testing.assert_allclose(coordinates.slope(POINT), np.diag(slopes), rtol=1e-7)
    np.testing.assert_allclose(coordinates.log_slope(POINT), np.sum(np.log(np.diag(slopes))), rtol=1e-7)
    found = differences(coordinates.log_slope, POINT)
    np.testing.assert_allclose(coordinates.log_slope_gradient(POINT), found, rtol=1e-6)


def test_far_coordinates_stay_finite() -> None:
    coordinates = UnboundedCoordinates(MIXED)
    far = np.array([[-1e4] * 6, [1e4] * 6])
    assert np.all(np.isfinite(coordinates.log_slope(far)))
    assert np.all(np.isfinite(coordinates.vectors(far)))


def test_the_slope_of_the_prior_is_that_of_differences() -> None:
    vector = UnboundedCoordinates(MIXED).vectors(POINT)
    density = PriorDensity(MIXED)
    found = differences(density, vector)
    np.testing.assert_allclose(density.gradient(vector), found, rtol=1e-5, atol=1e-6)


def test_draws_of_the_prior_have_its_moments_within_the_bounds() -> None:
    wide = CorrelatedNormal(("a", "b"), (1.0, 2.0), ((0.25, 0.2), (0.2, 1.0)))
    box = Parameters((*(Parameter(name, -9.0, 9.0, prior=wide) for name in "ab"), Parameter("c", 1.0, 4.0)))
    draws = PriorDensity(box).draws(20_000, seed=1)
    np.testing.assert_allclose(draws.mean(axis=0), [1.0, 2.0, 2.5], atol=0.03)
    np.testing.assert_allclose(np.cov(draws.T)[:2, :2], wide.covariance, atol=0.03)
    narrow = PriorDensity(MIXED).draws(500, seed=1)
    assert np.all((narrow >= MIXED.lower) & (narrow <= MIXED.upper))


@pytest.mark.parametrize("known", [True, False])
def test_the_gradient_of_the_target_is_that_of_differences(known: bool) -> None:
    likely = likelihood(DECAY, measured(known=known))
    parameters = with_priors(likely, {"height": LogNormal(1.0, 0.2)})
    count = len(parameters)
    factor = np.tril(0.1 + 0.2 * np.arange(count * count).reshape(count, count)) + np.eye(count)
    target = Target(likely, parameters, np.linspace(-0.2, 0.1, count), factor)
    place = np.linspace(0.1, -0.1, count)
    value, gradient = target.linearise(place)
    np.testing.assert_allclose(value, target.evaluate(place[None])[0], rtol=1e-12)
    found = differences(lambda one: target.evaluate(one[None])[0], place, 1e-5)
    np.testing.assert_allclose(gradient, found, rtol=1e-6, atol=1e-6)


def test_noise_is_log_uniform_if_nothing_else_is_said() -> None:
    likely = likelihood(DECAY, measured(known=False))
    prior = with_priors(likely, None).items[-1].prior
    assert isinstance(prior, LogUniform)
    assert with_priors(likely, {"noise.x.deviation": HalfNormal(0.1)}).items[-1].prior == HalfNormal(0.1)
