"""Forces, moments and elastic strains of a beam's section at the end of an element.

The residual of one element with the forces along it, without its neighbours, is what they exert on it at its nodes. So
these section forces are as accurate as displacements are; those of Gauss' points, extrapolated, have half of the order.
"""

__all__ = ["BeamSensor"]

from dataclasses import dataclass

import numpy as np

from dalembert.errors import InputError
from dalembert.kernels.kernel import inlined, inner
from dalembert.kernels.views import stack
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.points import Point
from dalembert.multibody.components.spatial.beam import Beam, beam_of
from dalembert.multibody.components.spatial.beam_columns import ENTRIES
from dalembert.multibody.components.spatial.beam_element import BEAMS, full_product
from dalembert.multibody.components.spatial.kinds import no_energy, no_residual
from dalembert.multibody.components.spatial.line_force import adding, signals_along
from dalembert.multibody.components.spatial.spatial_load import Load
from dalembert.multibody.components.spatial.spatial_markers import SLOTS
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows, first_coordinate
from dalembert.multibody.components.spatial.vectors import at, cross, dot, plus, times
from dalembert.multibody.kernels.kind import Kind

OUTPUTS = (
    ("force_1", "N"), ("force_2", "N"), ("force_3", "N"), ("moment_1", "N*m"), ("moment_2", "N*m"), ("moment_3", "N*m"),
    ("stretch", ""), ("shear_y", ""), ("shear_z", ""), ("twist", "1/m"), ("bend_y", "1/m"), ("bend_z", "1/m"),
    ("strain", ""),
)  # fmt: skip


@inlined
def _flexibility(p):
    return (
        p.s11, p.s12, p.s13, p.s14, p.s15, p.s16, p.s22, p.s23, p.s24, p.s25, p.s26, p.s33, p.s34, p.s35, p.s36, p.s44,
        p.s45, p.s46, p.s55, p.s56, p.s66,
    )  # fmt: skip


def _kind(degree: int) -> Kind:
    """The kind of sensors on elements of a degree."""
    element, width, add_force = BEAMS[degree - 1], SLOTS * (degree + 1), adding(degree)
    residual = element.residual
    assert residual is not None

    @inner
    def observe(x, v, a, p, m, inputs, out):
        """Force and moment in the axes of the node, and elastic strains of the section there."""
        r = stack(x, width)
        for i in range(width):
            r[i] = 0.0 * p.length
        residual(x, v, a, p, m, inputs, r)
        s = inputs.signals
        add_force(x, p.length, (s[m.dead_x, 0], s[m.dead_y, 0], s[m.dead_z, 0]), 0, r)
        add_force(x, p.length, (s[m.follower_x, 0], s[m.follower_y, 0], s[m.follower_z, 0]), 1, r)
        # At the end of an element its residual is the section force, at its start the opposite.
        k, sign = SLOTS * m.node, 1.0 if m.node > 0 else -1.0
        d1, d2, d3 = at(x, k + 3), at(x, k + 6), at(x, k + 9)
        force = times(sign, at(r, k))
        moment = plus(plus(cross(d1, at(r, k + 3)), cross(d2, at(r, k + 6))), cross(d3, at(r, k + 9)))
        n = dot(d1, force), dot(d2, force), dot(d3, force)
        moment = times(sign, (dot(d1, moment), dot(d2, moment), dot(d3, moment)))
        gamma, kappa = full_product(_flexibility(p), n, moment)
        out[0], out[1], out[2] = n
        out[3], out[4], out[5] = moment
        out[6], out[7], out[8] = gamma
        out[9], out[10], out[11] = kappa
        out[12] = gamma[0] + p.gauge_z * kappa[1] - p.gauge_y * kappa[2]

    return Kind(
        f"beam_sensor_{degree}",
        coordinates=width,
        numbers=(*element.numbers, *(f"s{entry[1:]}" for entry in ENTRIES), "gauge_y", "gauge_z"),
        integers=("node", "dead_x", "dead_y", "dead_z", "follower_x", "follower_y", "follower_z"),
        residual=no_residual,
        energy=no_energy,
        outputs=OUTPUTS,
        observe=observe,
        observes_inputs=True,
        charts=element.charts,
        home=__name__,
        is_usual=False,
    )


