"""Peers in Exudyn (C++): the same elements, the same integrator, the same step, nothing written or drawn.

Modified Newton is on, as Exudyn has it by default. Its ``contractivity``, at which a Jacobian is renewed, is 0.5 there;
0.1 was measured to be faster on the flexible pendulum and is what the ratios are taken against.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from exudyn.rigidBodyUtilities import ComputeOrthonormalBasis, RigidBodyInertia

from benchmarks.cases import ARM, GRAVITY, PENDULUM, Bar, FlexiblePendulum, Integration, Rod, TwoLinkArm
from benchmarks.spatial_cases import Mechanism

DENSE, SPARSE = "EXUdense", "EigenSparse"
AS_IT_COMES, TUNED = 0.5, 0.1
FULL, MIXED = 0, 2  # integration of a cable: Gauss order 9 and 5; Lobatto and Gauss
WEIGHT = [0.0, -GRAVITY, 0.0]


@dataclass(frozen=True)
class Peer:
    """A built model; ``run()`` integrates it from its initial state and returns (samples, channels).

    ``stiffness(bar index, youngs_modulus)`` changes a bar of the built model, so that a repeated solution, as an
    identification needs it, does not pay for building.
    """

    run: Callable[[], np.ndarray]
    stiffness: Callable[[int, float], None]
    newton_iterations: Callable[[], int]
    container: object  # the model dies with it


def flexible_pendulum(case: FlexiblePendulum = PENDULUM, solver: str = DENSE, contractivity=TUNED) -> Peer:
    """Channels: x and y of the joint, x and y of the tip."""
    container, system = _system()
    start = _ground(system)
    bars, points = [], []
    corner = np.zeros(2)
    for bar in (case.oa, case.ab):
        nodes, elements = _cable(system, bar, corner)
        system.AddObject(eii.ObjectJointRevolute2D(markerNumbers=[start, _at_node(system, nodes[0])]))
        start = _at_node(system, nodes[-1])
        points.append(nodes[-1])
        bars.append((bar, elements))
        corner = corner + bar.length * _direction(bar.angle)
    sensors = [_sensor(system, node) for node in points]
    return _peer(container, system, sensors, _settings(case.integration, solver, contractivity), bars)


def two_link_arm(case: TwoLinkArm = ARM, solver: str = DENSE, contractivity=TUNED) -> Peer:
    """Channels: x and y of the joint, x and y of the tip."""
    container, system = _system()
    start = _ground(system)
    corner, sensors = np.zeros(2), []
    for rod in (case.upper, case.lower):
        body = _rod(system, rod, corner)
        system.AddObject(eii.ObjectJointRevolute2D(markerNumbers=[start, _at_body(system, body, -rod.length / 2)]))
        start = _at_body(system, body, rod.length / 2)
        sensors.append(
            system.AddSensor(
                eii.SensorBody(
                    bodyNumber=body,
                    localPosition=[rod.length / 2, 0, 0],
                    outputVariableType=exu.OutputVariableType.Position,
                    storeInternal=True,
                    writeToFile=False,
                )
            )
        )
        corner = corner + rod.length * _direction(rod.angle)
    return _peer(container, system, sensors, _settings(case.integration, solver, contractivity))


def chain(bar: Bar, integration: Integration, solver: str = SPARSE, contractivity=TUNED) -> Peer:
    """Channels: x and y of the free end."""
    container, system = _system()
    nodes, elements = _cable(system, bar, np.zeros(2))
    system.AddObject(
        eii.ObjectJointRevolute2D(markerNumbers=[_ground(system), _at_node(system, nodes[0])]),
    )
    settings = _settings(integration, solver, contractivity)
    return _peer(container, system, [_sensor(system, nodes[-1])], settings, [(bar, elements)])


def strip(bar: Bar, integration: Integration, kind: str, contractivity=TUNED) -> Peer:
    """Bar clamped at its start. Channels: x and y of the free end.

    ``kind``: cables with full (``"cable"``) or mixed (``"cable, Lobatto"``) integration, or geometrically exact beams
    with shear (``"beam"``).
    """
    container, system = _system()
    if kind == "beam":
        nodes, elements = _beam(system, bar, np.zeros(2))
        held = (0, 1, 2)
    else:
        nodes, elements = _cable(system, bar, np.zeros(2), MIXED if kind == "cable, Lobatto" else FULL)
        held = (0, 1, 3)  # the place and the direction
    ground = system.AddNode(eii.NodePointGround())
    fixed = system.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
    for coordinate in held:
        marker = system.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=nodes[0], coordinate=coordinate))
        system.AddObject(eii.ObjectConnectorCoordinate(markerNumbers=[fixed, marker]))
    settings = _settings(integration, DENSE if bar.elements < 16 else SPARSE, contractivity)
    settings.timeIntegration.newton.relativeTolerance = 1e-6  # rounding in a thin strip is above the default of 1e-8
    return _peer(container, system, [_sensor(system, nodes[-1])], settings, [(bar, elements)])


def mechanism(case: Mechanism, solver: str = DENSE, contractivity=TUNED, node: str = "RotationEulerParameters") -> Peer:
    """A mechanism in space. Channels: x, y and z of its tip. ``node``: how rotations are described."""
    container, system = _system()
    ground = system.CreateGround()
    bodies = []
    for own in case.bodies:
        inertia = RigidBodyInertia(own.mass, own.tensor, own.centre, inertiaTensorAtCOM=True)
        bodies.append(
            system.CreateRigidBody(
                referencePosition=own.position,
                initialVelocity=list(own.velocity),
                initialAngularVelocity=list(own.spin),
                inertia=inertia,
                gravity=list(case.gravity),
                nodeType=getattr(exu.NodeType, node),
            )
        )
    for pin in case.joints:
        sides = [ground if side < 0 else bodies[side] for side in (pin.a, pin.b)]
        if pin.axis is None:
            system.CreateSphericalJoint(itemNumbers=sides, position=pin.point, show=False)
        elif pin.slides:
            axes, free_along_x = ComputeOrthonormalBasis(pin.axis), [0, 1, 1, 0, 1, 1]
            system.CreateGenericJoint(
                itemNumbers=sides, position=pin.point, rotationMatrixAxes=axes, constrainedAxes=free_along_x, show=False
            )
        else:
            system.CreateRevoluteJoint(itemNumbers=sides, position=pin.point, axis=list(pin.axis), show=False)
    sensor = eii.SensorBody(
        bodyNumber=bodies[-1],
        localPosition=case.tip,
        outputVariableType=exu.OutputVariableType.Position,
        storeInternal=True,
        writeToFile=False,
    )
    settings = _settings(case.integration, solver, contractivity)
    return _peer(container, system, [system.AddSensor(sensor)], settings, dimension=3)


def _system():
    container = exu.SystemContainer()
    return container, container.AddSystem()


def _direction(angle: float) -> np.ndarray:
    return np.array([np.cos(angle), np.sin(angle)])


def _ground(system) -> int:
    ground = system.AddObject(eii.ObjectGround())
    return system.AddMarker(eii.MarkerBodyPosition(bodyNumber=ground))


def _at_node(system, node: int) -> int:
    return system.AddMarker(eii.MarkerNodePosition(nodeNumber=node))


def _at_body(system, body: int, x: float) -> int:
    return system.AddMarker(eii.MarkerBodyPosition(bodyNumber=body, localPosition=[x, 0, 0]))


def _sensor(system, node: int) -> int:
    return system.AddSensor(
        eii.SensorNode(
            nodeNumber=node,
            outputVariableType=exu.OutputVariableType.Position,
            storeInternal=True,
            writeToFile=False,
        )
    )


def _cable(system, bar: Bar, corner: np.ndarray, integration: int = MIXED) -> tuple[list[int], list[int]]:
    """Nodes and elements of a straight bar; ``MIXED`` has Lobatto's points for the axial force, as ours."""
    direction = _direction(bar.angle)
    size = bar.length / bar.elements
    nodes = [
        system.AddNode(eii.NodePoint2DSlope1(referenceCoordinates=[*(corner + number * size * direction), *direction]))
        for number in range(bar.elements + 1)
    ]
    elements = []
    for left, right in pairwise(nodes):
        element = system.AddObject(
            eii.ObjectANCFCable2D(
                length=size,
                massPerLength=bar.mass_per_length,
                bendingStiffness=bar.bending_stiffness,
                axialStiffness=bar.axial_stiffness,
                nodeNumbers=[left, right],
                useReducedOrderIntegration=integration,
            )
        )
        mass = system.AddMarker(eii.MarkerBodyMass(bodyNumber=element))
        system.AddLoad(eii.LoadMassProportional(markerNumber=mass, loadVector=WEIGHT))
        elements.append(element)
    return nodes, elements


