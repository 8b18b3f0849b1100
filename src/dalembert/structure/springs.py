"""Springs and dampers between degrees of freedom of a structure."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.sparse import csc_array, issparse

from dalembert.errors import InputError
from dalembert.structure.structure import Structure

Spring = tuple[str, str | None, complex, complex]
"""First and second degree of freedom (None for the ground), stiffness in N/m and damping in N s/m."""


def with_springs(structure: Structure, springs: Sequence[Spring]) -> Structure:
    """The structure with springs and dampers between its degrees of freedom, or between one and the ground.

    Parameters
    ----------
    structure : Structure
    springs : sequence of (first, second, stiffness, damping)
        Degrees of freedom (None for the ground), N/m and N s/m.

    Raises
    ------
    InputError
        For a degree of freedom that is not there.

    Examples
    --------
    >>> from dalembert.structure import lumped
    >>> with_springs(lumped({"a": 1.0, "b": 1.0}, []), [("a", "b", 5.0, 0.0)]).stiffness.tolist()
    [[5.0, -5.0], [-5.0, 5.0]]
    """
    if not springs:
        return structure
    rows = np.zeros((structure.size, len(springs)))
    for number, (first, second, *_) in enumerate(springs):
        for end, sign in ((first, 1.0), (second, -1.0)):
            if end is not None:
                rows[_row(structure, end, number), number] += sign
    ends = csc_array(rows) if issparse(structure.stiffness) else rows
    stiffness, damping = ((ends * np.array(sizes)) @ ends.T for sizes in list(zip(*springs, strict=True))[2:])
    own = 0.0 * structure.mass if structure.damping is None else structure.damping
    return replace(structure, stiffness=structure.stiffness + stiffness, damping=own + damping)


def _row(structure: Structure, dof: str, number: int) -> int:
    try:
        return structure.dofs.index(dof)
    except InputError as error:
        raise InputError(f"spring {number + 1}: {error}") from None
