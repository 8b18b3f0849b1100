"""Search coordinates."""

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.inverse.problem.search_coordinates import SearchCoordinates
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters

BOX = Parameters(
    (
        Parameter("angle", -1.0, 3.0),
        Parameter("modulus", 1e6, 1e9),
        Parameter("length", 1.0, 9.0),
        Parameter("damping", 1.0, 100.0, log=False),
        Parameter("ratio", 0.5, 1.0, log=True),
    )
)
SEARCH = SearchCoordinates(BOX)


def test_wide_positive_parameters_are_searched_by_their_logarithm_unless_told_otherwise():
    assert SEARCH.logarithmic.tolist() == [False, True, False, False, True]


def test_there_and_back_again_within_rounding():
    vectors = BOX.lower + (BOX.upper - BOX.lower) * np.random.default_rng(0).random((20, 5))
    np.testing.assert_allclose(SEARCH.vectors(SEARCH.points(vectors)), vectors, rtol=1e-14)


def test_the_corners_are_the_bounds_to_the_last_bit():
    np.testing.assert_array_equal(SEARCH.vectors(SEARCH.lower), BOX.lower)
    np.testing.assert_array_equal(SEARCH.vectors(SEARCH.upper + 1e-12), BOX.upper)


def test_the_slope_is_the_derivative_of_the_vector():
    vector = BOX.lower + 0.3 * (BOX.upper - BOX.lower)
    point, step = SEARCH.points(vector), 1e-6
    numeric = [
        (SEARCH.vectors(point + step * unit) - SEARCH.vectors(point - step * unit)) / (2 * step) for unit in np.eye(5)
    ]
    np.testing.assert_allclose(np.diag(np.array(numeric)), SEARCH.slope(vector), rtol=1e-8)


def test_a_logarithm_of_a_bound_that_is_not_positive_is_refused():
    with pytest.raises(InputError) as error:
        Parameter("mass", 0.0, 1.0, log=True)
    assert str(error.value) == (
        "parameter 'mass': its logarithm is to be searched, but its lower bound is 0.0; "
        "expected a positive one; raise the bound or leave log out"
    )
