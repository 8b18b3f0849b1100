"""Small kernels that several test files compile."""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Integers, Reals, Reals2


class Pair(NamedTuple):
    """A number of values, the values, and whether their sign turns."""

    count: int
    values: Reals
    turned: bool


@inner
def total(pair, factor):
    result = 0.0
    for i in range(pair.count):
        result += factor * pair.values[i]
    return result


@kernel
def weighted(pair: Pair, factor: float, out: Reals) -> float:
    """Write the sum, and return it thrice."""
    out[0] = total(pair, factor)
    return 3.0 * out[0]


@kernel
def both(pair: Pair, rows: Reals2, marks: Integers) -> tuple[int, float]:
    """Call another kernel with a row of a matrix."""
    result = weighted(pair, 2.0, rows[1])
    marks[0] = len(rows)
    return len(marks), -result if pair.turned else result


def pair(*values: float, turned: bool = False) -> Pair:
    return Pair(len(values), np.array(values), turned)
