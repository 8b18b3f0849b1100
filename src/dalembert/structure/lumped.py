"""Structures of point masses and springs."""

from collections.abc import Mapping, Sequence

import numpy as np

from dalembert.arguments import takes_checked
from dalembert.errors import InputError, shown, unknown
from dalembert.structure.dofs import DIRECTIONS, Dofs
from dalembert.structure.springs import Spring, with_springs
from dalembert.structure.structure import Structure


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