def _beam(system, bar: Bar, corner: np.ndarray) -> tuple[list[int], list[int]]:
    """Nodes and elements of a straight bar of geometrically exact beams: linear, with shear."""
    direction, size = _direction(bar.angle), bar.length / bar.elements
    area = bar.height * bar.width
    nodes = [
        system.AddNode(eii.NodeRigidBody2D(referenceCoordinates=[*(corner + k * size * direction), bar.angle]))
        for k in range(bar.elements + 1)
    ]
    elements = []
    for left, right in pairwise(nodes):
        element = system.AddObject(
            eii.ObjectBeamGeometricallyExact2D(
                nodeNumbers=[left, right],
                length=size,
                massPerLength=bar.mass_per_length,
                crossSectionInertia=bar.mass_per_length * bar.height**2 / 12,
                bendingStiffness=bar.bending_stiffness,
                axialStiffness=bar.axial_stiffness,
                shearStiffness=bar.youngs_modulus / 2.6 * 13 / 15.3 * area,
                includeReferenceRotations=True,
            )
        )
        mass = system.AddMarker(eii.MarkerBodyMass(bodyNumber=element))
        system.AddLoad(eii.LoadMassProportional(markerNumber=mass, loadVector=WEIGHT))
        elements.append(element)
    return nodes, elements


