"""Beams in space written for Exudyn: a cantilever that falls under its weight, and an elbow."""

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import exudyn as exu
import numpy as np
from exudyn import itemInterface as items

EXACT, EXACT_LIE, CABLE = "geometrically exact, Euler parameters", "geometrically exact, rotation vectors", "ANCF cable"


def cantilever(
    kind: str, elements: int, stiffness: np.ndarray, inertia: tuple[float, float], length: float,
    gravity: tuple[float, float, float], end: float, step: float, radius: float, dense: bool,
) -> Callable[[], np.ndarray]:  # fmt: skip
    """A function that simulates, and returns the tip's position at the end, m; ``inertia``: mass and its second moment
    per length. A new system is assembled before the clock starts.
    """
    mass, second = inertia

    container = exu.SystemContainer()

    def build() -> tuple[Any, list[int]]:
        system = container.AddSystem()
        h, count = length / elements, elements + 1
        if kind == CABLE:
            place = [[i * h, 0, 0, 1, 0, 0] for i in range(count)]
            nodes = [system.AddNode(items.NodePointSlope1(referenceCoordinates=x)) for x in place]
            bodies = [
                items.ObjectANCFCable(
                    nodeNumbers=[a, b], length=h, massPerLength=mass, bendingStiffness=stiffness[4],
                    axialStiffness=stiffness[0], useReducedOrderIntegration=1,
                )
                for a, b in pairwise(nodes)
            ]  # fmt: skip
            for k in range(6):
                fixed = system.AddMarker(
                    items.MarkerNodeCoordinate(nodeNumber=system.AddNode(items.NodePointGround()), coordinate=0)
                )
                held = system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=nodes[0], coordinate=k))
                system.AddObject(items.CoordinateConstraint(markerNumbers=[fixed, held]))
        else:
            section = exu.BeamSection()
            section.stiffnessMatrix, section.massPerLength = np.diag(stiffness), mass
            section.inertia = np.diag([2 * second, second, second])
            node: Any = items.NodeRigidBodyEP if kind == EXACT else items.NodeRigidBodyRotVecLG
            turn = [1, 0, 0, 0] if kind == EXACT else [0, 0, 0]
            nodes = [system.AddNode(node(referenceCoordinates=[i * h, 0, 0, *turn])) for i in range(count)]
            bodies = [
                items.ObjectBeamGeometricallyExact(nodeNumbers=[a, b], length=h, sectionData=section)
                for a, b in pairwise(nodes)
            ]
            ground = system.AddMarker(items.MarkerNodeRigid(nodeNumber=system.AddNode(items.NodePointGround())))
            clamp = system.AddMarker(items.MarkerNodeRigid(nodeNumber=nodes[0]))
            system.AddObject(items.ObjectJointGeneric(markerNumbers=[ground, clamp]))
        for body in bodies:
            marker = system.AddMarker(items.MarkerBodyMass(bodyNumber=system.AddObject(body)))
            system.AddLoad(items.LoadMassProportional(markerNumber=marker, loadVector=list(gravity)))
        return system, nodes[-1:]

    run = runner(build, end, step, radius, dense)
    return lambda: run()[-1]


def elbow(
    elements: int, stiffness: np.ndarray, inertia: tuple[float, float], length: float, force: float, end: float,
    step: float, radius: float, dense: bool,
) -> Callable[[], np.ndarray]:  # fmt: skip
    """As :func:`cantilever`, of two geometrically exact beams at a right angle whose corner a force pushes along z."""
    mass, second = inertia
    container = exu.SystemContainer()

    def build() -> tuple[Any, list[int]]:
        system, h = container.AddSystem(), length / elements
        section = exu.BeamSection()
        section.stiffnessMatrix, section.massPerLength = np.diag(stiffness), mass
        section.inertia = np.diag([2 * second, second, second])
        half = np.sqrt(0.5)
        first = [[i * h, 0, 0, 1, 0, 0, 0] for i in range(elements + 1)]
        other = [[length, i * h, 0, half, 0, 0, half] for i in range(elements + 1)]
        legs = [
            [system.AddNode(items.NodeRigidBodyEP(referenceCoordinates=place)) for place in places]
            for places in (first, other)
        ]
        for leg in legs:
            for a, b in pairwise(leg):
                system.AddObject(items.ObjectBeamGeometricallyExact(nodeNumbers=[a, b], length=h, sectionData=section))
        ground = system.AddMarker(items.MarkerNodeRigid(nodeNumber=system.AddNode(items.NodePointGround())))
        clamp, corner, begin = (
            system.AddMarker(items.MarkerNodeRigid(nodeNumber=node)) for node in (legs[0][0], legs[0][-1], legs[1][0])
        )
        system.AddObject(items.ObjectJointGeneric(markerNumbers=[ground, clamp]))
        quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
        system.AddObject(items.ObjectJointGeneric(markerNumbers=[corner, begin], rotationMarker0=quarter))
        system.AddLoad(items.LoadForceVector(markerNumber=corner, loadVector=[0, 0, force]))
        return system, legs[1][-1:]

    run = runner(build, end, step, radius, dense)
    return lambda: run()[-1]


def runner(
    build: Callable[[], tuple[Any, list[int]]], end: float, step: float, radius: float, dense: bool, samples: int = 1,
    tolerance: float = 1e-8,
) -> Callable[[], np.ndarray]:  # fmt: skip
    """A function that simulates what ``build`` makes, and returns positions of its nodes, (samples, 3 nodes).

    The samples are at equal distances in time, and the last one is at the end.
    """
    settings = exu.SimulationSettings()
    steps = settings.timeIntegration
    steps.newton.useModifiedNewton = True
    steps.newton.relativeTolerance = steps.newton.absoluteTolerance = tolerance
    steps.numberOfSteps, steps.endTime = round(end / step), end
    steps.generalizedAlpha.spectralRadius = radius
    steps.verboseMode = 0
    settings.linearSolver.solverType = exu.LinearSolverType.EXUdense if dense else exu.LinearSolverType.EigenSparse
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = end / samples
    settings.displayStatistics = False
    settings.parallel.numberOfThreads = 1

    system, nodes = build()
    kept: dict[str, Any] = {"outputVariableType": exu.OutputVariableType.Position, "storeInternal": True}
    sensors = [system.AddSensor(items.SensorNode(nodeNumber=node, writeToFile=False, **kept)) for node in nodes]
    system.Assemble()

    def run() -> np.ndarray:
        if not system.SolveDynamic(settings, exu.DynamicSolverType.GeneralizedAlpha):
            raise RuntimeError("Exudyn could not integrate the model")
        return np.hstack([system.GetSensorStoredData(sensor)[-samples:, 1:] for sensor in sensors])

    return run
