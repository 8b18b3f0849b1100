"""What a kernel cannot do is said with its line."""

from collections.abc import Callable

import numpy as np
import pytest

from dalembert.errors import ModelError
from dalembert.kernels.kernel import inner
from dalembert.multibody import Kind


def plain(x):
    return x


@inner
def raises(x, p, m, inputs, g):
    if x[0] > 1.0:
        raise ValueError("too far")
    g[0] = x[0]


@inner
def allocates(x, p, m, inputs, g):
    g[0] = np.zeros(3)[0] * x[0]


@inner
def makes_a_list(x, p, m, inputs, g):
    values = [x[0], x[1]]
    g[0] = values[1]


@inner
def prints(x, p, m, inputs, g):
    print(x[0])  # noqa: T201 - it is refused
    g[0] = x[0]


@inner
def calls_python(x, p, m, inputs, g):
    g[0] = plain(x[0])


@inner
def mistypes(x, p, m, inputs, g):
    g[0] = p.lenght * x[0]


@pytest.mark.parametrize(
    ("constraint", "expected"),
    [
        (raises, "a kernel cannot raise an exception. Return nan"),
        (allocates, "a kernel cannot make arrays, lists or texts"),
        (makes_a_list, "a kernel cannot make arrays, lists or texts"),
        (prints, r"a kernel cannot call print. Run the component in plain Python"),
        (calls_python, "Untyped global name 'plain'.*Functions that a kernel calls need 'inner'"),
    ],
)
def test_it_is_refused_with_its_line(constraint: Callable, expected: str) -> None:
    kind = Kind("odd", coordinates=2, multipliers=1, numbers=("length",), constraint=constraint)
    with pytest.raises(ModelError, match=rf"test_refusals\.py, line \d+.*: .*{expected}"):
        kind.kernel("residual", float).object_code()


def test_an_unknown_column_is_named() -> None:
    kind = Kind("odd", coordinates=2, multipliers=1, numbers=("length",), constraint=mistypes)
    with pytest.raises(ModelError, match="A kernel reads 'lenght', but its record has no such column"):
        kind.kernel("residual", float).object_code()
