"""Forces along beams and cables in space, per length: dead, or turning with the sections of beams."""

__all__ = ["LineForce"]

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from dalembert.errors import InputError, ModelError
from dalembert.kernels.kernel import inlined, inner
from dalembert.multibody.components import hermite
from dalembert.multibody.components.fields import number
from dalembert.multibody.components.points import Point
from dalembert.multibody.components.signals import Course
from dalembert.multibody.components.spatial.beam import Beam, beam_of
from dalembert.multibody.components.spatial.beam_element import MOST_DEGREE
from dalembert.multibody.components.spatial.beam_shapes import rule
from dalembert.multibody.components.spatial.cable import Cable
from dalembert.multibody.components.spatial.directors import POSE
from dalembert.multibody.components.spatial.spatial_cable_element import WIDTH
from dalembert.multibody.components.spatial.spatial_load import Load
from dalembert.multibody.components.spatial.spatial_markers import SLOTS
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows, first_coordinate
from dalembert.multibody.components.spatial.vectors import add_at, at, combined, dot, plus, times
from dalembert.multibody.kernels.kind import Kind


@inlined
def _at_nodes(x, k, c, follower):
    """Components c of a force in the fixed axes, or in those of a node."""
    return c if follower == 0 else combined(c, at(x, k + 3), at(x, k + 6), at(x, k + 9))


def _force_along(degree: int) -> Callable[..., Any]:
    """A function that returns the force per length at a point: that of the nodes, interpolated as the line is."""
    nodes, values = degree + 1, rule(degree, degree + 1).values

    @inlined
    def force(x, c, follower, g):
        total = times(values[g][0], _at_nodes(x, 0, c, follower))
        for i in range(1, nodes):
            total = plus(total, times(values[g][i], _at_nodes(x, SLOTS * i, c, follower)))
        return total

    return force


def adding(degree: int) -> Callable[..., Any]:
    """A function (x, length, c, follower, r) that adds a force along an element of a beam to its left side."""
    nodes, points, (_, values, _, weights) = degree + 1, degree + 1, rule(degree, degree + 1)
    force = _force_along(degree)

    @inlined
    def add(x, length, c, follower, r):
        # The work-equivalent forces: the integral of N_i f.
        for g in range(points):
            f = times(weights[g] * length, force(x, c, follower, g))
            for i in range(nodes):
                add_at(r, SLOTS * i, times(-values[g][i], f))

    return add


@inlined
def add_to_cable(length, c, r):
    """Add a force along an element of a cable to its left side, as its weight: h c (1/2, h/12, 1/2, -h/12)."""
    for i in range(3):
        hermite.weight(length, length, c[i], i, i + 3, i + 6, i + 9, r)


@inlined
def force_of(m, inputs):
    """Components of the force."""
    return inputs.signals[m.along_x, 0], inputs.signals[m.along_y, 0], inputs.signals[m.along_z, 0]


def _kind(degree: int) -> Kind:
    """The kind of forces on elements of a degree."""
    nodes, points, (_, values, _, weights) = degree + 1, degree + 1, rule(degree, degree + 1)
    add, force = adding(degree), _force_along(degree)

    @inner
    def residual(x, v, a, p, m, inputs, r):
        add(x, p.length, force_of(m, inputs), m.follower, r)

    @inner
    def energy(x, v, p, m, inputs):
        power = 0.0 * p.length * x[0]
        for g in range(points):
            f = times(weights[g] * p.length, force(x, force_of(m, inputs), m.follower, g))
            for i in range(nodes):
                power += values[g][i] * dot(f, at(v, SLOTS * i))
        return 0.0 * power, 0.0 * power, power

    return Kind(
        f"line_force_{degree}",
        coordinates=SLOTS * nodes,
        numbers=("length",),
        integers=("follower", "along_x", "along_y", "along_z"),
        residual=residual,
        energy=energy,
        charts=POSE * nodes,
        loads=True,
        home=__name__,
        is_usual=False,
    )


@inlined
def _cable_residual(x, v, a, p, m, inputs, r):
    add_to_cable(p.length, force_of(m, inputs), r)


