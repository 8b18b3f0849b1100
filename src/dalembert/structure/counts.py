"""Checks of the sizes of meshes."""

from collections.abc import Sequence

import numpy as np

from dalembert.arguments import is_number, is_whole
from dalembert.errors import InputError, shown

_COUNTS = {2: "two", 3: "three"}


def require_lengths(where: str, what: str, given: Sequence, count: int) -> None:
    """Refuse lengths that are not ``count`` positive numbers.

    Raises
    ------
    InputError
    """
    if len(given) != count or not all(is_number(one) and np.real(one) > 0 for one in given):
        raise InputError(f"{where}: {what} is {shown(given)}; expected {_COUNTS[count]} positive numbers in m")


def require_counts(where: str, given: Sequence, count: int) -> None:
    """Refuse numbers of elements that are not ``count`` positive whole numbers.

    Raises
    ------
    InputError
    """
    if len(given) != count or not all(is_whole(one) and one > 0 for one in given):
        raise InputError(f"{where}: elements is {shown(given)}; expected {_COUNTS[count]} positive whole numbers")
