"""Planar mechanisms for tests of derivatives: one scene for each kind of component, as a function of all its numbers."""

from collections.abc import Callable

import numpy as np

import dalembert.multibody as mb
from dalembert.parameter import Parameter
from mechanisms import SECTION

TIMES = np.array([0.0, 0.02, 0.05, 0.08])
SOLVER = mb.GeneralizedAlpha(step=5e-3, newton_tolerance=1e-18)
#: For components in whose scene a step of 5 ms is divided sometimes.
SHORT = mb.GeneralizedAlpha(step=2.5e-3, newton_tolerance=1e-18)

FLEXIBLE = {
    "length": 1.0, "elements": 2, "youngs_modulus": 4e5, "density": 900.0, **SECTION, "angle": 0.4, "start": (0.1, 0.2),
    "velocity": (0.3, -0.2), "angular_velocity": 0.8, "damping": 0.01,
}  # fmt: skip
RIGID = {"mass": 2.0, "inertia": 0.3, "angle": 0.4, "velocity": (0.3, -0.2), "angular_velocity": 0.8}
RUBBING = {"viscous": 0.4, "coulomb": 0.6, "friction_coefficient": 0.3, "stribeck": 0.5, "stribeck_exponent": 1.4}
DRIVE = {
    "torque_constant": 0.5, "resistance": 0.8, "back_emf": 0.4, "voltage_limit": 3.0, "gear_ratio": 2.0,
    "efficiency": 0.7, "slip_rate": 2.0, "armature_inertia": 0.02, "enabled": 0.9,
}  # fmt: skip


def arm(system: mb.System, **options) -> mb.RigidBar:
    """A bar that the other components act on."""
    return system.add(mb.RigidBar("arm", 1.0, 2.0, angle=0.3, angular_velocity=1.5, **options))


def swinging(system: mb.System, body: mb.Body, point: str) -> None:
    """A spring at a body, so that all of its numbers matter."""
    system.add(mb.Spring("holder", system.ground.point(-0.5, 1.0), body.point(point), 60.0, free_length=0.8))
    system.add(mb.TorsionSpring("winder", system.ground.point(0.0, 0.0), body.point(point), 3.0, free_angle=0.1))


def alone(kind: type, point: str = "end") -> Callable:
    """Scene of one body, held by springs."""

    def build(**fields) -> mb.System:
        system = mb.System(gravity=(0.7, -9.81))
        swinging(system, system.add(kind("part", **fields)), point)
        return system

    return build


def mass(**fields) -> mb.System:
    system = mb.System()
    point = system.add(mb.PointMass("part", **fields)).centre
    system.add(mb.Spring("holder", system.ground.point(-0.5, 1.0), point, 60.0, free_length=0.8))
    return system


def pinned(**fields) -> mb.System:
    system = mb.System()
    first = arm(system)
    second = system.add(mb.RigidBar("part", 0.8, 1.5, start=first.end, angle=-0.5, angular_velocity=-2.0))
    system.add(mb.RevoluteJoint("O", system.ground, first.start))
    system.add(mb.RevoluteJoint("joint", first.end, second.start, **fields))
    return system


def sliding(**fields) -> mb.System:
    system = mb.System()
    first = arm(system)
    second = system.add(mb.RigidBar("part", 0.8, 1.5, start=first.end, angle=-0.5))
    system.add(mb.RevoluteJoint("O", system.ground, first.start))
    system.add(mb.PrismaticJoint("joint", first.end, second.centre, **fields))
    return system


def hung(**fields) -> mb.System:
    system = mb.System()
    bar = arm(system)
    system.add(mb.DistanceJoint("joint", system.ground.point(0.2, 1.0), bar.start, **fields))
    return system


def acted(load: type, named: str = "at") -> Callable:
    """Scene of a load at the end of a pinned bar."""

    def build(**fields) -> mb.System:
        system = mb.System()
        bar = arm(system)
        system.add(mb.RevoluteJoint("O", system.ground, bar.start))
        sides = {"at": bar.end} if named == "at" else {"a": system.ground.point(0.3, 1.0, 0.1), "b": bar.end}
        system.add(load("part", **sides, **fields))
        return system

    return build


def on_a_rail(**fields) -> mb.System:
    """A bar under a force, and a mass whose height is prescribed."""
    system = acted(mb.Force)(x=5.0)
    slider = system.add(mb.PointMass("slider", 1.0, (0.5, -0.5)))
    system.add(mb.PrescribedMotion("rail", system.ground.point(0.4, 0.2), slider.centre, "y", **fields))
    system.add(mb.Spring("holder", system.bodies[0].point("end"), slider.centre, 9.0, free_length=0.4))
    return system


