"""What of a response over frequency is looked at: which degrees of freedom, which contacts, which point."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from dalembert.units import OF_DIRECTION, unit_of
from dalembert.vibration.laws.friction_law import STATES

if TYPE_CHECKING:
    from dalembert.vibration.paths.curve import FrequencyCurve

MOST = 6
"""Lines that a figure shows unless more are named."""


@dataclass(frozen=True, eq=False)
class Look:
    """What of a ``curve`` with at least one converged point is looked at.

    ``kind``: of amplitude; ``dof``: the one of the ``dofs`` that moves most; ``point``: its peak.
    """

    curve: "FrequencyCurve"
    dofs: tuple[str, ...]
    kind: str
    dof: str
    point: int

    @classmethod
    def of(cls, curve: "FrequencyCurve", dofs: Sequence[str] = (), kind: str = "peak") -> "Look":
        """At degrees of freedom that are given, or those that move most; the peak is that of the first to move most."""
        chosen = tuple(dofs) or movers(curve)
        sizes = {dof: np.where(curve.converged, curve.amplitude(dof, kind), np.nan) for dof in chosen}
        dof = max(sizes, key=lambda name: float(np.nanmax(sizes[name])))
        return cls(curve, chosen, kind, dof, int(np.nanargmax(sizes[dof])))

    @property
    def harmonic_sizes(self) -> dict[int, float]:
        """Amplitude of each harmonic of the degree of freedom at its peak."""
        return {order: float(size[self.point]) for order, size in by_order(self.curve, self.dof).items()}


def movers(curve: "FrequencyCurve", most: int = MOST) -> tuple[str, ...]:
    """The degrees of freedom that move most, by their rms; displacements before rotations and modes."""
    kinds = [[dof for dof in curve.dofs if unit_of(dof) == unit] for unit in dict.fromkeys(OF_DIRECTION.values())]
    alike = next(filter(None, kinds), list(curve.dofs))
    return foremost({dof: float(np.nanmax(curve.amplitude(dof, "rms")[curve.converged])) for dof in alike}, most)


def foremost(sizes: dict[str, float], most: int = MOST) -> tuple[str, ...]:
    """Return the names with the largest numbers, in the order given.
    >>> foremost({"a": 1.0, "b": 3.0, "c": 2.0}, 2)
    ('b', 'c')
    """
    kept = set(sorted(sizes, key=lambda name: -sizes[name])[:most])
    return tuple(name for name in sizes if name in kept)


def by_order(curve: "FrequencyCurve", dof: str) -> dict[int, np.ndarray]:
    """Amplitude of each harmonic, of the mean its size, (points,)."""
    coefficients, mean = curve.harmonics(dof), int(curve.orders[0] == 0)
    sizes = {0: np.abs(coefficients[:, 0])} if mean else {}
    for number, order in enumerate(curve.orders[mean:]):
        place = mean + 2 * number
        sizes[order] = np.hypot(coefficients[:, place], coefficients[:, place + 1])
    return sizes


def of_contacts(curve: "FrequencyCurve") -> dict[str, list[str]]:
    """The coordinates of each contact: its tangential directions, then its normal one if it has one."""
    return {
        contact: [name for name in curve.coordinates if name.rpartition(".")[0] == contact]
        for contact in curve.contacts
    }


def of_springs(curve: "FrequencyCurve") -> list[str]:
    """The coordinates of all other elements."""
    contacts = set(curve.contacts)
    return [name for name in curve.coordinates if name.rpartition(".")[0] not in contacts]


def dissipation_of(curve: "FrequencyCurve") -> dict[str, np.ndarray]:
    """Energy that each contact takes from the motion in a period, J, (points,)."""
    return {
        contact: np.sum([curve.dissipated(name) for name in names], axis=0)
        for contact, names in of_contacts(curve).items()
    }


def state_shares(states: np.ndarray) -> dict[str, np.ndarray]:
    """Return the share of the period in each state, (contacts,), from states (contacts, phases)."""
    return {name: np.mean(np.asarray(states) == number, axis=1) for number, name in enumerate(STATES)}


def marked(curve: "FrequencyCurve") -> dict[str, list[int]]:
    """Points where the path has a fold or changes its stability, by what they are."""
    points: dict[str, list[int]] = {}
    for kind, point in curve.markers:
        points.setdefault(kind, []).append(point)
    return points


def unstable(curve: "FrequencyCurve") -> np.ndarray:
    """Whether each point is known to be unstable, (points,)."""
    return np.asarray(curve.stable) == 0
