"""The slider-crank with a flexible rod, written for Exudyn: geometrically exact beams between two rigid bodies."""

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import exudyn as exu
import numpy as np
from exudyn import itemInterface as items
from scipy.spatial.transform import Rotation

from benchmarks.crank_case import SliderCrank
from benchmarks.peers.exudyn_beams import runner

REVOLUTE_X, PRISMATIC_X, SPHERICAL = [1, 1, 1, 0, 1, 1], [0, 1, 1, 1, 1, 1], [1, 1, 1, 0, 0, 0]
UNIVERSAL = [1, 1, 1, 0, 1, 0]
"""The x axis of the first marker stays perpendicular to the z axis of the second one."""


def slider_crank(
    case: SliderCrank,
    elements: int,
    end: float,
    step: float,
    radius: float,
    samples: int,
    tolerance: float,
    dense: bool,
) -> Callable[[], np.ndarray]:
    """A function that simulates, and returns the slider's way and the position of the rod's middle, (samples, 4), m."""
    container = exu.SystemContainer()

    def build() -> tuple[Any, list[int]]:
        system = container.AddSystem()
        crank, slider = (
            _body(system, place, inertia, case.gravity)
            for place, inertia in ((case.bearing, case.flywheel), ((case.way, 0, 0), case.slider))
        )
        rod = _rod(system, case, elements)

        def marker(node: int) -> int:
            return system.AddMarker(items.MarkerNodeRigid(nodeNumber=node))

        def join(a: int, b: int, axes: list[int]) -> None:
            system.AddObject(items.GenericJoint(markerNumbers=[a, b], constrainedAxes=axes))

        ground = system.AddObject(items.ObjectGround())
        bearing, guide = (
            system.AddMarker(items.MarkerBodyRigid(bodyNumber=ground, localPosition=place))
            for place in (case.bearing, (0, 0, 0))
        )
        turning = marker(crank[0])
        pin = system.AddMarker(items.MarkerBodyRigid(bodyNumber=crank[1], localPosition=[0, 0, case.crank]))
        join(bearing, turning, REVOLUTE_X)
        join(pin, marker(rod[0]), UNIVERSAL)
        join(marker(rod[-1]), marker(slider[0]), SPHERICAL)
        join(guide, marker(slider[0]), PRISMATIC_X)
        system.AddLoad(items.LoadTorqueVector(markerNumber=turning, loadVector=[case.torque, 0, 0]))
        return system, [slider[0], rod[elements // 2]]

    places = runner(build, end, step, radius, dense, samples, tolerance)
    return lambda: places()[:, [0, 3, 4, 5]]


def _body(system: Any, place: Any, inertia: tuple[float, float], gravity: Any) -> tuple[int, int]:
    """Node and number of a rigid body with its mass and the same moment about all axes."""
    mass, moment = inertia
    node = system.AddNode(items.NodeRigidBodyEP(referenceCoordinates=[*place, 1, 0, 0, 0]))
    body = items.ObjectRigidBody(nodeNumber=node, physicsMass=mass, physicsInertia=[*[moment] * 3, 0, 0, 0])
    number = system.AddObject(body)
    _weigh(system, number, gravity)
    return node, number


def _rod(system: Any, case: SliderCrank, elements: int) -> list[int]:
    """Nodes of the rod."""
    section, (about_y, about_z) = exu.BeamSection(), case.section.moments
    section.stiffnessMatrix, section.massPerLength = case.section.matrix, case.section.mass
    section.inertia = np.diag([about_y + about_z, about_y, about_z])
    x, y, z, w = Rotation.from_matrix(case.axes).as_quat()
    places = case.pin + np.linspace(0.0, case.rod, elements + 1)[:, None] * case.axes[:, 0]
    nodes = [system.AddNode(items.NodeRigidBodyEP(referenceCoordinates=[*place, w, x, y, z])) for place in places]
    for a, b in pairwise(nodes):
        beam = items.ObjectBeamGeometricallyExact(nodeNumbers=[a, b], length=case.rod / elements, sectionData=section)
        _weigh(system, system.AddObject(beam), case.gravity)
    return nodes


def _weigh(system: Any, body: int, gravity: Any) -> None:
    marker = system.AddMarker(items.MarkerBodyMass(bodyNumber=body))
    system.AddLoad(items.LoadMassProportional(markerNumber=marker, loadVector=list(gravity)))
