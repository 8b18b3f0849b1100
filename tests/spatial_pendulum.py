"""A double pendulum in space: a body on a ball joint, and one on a skew hinge below it."""

import numpy as np

import dalembert as da
from dalembert.multibody import GeneralizedAlpha, RadauIIA, Trajectory, simulate
from dalembert.multibody.spatial import (
    Inertia,
    Pose,
    RevoluteJoint,
    RigidBody,
    Shape,
    SpatialSystem,
    SphericalJoint,
)

TRUE = np.array([2.0, 0.4, 2.5])
BOX = {"mass": (0.5, 3.0), "length": (0.3, 0.6), "spin": (0.0, 6.0)}
CHANNELS = [f"{point}.{axis}" for point in ("two.tip", "one.low") for axis in "xyz"]
TIMES = np.linspace(0.0, 1.0, 41)
SOLVER = GeneralizedAlpha(step=2e-3)


def build(mass, length, spin) -> SpatialSystem:
    system = SpatialSystem()
    one = system.add(
        RigidBody(
            "one",
            Inertia.box(mass, (0.1, 0.1, 0.4)).moved((0.0, 0.0, -length / 2)),
            points={"low": (0.0, 0.0, -length)},
            angular_velocity=(spin, 3.0, 0.5),
            shapes=[Shape.cylinder(0.02, length, Pose((0.0, 0.0, -length / 2))), Shape.sphere(0.04)],
        )
    )
    system.add(SphericalJoint("ball", system.ground, one.point("origin")))
    two = system.add(
        RigidBody(
            "two",
            Inertia.box(1.0, (0.1, 0.08, 0.4)).moved((0.0, 0.0, -0.2)),
            position=one.point("low"),
            points={"tip": (0.0, 0.0, -0.4)},
        )
    )
    system.add(RevoluteJoint("hinge", one.point("low"), two.point("origin"), axis=(0.0, 1.0, 0.0)))
    return system


def motion(samples: int = 251, end: float = 1.0) -> Trajectory:
    return simulate(build(*TRUE), end, SOLVER, np.linspace(0.0, end, samples))


def response(solver=SOLVER) -> da.TimeResponse:
    return da.TimeResponse(build, BOX, CHANNELS, TIMES, solver)


def records(noise: float = 1e-3) -> da.Measurements:
    """Positions of two points with noise, of an exact integration."""
    values = response(RadauIIA(tolerance=1e-9)).evaluate(TRUE).only()[0]
    values = values + noise * np.random.default_rng(1).standard_normal(values.shape)
    return da.Measurements.of(TIMES, dict(zip(CHANNELS, values.T, strict=True)))