def driven(signal: type) -> Callable:
    """Scene of a smooth function of time, which drives a force and a motion."""

    def build(**fields) -> mb.System:
        system = on_a_rail(motion=signal(**fields))
        system.add(mb.Force("jet", system.bodies[0].point("end"), y=signal(**fields), follower=True))
        return system

    return build


def in_a_field(**fields) -> mb.System:
    system = acted(mb.Torque)(torque=1.0)
    system.gravity = fields["gravity"]
    return system


def grounded(**fields) -> mb.System:
    """A bar that hangs in a fixed line at a fixed point."""
    system = mb.System()
    place = mb.GroundPoint(**fields)
    bar = system.add(mb.RigidBar("part", 1.0, 2.0, start=place, angle=0.4))
    system.add(mb.PrismaticJoint("joint", place, bar.start, angle=-0.6))
    return system


def driving(kind: type) -> Callable:
    """Scene of two motors between two pinned bars, one of them at the limit of its voltage."""

    def build(**fields) -> mb.System:
        system = pinned()
        first, second = system.bodies
        sides = first.point("end"), second.point("start")
        system.add(kind("limited", *sides, **fields))
        system.add(kind("free", *sides, **fields | {"voltage_limit": None}))
        return system

    return build


def geared(**fields) -> mb.System:
    """A pinion under a spring that drives a wheel."""
    system = mb.System()
    bodies = arm(system), system.add(mb.RigidBar("wheel", 0.8, 1.5, start=(2.0, 0.0), angle=-0.5))
    for body in bodies:
        system.add(mb.RevoluteJoint(f"bearing of {body.name}", system.ground, body.start))
    system.add(mb.Spring("holder", system.ground.point(0.3, 1.0), bodies[0].end, 60.0, free_length=0.8))
    system.add(mb.GearJoint("joint", bodies[0].start, bodies[1].start, **fields))
    return system


#: Component: how to build its scene, and values of its numeric fields.
SCENES: dict[type, tuple[Callable[..., mb.System], dict]] = {
    mb.AncfBeam: (alone(mb.AncfBeam), FLEXIBLE | {"poisson_ratio": 0.3}),
    mb.AncfCable: (alone(mb.AncfCable), FLEXIBLE),
    mb.RigidBody: (
        lambda tip, **fields: alone(mb.RigidBody, "tip")(points={"tip": tip}, anchor="tip", **fields),
        RIGID | {"position": (0.1, 0.2), "tip": (0.6, 0.1)},
    ),
    mb.RigidBar: (alone(mb.RigidBar), RIGID | {"length": 1.2, "centre": 0.3, "start": (0.1, 0.2)}),
    mb.RigidBarBetween: (
        alone(mb.RigidBarBetween),
        {"start": (0.1, 0.2), "end": (1.1, 0.6), "mass": 2.0, "line_density": 0.5, "inertia": 0.3, "centre": 0.3}
        | {"velocity": (0.3, -0.2), "angular_velocity": 0.8},
    ),
    mb.PointMass: (mass, {"mass": 1.5, "position": (0.3, 0.4), "velocity": (0.5, -0.6)}),
    mb.RevoluteJoint: (pinned, RUBBING | {"pin_radius": 0.2, "slip_rate": 2.0, "stribeck_rate": 2.5}),
    mb.PrismaticJoint: (sliding, RUBBING | {"slip_velocity": 1.5, "angle": 0.7, "stribeck_velocity": 0.5}),
    mb.Motor: (driving(mb.Motor), DRIVE | {"voltage": 6.0, "current": None}),
    mb.Servo: (driving(mb.Servo), DRIVE | {"goal": 0.7, "kp": 6.0, "kd": 0.4, "dead_band": 0.05}),
    mb.FixedJoint: (pinned, {}),
    mb.DistanceJoint: (hung, {"length": 1.1}),
    mb.PrescribedMotion: (on_a_rail, {"motion": -0.6}),
    mb.Force: (acted(mb.Force), {"x": 3.0, "y": -8.0}),
    mb.Torque: (acted(mb.Torque), {"torque": 4.0}),
    mb.Spring: (acted(mb.Spring, "a"), {"stiffness": 90.0, "damping": 3.0, "free_length": 1.6, "cubic": 40.0}),
    mb.TorsionSpring: (
        acted(mb.TorsionSpring, "a"),
        {"stiffness": 9.0, "damping": 0.5, "free_angle": 0.9, "cubic": 4.0},
    ),
    mb.Bushing: (
        acted(mb.Bushing, "a"),
        {f"stiffness_{axis}": value for axis, value in (("x", 90.0), ("y", 60.0), ("angle", 8.0))}
        | {f"damping_{axis}": value for axis, value in (("x", 3.0), ("y", 2.0), ("angle", 0.5))},
    ),
    mb.GearJoint: (geared, {"ratio": -0.6}),
    mb.UserForce: (pinned, {}),
    mb.Constant: (driven(mb.Constant), {"value": 7.0}),
    mb.Step: (lambda value: acted(mb.Force)(x=mb.Step(value, 0.0131, 0.0567)), {"value": 30.0}),
    mb.Harmonic: (
        driven(mb.Harmonic),
        {"amplitude": 5.0, "angular_frequency": 20.0, "phase": 0.3, "offset": 1.0},
    ),
    mb.Polynomial: (
        lambda **c: driven(mb.Polynomial)(coefficients=list(c.values())),
        {"c0": 2.0, "c1": 30.0, "c2": -80.0},
    ),
    mb.Table: (
        lambda v0, v1, v2, v3, **own: driven(mb.Table)(times=[-0.02, 0.03, 0.05, 0.1], values=[v0, v1, v2, v3], **own),
        {"v0": 1.0, "v1": 2.0, "v2": -1.0, "v3": 0.5, "scale": 3.0, "offset": 0.8, "delay": 0.004},
    ),
    mb.BSpline: (
        lambda **c: driven(mb.BSpline)(coefficients=list(c.values()), start=-0.01, end=0.12),
        {"c0": 2.0, "c1": -1.0, "c2": 3.0, "c3": 0.5, "c4": 1.0},
    ),
    mb.Custom: (pinned, {}),
    mb.GroundPoint: (grounded, {"x": 0.3, "y": -0.4, "angle": 0.2}),
    mb.System: (in_a_field, {"gravity": (0.7, -9.81)}),
}