@inlined
def _cable_energy(x, v, p, m, inputs):
    force, power = force_of(m, inputs), 0.0 * p.length * x[0]
    for i in range(3):
        power += p.length * force[i] * hermite.centre(p.length, i, i + 3, i + 6, i + 9, v)
    return 0.0 * power, 0.0 * power, power


ON_CABLE = Kind(
    "line_force_on_cable",
    coordinates=WIDTH,
    numbers=("length",),
    integers=("along_x", "along_y", "along_z"),
    residual=_cable_residual,
    energy=_cable_energy,
    loads=True,
    is_usual=False,
)
LINEAR, QUADRATIC, CUBIC, QUARTIC = FORCES = tuple(map(_kind, range(1, MOST_DEGREE + 1)))
"""Kinds of forces by the degree of the beam, less one."""


@dataclass(frozen=True)
class LineForce(Load):
    """A force per length along a whole beam or cable.

    Parameters
    ----------
    name : str
    on : Point
        Any point of the beam or cable.
    x, y, z : float or Signal
        Components along the fixed axes, or along those of the sections for a follower force, N/m.
    follower : bool
        Whether the force turns with the sections of a beam.

    Raises
    ------
    InputError
        For a point of another body, and for a follower force on a cable, which has no sections.

    Examples
    --------
    >>> from dalembert.multibody import equilibrium
    >>> from dalembert.multibody.spatial import Beam, FixedJoint, Section, SpatialSystem
    >>> system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    >>> rod = Section.circle(0.01, youngs_modulus=2.1e11, poisson_ratio=0.3, density=7850.0)
    >>> arm = system.add(Beam("arm", rod, length=1.0, elements=2))
    >>> for part in (FixedJoint("clamp", system.ground, arm.start), LineForce("wind", arm.end, y=8.0)):
    ...     _ = system.add(part)
    >>> deflection = equilibrium(system).channels(["arm.end.y"])[0]
    >>> round(deflection / (8.0 / (8 * rod.matrix[5, 5])), 3).item()  # q L^4 / (8 E I), and a little shear
    1.0
    """

    on: Point
    x: Course = number("N/m", 0.0)
    y: Course = number("N/m", 0.0)
    z: Course = number("N/m", 0.0)
    follower: bool = False

    @property
    def kind(self) -> Kind:  # type: ignore[override]
        """Of the degree of the beam, or of a cable."""
        return ON_CABLE if isinstance(self._line, Cable) else FORCES[self._line.degree - 1]

    @property
    def _line(self) -> Any:
        owner = f"LineForce {self.name!r}"
        if not isinstance(self.on.body, Cable):
            return beam_of(owner, self.on)
        if self.follower:
            raise InputError(f"{owner}: a cable has no sections that the force can turn with; leave out follower")
        return self.on.body

    def __post_init__(self) -> None:
        _ = self._line

    def lower(self, lowering: SpatialRows) -> None:
        line, kind = self._line, self.kind
        integers = [lowering.signal(course) for course in (self.x, self.y, self.z)]
        if isinstance(line, Beam):
            integers = [int(self.follower), *integers]
        for index in line.element_index(first_coordinate(lowering, self.on, self.name)):
            lowering.add(kind, index.tolist(), [line.length / line.elements], integers)


def signals_along(lowering: SpatialRows, body: Any, owner: str, follower: bool) -> list[int]:
    """Signals of the components of the force along a body, or zeros: what a sensor takes off its section forces.

    Raises
    ------
    ModelError
        For more than one force of the kind.
    """
    forces = [load for load in lowering.loads if isinstance(load, LineForce) and load.on.body.name == body.name]
    forces = [load for load in forces if load.follower == follower]
    if len(forces) > 1:
        names = " and ".join(repr(load.name) for load in forces)
        raise ModelError(
            f"{owner}: the line forces {names} act on {body.name!r}, and the sensor takes one; add them into one force"
        )
    parts = (forces[0].x, forces[0].y, forces[0].z) if forces else (0.0, 0.0, 0.0)
    return [lowering.signal(part) for part in parts]
