"""Whole powers carry a complex step, at negative numbers too."""

import numpy as np
import pytest

from dalembert.kernels.kernel import kernel
from dalembert.kernels.words import Complexes, Reals


@kernel
def powers(x: Complexes, y: Complexes) -> None:
    a = x[0]
    y[0], y[1], y[2], y[3] = a**2, a**3, a**4, a**5
    y[4], y[5], y[6] = a**3.0, (a + 1.0) ** 7, a**13
    y[7] = a
    y[7] **= 6


@kernel
def real_powers(x: Reals, y: Reals) -> None:
    y[0], y[1], y[2] = x[0] ** 2, x[0] ** 3, x[0] ** 5


EXPONENTS = np.array([2, 3, 4, 5, 3, 7, 13, 6])


@pytest.mark.parametrize("value", [-0.3, 0.7, -1.9])
def test_whole_powers_carry_a_complex_step(value: float) -> None:
    y = np.zeros(8, complex)
    powers(np.array([value + 1e-30j]), y)
    base = np.full(8, value)
    base[5] += 1.0
    np.testing.assert_allclose(y.real, base**EXPONENTS, rtol=1e-14)
    np.testing.assert_allclose(y.imag / 1e-30, EXPONENTS * base ** (EXPONENTS - 1), rtol=1e-14)


def test_powers_of_real_numbers_are_those_of_numpy() -> None:
    y = np.zeros(3)
    real_powers(np.array([-0.7]), y)
    np.testing.assert_allclose(y, [0.49, -0.343, -0.16807], rtol=1e-15)