def _rod(system, rod: Rod, corner: np.ndarray) -> int:
    centre = corner + rod.length / 2 * _direction(rod.angle)
    node = system.AddNode(eii.NodeRigidBody2D(referenceCoordinates=[*centre, rod.angle]))
    body = system.AddObject(eii.ObjectRigidBody2D(mass=rod.mass, inertia=rod.inertia, nodeNumber=node))
    mass = system.AddMarker(eii.MarkerBodyMass(bodyNumber=body))
    system.AddLoad(eii.LoadMassProportional(markerNumber=mass, loadVector=WEIGHT))
    return body


def _settings(integration: Integration, solver: str, contractivity: float) -> exu.SimulationSettings:
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime = integration.end
    settings.timeIntegration.numberOfSteps = integration.steps
    settings.timeIntegration.generalizedAlpha.spectralRadius = integration.spectral_radius
    settings.timeIntegration.newton.useModifiedNewton = True
    settings.timeIntegration.newton.modifiedNewtonContractivity = contractivity
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = integration.every * integration.step
    settings.linearSolver.solverType = getattr(exu.LinearSolverType, solver)
    settings.displayStatistics = False
    settings.parallel.numberOfThreads = 1
    return settings


def _peer(container, system, sensors: list[int], settings: exu.SimulationSettings, bars=(), dimension=2) -> Peer:
    system.Assemble()

    def run() -> np.ndarray:
        if not system.SolveDynamic(settings, exu.DynamicSolverType.GeneralizedAlpha):
            raise RuntimeError("Exudyn could not integrate the model")
        return np.hstack([system.GetSensorStoredData(sensor)[:, 1 : 1 + dimension] for sensor in sensors])

    def stiffness(index: int, youngs_modulus: float) -> None:
        bar, elements = bars[index]
        changed = replace(bar, youngs_modulus=youngs_modulus)
        for element in elements:
            system.SetObjectParameter(element, "bendingStiffness", changed.bending_stiffness)
            system.SetObjectParameter(element, "axialStiffness", changed.axial_stiffness)

    def newton_iterations() -> int:
        return int(system.sys["dynamicSolver"].it.newtonStepsCount)

    return Peer(run, stiffness, newton_iterations, container)
