"""What holds for any polynomial: a scheme of its degree finds it again, and says so."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dalembert.surrogate import Adaptive, ChebyshevPolynomial, Tensor, TotalDegree, fit
from dalembert.surrogate.basis import total_degree


@st.composite
def polynomials(draw) -> ChebyshevPolynomial:
    directions, order = draw(st.integers(1, 3)), draw(st.integers(1, 4))
    exponents = total_degree(directions, order)
    seed = draw(st.integers(0, 2**32 - 1))
    coefficients = np.random.default_rng(seed).normal(size=(len(exponents), 2))
    lower = np.array(draw(st.lists(st.floats(-100, 100), min_size=directions, max_size=directions)))
    width = np.array(draw(st.lists(st.floats(0.1, 100), min_size=directions, max_size=directions)))
    return ChebyshevPolynomial(lower, lower + width, exponents, coefficients)


@pytest.mark.parametrize("scheme", [TotalDegree, Tensor, lambda order: Adaptive(1e-9)])
@settings(max_examples=30, deadline=None)
@given(truth=polynomials(), seed=st.integers(0, 1000))
def test_a_polynomial_is_found_again_by_each_scheme(scheme, truth: ChebyshevPolynomial, seed: int) -> None:
    order = int(truth.degrees.max())
    found = fit(truth, truth.lower, truth.upper, scheme(order), seed=seed)
    points = np.random.default_rng(seed).uniform(truth.lower, truth.upper, (50, len(truth.lower)))
    size = np.abs(truth.coefficients).sum()
    np.testing.assert_allclose(found(points), truth(points), atol=1e-8 * size)
    assert np.all(found.held_out <= 1e-8 * size)


@settings(max_examples=30, deadline=None)
@given(truth=polynomials())
def test_values_at_the_runs_are_those_of_the_runs(truth: ChebyshevPolynomial) -> None:
    """Interpolation passes through its runs, whatever the function: here one that is no polynomial."""
    found = fit(lambda p: np.tanh(truth(p)), truth.lower, truth.upper, Adaptive(1e-2, most_runs=60), held_out=0)
    np.testing.assert_allclose(found(found.points), found.values, atol=1e-7)
