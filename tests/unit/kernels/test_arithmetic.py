"""Kernels in real and in complex numbers, kernels with given arguments, products by the BLAS."""

import numpy as np
import pytest

from dalembert.kernels.arithmetic import Numbers, Numbers2, kernels
from dalembert.kernels.blas import applied, gemm, gemv, product
from dalembert.kernels.kernel import kernel
from dalembert.kernels.words import Address, Bytes, Reals, Reals2


def _weigh(rows: Numbers2, marks: Bytes, factor: float, out: Numbers) -> int:
    last = 0
    for i in range(len(out)):
        out[i] = factor * rows[i, 0] * rows[i, 0]
        marks[i] = 255 if out[i].real < 0.0 else i
        last = i
    return last


_weigh_real, _weigh_complex = kernels(_weigh)


@pytest.mark.parametrize(("law", "unit"), [(_weigh_real, 1.0), (_weigh_complex, 1j)])
def test_one_function_makes_a_kernel_for_either_kind_of_numbers(law, unit) -> None:
    rows, marks = unit * np.array([[2.0], [3.0]]), np.zeros(2, np.uint8)
    out = np.zeros_like(rows[:, 0])
    assert law(rows, marks, 2.0, out) == 1
    np.testing.assert_array_equal(out, 2.0 * rows[:, 0] ** 2)
    assert marks.tolist() == ([0, 1] if unit == 1.0 else [255, 255])


def test_the_kernels_of_a_function_have_symbols_of_their_own() -> None:
    assert _weigh_real.symbol != _weigh_complex.symbol


def test_arguments_that_are_given_once_are_those_of_each_call() -> None:
    rows, marks = np.array([[2.0], [3.0]]), np.zeros(2, np.uint8)
    weighed = _weigh_real.given(rows, marks)
    for factor in (1.0, 2.0):
        out = np.zeros(2)
        assert weighed(factor, out) == 1
        np.testing.assert_array_equal(out, factor * rows[:, 0] ** 2)


@kernel
def _products(gemm: Address, gemv: Address, a: Reals2, b: Reals2, x: Reals, former: float, c: Reals2, y: Reals) -> None:
    product(gemm, a, b, former, c)
    applied(gemv, a, x, y)


@pytest.mark.parametrize("former", [0.0, 2.0])
@pytest.mark.parametrize("shape", [(1, 1, 1), (2, 3, 4), (7, 100, 5)])
def test_products_are_those_of_the_matrices(shape: tuple[int, int, int], former: float) -> None:
    m, k, n = shape
    rng = np.random.default_rng(0)
    a, b, x, c, y = (rng.normal(size=own) for own in ((m, k), (k, n), k, (m, n), m))
    expected = a @ b + former * c
    _products(gemm(), gemv(), a, b, x, former, c, y)
    np.testing.assert_allclose(c, expected, atol=1e-13)
    np.testing.assert_allclose(y, a @ x, atol=1e-13)
