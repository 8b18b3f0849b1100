"""Structures of point masses and springs on one axis."""

from collections.abc import Mapping, Sequence

import numpy as np

from dalembert.errors import InputError, unknown
from dalembert.structure.dofs import Dofs
from dalembert.structure.structure import Structure

Spring = tuple[str, str | None, float, float]


def lumped(masses: Mapping[str, float], springs: Sequence[Spring]) -> Structure:
    """A structure of masses that move along x, and springs with dampers between them or to the ground.

    Parameters
    ----------
    masses : mapping of str to float
        kg, by name; the degree of freedom of the mass ``"a"`` is ``"a.x"``, or ``"a"`` for short.
    springs : sequence of (first, second, stiffness, damping)
        Names of two masses (None for the ground), N/m and N s/m.

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
    names = list(masses)
    places = {name: place for place, name in enumerate(names)}
    kind = np.result_type(float, *masses.values(), *(value for *_, k, c in springs for value in (k, c)))
    stiffness, damping = np.zeros((2, len(names), len(names)), dtype=kind)
    for number, (first, second, k, c) in enumerate(springs):
        row: dict[int, float] = {}
        for end, sign in ((first, 1.0), (second, -1.0)):
            if end is None:
                continue
            if end not in masses:
                raise InputError(unknown("mass", end, names, f"lumped: spring {number + 1}"))
            row[places[end]] = row.get(places[end], 0.0) + sign
        block, signs = np.ix_(list(row), list(row)), list(row.values())
        stiffness[block] += k * np.outer(signs, signs)
        damping[block] += c * np.outer(signs, signs)
    mass = np.diag(np.array(list(masses.values()), dtype=kind))
    return Structure(mass, stiffness, Dofs(tuple(f"{name}.x" for name in names)), damping)
