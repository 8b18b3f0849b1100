"""A flexible body in space by the modes of a finite element model."""

__all__ = ["ReducedBody"]

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from dalembert.errors import InputError, require_known
from dalembert.findings import Finding
from dalembert.multibody.components.base_body import DISPLACEMENT, POSITION, with_points
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.spatial import spatial_markers as markers
from dalembert.multibody.components.spatial.directors import DIRECTORS
from dalembert.multibody.components.spatial.ground_points import Place
from dalembert.multibody.components.spatial.linear_deformation import deformation_findings
from dalembert.multibody.components.spatial.modal_strains import ModalStrains
from dalembert.multibody.components.spatial.node_point import NodePoint
from dalembert.multibody.components.spatial.orientation import Orientation, Vector
from dalembert.multibody.components.spatial.reduced_kinds import INTERFACE, MODE, PAIR
from dalembert.multibody.components.spatial.shapes import Surface
from dalembert.multibody.components.spatial.spatial_body import DIRECTOR, Body, Marker, pose_modes
from dalembert.multibody.components.spatial.spatial_fixed_joint import KIND as FIXED
from dalembert.multibody.components.spatial.spatial_rigid_body import RIGID
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows
from dalembert.structure.free_body_modes import FreeBodyModes

MOST_CORNERS = 800
"""Corners of the surface of a body in drawings."""


