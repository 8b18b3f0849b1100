"""Which changes of a source make a kernel another one."""

from collections.abc import Callable

import numpy as np

from dalembert.kernels import digest
from dalembert.kernels.kernel import inner

SOURCE = """
from dalembert.kernels.kernel import inner

FACTOR = 2.0
WEIGHTS = np.array([1.0, 2.0])

@inner
def inside(x):
    return FACTOR * x

def outer(x):
    '''What it returns.'''
    return inside(x) + WEIGHTS[0]
"""


def digested(source: str) -> str:
    space: dict = {"np": np, "__name__": "a_users_module"}
    exec(compile(source, "source", "exec"), space)
    return digest.digest(space["outer"])


def test_the_same_source_has_the_same_digest() -> None:
    assert digested(SOURCE) == digested(SOURCE)


def test_comments_and_docstrings_do_not_matter() -> None:
    assert digested(SOURCE.replace("What it returns.", "Another text.")) == digested(SOURCE)
    assert digested(SOURCE.replace("    return inside", "    # why\n    return inside")) == digested(SOURCE)


def test_what_is_reached_matters() -> None:
    changes = {"FACTOR = 2.0": "FACTOR = 3.0", "FACTOR * x": "FACTOR + x", "[1.0, 2.0]": "[1.0, 2.5]"}
    digests = {digested(SOURCE.replace(old, new)) for old, new in changes.items()}
    assert len(digests | {digested(SOURCE)}) == len(changes) + 1


def test_what_is_not_reached_does_not_matter() -> None:
    assert digested(SOURCE + "\nUNUSED = 1.0\n") == digested(SOURCE)


def closing_over(value: float) -> Callable:
    @inner
    def function(x):
        return value * x

    return function


def test_closed_over_values_matter() -> None:
    first, second = (digest.digest(closing_over(value).py_func) for value in (1.0, 2.0))
    assert first != second
    assert digest.digest(closing_over(1.0).py_func) == first