def numbers_of(fields: dict) -> dict[str, float]:
    """Numbers by name; those of a pair get names of their own."""
    numbers = {}
    for name, value in fields.items():
        if isinstance(value, tuple):
            numbers |= {f"{name}_x": value[0], f"{name}_y": value[1]}
        elif isinstance(value, float):
            numbers[name] = value
    return numbers


def response(build: Callable[..., mb.System], fields: dict, solver: mb.GeneralizedAlpha = SOLVER) -> mb.TimeResponse:
    """A scene as a function of all of its numbers."""

    def builder(**numbers) -> mb.System:
        own = {
            name: (numbers[f"{name}_x"], numbers[f"{name}_y"]) if isinstance(value, tuple) else numbers.get(name, value)
            for name, value in fields.items()
        }
        return build(**own)

    parameters = {
        name: Parameter(name, value - abs(value) / 2, value + abs(value) / 2, scale=abs(value))
        for name, value in numbers_of(fields).items()
    }
    system = build(**fields)
    names = [f"{body.name}.{body.point_names[-1]}.{entry}" for body in system.bodies for entry in ("x", "vy", "ax")]
    names += ["system.total_energy", *(f"{joint.name}.force_x" for joint in system.joints)]
    return mb.TimeResponse(builder, parameters, names, TIMES, solver)


def rod(mass: float, length: float) -> mb.System:
    """A uniform rod, whose inertia follows from mass and length."""
    return alone(mb.RigidBar)(mass=mass, length=length)


def slack(x: float, angle: float) -> mb.System:
    """Springs and a rod whose free lengths and angles are those of the first placement."""
    system = mb.System()
    bar = system.add(mb.AncfCable("arm", 1.0, 2, 4e5, 900.0, **SECTION, start=(x, 0.2), angle=angle))
    system.add(mb.Spring("coil", system.ground.point(0.0, 0.0), bar.start, 50.0))
    system.add(mb.TorsionSpring("winder", system.ground, bar.end, 5.0))
    system.add(mb.DistanceJoint("rod", system.ground.point(1.0, 2.0), bar.node(1)))
    return system


def loop(crank: float, base: float, turn: float, rate: float) -> mb.System:
    """A four-bar, roughly placed, with a flexible coupler; the crank drives."""
    system = mb.System(driving=["crank.angle"])
    first = system.add(mb.RigidBar("crank", crank, 1.0, angle=turn, angular_velocity=rate))
    second = system.add(mb.AncfCable("coupler", 1.0, 2, 4e6, 900.0, **SECTION, start=first.end, angle=0.3))
    third = system.add(mb.RigidBar("rocker", 0.8, 1.5, start=(base, 0.0), angle=1.5))
    system.add(mb.RevoluteJoint("A0", system.ground.point(0.0, 0.0), first.start))
    system.add(mb.RevoluteJoint("A", first.end, second.start))
    system.add(mb.RevoluteJoint("B", second.end, third.end))
    system.add(mb.RevoluteJoint("B0", system.ground.point(base, 0.0), third.start))
    return system
