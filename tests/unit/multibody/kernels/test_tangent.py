"""The matrix of Newton's iteration against derivatives of the residual."""

import numpy as np
import pytest

import mechanisms
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.model.evaluate import residual, tangent
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.lowering import lower

TIME = 0.37
BY = (0.7, 1.3, 0.4)


def state(lowered: Lowered) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates near the first ones, any multipliers and velocities."""
    noise = np.random.default_rng(0).normal(size=(2, len(lowered.x)))
    n = lowered.structure.n
    x, v = lowered.x + 0.1 * noise[0], noise[1]
    x[n:], v[n:] = 5 * noise[0, n:], 0.0
    x[-1] = 0.0
    return x, v


def directions(lowered: Lowered, column: int) -> np.ndarray:
    """Directions of coordinates, velocities and accelerations that belong to a column, (3, N + 1)."""
    moved = np.zeros((3, len(lowered.x)))
    moved[:, column] = BY if column < lowered.structure.n else (1.0, 0.0, 0.0)
    return moved


@pytest.fixture(scope="module")
def everything() -> Lowered:
    return lower(mechanisms.mechanism(*mechanisms.PIECES))


def test_it_is_the_complex_step_of_the_residual(everything: Lowered) -> None:
    x, v = state(everything)
    matrix = tangent(everything, x, v, BY, t=TIME).toarray()
    for column in range(everything.structure.size):
        dx, dv, da = 1j * STEP * directions(everything, column)
        exact = residual(everything, everything.complex_model, x + dx, v + dv, da, TIME).imag / STEP
        np.testing.assert_allclose(matrix[:, column], exact, rtol=0, atol=1e-12 * np.abs(exact).max())


@pytest.mark.parametrize("piece", mechanisms.PIECES)
def test_it_is_the_slope_of_the_residual_in_real_numbers(piece: str) -> None:
    lowered = lower(mechanisms.mechanism(piece))
    x, v = state(lowered)
    matrix = tangent(lowered, x, v, BY, t=TIME).toarray()

    def moved(column: int, h: float) -> np.ndarray:
        dx, dv, da = h * directions(lowered, column)
        return residual(lowered, lowered.real, x + dx, v + dv, da, TIME)

    h = 1e-3
    for column in range(lowered.structure.size):
        near, far = ((moved(column, k * h) - moved(column, -k * h)) / (2 * k * h) for k in (1, 2))
        slope = (4 * near - far) / 3
        np.testing.assert_allclose(matrix[:, column], slope, rtol=0, atol=1e-6 * np.abs(slope).max())


def test_it_is_symmetric_where_forces_have_a_potential() -> None:
    lowered = lower(mechanisms.mechanism(*mechanisms.CONSERVATIVE))
    x, v = state(lowered)
    matrix = tangent(lowered, x, v, (1.0, 0.0, 0.0), t=TIME).toarray()
    np.testing.assert_allclose(matrix, matrix.T, rtol=0, atol=1e-13 * np.abs(matrix).max())


def test_the_mass_matrix_is_positive(everything: Lowered) -> None:
    n = everything.structure.n
    x, v = state(everything)
    mass = tangent(everything, x, v, (0.0, 0.0, 1.0))[:n, :n].toarray()
    np.testing.assert_allclose(mass, mass.T, rtol=0, atol=1e-15 * np.abs(mass).max())
    counted = np.array([owner.endswith(".joint") for owner in everything.structure.owners[:n]])  # without mass
    assert np.linalg.eigvalsh(mass[np.ix_(~counted, ~counted)])[0] > 0
    assert not mass[counted].any()


def test_rows_are_scaled_apart(everything: Lowered) -> None:
    n = everything.structure.n
    x, v = state(everything)
    plain, scaled = (tangent(everything, x, v, BY, rows, TIME).toarray() for rows in ((1.0, 1.0), (2.0, 0.25)))
    np.testing.assert_array_equal(scaled[:n], 2.0 * plain[:n])
    np.testing.assert_array_equal(scaled[n:], 0.25 * plain[n:])
