"""The beam in space: bending in two directions, torsion, shear and stretch at large rotations."""

__all__ = ["Beam"]

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from dalembert.arguments import is_number
from dalembert.errors import InputError, require_known, shown
from dalembert.findings import Finding
from dalembert.multibody.components.base_body import POSITION, with_points
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.node_chain import NodeChain
from dalembert.multibody.components.points import Point
from dalembert.multibody.components.spatial import spatial_markers as markers
from dalembert.multibody.components.spatial.beam_element import BEAMS, MOST_DEGREE
from dalembert.multibody.components.spatial.beam_kinematics import frames, lines, node_traces, strains
from dalembert.multibody.components.spatial.beam_reference import placed_nodes
from dalembert.multibody.components.spatial.beam_shapes import Places, rule
from dalembert.multibody.components.spatial.beam_turns import turn_findings
from dalembert.multibody.components.spatial.directors import DIRECTORS
from dalembert.multibody.components.spatial.ground_points import Place
from dalembert.multibody.components.spatial.node_point import NodePoint
from dalembert.multibody.components.spatial.orientation import Orientation, Pose, Vector
from dalembert.multibody.components.spatial.section import Section
from dalembert.multibody.components.spatial.shapes import Surface
from dalembert.multibody.components.spatial.spatial_body import DIRECTOR, Body, Marker, pose_modes
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows

LIMIT = ", and it fails at 180 degrees"
_RINGS = 16
"""Outlines of the section along a beam of few elements, for drawings."""


