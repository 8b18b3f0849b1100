"""The cable in space: a rope or a wire, which stretches and bends."""

__all__ = ["Cable"]

from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np
from scipy.optimize import brentq

from dalembert.errors import InputError
from dalembert.findings import Finding
from dalembert.multibody.components.base_body import POSITION, with_points
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.hermite import line
from dalembert.multibody.components.node_chain import NodeChain
from dalembert.multibody.components.points import Point
from dalembert.multibody.components.spatial import spatial_markers as markers
from dalembert.multibody.components.spatial.beam_turns import turn_findings
from dalembert.multibody.components.spatial.ground_points import Place
from dalembert.multibody.components.spatial.orientation import Orientation, Vector
from dalembert.multibody.components.spatial.spatial_body import GRADIENT, Body, Marker, pose_modes
from dalembert.multibody.components.spatial.spatial_cable_element import CABLE, NODE, WIDTH
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows


@with_points("start", "end")
@dataclass(frozen=True)
class Cable(NodeChain, Body):
    """A rope or a wire in space: a line with a stiffness against stretch and, if wanted, against bending.

    It has no torsion, no shear, and no inertia of its sections: it takes long steps where a thin :class:`Beam` does
    not. Its nodes have a position and the slope of the line, but no axes. A fixed joint at the start or the end holds
    the direction of the line, the x axis of the other side; spherical joints, springs and forces hold points.

    Parameters
    ----------
    name : str
    length : float
        Without stretch, m.
    elements : int
    axial_stiffness : float
        E A, N.
    mass_per_length : float
        kg/m.
    bending_stiffness : float
        E I, N m^2, the same in all directions. Without it a cable without tension has no stiffness across its line.
    span : float, optional
        Initial distance from start to end, m. A slack cable, with a span below its length, is placed as an arc of a
        circle that sags along -z of its frame; one with a longer span is stretched. If not given, the length.
    prestrain : float
        Stretch at which the cable is free of stress; a negative one pulls a cable of the placed length.
    position : (float, float, float) or Point
        Initial position of the start, m.
    orientation : Orientation
        Its x axis points from start to end; relative to the marker where the cable is placed at a marker of another
        body.
    velocity : (float, float, float), optional
        Initial velocity of the start, m/s. If not given, that of the point that the cable is placed at, or zero; the
        joints may change it then.
    angular_velocity : (float, float, float), optional
        Initial angular velocity in the fixed axes, rad/s. If not given, zero; the joints may change it then.
    damping : float
        Retardation time of the Kelvin-Voigt material, s: force = E A (strain + damping x strain rate), likewise of
        bending, in sections that do not spin about the line: a spin about the line is damped, and no torque holds it.
    mass_damping : float
        Damping force of the momenta, 1/s.

    Raises
    ------
    InputError
        For a number of elements that does not exist, and for too few of them for the arc.

    Examples
    --------
    A wire of 20 m that sags by 1 % of its span: H = q L^2 / (8 sag) is its tension.

    >>> from dalembert.multibody import equilibrium
    >>> from dalembert.multibody.spatial import CableSensor, SpatialSystem, SphericalJoint
    >>> system = SpatialSystem()
    >>> wire = Cable("wire", 20.0053, 8, axial_stiffness=1e7, mass_per_length=0.5, span=20.0)
    >>> _ = system.add(wire)
    >>> _ = system.add(SphericalJoint("left", system.ground, wire.start))
    >>> _ = system.add(SphericalJoint("right", system.ground.point((20.0, 0.0, 0.0)), wire.end))
    >>> _ = system.add(CableSensor("load", wire.node(4)))
    >>> tension, sag = equilibrium(system).channels(["load.tension", "wire.node4.z"])
    >>> round(tension * 8 * -sag / (0.5 * 9.81 * 20.0**2), 3).item()
    1.0
    """

    has_axes = False
    has_motion_findings = True
    length: Number = number("m", above=0)
    elements: int = cast(Any, field())  # as a field of ours is to a type checker: any
    axial_stiffness: Number = number("N", above=0)
    mass_per_length: Number = number("kg/m", above=0)
    bending_stiffness: Number = number("N*m**2", 0.0, least=0)
    span: Number | None = number("m", None, above=0)
    prestrain: Number = number("", 0.0, above=-1)
    position: Place = field(default=(0.0, 0.0, 0.0), metadata={"unit": "m", "shape": (3,)})
    orientation: Orientation = Orientation()
    velocity: Vector | None = number("m/s", None)
    angular_velocity: Vector | None = number("rad/s", None)
    damping: Number = number("s", 0.0, least=0)
    mass_damping: Number = number("1/s", 0.0, least=0)

    def __post_init__(self) -> None:
        self.require_elements(f"cable {self.name!r}")
        if self.span is not None and np.real(self.span) < np.real(self.length):
            angle = 2.0 * float(np.real(_half_angle(self.span / self.length)))
            if angle / self.elements > np.pi / 2:
                raise InputError(
                    f"cable {self.name!r}: with a span of {np.real(self.span):.6g} m it is an arc of "
                    f"{np.degrees(angle):.0f} degrees at the start, more than 90 degrees an element; use more elements"
                )

    @property
    def place(self) -> Place:
        return self.position

    @property
    def coordinate_kinds(self) -> tuple[str, ...]:
        return ((POSITION,) * 3 + (GRADIENT,) * 3) * (self.elements + 1)

    def _shape(self) -> np.ndarray:
        """Nodes in the frame of the start, (nodes, 2, 3): position and slope."""
        share = np.arange(self.elements + 1) / self.elements
        span = self.length if self.span is None else self.span
        zero = 0.0 * share * span
        if self.span is None or np.real(span) >= np.real(self.length):
            at, slope = [share * span, zero, zero], [zero + span / self.length, zero, zero]
        else:
            half = _half_angle(span / self.length)
            radius, angle = self.length / (2.0 * half), half * (2.0 * share - 1.0)
            sines, cosines = np.sin(angle), np.cos(angle)
            at = [radius * (sines + np.sin(half)), zero, -radius * (cosines - np.cos(half))]
            slope = [cosines, zero, sines]
        return np.stack([np.stack(at, axis=-1), np.stack(slope, axis=-1)], axis=1)

    def placed(self, frame: np.ndarray) -> np.ndarray:
        """Coordinates of all nodes in a frame: the start, and its axes one after the other."""
        shape = self._shape() @ frame[3:].reshape(3, 3)
        shape[:, 0] += frame[:3]
        return shape.ravel()

    def rigid_modes(self, coordinates: np.ndarray, frame: np.ndarray) -> np.ndarray:
        return pose_modes(coordinates, frame, NODE // 3)

    def marker(self, point: str) -> Marker:
        k = NODE * self.node_number(point)
        return Marker(markers.MASS, (k, k + 1, k + 2, *(None,) * 9), np.zeros(3), np.eye(3))

    def element_numbers(self, gravity: tuple[Number, Number, Number]) -> list[Number]:
        """Numbers of an element for its kernels."""
        h = self.length / self.elements
        return [
            h, self.axial_stiffness, self.bending_stiffness, *(self.prestrain,) * 3, self.mass_per_length * h,
            self.damping, self.mass_damping, *gravity,
        ]  # fmt: skip

    def element_index(self, first: int) -> np.ndarray:
        """Coordinates of each element, (elements, 12), where ``first`` is that of the cable."""
        return first + np.arange(WIDTH) + NODE * np.arange(self.elements)[:, None]

    def lower(self, lowering: SpatialRows, first: int) -> None:
        lowering.add_many(CABLE, self.element_index(first), self.element_numbers(lowering.gravity))

    def motion_findings(self, times: np.ndarray, states: np.ndarray, rates: np.ndarray) -> tuple[Finding, ...]:
        nodes = states.reshape(len(states), -1, 2, 3)
        # Of each element: the directions of both slopes and of the chord.
        vectors = np.stack([nodes[:, :-1, 1], nodes[:, 1:, 1], np.diff(nodes[:, :, 0], axis=1)])
        directions = vectors / (np.linalg.norm(vectors, axis=-1, keepdims=True) + 1e-300)
        cosines = np.einsum("atec,btec->abte", directions, directions).min(axis=(0, 1, 3))
        return turn_findings(f"cable {self.name!r}", self.name, self.elements, times, cosines, "")

    def outline(self, coordinates: np.ndarray, points: int) -> np.ndarray:
        return line(
            coordinates.reshape(len(coordinates), -1, 2, 3), float(np.real(self.length)) / self.elements, points
        )


def cable_of(owner: str, point: Point) -> Cable:
    """Return the cable of a point; refuse points of other bodies."""
    if not isinstance(point.body, Cable):
        raise InputError(f"{owner}: {point} belongs to another body than a cable. Give a point of a Cable")
    return point.body


def _half_angle(share: Number) -> Any:
    """Half of the angle of an arc whose chord is a ``share`` of its length: sin(t) / t = share; complex-safe."""
    angle = float(cast(float, brentq(lambda t: np.sinc(t / np.pi) - np.real(share), 0.0, np.pi)))
    # A step of Newton's method with a complex share adds the derivative.
    return angle - (np.sin(angle) - share * angle) / (np.cos(angle) - share)
