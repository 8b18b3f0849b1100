"""Springs and dampers between degrees of freedom of a structure, and structures of masses with them."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.sparse import csc_array, issparse

from dalembert.arguments import is_number, takes_checked
from dalembert.errors import InputError, shown, unknown
from dalembert.structure.dofs import DIRECTIONS, Dofs
from dalembert.structure.structure import Matrix, Structure, checked_factor

Spring = tuple[str, str | None, complex, complex] | tuple[str, str | None, complex, complex, complex]
"""First and second degree of freedom (None for the ground), stiffness in N/m, damping in N s/m, maybe a loss factor."""


@takes_checked("springs")
def lumped(masses: Mapping[str, float | complex], springs: Sequence[Spring]) -> Structure:
    """A structure of masses that move along x, and springs with dampers between them or to the ground.

    Parameters
    ----------
    masses : mapping of str to float
        kg, by name; the degree of freedom of the mass ``"a"`` is ``"a.x"``, or ``"a"`` for short. A mass that moves
        along several axes is given for each of them: ``"a.x"``, ``"a.y"``.
    springs : sequence of (first, second, stiffness, damping) or (first, second, stiffness, damping, loss factor)
        Names of two masses (None for the ground), N/m and N s/m; the loss factor η of hysteretic damping is 0 if not
        given: the spring then has the complex stiffness k (1 + i η) under harmonic motion.

    Raises
    ------
    InputError
        For a spring on a mass that is not there.

    Examples
    --------
    >>> chain = lumped({"a": 1.0, "b": 2.0}, [("a", None, 3.0, 0.1), ("a", "b", 1.0, 0.0)])
    >>> chain.stiffness.tolist(), chain.dofs.names
    ([[4.0, -1.0], [-1.0, 1.0]], ('a.x', 'b.x'))
    """
    if not isinstance(springs, Sequence):
        raise InputError(f"lumped: springs is {shown(springs)}; expected a list, such as [('a', None, 3.0, 0.1)]")
    names = list(masses)
    for number, spring in enumerate(springs):
        for end in spring[:2] if isinstance(spring, Sequence) else ():
            if end is not None and end not in masses:
                raise InputError(unknown("mass", end, names, f"lumped: spring {number + 1}"))
    dofs = Dofs(tuple(name if name.rpartition(".")[2] in DIRECTIONS else f"{name}.x" for name in names))
    mass = np.diag(np.array(list(masses.values()), dtype=np.result_type(float, *masses.values())))
    return with_springs(Structure(mass, np.zeros(mass.shape), dofs, np.zeros(mass.shape)), springs)


def with_springs(structure: Structure, springs: Sequence[Spring]) -> Structure:
    """Return the structure with springs and dampers between degrees of freedom, or between one and the ground.
    ``springs``: (first, second, stiffness, damping) or (first, second, stiffness, damping, loss factor): degrees of
    freedom (None for the ground), N/m and N s/m; the loss factor η of hysteretic damping is 0 if not given.
    """
    if not springs:
        return structure
    rows, numbers = np.zeros((structure.size, len(springs))), []
    for number, spring in enumerate(springs):
        numbers.append(_numbers(spring, number))
        first, second = spring[:2]
        for end, sign in ((first, 1.0), (second, -1.0)):
            if end is not None:
                rows[structure.dofs.index(end, f"spring {number + 1}"), number] += sign
    ends = csc_array(rows) if issparse(structure.stiffness) else rows
    stiffness, damping, factors = (np.array(sizes) for sizes in zip(*numbers, strict=True))

    def added(matrix: Matrix | None, sizes: np.ndarray) -> Matrix:
        return (0.0 * structure.mass if matrix is None else matrix) + (ends * sizes) @ ends.T

    return replace(
        structure,
        stiffness=added(structure.stiffness, stiffness),
        damping=added(structure.damping, damping),
        loss=added(structure.loss, factors * stiffness) if np.any(factors) else structure.loss,
    )


def _numbers(spring: Any, number: int) -> tuple[complex, complex, complex]:
    where = f"spring {number + 1}"
    if not isinstance(spring, Sequence) or isinstance(spring, str) or len(spring) not in (4, 5):
        raise InputError(
            f"{where} is {shown(spring)}; expected (first, second, stiffness, damping), perhaps with a loss factor"
        )
    first, second, *numbers = spring
    for what, value in zip(("stiffness", "damping"), numbers, strict=False):
        if not is_number(value):
            raise InputError(f"{where}: the {what} is {shown(value)}; expected a finite number")
    if first == second:
        raise InputError(f"{where} connects {first!r} with itself; expected two ends, None for the ground")
    factor = checked_factor(f"{where}: the loss factor", numbers[2]) if len(numbers) == 3 else 0.0
    return numbers[0], numbers[1], factor
