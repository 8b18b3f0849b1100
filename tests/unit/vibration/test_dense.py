"""Small dense matrices in compiled code."""

import numpy as np
import pytest

from dalembert.kernels.blas import gemv
from dalembert.kernels.kernel import kernel
from dalembert.kernels.words import Address, Reals, Reals2
from dalembert.vibration.dense import LARGE, apply, invert


@kernel
def _invert(matrix: Reals2, inverse: Reals2) -> None:
    invert(matrix, inverse)


@kernel
def _apply(gemv: Address, matrix: Reals2, x: Reals, y: Reals) -> None:
    apply(gemv, matrix, x, y)


@pytest.mark.parametrize("size", [1, 2, 3, 8, 30])
def test_the_inverse_is_found_with_pivots(size: int) -> None:
    matrix, inverse = np.random.default_rng(size).normal(size=(size, size)), np.empty((size, size))
    if size > 1:
        matrix[0, 0] = 0.0
    _invert(matrix.copy(), inverse)
    np.testing.assert_allclose(inverse @ matrix, np.eye(size), atol=1e-11)


def test_a_singular_matrix_has_no_finite_inverse() -> None:
    inverse = np.empty((2, 2))
    _invert(np.ones((2, 2)), inverse)
    assert not np.isfinite(inverse).all()


@pytest.mark.parametrize("columns", [1, 5, LARGE])
def test_a_matrix_is_applied_in_loops_or_by_the_blas(columns: int) -> None:
    rng = np.random.default_rng(0)
    matrix, x, y = rng.normal(size=(3, columns)), rng.normal(size=columns), np.empty(3)
    _apply(gemv(), matrix, x, y)
    np.testing.assert_allclose(y, matrix @ x, atol=1e-12)
