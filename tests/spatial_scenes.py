"""Mechanisms in space for tests: one scene for each kind of component, as a function of all of its numbers."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

import dalembert.multibody as mb
import dalembert.multibody.spatial as sp
from dalembert.parameter import Parameter
from dalembert.structure import FreeBodyModes

AXIS = (0.3, 0.2, 1.0)
Scene = tuple[Callable[..., sp.SpatialSystem], dict]


def by_angles(angles) -> sp.Orientation:
    """The orientation of three angles about turning axes."""
    return sp.Orientation.by_angles("zyx", angles)


def two_rods(on_ball: bool | None = True) -> tuple[sp.SpatialSystem, sp.RigidBody, sp.RigidBody]:
    """Two rods, the second placed at the end of the first; one turns, which must be on a ball joint; none if None."""
    spin = (0.3, 0.4, 0.2)
    system = sp.SpatialSystem()
    rod = sp.Inertia.box(1.3, (0.1, 0.2, 0.5)).moved((0.02, 0.01, -0.25))
    first = system.add(
        sp.RigidBody(
            "first",
            rod,
            points={"end": sp.Pose((0.05, 0.0, -0.5), by_angles([0.3, 0.1, 0.2]))},
            orientation=sp.Orientation.by_angles("xyz", [0.1, 0.3, 0.2]),
            angular_velocity=spin if on_ball else None,
        )
    )
    second = system.add(
        sp.RigidBody(
            "second",
            rod,
            position=first.point("end"),
            points={"tip": sp.Pose((0.0, 0.1, -0.4), by_angles([-0.2, 0.3, 0.1]))},
            orientation=sp.Orientation.by_angles("x", [0.3]),
            angular_velocity=spin if on_ball is False else None,
        )
    )
    return system, first, second


def jointed(kind: type, **fixed) -> Callable[..., sp.SpatialSystem]:
    """Two rods: the first hangs on a ball joint, the second on the joint."""

    def build(**fields) -> sp.SpatialSystem:
        system, first, second = two_rods()
        system.add(sp.SphericalJoint("hold", system.ground, first.point("origin")))
        system.add(kind("part", first.point("end"), second.point("origin"), **fixed, **fields))
        return system

    return build


def grounded(kind: type, **fixed) -> Callable[..., sp.SpatialSystem]:
    """Two rods: the first hangs on the joint, the second on a ball joint."""

    def build(**fields) -> sp.SpatialSystem:
        system, first, second = two_rods(on_ball=False)
        place = system.ground.point((0.0, 0.0, 0.0), by_angles([0.2, 0.1, 0.1]))
        system.add(kind("part", place, first.point("origin"), **fixed, **fields))
        system.add(sp.SphericalJoint("hold", first.point("end"), second.point("origin")))
        return system

    return build


def acting(make: Callable) -> Callable[..., sp.SpatialSystem]:
    """Two rods on ball joints, and what ``make`` adds for the system, the end of the first and the tip of the second."""

    def build(**fields) -> sp.SpatialSystem:
        system, first, second = two_rods()
        system.add(sp.SphericalJoint("hold", system.ground, first.point("origin")))
        system.add(sp.SphericalJoint("middle", first.point("end"), second.point("origin")))
        system.add(make(system, first.point("end"), second.point("tip"), **fields))
        return system

    return build


def between(kind: type, **fixed) -> Callable[..., sp.SpatialSystem]:
    """A load between both rods."""
    return acting(lambda system, a, b, **fields: kind("part", a, b, **fixed, **fields))


def from_ground(kind: type, **fixed) -> Callable[..., sp.SpatialSystem]:
    """A load between a point of the ground and the second rod."""

    def make(system, a, b, **fields):
        return kind("part", system.ground.point((0.3, 0.1, -1.0), by_angles([0.3, 0.2, 0.1])), b, **fixed, **fields)

    return acting(make)


def hung(length) -> sp.SpatialSystem:
    """The second rod hangs on a massless rod at the first."""
    system, first, second = two_rods()
    system.add(sp.SphericalJoint("hold", system.ground, first.point("origin")))
    system.add(sp.DistanceJoint("part", first.point("end"), second.point("tip"), length=length))
    return system


def pulling(kind: type, against: bool, follower: bool) -> Callable[..., sp.SpatialSystem]:
    """A force or torque on the second rod, and its opposite on the first."""
    return acting(lambda system, a, b, **own: kind("part", b, **own, follower=follower, against=a if against else None))


def driven(coordinate: str, joint: Callable[..., sp.SpatialSystem]) -> Callable[..., sp.SpatialSystem]:
    """A prescribed motion of a joint, which begins with the rate of the joint as it is placed."""

    def build(axis, motion) -> sp.SpatialSystem:
        system = joint(axis=axis)
        guide = next(own for own in system.joints if own.name == "part")
        course = mb.Polynomial([motion, 0.7, 0.4])
        system.add(sp.PrescribedMotion("motion", guide.a, guide.b, coordinate, course, axis=axis))
        return system

    return build


def wound(joint: Callable[..., sp.SpatialSystem]) -> Callable[..., sp.SpatialSystem]:
    """A torsion spring at a hinge."""

    def build(axis, **fields) -> sp.SpatialSystem:
        system = joint(axis=axis)
        hinge = next(own for own in system.joints if own.name == "part")
        system.add(sp.TorsionSpring("spring", hinge.a, hinge.b, axis=axis, **fields))
        return system

    return build


def stopped(kind: type, joint: Callable[..., sp.SpatialSystem]) -> Callable[..., sp.SpatialSystem]:
    """Two limits of a joint, beyond which it is at the start: it is wedged between them."""

    def build(axis, lower_limit, upper_limit, **fields) -> sp.SpatialSystem:
        system = joint(axis=axis)
        guide = next(own for own in system.joints if own.name == "part")
        system.add(kind("lower", guide, lower_limit=lower_limit, upper_limit=2.0, **fields))
        system.add(kind("upper", guide, lower_limit=-2.0, upper_limit=upper_limit, **fields))
        return system

    return build


def coupled(kind: type, first_joint: type, second_joint: type) -> Callable[..., sp.SpatialSystem]:
    """Two rods on joints with an axis, of which the second follows the first."""

    def build(axis, **fields) -> sp.SpatialSystem:
        system, first, second = two_rods(None)
        place = system.ground.point((0.0, 0.0, 0.0), by_angles([0.2, 0.1, 0.1]))
        a = system.add(first_joint("a", place, first.point("origin"), axis=axis))
        b = system.add(second_joint("b", first.point("end"), second.point("origin"), axis=(1.0, 0.2, 0.1)))
        system.add(kind("part", a, b, **fields))
        return system

    return build


def powered(joint: Callable[..., sp.SpatialSystem]) -> Callable[..., sp.SpatialSystem]:
    """Two motors at a hinge, one of them at the limit of its voltage."""

    def build(axis, **fields) -> sp.SpatialSystem:
        system = joint(axis=axis)
        hinge = next(own for own in system.joints if own.name == "part")
        system.add(sp.Motor("limited", hinge.a, hinge.b, axis=axis, **fields))
        system.add(sp.Motor("free", hinge.a, hinge.b, axis=axis, **fields | {"voltage_limit": None}))
        return system

    return build


def rubbing(build: Callable[..., sp.SpatialSystem]) -> Callable[..., sp.SpatialSystem]:
    """A joint whose friction has the numbers."""
    return lambda axis, **fields: build(axis=axis, friction=sp.Friction(**fields))


def bushed(build: Callable[..., sp.SpatialSystem]) -> Callable[..., sp.SpatialSystem]:
    """A bushing with two full symmetric matrices of numbers."""

    def made(**fields) -> sp.SpatialSystem:
        rows = {what: [[0.0] * 6 for _ in range(6)] for what in ("stiffness", "damping")}
        for name, value in fields.items():
            what, entry = name.split("_")
            i, j = int(entry[0]), int(entry[1])
            rows[what][i][j] = rows[what][j][i] = value
        return build(**{what: np.array(matrix) for what, matrix in rows.items()})

    return made


def body(mass, moments, products, centre, position, angles, velocity, angular_velocity, tip, tip_angles):
    """A body on springs."""
    system = sp.SpatialSystem()
    part = system.add(
        sp.RigidBody(
            "part",
            sp.Inertia(mass, moments, products, centre),
            position,
            by_angles(angles),
            anchor="tip",
            points={"tip": sp.Pose(tip, by_angles(tip_angles))},
            velocity=velocity,
            angular_velocity=angular_velocity,
        )
    )
    held = system.ground.point((-0.5, 1.0, 0.3))
    system.add(sp.Spring("holder", held, part.point("tip"), 60.0, free_length=0.8))
    system.add(sp.Bushing("winder", held, part.point("tip"), (1.0, 2.0, 3.0, 4.0, 5.0, 6.0), (0.1,) * 6))
    return system


def sensed(place, angles, **fields) -> sp.SpatialSystem:
    """An inertial sensor on the second of two rods; its gains have all entries."""
    system, first, second = two_rods()
    points = {"tip": sp.Pose(place, by_angles(angles))}
    system.bodies[1] = second = replace(second, points=points)
    system.add(sp.SphericalJoint("hold", system.ground, first.point("origin")))
    system.add(sp.SphericalJoint("middle", first.point("end"), second.point("origin")))
    gains = {
        what: np.array([fields.pop(f"{what}_{k}") for k in (1, 2, 3)]) for what in ("acceleration_gain", "rate_gain")
    }
    system.add(sp.InertialSensor("part", second.point("tip"), **fields, **gains))
    return system


def seen(place, angles) -> sp.SpatialSystem:
    """A relative sensor whose first marker, on the second of two rods, has the numbers."""
    system, first, second = two_rods()
    system.bodies[1] = second = replace(second, points={"tip": sp.Pose(place, by_angles(angles))})
    system.add(sp.SphericalJoint("hold", system.ground, first.point("origin")))
    system.add(sp.SphericalJoint("middle", first.point("end"), second.point("origin")))
    system.add(sp.RelativeSensor("part", second.point("tip"), first.point("centre"), angles="zxz"))
    return system


def beam(degree: int = 2) -> Callable[..., sp.SpatialSystem]:
    """A soft beam that swings from a ball joint; its section has a full stiffness matrix."""

    def build(mass, moment_y, moment_z, product, centre_y, centre_z, length, angles, **fields) -> sp.SpatialSystem:
        system, wind, push = sp.SpatialSystem(), fields.pop("wind"), fields.pop("push")
        gauge = fields.pop("gauge_y"), fields.pop("gauge_z")
        entries = [entry for k in range(7) for entry in fields.pop(f"stiffness_{k}")]
        matrix = np.zeros((6, 6), np.result_type(*entries))
        matrix[np.triu_indices(6)] = entries
        matrix = matrix + matrix.T - np.diag(np.diagonal(matrix))
        section = sp.Section(matrix, mass, (moment_y, moment_z), product, (centre_y, centre_z))
        fields |= {"orientation": by_angles(angles), "prestrain": (*fields.pop("strain"), *fields.pop("bend"))}
        own = system.add(sp.Beam("part", section, length, 1, degree, **fields))
        system.add(sp.SphericalJoint("hold", system.ground.point((0.1, 0.2, 0.3)), own.start))
        system.add(sp.BeamSensor("gauge", own.start, gauge))
        system.add(sp.LineForce("wind", own.end, *wind, follower=True))
        system.add(sp.LineForce("push", own.start, *push))
        return system

    return build


def cable(angles, push, **fields) -> sp.SpatialSystem:
    """A soft cable that swings from the end of a rod; both its ends are clamped, the other one at a second rod."""
    system = sp.SpatialSystem()
    rod = system.add(
        sp.RigidBody("rod", sp.Inertia.box(1.3, (0.1, 0.2, 0.5)), points={"end": (0.1, 0.0, -0.4)}, anchor="end")
    )
    system.add(sp.SphericalJoint("hold", system.ground.point((0.0, 0.0, 0.0)), rod.point("end")))
    own = system.add(sp.Cable("part", elements=2, position=rod.point("end"), orientation=by_angles(angles), **fields))
    bob = system.add(
        sp.RigidBody("bob", sp.Inertia.box(0.4, (0.1, 0.1, 0.1)), own.end, by_angles(angles), anchor="origin")
    )
    system.add(sp.SphericalJoint("eye", rod.point("end"), own.start))
    system.add(sp.FixedJoint("clamp", own.end, bob.point("origin")))
    system.add(sp.CableSensor("gauge", own.node(1)))
    system.add(sp.LineForce("push", own.end, *push))
    return system


def reduced(near, far, stiffness, coupling, damping, friction, angles, corner, **fields) -> sp.SpatialSystem:
    """A reduced body of six masses with three modes, which swings from a ball joint and has a corner."""
    rng = np.random.default_rng(5)
    places, shapes = rng.uniform(-0.3, 0.3, (6, 3)), rng.uniform(-0.5, 0.5, (6, 3, 3))
    m, z = np.array([*near, *far]), np.c_[np.ones(6), places]
    second = np.einsum("p,pia,pjb->ijab", m, shapes, shapes)
    entries = [[0, 3, 4], [3, 1, 5], [4, 5, 2]]
    modes = FreeBodyModes(
        pseudo_inertia=np.einsum("p,pi,pj->ij", m, z, z),
        first=np.einsum("p,pi,pja->ija", m, z, shapes),
        second=second,
        mass=np.einsum("iiab->ab", second),
        stiffness=np.array([*stiffness, *coupling])[entries],
        damping=np.array([*damping, *friction])[entries],
        names=("foot", "tip"),
        interface_places=places[:2],
        interface_shapes=np.concatenate([shapes[:2], rng.uniform(-1.0, 1.0, (2, 3, 3))], axis=1),
        centre=np.zeros(3),
        places=places,
        shapes=shapes,
        faces=np.zeros((0, 3), dtype=int),
        recovery={"strain": np.array([0.5, -1.2, 0.8])},
    )
    points = {"corner": sp.NodePoint("tip", corner, by_angles([0.3, -0.2, 0.1]))}
    fields |= {"orientation": by_angles(angles), "anchor": "foot", "points": points}
    system = sp.SpatialSystem()
    body = system.add(sp.ReducedBody("part", modes, **fields))
    system.add(sp.SphericalJoint("hold", system.ground.point((0.1, 0.2, 0.3)), body.point("foot")))
    system.add(sp.Force("push", body.point("corner"), 1.0, -2.0, 0.5, follower=True))
    system.add(sp.RecoverySensor("gauge", body.point("tip"), "strain"))
    return system


def mass(**fields) -> sp.SpatialSystem:
    """A point mass on a spring."""
    system = sp.SpatialSystem()
    point = system.add(sp.PointMass("part", **fields)).point("centre")
    system.add(sp.Spring("holder", system.ground.point((-0.5, 1.0, 0.2)), point, 60.0, free_length=0.8))
    return system


def placed(position, angles, gravity) -> sp.SpatialSystem:
    """A rod in a plane of the ground."""
    system, first, second = two_rods(on_ball=False)
    system.gravity = gravity
    system.add(sp.PlanarJoint("part", system.ground.point(position, by_angles(angles)), first.point("origin")))
    system.add(sp.SphericalJoint("middle", first.point("end"), second.point("origin")))
    return system


_ENTRIES = [(i, j) for i in range(6) for j in range(i, 6)]
BUSHING = {f"stiffness_{i}{j}": 20.0 + 5 * i if i == j else 0.7 + 0.3 * i + 0.1 * j for i, j in _ENTRIES} | {
    f"damping_{i}{j}": 0.3 + 0.1 * i if i == j else 0.02 + 0.01 * i + 0.005 * j for i, j in _ENTRIES
}
FRICTION = {
    "viscous": 0.05, "coulomb": 0.1, "coefficient": 0.2, "radius": 0.05, "slip": 0.5, "stribeck": 0.1,
    "stribeck_rate": 0.4, "stribeck_exponent": 1.4,
}  # fmt: skip
SLIDING = {name: value for name, value in FRICTION.items() if name != "radius"}
STOP = {"axis": AXIS, "lower_limit": 0.8, "upper_limit": -0.7, "stiffness": 40.0, "damping": 0.4}
VECTOR = {"x": 2.0, "y": -1.0, "z": 0.7}
SPRING = {"stiffness": 90.0, "damping": 3.0, "free_length": 0.6, "cubic": 40.0}
TORSION = {"stiffness": 9.0, "damping": 0.5, "free_angle": 0.4, "cubic": 4.0, "axis": AXIS}
DRIVE = {
    "axis": AXIS, "torque_constant": 0.05, "resistance": 0.8, "back_emf": 0.4, "voltage_limit": 3.0, "gear_ratio": 2.0,
    "efficiency": 0.7, "slip_rate": 2.0, "armature_inertia": 2e-3, "enabled": 0.9, "voltage": 6.0,
}  # fmt: skip
AXIAL = (sp.PrismaticJoint, sp.CylindricalJoint, sp.PlanarJoint, sp.PointOnLineJoint, sp.ConstantVelocityJoint)

BEAM = {
    "stiffness_0": (60.0, 3.0, -2.0),
    "stiffness_1": (1.0, 0.5, -0.4),
    "stiffness_2": (40.0, 1.5, -0.6),
    "stiffness_3": (0.3, 0.2, 35.0),
    "stiffness_4": (0.4, -0.2, 0.3),
    "stiffness_5": (1.5, 0.1, -0.1),
    "stiffness_6": (2.0, 0.2, 1.2),
    "mass": 5.0,
    "moment_y": 0.2,
    "moment_z": 0.3,
    "product": 0.05,
    "centre_y": 0.02,
    "centre_z": -0.03,
    "length": 0.8,
    "angles": (0.3, 0.5, -0.2),
    "curvature": (0.4, -0.3, 0.6),
    "strain": (0.01, 0.02, -0.01),
    "bend": (0.1, -0.2, 0.15),
    "angular_velocity": (0.8, -0.5, 0.6),
    "damping": 0.01,
    "mass_damping": 0.1,
    "wind": (0.5, -0.4, 0.8),
    "gauge_y": 0.02,
    "gauge_z": -0.03,
    "push": (-0.3, 0.6, 0.2),
}

SCENES: dict[str, Scene] = {
    "beam": (beam(), BEAM),
    "cable": (
        cable,
        {
            "angles": (0.3, 0.9, -0.2),
            "push": (-0.3, 0.6, 0.2),
            "length": 0.8,
            "axial_stiffness": 40.0,
            "mass_per_length": 2.0,
            "bending_stiffness": 0.3,
            "span": 0.85,
            "prestrain": 0.02,
            "angular_velocity": (0.8, -0.5, 0.6),
            "damping": 0.004,
            "mass_damping": 0.1,
        },
    ),
    "reduced body": (
        reduced,
        {
            "near": (0.1, 0.15, 0.2),
            "far": (0.25, 0.3, 0.35),
            "stiffness": (90.0, 150.0, 220.0),
            "coupling": (3.0, -5.0, 8.0),
            "damping": (0.2, 0.3, 0.4),
            "friction": (0.05, -0.03, 0.02),
            "angles": (0.3, 0.2, -0.1),
            "corner": (0.1, -0.05, 0.2),
            "angular_velocity": (0.8, -0.5, 0.6),
            "damping_ratio": 0.02,
        },
    ),
    "rigid body": (
        body,
        {
            "mass": 2.0,
            "moments": (0.3, 0.35, 0.25),
            "products": (0.02, -0.03, 0.01),
            "centre": (0.05, -0.1, 0.2),
            "position": (0.1, 0.2, -0.3),
            "angles": (0.4, -0.3, 0.2),
            "velocity": (0.3, -0.2, 0.1),
            "angular_velocity": (0.8, -0.5, 0.6),
            "tip": (0.6, 0.1, 0.2),
            "tip_angles": (0.3, 0.2, -0.1),
        },
    ),
    "point mass": (mass, {"mass": 1.5, "position": (0.3, 0.4, -0.2), "velocity": (0.5, -0.6, 0.4)}),
    "ground": (placed, {"position": (0.1, 0.2, 0.05), "angles": (0.2, 0.1, -0.1), "gravity": (0.7, -0.4, -9.81)}),
    "revolute": (rubbing(jointed(sp.RevoluteJoint)), {"axis": AXIS} | FRICTION),
    "revolute to ground": (rubbing(grounded(sp.RevoluteJoint)), {"axis": AXIS} | FRICTION),
    "prismatic, rubbing": (rubbing(jointed(sp.PrismaticJoint)), {"axis": AXIS} | SLIDING),
    "prismatic to ground, rubbing": (rubbing(grounded(sp.PrismaticJoint)), {"axis": AXIS} | SLIDING),
    **{f"{kind.__name__}": (jointed(kind), {"axis": AXIS}) for kind in AXIAL},
    **{f"{kind.__name__} to ground": (grounded(kind), {"axis": AXIS}) for kind in AXIAL},
    **{f"{kind.__name__}": (jointed(kind), {}) for kind in (sp.SphericalJoint, sp.FixedJoint)},
    **{f"{kind.__name__} to ground": (grounded(kind), {}) for kind in (sp.SphericalJoint, sp.FixedJoint)},
    "universal": (jointed(sp.UniversalJoint), {"axis_a": (1.0, 0.1, 0.2), "axis_b": (0.1, 1.0, -0.2)}),
    "universal to ground": (grounded(sp.UniversalJoint), {"axis_a": (1.0, 0.1, 0.2), "axis_b": (0.1, 1.0, -0.2)}),
    "distance": (hung, {"length": 0.4}),
    "distance to ground": (from_ground(sp.DistanceJoint), {"length": 0.45}),
    "prescribed angle": (driven("angle", jointed(sp.RevoluteJoint)), {"axis": AXIS, "motion": 0.2}),
    "prescribed angle to ground": (driven("angle", grounded(sp.RevoluteJoint)), {"axis": AXIS, "motion": 0.2}),
    "prescribed displacement": (
        driven("displacement", jointed(sp.CylindricalJoint)),
        {"axis": AXIS, "motion": 0.05},
    ),
    "relative sensor": (seen, {"place": (0.2, -0.1, 0.4), "angles": (0.4, -0.8, 0.3)}),
    "inertial sensor": (
        sensed,
        {
            "place": (0.1, -0.2, -0.3),
            "angles": (0.2, 0.4, -0.3),
            "acceleration_bias": (0.1, -0.2, 0.3),
            "rate_bias": (0.02, 0.03, -0.01),
            "acceleration_gain_1": (1.1, 0.02, -0.03),
            "acceleration_gain_2": (0.01, 0.9, 0.03),
            "acceleration_gain_3": (0.02, 0.04, 1.2),
            "rate_gain_1": (1.05, 0.03, -0.02),
            "rate_gain_2": (0.04, 0.95, 0.01),
            "rate_gain_3": (0.02, -0.05, 1.1),
        },
    ),
    "force": (pulling(sp.Force, False, False), VECTOR),
    "force between": (pulling(sp.Force, True, False), VECTOR),
    "follower force": (pulling(sp.Force, True, True), VECTOR),
    "torque": (pulling(sp.Torque, False, False), VECTOR),
    "follower torque": (pulling(sp.Torque, True, True), VECTOR),
    "spring": (acting(lambda system, a, b, **own: sp.Spring("part", a.body.point("origin"), b, **own)), SPRING),
    "spring to ground": (from_ground(sp.Spring), SPRING),
    "torsion spring": (wound(jointed(sp.RevoluteJoint)), TORSION),
    "torsion spring to ground": (wound(grounded(sp.RevoluteJoint)), TORSION),
    "motor": (powered(jointed(sp.RevoluteJoint)), DRIVE),
    "motor to ground": (powered(grounded(sp.RevoluteJoint)), DRIVE),
    "gear": (
        coupled(sp.GearJoint, sp.RevoluteJoint, sp.RevoluteJoint),
        {"axis": (0.3, 1.0, 0.2), "ratio": -0.7, "offset": 0.3},
    ),
    "rack": (coupled(sp.RackJoint, sp.RevoluteJoint, sp.PrismaticJoint), {"axis": AXIS, "radius": 0.2, "offset": 0.1}),
    "coupling of a slide and a hinge": (
        coupled(sp.CouplingJoint, sp.PrismaticJoint, sp.RevoluteJoint),
        {"axis": AXIS, "ratio": 2.5, "offset": 0.2},
    ),
    "coupling of two slides": (
        coupled(sp.CouplingJoint, sp.PrismaticJoint, sp.PrismaticJoint),
        {"axis": AXIS, "ratio": -0.6, "offset": 0.1},
    ),
    "screw": (jointed(sp.ScrewJoint), {"axis": AXIS, "lead": 0.8, "offset": 0.05}),
    "screw to ground": (grounded(sp.ScrewJoint), {"axis": AXIS, "lead": 0.8, "offset": 0.05}),
    "screw of short lead": (jointed(sp.ScrewJoint), {"axis": AXIS, "lead": 0.01, "offset": 0.05}),
    "screw of short lead to ground": (grounded(sp.ScrewJoint), {"axis": AXIS, "lead": 0.01, "offset": 0.003}),
    "angle limit": (stopped(sp.AngleLimit, grounded(sp.RevoluteJoint)), STOP | {"stiffness": 4.0}),
    "angle limit between": (stopped(sp.AngleLimit, jointed(sp.RevoluteJoint)), STOP | {"stiffness": 0.6}),
    "displacement limit": (stopped(sp.DisplacementLimit, grounded(sp.PrismaticJoint)), STOP),
    "displacement limit between": (stopped(sp.DisplacementLimit, jointed(sp.CylindricalJoint)), STOP),
    "bushing": (bushed(between(sp.Bushing)), BUSHING),
    "bushing to ground": (bushed(from_ground(sp.Bushing)), BUSHING),
}
"""Scene: its builder, and values of its numbers. Tuples are vectors, one number for each entry."""


def numbers_of(fields: dict) -> dict[str, float]:
    """Numbers by name; those of a vector get names of their own."""
    numbers = {}
    for name, value in fields.items():
        if isinstance(value, tuple):
            numbers |= {f"{name}_{axis}": own for axis, own in zip("xyz", value, strict=True)}
        else:
            numbers[name] = value
    return numbers


def fields_of(fields: dict, numbers: dict) -> dict:
    """The fields of a scene with other numbers."""
    return {
        name: tuple(numbers[f"{name}_{axis}"] for axis in "xyz") if isinstance(value, tuple) else numbers[name]
        for name, value in fields.items()
    }


def parameters_of(fields: dict) -> dict[str, Parameter]:
    """Parameters of a scene: each number within a half of itself, with its size as the scale."""
    return {
        name: Parameter(name, value - abs(value) / 2, value + abs(value) / 2, scale=abs(value))
        for name, value in numbers_of(fields).items()
    }