@with_points("start", "end")
@dataclass(frozen=True)
class Beam(NodeChain, Body):
    """A flexible beam in space: geometrically exact, with stretch, shear, torsion and bending in two directions.

    Its line is along the x axis of its frame. The axes y and z of its sections follow it. Its nodes have positions and
    axes as rigid bodies have, so joints, loads and sensors act on them.

    Parameters
    ----------
    name : str
    section : Section, or sequence of (float, Section)
        Stiffness and inertia; or a table of them at places along the beam, m from its start, between which they are
        interpolated linearly.
    length : float
        Along the line without strains, m.
    elements : int
    degree : int
        Of the polynomials of an element, 1 to 4. The error of static solutions falls with the power 2 ``degree`` of
        the number of elements. An element has ``degree`` + 1 nodes, of which neighbours share one.
    position : (float, float, float) or Point
        Initial position of the start, m.
    orientation : Orientation
        Initial orientation of the start; relative to the marker where the beam is placed at a marker of another body.
    curvature : (float, float, float), or callable
        Twist and curvatures about y and z of the line without stress, 1/m; or a function of the place, m from the
        start, that returns them.
    nodes : sequence of Pose, optional
        Instead of a curvature: poses of all nodes without stress, in the frame of the start.
    prestrain : six float
        Strains at which a beam is free of stress, beside those of its shape: stretch, shear along y and z, twist, and
        curvatures about y and z, 1 and 1/m.
    velocity : (float, float, float), optional
        Initial velocity of the start, m/s. If not given, that of the point that the beam is placed at, or zero; the
        joints may change it then.
    angular_velocity : (float, float, float), optional
        Initial angular velocity in the fixed axes, rad/s. If not given, zero; the joints may change it then.
    points : mapping of str to NodePoint
        Markers beside the nodes themselves: corners, and points off the line.
    damping : float
        Retardation time of the Kelvin-Voigt material, s: stress = C (strain + damping x strain rate).
    mass_damping : float
        Damping force of the momenta, 1/s; with ``damping`` it is Rayleigh's damping.

    Raises
    ------
    InputError
        For a degree or a number of elements that does not exist, tables or nodes that do not fit, and nodes that turn
        by half a turn or more within an element.

    Examples
    --------
    >>> rod = Section.circle(0.005, youngs_modulus=2.1e11, poisson_ratio=0.3, density=7850.0)
    >>> whip = Beam("whip", rod, length=1.0, elements=4)
    >>> whip.size, str(whip.end), whip.point_names[:3]
    (108, 'whip.end', ('start', 'end', 'node0'))
    """

    has_motion_findings = True
    section: Any = field(metadata={"table": "Section"})
    length: Number = number("m", above=0)
    elements: int = 1
    degree: int = 2
    position: Place = field(default=(0.0, 0.0, 0.0), metadata={"unit": "m", "shape": (3,)})
    orientation: Orientation = Orientation()
    curvature: Vector | Callable[[float], Any] = field(default=(0.0, 0.0, 0.0), metadata={"table": "Curvature"})
    nodes: Sequence[Pose] | None = field(default=None, metadata={"key": False})
    prestrain: tuple[Number, Number, Number, Number, Number, Number] = number("", (0.0,) * 6)
    velocity: Vector | None = number("m/s", None)
    angular_velocity: Vector | None = number("rad/s", None)
    points: Mapping[str, NodePoint] = field(default_factory=dict)
    damping: Number = number("s", 0.0, least=0)
    mass_damping: Number = number("1/s", 0.0, least=0)

    def __post_init__(self) -> None:
        owner = f"beam {self.name!r}"
        if self.degree not in range(1, MOST_DEGREE + 1):
            raise InputError(f"{owner}: degree is {shown(self.degree)}; expected 1, 2, 3 or 4")
        self.require_elements(owner)
        for name, point in self.points.items():
            if name in self.node_names:
                raise InputError(f"{owner}: the point name {name!r} is that of a node. Choose another name")
            require_known("node", point.at, self.node_names, f"{owner}, point {name!r}")
        _require_table(owner, self.section, self.length)
        if not callable(self.curvature) and not _is_vector(self.curvature):
            raise InputError(
                f"{owner}: curvature is {shown(self.curvature)}; expected three finite numbers in 1/m (twist, and "
                "curvatures about y and z), or a function of the place that returns them"
            )
        count = self.elements * self.degree + 1
        if self.nodes is not None:
            if len(self.nodes) != count or not all(isinstance(node, Pose) for node in self.nodes):
                raise InputError(
                    f"{owner}: {len(self.nodes)} nodes were given; expected a Pose for each of its {count} nodes, "
                    "elements x degree + 1"
                )
            if callable(self.curvature) or any(self.curvature):
                raise InputError(f"{owner}: nodes and a curvature were given; leave out one of them")
        if self._turn >= np.pi * (1 - 1e-6):
            raise InputError(
                f"{owner}: a node turns by 180 degrees or more against the middle of its element; use more elements"
            )

    @property
    def place(self) -> Place:
        return self.position

    @property
    def coordinate_kinds(self) -> tuple[str, ...]:
        return ((POSITION,) * 3 + (DIRECTOR,) * 9) * (self.elements * self.degree + 1)

    @property
    def point_names(self) -> tuple[str, ...]:
        return (*self.node_names, *self.points)

    @property
    def last_node(self) -> int:
        return self.elements * self.degree

    # -- the line without stress ----------------------------------------------------------------------------------

    def _curvature_at(self, place: Any) -> np.ndarray:
        return np.array(self.curvature(place) if callable(self.curvature) else self.curvature)

    def _shape(self) -> np.ndarray:
        """Nodes in the frame of the start, (nodes, 4, 3): origin and directors."""
        if self.nodes is not None:
            return np.array([[node.position, *node.orientation.matrix.T] for node in self.nodes])
        return placed_nodes(self.degree, self.elements, self.length, self.curvature)

    def by_element(self, nodes: np.ndarray) -> np.ndarray:
        """Return nodes (..., nodes, 4, 3) by elements, (..., elements, degree + 1, 4, 3)."""
        numbers = self.degree * np.arange(self.elements)[:, None] + np.arange(self.degree + 1)
        return nodes[..., numbers, :, :]

    @property
    def _turn(self) -> float:
        """Largest angle of a node against the middle of its element without stress, rad."""
        if self.nodes is not None:
            cosines = np.real(node_traces(self.by_element(self._shape())))
            return float(np.arccos(np.clip(np.min(cosines), -1.0, 1.0)))
        h, places = self.length / self.elements, rule(self.degree, self.degree).places
        sizes = [
            np.linalg.norm(np.real(self._curvature_at(e * h + at * h))) for e in range(self.elements) for at in places
        ]
        # The middle node of an odd degree is half an interval before the middle of the element.
        return float(max(sizes) * np.real(h) * (1 - self.degree // 2 / self.degree))

    @cached_property
    def _references(self) -> np.ndarray:
        """Strains without stress at the points of each element, (elements, degree, 6)."""
        places, h = rule(self.degree, self.degree).places, self.length / self.elements
        if self.nodes is not None:
            references = strains(
                self.by_element(self._shape()), Places.at(self.degree, np.array(places)), np.full(1, h)
            )
        else:
            curvatures = [[self._curvature_at((e + at) * h) for at in places] for e in range(self.elements)]
            straight = np.broadcast_to([1.0, 0.0, 0.0], (self.elements, self.degree, 3))
            references = np.concatenate([straight, np.array(curvatures)], axis=-1)
        return references + np.array(self.prestrain)

    # -- what kernels need ----------------------------------------------------------------------------------------

    def placed(self, frame: np.ndarray) -> np.ndarray:
        """Coordinates of all nodes in a frame: the start, and its axes one after the other."""
        shape = self._shape() @ frame[3:].reshape(3, 3)
        shape[:, 0] += frame[:3]
        return shape.ravel()

    def rigid_modes(self, coordinates: np.ndarray, frame: np.ndarray) -> np.ndarray:
        return pose_modes(coordinates, frame)

    def node_number(self, point: str) -> int:
        return super().node_number(self.points[point].at if point in self.points else point)

    def marker(self, point: str) -> Marker:
        k, place = markers.SLOTS * self.node_number(point), self.points.get(point) or NodePoint()
        slots = tuple(range(k, k + markers.SLOTS))
        return Marker(markers.BODY, slots, np.array(place.position), place.orientation.matrix)

    def element_numbers(self, element: int, gravity: tuple[Number, Number, Number]) -> list[Number]:
        """Numbers of an element for its kernels."""
        h = self.length / self.elements
        numbers = [h]
        for share, reference in zip(rule(self.degree, self.degree).places, self._references[element], strict=True):
            stiffness = self.section_at((element + share) * h).matrix
            numbers += [*stiffness[np.triu_indices(6)].tolist(), *reference.tolist()]
        for share in rule(self.degree, self.degree + 1).places:
            numbers += self.section_at((element + share) * h).pseudo_inertia[np.triu_indices(3)].tolist()
        return [*numbers, self.damping, self.mass_damping, *gravity]

    def element_index(self, first: int) -> np.ndarray:
        """Coordinates of each element, (elements, 12 (degree + 1)), where ``first`` is that of the beam."""
        width, step = markers.SLOTS * (self.degree + 1), markers.SLOTS * self.degree
        return first + np.arange(width) + step * np.arange(self.elements)[:, None]

    def lower(self, lowering: SpatialRows, first: int) -> None:
        for element, index in enumerate(self.element_index(first)):
            numbers = self.element_numbers(element, lowering.gravity)
            lowering.add(BEAMS[self.degree - 1], index.tolist(), numbers)
        for node in range(first, first + self.size, markers.SLOTS):
            lowering.add(DIRECTORS, list(range(node + 3, node + 12)) + lowering.multipliers(self.name, 6), [])

    def section_at(self, place: Any) -> Any:
        """Stiffness and inertia at a place, m from the start."""
        if isinstance(self.section, Section):
            return self.section
        places = [np.real(at) for at, _ in self.section]
        k = int(np.clip(np.searchsorted(places, np.real(place)) - 1, 0, len(places) - 2))
        (low, first), (high, second) = self.section[k], self.section[k + 1]
        share = (place - low) / (high - low)
        return _Mixed(*((1 - share) * a + share * b for a, b in zip(_parts(first), _parts(second), strict=True)))

    def motion_findings(self, times: np.ndarray, states: np.ndarray, rates: np.ndarray) -> tuple[Finding, ...]:
        cosines = node_traces(self.by_element(states.reshape(len(states), -1, 4, 3))).reshape(len(states), -1)
        return turn_findings(f"beam {self.name!r}", self.name, self.elements, times, cosines.min(axis=1), LIMIT)

    def outline(self, coordinates: np.ndarray, points: int) -> np.ndarray:
        nodes = self.by_element(coordinates.reshape(len(coordinates), -1, 4, 3))
        return self._along(lines(nodes, Places.at(self.degree, np.linspace(0.0, 1.0, points + 1))))

    def skin(self, coordinates: np.ndarray) -> Surface | None:
        """The outline of the section along the line, and its ends."""
        sections = [self.section] if isinstance(self.section, Section) else [section for _, section in self.section]
        outlines = [np.real(np.array(section.outline, dtype=complex)) for section in sections]
        if not all(len(outline) == len(outlines[0]) > 2 for outline in outlines):
            return None
        nodes = self.by_element(coordinates.reshape(len(coordinates), -1, 4, 3))
        shares = np.linspace(0.0, 1.0, max(1, _RINGS // self.elements) + 1)
        places = Places.at(self.degree, shares)
        line, axes = (self._along(part(nodes, places)) for part in (lines, frames))
        at, corners = np.linspace(0.0, float(np.real(self.length)), line.shape[1]), np.stack(outlines)
        known = np.zeros(1)
        if not isinstance(self.section, Section):
            known = np.array([float(np.real(place)) for place, _ in self.section])
        rings = np.stack([[np.interp(at, known, corners[:, k, c]) for c in (0, 1)] for k in range(corners.shape[1])])
        # Position of a corner: the line, y times d2 and z times d3; rings (corners, 2, rings).
        surface = line[:, :, None] + np.einsum("kcr,frcx->frkx", rings, axes[:, :, 1:])
        e = np.real(self._along(self._elastic_strains(nodes, shares)))[:, :, None]
        # Along the line, at the corner (y, z): stretch + z K_y - y K_z.
        strain = np.abs(e[..., 0] + rings[:, 1].T * e[..., 4] - rings[:, 0].T * e[..., 5])
        corners = surface.reshape(len(surface), -1, 3)
        return Surface(corners, _tube(len(at), len(rings)), strain.reshape(len(surface), -1), "strain along beams")

    def _elastic_strains(self, nodes: np.ndarray, shares: np.ndarray) -> np.ndarray:
        """Strains less those without stress at shares of the elements, (frames, elements, shares, 6).

        Those of the points, and the polynomial through them, are more accurate than strains elsewhere.
        """
        points = np.array(rule(self.degree, self.degree).places)
        known = strains(nodes, Places.at(self.degree, points), np.full(1, self.length / self.elements))
        # Lagrange's polynomials of the points, by the inverse of Vandermonde's matrix.
        weights = np.linalg.solve(np.vander(points).T, np.vander(shares, len(points)).T).T
        return np.einsum("sp,fepk->fesk", weights, known - self._references)

    def _along(self, values: np.ndarray) -> np.ndarray:
        """Values at points of all elements (frames, elements, points, ...) along the beam, ends of elements once."""
        inner = values[:, :, :-1].reshape(len(values), -1, *values.shape[3:])
        return np.concatenate([inner, values[:, -1, -1:]], axis=1)


def beam_of(owner: str, point: Point) -> Beam:
    """Return the beam of a point; refuse points of other bodies."""
    if not isinstance(point.body, Beam):
        raise InputError(f"{owner}: {point} belongs to another body than a beam. Give a point of a Beam")
    return point.body


@dataclass(frozen=True)
class _Mixed:
    """Stiffness and inertia between two sections."""

    matrix: np.ndarray
    pseudo_inertia: np.ndarray


def _parts(section: Section) -> tuple[np.ndarray, np.ndarray]:
    return section.matrix, section.pseudo_inertia


def _tube(rings: int, corners: int) -> np.ndarray:
    """Triangles between rings of corners, and of both ends as fans."""
    k, following = np.arange(corners), (np.arange(corners) + 1) % corners
    first = corners * np.arange(rings - 1)[:, None]
    a, b = first + k, first + following
    sides = np.stack([a, b, b + corners, a, b + corners, a + corners], axis=-1).reshape(-1, 3)
    fan = np.column_stack([np.zeros(corners - 2, dtype=int), k[1:-1], k[2:]])
    return np.concatenate([sides, fan, fan + corners * (rings - 1)])


def _is_vector(value: Any) -> bool:
    """Whether something is three finite numbers."""
    return isinstance(value, Sequence | np.ndarray) and len(value) == 3 and all(map(is_number, value))


def _require_table(owner: str, section: Any, length: Number) -> None:
    """Refuse a table of sections that does not reach over the beam."""
    if isinstance(section, Section):
        return
    rows = list(section) if isinstance(section, Sequence) else []
    usable = len(rows) > 1 and all(
        isinstance(row, Sequence) and len(row) == 2 and isinstance(row[1], Section) for row in rows
    )
    if not usable:
        raise InputError(
            f"{owner}: section is {shown(section)}; expected {Section.IN_WORDS}, or two or more of (place, Section)"
        )
    places = np.array([np.real(at) for at, _ in rows])
    if np.any(np.diff(places) <= 0) or places[0] > 0 or places[-1] < np.real(length) * (1 - 1e-12):
        raise InputError(
            f"{owner}: the places of its sections are {shown(places.tolist())}; expected increasing ones from 0 to the "
            f"length, {np.real(length):.6g} m"
        )
