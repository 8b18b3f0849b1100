"""What of a response over frequency is looked at: which degrees of freedom, which contacts, which point."""

from collections.abc import Sequence

import numpy as np

from dalembert.report.needs_frequency import CurveFamilyLike, FrequencyCurveLike

UNITS = {"x": "m", "y": "m", "z": "m", "rx": "rad", "ry": "rad", "rz": "rad", "rxy": "1/m", "q": "m √kg"}
MOST = 6
"""Lines that a figure shows unless more are named."""


def unit_of(dof: str) -> str:
    """Unit of a degree of freedom, by its direction.

    >>> unit_of("A.x"), unit_of("A.ry")
    ('m', 'rad')
    """
    return UNITS.get(dof.rpartition(".")[2], "m")


def size_label(kind: str) -> str:
    """What a kind of amplitude is called on an axis.

    >>> size_label("peak"), size_label("rms"), size_label("harmonic 1")
    ('amplitude', 'rms', 'amplitude of harmonic 1')
    """
    return {"peak": "amplitude", "rms": "rms"}.get(kind, f"amplitude of {kind}")


def largest(curve: FrequencyCurveLike, dof: str, kind: str = "peak") -> float:
    """Largest amplitude of a degree of freedom among the points that were found; 0 if none was."""
    return float(np.nanmax(curve.amplitude(dof, kind)[curve.converged], initial=0.0))


def chosen_dofs(curve: FrequencyCurveLike, dofs: Sequence[str] | None = None, kind: str = "peak") -> tuple[str, ...]:
    """The degrees of freedom given, or those that move most, displacements before rotations and modes."""
    if dofs:
        return tuple(dofs)
    kinds = [[dof for dof in curve.dofs if unit_of(dof) == unit] for unit in dict.fromkeys(UNITS.values())]
    own = next(filter(None, kinds), list(curve.dofs))
    moving = set(foremost({dof: largest(curve, dof, kind) for dof in own}))
    return tuple(dof for dof in own if dof in moving)


def main_dof(curve: FrequencyCurveLike, dofs: Sequence[str] | None = None, kind: str = "peak") -> str:
    """The one of some degrees of freedom that moves most, the first where several do."""
    return max(chosen_dofs(curve, dofs, kind), key=lambda dof: largest(curve, dof, kind))


def family_dofs(family: CurveFamilyLike, kind: str = "peak") -> tuple[str, ...]:
    """The degree of freedom that moves most in the first curve there is; none where there is none."""
    found = (curve for curve in family.curves if curve is not None and curve.converged.any())
    return next(((main_dof(curve, kind=kind),) for curve in found), ())


def at_peak(curve: FrequencyCurveLike, dof: str, kind: str = "peak") -> int:
    """Number of the point with the largest amplitude."""
    return int(np.nanargmax(np.where(curve.converged, curve.amplitude(dof, kind), np.nan)))


def foremost(sizes: dict[str, float], most: int = MOST) -> tuple[str, ...]:
    """The names with the largest numbers, in the order given.

    >>> foremost({"a": 1.0, "b": 3.0, "c": 2.0}, 2)
    ('b', 'c')
    """
    kept = set(sorted(sizes, key=lambda name: -sizes[name])[:most])
    return tuple(name for name in sizes if name in kept)


def of_contacts(curve: FrequencyCurveLike) -> dict[str, list[str]]:
    """The coordinates of each contact: its tangential directions, then its normal one if it has one."""
    return {contact: [name for name in curve.coordinates if _owner(name) == contact] for contact in curve.contacts}


def of_springs(curve: FrequencyCurveLike) -> list[str]:
    """The coordinates of all other elements."""
    contacts = set(curve.contacts)
    return [name for name in curve.coordinates if _owner(name) not in contacts]


def dissipation_of(curve: FrequencyCurveLike) -> dict[str, np.ndarray]:
    """Energy that each contact takes from the motion in a period, J, (points,)."""
    return {
        contact: np.sum([curve.dissipated(name) for name in names], axis=0)
        for contact, names in of_contacts(curve).items()
    }


def marked(curve: FrequencyCurveLike) -> dict[str, list[int]]:
    """Points where the path turns back or changes its stability, by what they are."""
    found: dict[str, list[int]] = {}
    for kind, point in curve.markers:
        found.setdefault(kind, []).append(point)
    return found


def unstable(curve: FrequencyCurveLike) -> np.ndarray:
    """Whether each point is known to be unstable, (points,)."""
    return np.asarray(curve.stable) == 0


def _owner(coordinate: str) -> str:
    return coordinate.rpartition(".")[0]
