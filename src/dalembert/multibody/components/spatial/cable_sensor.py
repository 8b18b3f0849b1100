"""The force and the moment in a cable at a node.

The residual of one element with the force along it, without its neighbours, is what they exert on it at its nodes.
"""

__all__ = ["CableSensor"]

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.kernels.views import stack
from dalembert.multibody.components.points import Point
from dalembert.multibody.components.spatial.cable import Cable, cable_of
from dalembert.multibody.components.spatial.kinds import no_energy, no_residual
from dalembert.multibody.components.spatial.line_force import add_to_cable, force_of, signals_along
from dalembert.multibody.components.spatial.spatial_cable_element import CABLE, NODE, WIDTH, residual
from dalembert.multibody.components.spatial.spatial_load import Load
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows, first_coordinate
from dalembert.multibody.components.spatial.vectors import at, cross, dot, times
from dalembert.multibody.kernels.elementary import reciprocal, root
from dalembert.multibody.kernels.kind import Kind


@inlined
def _observe(x, v, a, p, m, inputs, out):
    """Tension, force and moment, and the direction of the line."""
    r = stack(x, WIDTH)
    for i in range(WIDTH):
        r[i] = 0.0 * p.length
    residual(x, v, a, p, m, inputs, r)
    add_to_cable(p.length, force_of(m, inputs), r)
    # At the end of an element its residual is the force in the cable, at its start the opposite.
    k, sign = NODE * m.node, 1.0 if m.node > 0 else -1.0
    slope, force = at(x, k + 3), times(sign, at(r, k))
    direction = times(reciprocal(root(dot(slope, slope))), slope)
    out[0] = dot(direction, force)
    out[1], out[2], out[3] = force
    out[4], out[5], out[6] = cross(slope, times(sign, at(r, k + 3)))
    out[7], out[8], out[9] = direction


SENSOR = Kind(
    "cable_sensor",
    coordinates=WIDTH,
    numbers=CABLE.numbers,
    integers=("node", "along_x", "along_y", "along_z"),
    residual=no_residual,
    energy=no_energy,
    outputs=(
        ("tension", "N"), ("force_x", "N"), ("force_y", "N"), ("force_z", "N"),
        ("moment_x", "N*m"), ("moment_y", "N*m"), ("moment_z", "N*m"),
        ("direction_x", ""), ("direction_y", ""), ("direction_z", ""),
    ),
    observe=_observe,
    observes_inputs=True,
    home=__name__,
)  # fmt: skip


@dataclass(frozen=True)
class CableSensor(Load):
    """Tension, force, moment and direction of a cable at a node.

    Parameters
    ----------
    name : str
    at : Point
        A node of a cable.

    Raises
    ------
    InputError
        For a point of another body.

    Notes
    -----
    Outputs in the fixed axes: ``tension``, along the line; ``force_x``, ``force_y``, ``force_z`` and ``moment_x``,
    ``moment_y``, ``moment_z``, which the part behind the node exerts on that before it; and the direction of the line.
    Between two elements the values are those of the element before the node.

    Examples
    --------
    >>> from dalembert.multibody import equilibrium
    >>> from dalembert.multibody.spatial import Cable, Orientation, SpatialSystem, SphericalJoint
    >>> system, down = SpatialSystem(), Orientation.by_angles("y", [1.5707963267948966])
    >>> rope = system.add(Cable("rope", 10.0, 2, axial_stiffness=1e5, mass_per_length=0.2, orientation=down))
    >>> _ = system.add(SphericalJoint("hook", system.ground, rope.start))
    >>> _ = system.add(CableSensor("load", rope.start))
    >>> equilibrium(system).channels(["load.tension"]).round(2).tolist()  # its weight
    [19.62]
    """

    kind = SENSOR
    at: Point

    @property
    def _cable(self) -> Cable:
        return cable_of(f"CableSensor {self.name!r}", self.at)

    def __post_init__(self) -> None:
        _ = self._cable

    def lower(self, lowering: SpatialRows) -> None:
        cable, node = self._cable, self._cable.node_number(self.at.name)
        element = max(node - 1, 0)
        forces = signals_along(lowering, cable, f"CableSensor {self.name!r}", follower=False)
        index = cable.element_index(first_coordinate(lowering, self.at, self.name))[element].tolist()
        lowering.add(SENSOR, index, cable.element_numbers(lowering.gravity), [node - element, *forces], self.name)
