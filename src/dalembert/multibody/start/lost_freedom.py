"""Mechanisms that cannot move: joints that leave no freedom."""

from typing import NamedTuple

import numpy as np

from dalembert.errors import ModelError
from dalembert.findings import Finding
from dalembert.multibody.model.evaluate import constraint_jacobian
from dalembert.multibody.model.lowered import Lowered

_INDEPENDENT = 1e-9
"""Smallest singular value of a Jacobian with rows of length one, against the largest, of an independent constraint."""


class Locked(NamedTuple):
    """A mechanism that cannot move. ``constraints``: of joints, without prescribed motions and the constraints inside
    of bodies; ``freedoms``: of the bodies without joints; ``joints``: those without which, one at a time, the mechanism
    would move; all if there is none.
    """

    constraints: int
    freedoms: int
    joints: tuple[str, ...]

    @property
    def sentence(self) -> str:
        """What is wrong."""
        return (
            f"The mechanism cannot move: its joints have {self.constraints} constraints, its bodies {self.freedoms} "
            f"degrees of freedom, and none is left."
        )

    @property
    def advice(self) -> str:
        """What to do."""
        names = ", ".join(map(repr, self.joints))
        if len(self.joints) == 1:
            return f"Take joint {names} out, or replace it by one that holds less."
        return (
            f"Take one of the joints {names} out, or replace it by one that holds less. If the chain should move as it "
            "is, check axes and lengths: they have to fit exactly."
        )


def locked(lowered: Lowered) -> Locked | None:
    """Return what locks a mechanism at its start; None if a freedom is left. Prescribed motions do not count."""
    structure = lowered.structure
    n = structure.n
    if structure.size - n < n:
        return None
    owners = np.array(structure.owners[n : structure.size])
    driven = [name for name, (kind, _) in structure.rows.items() if kind.driven]
    holding = ~np.isin(owners, driven)
    if np.sum(holding) < n:
        return None
    jacobian = constraint_jacobian(lowered, np.real(lowered.x)).toarray()
    jacobian /= np.linalg.norm(jacobian, axis=1, keepdims=True) + 1e-300
    if _rank(jacobian[holding]) < n:
        return None
    inside = np.isin(owners, list(lowered.bodies))
    joints = sorted(set(owners[holding & ~inside].tolist()))
    alone = [name for name in joints if _rank(jacobian[holding & (owners != name)]) < n]
    return Locked(int(np.sum(holding & ~inside)), n - int(np.sum(inside)), tuple(alone or joints))


def no_freedom(lowered: Lowered) -> tuple[Finding, ...]:
    """Return a finding on a mechanism whose joints leave no freedom; none if it can move."""
    found = locked(lowered)
    if found is None:
        return ()
    values = {
        "constraints": found.constraints,
        "freedoms": found.freedoms,
        "joints": ", ".join(map(repr, found.joints)),
    }
    return (Finding("no-freedom", "warning", values, found.sentence, found.advice),)


def refuse_locked(lowered: Lowered) -> None:
    """Raise where the joints leave no freedom."""
    found = locked(lowered)
    if found is not None:
        raise ModelError(f"{found.sentence[0].lower()}{found.sentence[1:]} {found.advice}")


def _rank(jacobian: np.ndarray) -> int:
    """Number of independent rows."""
    values = np.linalg.svd(jacobian, compute_uv=False)
    return int(np.sum(values > _INDEPENDENT * values.max(initial=1e-300)))