@with_points("centre")
@dataclass(frozen=True)
class ReducedBody(Body):
    """A flexible body in space with small deformations and large rotations, from a finite element model.

    Its axes float with it, so that its modes have no momentum and no angular momentum about its centre of mass.
    Interface nodes have positions and axes as rigid bodies have: joints, loads, sensors and beams attach to them. The
    deformation is linear in these axes: bending does not shorten the body, and a spin does not stiffen it enough.

    Parameters
    ----------
    name : str
    modes : FreeBodyModes
        Mass, stiffness and modes, made by :func:`dalembert.structure.free_body_modes`.
    position : (float, float, float) or Point
        Initial position of the anchor, m.
    orientation : Orientation
        Initial orientation of the axes of the finite element model; relative to the marker where the body is placed at
        a marker of another body.
    anchor : str
        The point that is placed: ``"centre"`` (of mass), an interface node or one of ``points``, without deformation.
    points : mapping of str to NodePoint
        Markers beside the interface nodes themselves: corners, and points off the nodes.
    velocity : (float, float, float), optional
        Initial velocity of the anchor, m/s. If not given, that of the point that the body is placed at, or zero; the
        joints may change it then.
    angular_velocity : (float, float, float), optional
        Initial angular velocity in the fixed axes, rad/s. If not given, zero; the joints may change it then.
    damping_ratio : float
        Part of the critical damping of each mode of the free body, beside the damping of the structure.

    Raises
    ------
    InputError
        For points with names of interface nodes, points at unknown ones, and an interface node called ``centre``.

    Examples
    --------
    >>> from dalembert.structure import Material, box, free_body_modes, solid
    >>> bar = solid(box((0.4, 0.02, 0.03), (8, 2, 2)), Material(210e9, 0.3, 7800.0))
    >>> link = ReducedBody("link", free_body_modes(bar, {"foot": "left", "tip": "right"}, modes=4), anchor="foot")
    >>> link.point_names, link.size
    (('centre', 'foot', 'tip'), 46)
    """

    has_motion_findings, buckles = True, False
    modes: FreeBodyModes = field(metadata={"table": "FreeBodyModes"})
    position: Place = field(default=(0.0, 0.0, 0.0), metadata={"unit": "m", "shape": (3,)})
    orientation: Orientation = Orientation()
    anchor: str = "centre"
    points: Mapping[str, NodePoint] = field(default_factory=dict)
    velocity: Vector | None = number("m/s", None)
    angular_velocity: Vector | None = number("rad/s", None)
    damping_ratio: Number = number("", 0.0, least=0)

    def __post_init__(self) -> None:
        owner = f"reduced body {self.name!r}"
        if "centre" in self.modes.names:
            raise InputError(f"{owner}: an interface node is called 'centre', as the centre of mass. Rename the node")
        for name, point in self.points.items():
            if name in ("centre", *self.modes.names):
                raise InputError(f"{owner}: the point name {name!r} is that of a node. Choose another name")
            require_known("interface node", point.at, self.modes.names, f"{owner}, point {name!r}")
        require_known("anchor", self.anchor, self.point_names, owner)

    @property
    def place(self) -> Place:
        return self.position

    @property
    def coordinate_kinds(self) -> tuple[str, ...]:
        return ((POSITION,) * 3 + (DIRECTOR,) * 9) * (1 + len(self.modes.names)) + (DISPLACEMENT,) * self.modes.count

    @property
    def rigid(self) -> bool:
        return False

    @property
    def point_names(self) -> tuple[str, ...]:
        return ("centre", *self.modes.names, *self.points)

    def node_number(self, point: str) -> int:
        """Number of the node of a point: 0 of the floating axes, then those of the interface nodes."""
        return self._node(point)[0]

    def _node(self, point: str) -> tuple[int, NodePoint]:
        """Number of the node of a point, 0 for the floating axes, and the marker in its axes."""
        if point == "centre":
            return 0, NodePoint()
        at = self.points.get(point) or NodePoint(point)
        return 1 + self.modes.names.index(at.at), at

    def placed(self, frame: np.ndarray) -> np.ndarray:
        node, at = self._node(self.anchor)
        places = np.vstack([np.zeros(3), self.modes.interface_places])
        directors = frame[3:].reshape(3, 3)
        nodes = np.zeros((len(places), 4, 3), np.result_type(frame, np.array(at.position)))
        nodes[:, 0] = frame[:3] + (places - places[node] - np.array(at.position)) @ directors
        nodes[:, 1:] = directors
        return np.concatenate([nodes.ravel(), np.zeros(self.modes.count)])

    def rigid_modes(self, coordinates: np.ndarray, frame: np.ndarray) -> np.ndarray:
        poses = pose_modes(coordinates[: -self.modes.count], frame)
        return np.vstack([poses, np.zeros((self.modes.count, 6))])

    def marker(self, point: str) -> Marker:
        node, at = self._node(point)
        slots = tuple(range(markers.SLOTS * node, markers.SLOTS * (node + 1)))
        return Marker(markers.BODY, slots, np.array(at.position), at.orientation.matrix)

    def lower(self, lowering: SpatialRows, first: int) -> None:
        modes, upper = self.modes, np.triu_indices(4)
        frame = list(range(first, first + markers.SLOTS))
        coordinates = list(range(first + self.size - modes.count, first + self.size))
        lowering.add(RIGID, frame, [*modes.pseudo_inertia[upper].tolist(), *lowering.gravity])
        for node in range(first, coordinates[0], markers.SLOTS):
            lowering.add(DIRECTORS, list(range(node + 3, node + 12)) + lowering.multipliers(self.name, 6), [])
        for a, eta in enumerate(coordinates):
            products = modes.second[:, :, a, a][np.triu_indices(3)].tolist()
            numbers = [*modes.first[:, :, a].ravel().tolist(), *products, *self._modal(a, a), *lowering.gravity]
            lowering.add(MODE, [*frame, eta], numbers)
            for b in range(a + 1, modes.count):
                both = modes.second[:, :, a, b].ravel().tolist()
                lowering.add(PAIR, [*frame[3:], eta, coordinates[b]], [*both, *self._modal(a, b)])
        for node, place in enumerate(modes.interface_places):
            begin = first + markers.SLOTS * (node + 1)
            slots, rows = list(range(begin, begin + markers.SLOTS)), lowering.multipliers(self.name, 6)
            ends = [Marker(markers.BODY, (), at, np.eye(3)).numbers for at in (place, np.zeros(3))]
            lowering.add(FIXED, [*frame, *slots, *rows], [*ends[0], *ends[1]], [markers.BODY, markers.BODY])
            for a, eta in enumerate(coordinates):
                numbers = modes.interface_shapes[node, :, a].tolist()
                lowering.add(INTERFACE, [*frame[3:], eta, *slots[3:], *rows], numbers)

    def _modal(self, a: int, b: int) -> list[Number]:
        """Modal mass, stiffness and damping of two modes."""
        modes = self.modes
        mass, stiffness, damping = (matrix[a, b] for matrix in (modes.mass, modes.stiffness, modes.damping))
        if a == b:
            damping = damping + 2.0 * self.damping_ratio * np.sqrt(mass * stiffness)
        return [mass, stiffness, damping]

    def motion_findings(self, times: np.ndarray, states: np.ndarray, rates: np.ndarray) -> tuple[Finding, ...]:
        return deformation_findings(self, times, states, rates)

    # -- drawings -------------------------------------------------------------------------------------------------

    def _deformed(self, coordinates: np.ndarray, places: np.ndarray, shapes: np.ndarray) -> np.ndarray:
        """Points of the body over time, (frames, points, 3)."""
        axes = coordinates[:, : markers.SLOTS].reshape(-1, 4, 3)
        moved = places + np.einsum("pja,fa->fpj", shapes, coordinates[:, -self.modes.count :])
        return axes[:, :1] + np.einsum("fpj,fjx->fpx", moved, axes[:, 1:])

    def outline(self, coordinates: np.ndarray, points: int) -> np.ndarray:
        """Lines from the centre of mass to each interface node and back."""
        nodes = coordinates[:, : -self.modes.count].reshape(len(coordinates), -1, 4, 3)[:, :, 0]
        order = [node for number in range(1, nodes.shape[1]) for node in (0, number)]
        return nodes[:, [*order, 0]]

    @cached_property
    def _drawn(self) -> tuple[np.ndarray, np.ndarray]:
        """Rows of the places and triangles between them, of few corners."""
        return coarse_surface(self.modes.places, self.modes.faces, MOST_CORNERS)

    def skin(self, coordinates: np.ndarray) -> Surface | None:
        """The surface of the finite element model with the deformation, and the largest principal strain.

        In tension and bending this is the strain along the body, as beams have it: one colour bar serves both. An
        equivalent strain of von Mises would differ from it by a factor that depends on Poisson's ratio.
        """
        rows, triangles = self._drawn
        if not len(triangles):
            return None
        corners = self._deformed(coordinates, self.modes.places[rows], self.modes.shapes[rows])
        if self.modes.strains is None:
            return Surface(corners, triangles)
        strains = self.modes.strains[np.searchsorted(np.unique(self.modes.faces), rows)]
        eta = coordinates[:, -self.modes.count :]
        return Surface(corners, triangles, ModalStrains(strains, eta), "largest principal strain")

    def moving_axes(self, coordinates: np.ndarray) -> np.ndarray:
        return coordinates[:, : markers.SLOTS].reshape(-1, 4, 3)


