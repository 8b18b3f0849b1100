"""Strains, stresses and displacements of a reduced body: linear combinations of its modal coordinates."""

__all__ = ["RecoverySensor"]

from dataclasses import dataclass
from typing import Any

import numpy as np

from dalembert.errors import InputError, require_known
from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.base_body import DISPLACEMENT
from dalembert.multibody.components.points import Point
from dalembert.multibody.components.spatial.kinds import no_energy, no_residual
from dalembert.multibody.components.spatial.massless_coordinate import MasslessCoordinate
from dalembert.multibody.components.spatial.reduced_body import ReducedBody
from dalembert.multibody.components.spatial.spatial_load import Load
from dalembert.multibody.components.spatial.spatial_markers import SLOTS
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows
from dalembert.multibody.kernels.kind import Kind


@inlined
def _term(x, p, m, inputs, g):
    """One term of c - sum_a R_a eta_a / s = 0: c itself, of the factor 1, or a modal coordinate."""
    g[0] = p.factor * x[0]


@inlined
def _forces(x, p, m, r):
    r[0] += p.factor * x[1]


@inlined
def _observe(x, v, a, p, m, inputs, out):
    out[0], out[1] = p.scale * x[0], p.scale * v[0]


TERM = Kind(
    "recovery_term", coordinates=1, multipliers=1, numbers=("factor",), constraint=_term, forces=_forces, home=__name__
)
SENSOR = Kind(
    "recovery_sensor",
    coordinates=1,
    numbers=("scale",),
    residual=no_residual,
    energy=no_energy,
    outputs=(("value", ""), ("rate", "1/s")),
    observe=_observe,
    home=__name__,
)


@dataclass(frozen=True)
class RecoveredCoordinate(MasslessCoordinate):
    """The value of a sensor over its scale."""

    @property
    def place(self) -> Any:
        return (0.0, 0.0, 0.0)

    @property
    def coordinate_kinds(self) -> tuple[str, ...]:
        return (DISPLACEMENT,)

    def placed(self, frame: np.ndarray) -> np.ndarray:
        return np.zeros(1)

    def rigid_modes(self, coordinates: np.ndarray, frame: np.ndarray) -> np.ndarray:
        return np.zeros((1, 6))

    def lower(self, lowering: SpatialRows, first: int) -> None:
        """Nothing: the sensor writes the rows."""


@dataclass(frozen=True)
class RecoverySensor(Load):
    """A strain, a stress or a displacement of a reduced body, as its modes recover it.

    Parameters
    ----------
    name : str
    at : Point
        Any point of a reduced body.
    quantity : str
        Name of a row of ``recovery`` of its modes.

    Raises
    ------
    InputError
        For a point of another body, and an unknown quantity.

    Notes
    -----
    Outputs: ``value``, in the unit of the row, and its ``rate`` per second.

    Examples
    --------
    A gauge along the upper side of a bar that bends under a force at its tip, near the foot:

    >>> from dalembert.multibody import equilibrium
    >>> from dalembert.multibody.spatial import FixedJoint, Force, ReducedBody, SpatialSystem
    >>> from dalembert.structure import Material, box, free_body_modes, solid, strain_between
    >>> bar = solid(box((0.4, 0.02, 0.02), (8, 2, 2)), Material(2e9, 0.3, 1200.0))
    >>> ends = [bar.nodes.nearest((x, 0.01, 0.02)) for x in (0.1, 0.15)]
    >>> recovery = {"gauge": strain_between(bar, *ends)}
    >>> modes = free_body_modes(bar, {"foot": "left", "tip": "right"}, recovery=recovery)
    >>> system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    >>> body = system.add(ReducedBody("bar", modes, anchor="foot"))
    >>> for part in (FixedJoint("clamp", system.ground, body.point("foot")), Force("push", body.point("tip"), z=-1.0)):
    ...     _ = system.add(part)
    >>> _ = system.add(RecoverySensor("gauge", body.point("tip"), "gauge"))
    >>> strain = equilibrium(system).channels(["gauge.value"])[0]
    >>> round(float(strain / (0.275 * 0.01 / (2e9 * 0.02**4 / 12))), 2)  # M z / (E I)
    1.0
    """

    at: Point
    quantity: str

    kind = SENSOR

    def __post_init__(self) -> None:
        owner = f"RecoverySensor {self.name!r}"
        body: Any = self.at.body
        if not isinstance(body, ReducedBody):
            raise InputError(f"{owner}: {self.at} belongs to another body. Give a point of a ReducedBody")
        require_known("quantity", self.quantity, body.modes.recovery, owner)

    @property
    def coordinates(self) -> tuple[RecoveredCoordinate]:
        return (RecoveredCoordinate(f"{self.name} value"),)

    def lower(self, lowering: SpatialRows) -> None:
        body: Any = self.at.body
        (begin, *_), (value, _) = (
            lowering.pair(self.at, None, self.name).slots,
            lowering.coordinate(self.coordinates[0]),
        )
        assert begin is not None
        first = begin - SLOTS * body.node_number(self.at.name) + body.size - body.modes.count
        rows, factors = lowering.multipliers(self.name, 1), body.modes.recovery[self.quantity]
        # Newton's method compares the unknown with sizes of displacements: a stress in Pa would never settle.
        scale = float(np.linalg.norm(np.real(factors))) or 1.0
        lowering.add(TERM, [value, *rows], [1.0])
        for mode, factor in enumerate((factors / scale).tolist()):
            lowering.add(TERM, [first + mode, *rows], [-factor])
        lowering.add(SENSOR, [value], [scale], name=self.name)
