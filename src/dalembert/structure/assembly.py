"""Finite elements: the library of their shape functions, the sizes of meshes, the assembly of element matrices.

The shape functions, meshes and quadratures are scikit-fem's. Its own assembly evaluates a form once for each pair of
local functions, 3,600 times for a brick of 20 nodes; products of the arrays of all elements at once are faster.
"""

from collections.abc import Sequence
from importlib import import_module
from typing import Any

import numpy as np
from scipy.sparse import coo_array, csc_array

from dalembert.arguments import is_integer, is_number
from dalembert.errors import InputError, shown

PACKAGES = {"skfem": "scikit-fem"}
_COUNTS = {2: "two", 3: "three"}


def library(name: str, what: str) -> Any:
    """Import a module that comes with the extra ``fem``."""
    try:
        return import_module(name)
    except ImportError:
        raise InputError(
            f"{what}: {PACKAGES.get(name, name)} is needed and not installed; run: pip install 'dalembert[fem]'"
        ) from None


def require_lengths(where: str, what: str, lengths: Sequence, count: int) -> None:
    """Refuse lengths that are not ``count`` positive numbers."""
    if len(lengths) != count or not all(is_number(length) and np.real(length) > 0 for length in lengths):
        raise InputError(f"{where}: {what} is {shown(lengths)}; expected {_COUNTS[count]} positive numbers in m")


def require_counts(where: str, counts: Sequence, count: int) -> None:
    """Refuse numbers of elements that are not ``count`` positive whole numbers."""
    if len(counts) != count or not all(is_integer(number) and number > 0 for number in counts):
        raise InputError(f"{where}: elements is {shown(counts)}; expected {_COUNTS[count]} positive whole numbers")


def assemble(local: np.ndarray, dofs: np.ndarray, size: int) -> csc_array:
    """Assemble element matrices (elements, m, m) at their degrees of freedom (elements, m), shape (size, size).

    Made exactly symmetric: the two sums that meet across the diagonal round differently.
    """
    rows = np.repeat(dofs, dofs.shape[1], axis=1).ravel()
    columns = np.tile(dofs, dofs.shape[1]).ravel()
    total = csc_array(coo_array((local.ravel(), (rows, columns)), shape=(size, size)))
    return csc_array((total + total.T) / 2)
