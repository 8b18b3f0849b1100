"""Jacobians by few complex steps."""

from collections.abc import Callable

import numpy as np
import pytest

from dalembert.forward.sparse_steps import FEW, sparse_jacobian


class Counted:
    """Derivative of linear numbers along directions, counted."""

    def __init__(self, matrix: np.ndarray) -> None:
        self.matrix, self.steps = matrix, 0

    def __call__(self, direction: np.ndarray) -> np.ndarray:
        self.steps += 1
        return self.matrix @ direction


def spline(count: int = 300) -> np.ndarray:
    """Each number depends on four neighbours."""
    random, matrix = np.random.default_rng(0), np.zeros((4 * (count - 3), count))
    for k in range(count - 3):
        matrix[4 * k : 4 * k + 4, k : k + 4] = random.normal(size=(4, 4))
    return matrix


def local_and_common(count: int = 300) -> np.ndarray:
    """Each number depends on a parameter of its part, and most on common ones of other sizes."""
    matrix = np.repeat(np.eye(count), 3, axis=0) * np.random.default_rng(0).normal(size=(3 * count, 1)) * 1e8
    matrix[::3, 0] += 1e-2
    matrix[1::3, 1] = 1e11
    return matrix


@pytest.mark.parametrize(("make", "first", "later"), [(spline, 40, 5), (local_and_common, 100, 4)])
def test_the_price_is_that_of_the_parameters_of_one_number(make: Callable, first: int, later: int) -> None:
    along = Counted(make())
    count = along.matrix.shape[1]
    jacobian, pattern = sparse_jacobian(along, count)
    assert along.steps <= first
    np.testing.assert_array_equal(jacobian.toarray(), along.matrix)
    along.steps = 0
    again, _ = sparse_jacobian(along, count, pattern)
    assert along.steps <= later
    np.testing.assert_array_equal(again.toarray(), along.matrix)


def test_a_dense_jacobian_takes_a_step_a_parameter() -> None:
    along = Counted(np.random.default_rng(0).normal(size=(50, 60)))
    jacobian, _ = sparse_jacobian(along, 60)
    np.testing.assert_array_equal(jacobian.toarray(), along.matrix)


def test_a_pattern_that_no_longer_holds_is_sought_anew() -> None:
    along = Counted(spline())
    _, pattern = sparse_jacobian(along, 300)
    along.matrix = along.matrix.copy()
    along.matrix[7, 250] = 0.3
    jacobian, _ = sparse_jacobian(along, 300, pattern)
    np.testing.assert_array_equal(jacobian.toarray(), along.matrix)


def test_parameters_without_effect_have_empty_columns() -> None:
    jacobian, _ = sparse_jacobian(Counted(np.zeros((5, 100))), 100)
    assert jacobian.shape == (5, 100)
    assert jacobian.nnz == 0


def test_few_parameters_are_moved_one_by_one() -> None:
    along = Counted(np.ones((3, FEW)))
    sparse_jacobian(along, FEW)
    assert along.steps == FEW
