import numpy as np

from dalembert.surrogate.leja import hierarchical, leja


def test_each_point_is_where_the_product_of_the_distances_is_largest() -> None:
    points = leja(12)
    everywhere = np.linspace(-1, 1, 20_001)
    for number in range(3, 12):
        products = np.prod(np.abs(everywhere[:, None] - points[:number]), axis=1)
        assert np.prod(np.abs(points[number] - points[:number])) >= products.max() * (1 - 1e-9)


def test_points_never_move() -> None:
    np.testing.assert_array_equal(leja(9), leja(30)[:9])
    assert len(np.unique(leja(30))) == 30


def test_hierarchical_polynomials_are_no_larger_than_one_and_their_series_are_theirs() -> None:
    values, series = hierarchical(15)
    np.testing.assert_allclose(np.polynomial.chebyshev.chebval(leja(15), series.T), values, atol=1e-11)
    np.testing.assert_allclose(np.diag(values), 1, atol=0)
    everywhere = np.polynomial.chebyshev.chebval(np.linspace(-1, 1, 2001), series.T)
    assert np.abs(everywhere).max() < 1 + 1e-9