def coarse_surface(places: np.ndarray, faces: np.ndarray, most: int) -> tuple[np.ndarray, np.ndarray]:
    """Return rows of places (corners,) and triangles between them (triangles, 3), of at most ``most`` corners.

    Corners within a cell of a grid become that nearest to their mean; the grid is refined as far as their number
    allows.
    """
    triangles = faces if faces.shape[1] == 3 else np.vstack([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])
    rows = np.unique(triangles)
    cells = max(int(np.sqrt(most)), 1)
    chosen = rows
    while len(chosen) > most:
        corner, size = places[rows].min(axis=0), np.ptp(places[rows], axis=0).max() / cells
        _, cell = np.unique(np.floor((places[rows] - corner) / size + 1e-9).astype(int), axis=0, return_inverse=True)
        cell = cell.ravel()
        means = np.array([np.bincount(cell, axis) for axis in places[rows].T]).T / np.bincount(cell)[:, None]
        order = np.lexsort((np.linalg.norm(places[rows] - means[cell], axis=1), cell))
        chosen = rows[order[np.unique(cell[order], return_index=True)[1]]]
        nearest = dict(zip(rows.tolist(), chosen[cell].tolist(), strict=True))
        cells -= max(cells // 8, 1)
        if len(chosen) <= most:
            triangles = np.vectorize(nearest.__getitem__)(triangles)
            flat = (triangles[:, [0, 1, 2]] == triangles[:, [1, 2, 0]]).any(axis=1)
            triangles = np.unique(triangles[~flat], axis=0)
    return chosen, np.searchsorted(chosen, triangles)
