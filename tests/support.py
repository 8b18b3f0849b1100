"""What several test files share."""

import re
from collections.abc import Callable

from numba import njit


def says(sentence: str) -> str:
    """Pattern for a message that is this sentence and no more."""
    return f"^{re.escape(sentence)}$"


def from_python(kernel: Callable) -> Callable:
    """A kernel inside a compiled function of its own, which Python can call."""

    @njit
    def called(*arguments):
        return kernel(*arguments)

    return called
