"""What of a response over frequency is looked at: which degrees of freedom, which contacts, which point."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dalembert.units import OF_DIRECTION, unit_of
from dalembert.vibration import CurveFamily, FrequencyCurve

MOST = 6
"""Lines that a figure shows unless more are named."""


@dataclass(frozen=True, eq=False)
class Look:
    """What of a curve is looked at.

    Parameters
    ----------
    curve : FrequencyCurve
        With at least one point that was found.
    dofs : tuple of str
    kind : str
        Of amplitude.
    dof : str
        The one of the dofs that moves most.
    point : int
        Its peak.
    """

    curve: FrequencyCurve
    dofs: tuple[str, ...]
    kind: str
    dof: str
    point: int

    @classmethod
    def of(cls, curve: FrequencyCurve, dofs: Sequence[str] = (), kind: str = "peak") -> "Look":
        """At degrees of freedom that are given, or those that move most; the peak is that of the first to move most."""
        chosen = tuple(dofs) or movers(curve)
        sizes = {dof: np.where(curve.converged, curve.amplitude(dof, kind), np.nan) for dof in chosen}
        dof = max(sizes, key=lambda name: float(np.nanmax(sizes[name])))
        return cls(curve, chosen, kind, dof, int(np.nanargmax(sizes[dof])))


def movers(curve: FrequencyCurve, most: int = MOST) -> tuple[str, ...]:
    """The degrees of freedom that move most, by their rms; displacements before rotations and modes."""
    kinds = [[dof for dof in curve.dofs if unit_of(dof) == unit] for unit in dict.fromkeys(OF_DIRECTION.values())]
    own = next(filter(None, kinds), list(curve.dofs))
    return foremost({dof: float(np.nanmax(curve.amplitude(dof, "rms")[curve.converged])) for dof in own}, most)


def family_dofs(family: CurveFamily, kind: str = "peak") -> tuple[str, ...]:
    """The degree of freedom that moves most in the first curve there is; none where there is none."""
    found = (curve for curve in family.curves if curve is not None and curve.converged.any())
    return next(((Look.of(curve, kind=kind).dof,) for curve in found), ())


def foremost(sizes: dict[str, float], most: int = MOST) -> tuple[str, ...]:
    """The names with the largest numbers, in the order given.

    >>> foremost({"a": 1.0, "b": 3.0, "c": 2.0}, 2)
    ('b', 'c')
    """
    kept = set(sorted(sizes, key=lambda name: -sizes[name])[:most])
    return tuple(name for name in sizes if name in kept)


def of_contacts(curve: FrequencyCurve) -> dict[str, list[str]]:
    """The coordinates of each contact: its tangential directions, then its normal one if it has one."""
    return {contact: [name for name in curve.coordinates if _owner(name) == contact] for contact in curve.contacts}


def of_springs(curve: FrequencyCurve) -> list[str]:
    """The coordinates of all other elements."""
    contacts = set(curve.contacts)
    return [name for name in curve.coordinates if _owner(name) not in contacts]


def dissipation_of(curve: FrequencyCurve) -> dict[str, np.ndarray]:
    """Energy that each contact takes from the motion in a period, J, (points,)."""
    return {
        contact: np.sum([curve.dissipated(name) for name in names], axis=0)
        for contact, names in of_contacts(curve).items()
    }


def marked(curve: FrequencyCurve) -> dict[str, list[int]]:
    """Points where the path turns back or changes its stability, by what they are."""
    found: dict[str, list[int]] = {}
    for kind, point in curve.markers:
        found.setdefault(kind, []).append(point)
    return found


def unstable(curve: FrequencyCurve) -> np.ndarray:
    """Whether each point is known to be unstable, (points,)."""
    return np.asarray(curve.stable) == 0


def _owner(coordinate: str) -> str:
    return coordinate.rpartition(".")[0]
