"""The linear systems of the integrators against NumPy's."""

import numpy as np
import pytest

from dalembert.multibody.kernels import linear
from dalembert.multibody.kernels.linear import BAND, DENSE, Layout, dense_layout, factorise, solve


def band_layout(size: int, reach: int) -> Layout:
    return linear.band_layout(np.random.default_rng(1).permutation(size), linear.padded(reach))


def place(layout: Layout, i: int, j: int) -> int:
    """Where an entry is stored."""
    if layout.kind == DENSE:
        return j * layout.lead + i
    i, j = layout.order[i], layout.order[j]
    return j * layout.lead + 2 * layout.reach + i - j


def solved(layout: Layout, matrix: np.ndarray, given: np.ndarray) -> np.ndarray | None:
    factors = linear.storage(layout)
    for i, j in zip(*np.nonzero(matrix), strict=True):
        factors.matrix[place(layout, i, j)] = matrix[i, j]
    if not factorise(layout, factors):
        return None
    answer = np.zeros(layout.size + 1)
    solve(layout, factors, np.append(given, 0.0), answer)
    return answer[:-1]


def random(layout: Layout, zeros: float) -> np.ndarray:
    """A matrix that the layout holds, with a share of ``zeros`` on its diagonal, which asks for exchanged rows."""
    chance = np.random.default_rng(layout.size)
    matrix = chance.normal(size=(layout.size, layout.size))
    if layout.kind == BAND:
        matrix[np.abs(layout.order[:, None] - layout.order) > layout.reach] = 0.0
    matrix[np.diag_indices(layout.size)] *= chance.random(layout.size) >= zeros
    return matrix


@pytest.mark.parametrize(
    "layout",
    [dense_layout(2), dense_layout(10), dense_layout(53), band_layout(9, 3), band_layout(60, 8), band_layout(131, 17)],
)
@pytest.mark.parametrize("zeros", [0.0, 0.3, 1.0])
def test_it_solves_what_numpy_solves(layout: Layout, zeros: float) -> None:
    matrix, given = random(layout, zeros), np.random.default_rng(0).normal(size=layout.size)
    answer = solved(layout, matrix, given)
    assert answer is not None
    expected = np.linalg.solve(matrix, given)
    rounding = 1e-14 * np.linalg.cond(matrix) * np.abs(expected).max()
    np.testing.assert_allclose(answer, expected, rtol=0, atol=rounding)


@pytest.mark.parametrize("layout", [dense_layout(6), band_layout(12, 4)])
def test_a_singular_matrix_is_said_to_be_one(layout: Layout) -> None:
    matrix = random(layout, 0.0)
    matrix[:, 3] = 0.0
    assert solved(layout, matrix, np.ones(layout.size)) is None


@pytest.mark.parametrize("layout", [dense_layout(6), band_layout(12, 4)])
def test_what_is_not_a_number_stays_visible(layout: Layout) -> None:
    matrix = random(layout, 0.0)
    matrix[:, 3] = np.nan
    answer = solved(layout, matrix, np.ones(layout.size))
    assert answer is not None
    assert np.isnan(answer).any()
