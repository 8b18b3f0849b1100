"""Kernels called from Python and from each other."""

import numpy as np
import pytest

from dalembert.kernels.kernel import kernel
from dalembert.kernels.words import Reals, Reals2
from small_kernels import both, pair, weighted


def test_arguments_arrive_and_results_come_back() -> None:
    out = np.zeros(2)
    assert weighted(pair(1.0, 2.0, 4.0), 0.5, out) == 10.5
    assert out.tolist() == [3.5, 0.0]


@pytest.mark.parametrize(("turned", "sign"), [(False, 1), (True, -1)])
def test_a_kernel_calls_another_one(turned: bool, sign: int) -> None:
    rows, marks = np.zeros((3, 2)), np.zeros(4, np.int64)
    assert both(pair(1.0, 2.0, turned=turned), rows, marks) == (4, sign * 18.0)
    assert rows.tolist() == [[0.0, 0.0], [6.0, 0.0], [0.0, 0.0]]
    assert marks.tolist() == [3, 0, 0, 0]


def test_a_kernel_is_called_by_its_address_too() -> None:
    out = np.zeros(1)
    assert weighted.at(weighted.address, pair(1.0), 2.0, out) == 6.0


@pytest.mark.parametrize(
    "out", [np.zeros(2, np.float32), np.zeros((2, 2)), np.zeros(4)[::2]], ids=["dtype", "axes", "strides"]
)
def test_an_array_of_another_form_is_refused(out: np.ndarray) -> None:
    with pytest.raises(TypeError, match=r"^weighted: out is an array of .*expected a contiguous one of float64"):
        weighted(pair(1.0), 1.0, out)


def test_an_argument_without_a_form_is_refused() -> None:
    def function(text: str) -> None:
        """Takes what no kernel takes."""

    with pytest.raises(TypeError, match="cannot be an argument of a kernel"):
        kernel(function)


@kernel
def scaled(rows: Reals2, factor: float, out: Reals) -> None:
    for i in range(len(out)):
        out[i] = factor * rows[i, 0]


def test_an_empty_array_is_taken() -> None:
    scaled(np.zeros((0, 3)), 1.0, np.zeros(0))
