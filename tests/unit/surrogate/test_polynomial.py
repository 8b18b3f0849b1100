import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.surrogate import ChebyshevPolynomial
from support import says


@pytest.fixture
def polynomial() -> ChebyshevPolynomial:
    rng = np.random.default_rng(3)
    exponents = np.array([(i, j, 0) for i in range(5) for j in range(4)])
    return ChebyshevPolynomial([0.1, -2.0, 5.0], [0.4, 3.0, 5.0], exponents, rng.normal(size=(20, 3)))


def test_values_are_those_of_numpys_chebyshev_series(polynomial: ChebyshevPolynomial) -> None:
    points = np.random.default_rng(0).uniform([0.1, -2, 5], [0.4, 3, 5], (50, 3))
    x, y = (points[:, 0] - 0.25) / 0.15, (points[:, 1] - 0.5) / 2.5
    series = polynomial.coefficients.reshape(5, 4, 3)
    np.testing.assert_allclose(polynomial(points), np.polynomial.chebyshev.chebval2d(x, y, series).T, atol=1e-12)
    assert polynomial.degrees.tolist() == [4, 3, 0]


def test_the_gradient_is_that_of_differences(polynomial: ChebyshevPolynomial) -> None:
    points = np.random.default_rng(1).uniform([0.1, -2, 5], [0.4, 3, 5], (20, 3))
    gradient = polynomial.gradient(points)
    assert gradient.shape == (20, 3, 3)
    for k, step in enumerate([1e-6, 1e-5]):
        shift = step * np.eye(3)[k]
        differences = (polynomial(points + shift) - polynomial(points - shift)) / (2 * step)
        np.testing.assert_allclose(gradient[:, :, k], differences, rtol=1e-6, atol=1e-6)
    assert not gradient[:, :, 2].any()


def test_the_ends_of_its_box_are_exact() -> None:
    polynomial = ChebyshevPolynomial([0.1], [0.7], [[5]], [[1.0]])
    assert polynomial([[0.1], [0.7]]).tolist() == [[-1.0], [1.0]]


@pytest.mark.parametrize(
    ("lower", "exponents", "sentence"),
    [
        (
            [0.0, 0.0],
            [[1]],
            "a polynomial has bounds of shapes (2,) and (1,), exponents of shape (1, 1) and coefficients of shape "
            "(1, 1); expected (d,), (d,), (terms, d) and (terms, outputs)",
        ),
        (
            [1.0],
            [[1]],
            "a polynomial has a degree above zero in a direction without width; expected zero there",
        ),
    ],
)
def test_a_polynomial_that_is_none_is_refused(lower: list, exponents: list, sentence: str) -> None:
    with pytest.raises(InputError, match=says(sentence)):
        ChebyshevPolynomial(lower, [1.0], exponents, [[1.0]])


def test_points_of_another_shape_are_refused(polynomial: ChebyshevPolynomial) -> None:
    with pytest.raises(InputError, match=says("points of shape (3,) were given; expected (n, 3)")):
        polynomial([0.1, 0.2, 5.0])