LINEAR, QUADRATIC, CUBIC, QUARTIC = SENSORS = tuple(map(_kind, range(1, len(BEAMS) + 1)))
"""Kinds of sensors by the degree of the beam, less one."""


@dataclass(frozen=True)
class BeamSensor(Load):
    """Section forces and strains of a beam at the end of an element, as strain gauges measure them.

    Parameters
    ----------
    name : str
    at : Point
        A node of a beam between two elements, its start or its end.
    gauge : (float, float)
        Point (y, z) of the section whose strain along the line is the output ``strain``, m.

    Raises
    ------
    InputError
        For a point that is none of these.

    Notes
    -----
    Outputs in the axes of the section: ``force_1`` (axial), ``force_2``, ``force_3``, ``moment_1`` (torque),
    ``moment_2``, ``moment_3``, which the part behind the section exerts on that before it; the elastic strains
    ``stretch``, ``shear_y``, ``shear_z``, ``twist``, ``bend_y``, ``bend_z`` that the stiffness of the section has
    under these forces; and ``strain`` = stretch + z bend_y - y bend_z at the ``gauge``, as a strain gauge measures it.
    Between two elements the values are those of the element before the node.

    Examples
    --------
    >>> from dalembert.multibody import equilibrium
    >>> from dalembert.multibody.spatial import Beam, FixedJoint, Force, Section, SpatialSystem
    >>> system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    >>> rod = Section.circle(0.01, youngs_modulus=2.1e11, poisson_ratio=0.3, density=7850.0)
    >>> arm = system.add(Beam("arm", rod, length=0.5, elements=2))
    >>> for part in (FixedJoint("clamp", system.ground, arm.start), Force("pull", arm.end, z=2.0)):
    ...     _ = system.add(part)
    >>> _ = system.add(BeamSensor("gauge", arm.start))
    >>> equilibrium(system).channels(["gauge.force_3", "gauge.moment_2"]).round(3).tolist()
    [2.0, -1.0]
    """

    at: Point
    gauge: tuple[Number, Number] = number("m", (0.0, 0.0))

    @property
    def kind(self) -> Kind:  # type: ignore[override]
        """Of the degree of the beam."""
        return SENSORS[self._beam.degree - 1]

    @property
    def _beam(self) -> Beam:
        return beam_of(f"BeamSensor {self.name!r}", self.at)

    def __post_init__(self) -> None:
        beam = self._beam
        node = beam.node_number(self.at.name)
        if node % beam.degree:
            ends = ", ".join(f"node{k}" for k in range(0, beam.elements * beam.degree + 1, beam.degree)[:4])
            raise InputError(
                f"BeamSensor {self.name!r}: {self.at} is inside an element; expected an end of an element: {ends}, …"
            )

    def lower(self, lowering: SpatialRows) -> None:
        beam, node = self._beam, self._beam.node_number(self.at.name)
        element, owner = max(node // beam.degree - 1, 0), f"BeamSensor {self.name!r}"
        forces = [k for follower in (False, True) for k in signals_along(lowering, beam, owner, follower)]
        place = beam.length * node / (beam.elements * beam.degree)
        flexibility = np.linalg.inv(beam.section_at(place).matrix)[np.triu_indices(6)].tolist()
        numbers = [*beam.element_numbers(element, lowering.gravity), *flexibility, *self.gauge]
        index = beam.element_index(first_coordinate(lowering, self.at, self.name))[element].tolist()
        lowering.add(self.kind, index, numbers, [node - beam.degree * element, *forces], self.name)
