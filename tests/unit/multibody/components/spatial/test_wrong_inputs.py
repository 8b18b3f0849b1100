"""Errors of bad input in space, with their whole messages."""

import numpy as np
import pytest
from inline_snapshot import snapshot

import dalembert.multibody as planar
from dalembert.errors import InputError, ModelError
from dalembert.multibody import simulate
from dalembert.multibody.spatial import (
    Bushing,
    DistanceJoint,
    FixedJoint,
    Force,
    Friction,
    Inertia,
    Orientation,
    PointMass,
    PrescribedMotion,
    RevoluteJoint,
    RigidBody,
    SpatialSystem,
    SphericalJoint,
    Torque,
)
from refusals import refused

BOX = Inertia.box(1.0, (0.1, 0.2, 0.3))


def pair(**placed) -> tuple[SpatialSystem, RigidBody, PointMass]:
    """A system with a rigid body and a point mass."""
    system = SpatialSystem()
    body = system.add(RigidBody("body", BOX, points={"end": (0.0, 0.0, 1.0)}, **placed))
    return system, body, system.add(PointMass("mass", 1.0, (1.0, 0.0, 0.0)))


def test_inertias() -> None:
    with refused(
        InputError,
        snapshot(
            "Inertia: the principal moments are 0.1, 0.2, 0.4 kg m^2; the largest, about (0, 0, 1), is 0.1 larger than the sum of both others, which no body can have. Check moments and products"
        ),
    ):
        Inertia(1.0, (0.1, 0.2, 0.4))
    with refused(
        InputError,
        snapshot(
            "Inertia: the smallest principal moment, about (0.788, -0.615, 0), is -0.0561553 kg m^2; expected a positive one. Check moments and products"
        ),
    ):
        Inertia(1.0, (0.1, 0.2, 0.2), products=(0.2, 0.0, 0.0))
    with refused(InputError, snapshot("Inertia: mass is -1 kg; expected a positive number")):
        Inertia(-1.0, (0.1, 0.2, 0.2))


def test_orientations() -> None:
    with refused(
        InputError,
        snapshot(
            "Orientation: the quaternion (0.0, 0.0, 0.0, 0.0) has the length zero; expected one that is not zero, such as (1, 0, 0, 0)"
        ),
    ):
        Orientation.by_quaternion(0.0, 0.0, 0.0, 0.0)
    with refused(
        InputError,
        snapshot(
            "Orientation: rows is ((1.0, 0.0, 0.0), (0.0, 2.0, 0.0), (0.0, 0.0, 1.0)); expected the rows of a rotation matrix, with orthonormal, right-handed columns. Or use by_angles, by_quaternion, by_rotation_vector or by_axes"
        ),
    ):
        Orientation(((1.0, 0.0, 0.0), (0.0, 2.0, 0.0), (0.0, 0.0, 1.0)))
    with refused(
        InputError,
        snapshot(
            "Orientation: rows is ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, -1.0)); expected the rows of a rotation matrix, with orthonormal, right-handed columns. Or use by_angles, by_quaternion, by_rotation_vector or by_axes"
        ),
    ):
        Orientation(((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, -1.0)))
    with refused(
        InputError,
        snapshot(
            "Orientation: the axes are 'xY'; expected one to three of 'xyz' (turning with the body) or of 'XYZ' (fixed)"
        ),
    ):
        Orientation.by_angles("xY", [0.1, 0.2])
    with refused(InputError, snapshot("Orientation: 1 angles for the axes 'xyz'; expected 3")):
        Orientation.by_angles("xyz", [0.1])
    with refused(
        InputError,
        snapshot(
            "Orientation: the direction z is (0.0, 0.0, 0.0), which has the length zero; expected a direction, such as (0, 0, 1)"
        ),
    ):
        Orientation.by_axes((0.0, 0.0, 0.0))
    with refused(
        InputError,
        snapshot("Orientation: x (0.0, 0.0, 2.0) is zero or parallel to z (0.0, 0.0, 1.0); expected another direction"),
    ):
        Orientation.by_axes((0.0, 0.0, 1.0), (0.0, 0.0, 2.0))


def test_a_zero_axis() -> None:
    system, body, _ = pair()
    system.add(RevoluteJoint("pin", system.ground, body.point("origin"), axis=(0.0, 0.0, 0.0)))
    with refused(
        InputError,
        snapshot(
            "RevoluteJoint 'pin': the axis is (0.0, 0.0, 0.0), which has the length zero; expected a direction, such as (0, 0, 1)"
        ),
    ):
        simulate(system, 0.1)


def test_two_points_of_one_body() -> None:
    system, body, _ = pair()
    system.add(SphericalJoint("ball", body.point("origin"), body.point("end")))
    with refused(
        ModelError,
        snapshot(
            "'ball': both its points, body.origin and body.end, belong to the same rigid body, so it does nothing; give it points of two bodies, or of a body and the ground"
        ),
    ):
        simulate(system, 0.1)


@pytest.mark.parametrize(
    "make",
    [
        lambda a, b: FixedJoint("part", a, b),
        lambda a, b: RevoluteJoint("part", a, b),
        lambda a, b: PrescribedMotion("part", a, b),
        lambda a, b: Bushing("part", a, b, (1.0,) * 6),
        lambda a, b: Torque("part", b, x=1.0),
        lambda a, b: Force("part", b, x=1.0, follower=True),
    ],
)
def test_point_masses_have_no_axes(make) -> None:
    system, body, mass = pair()
    system.add(make(body.point("end"), mass.point("centre")))
    with pytest.raises(ModelError, match=r"'part': mass.centre has no direction; use "):
        simulate(system, 0.1)


def test_a_mechanism_that_cannot_be_assembled() -> None:
    system, body, _ = pair()
    system.add(SphericalJoint("ball", system.ground.point((0.0, 0.0, 0.0)), body.point("origin")))
    system.add(SphericalJoint("far", system.ground.point((0.0, 0.0, 3.0)), body.point("end")))
    with refused(
        ModelError,
        snapshot(
            "the mechanism cannot be assembled: joint 'ball' has a gap of 1 (m or rad). Check lengths and places of the bodies that it connects; a first placement nearer to the closed position may be needed, or fewer driving coordinates"
        ),
    ):
        simulate(system, 0.1)


def test_joints_that_close_with_other_axes() -> None:
    """Conditions of orthogonality hold for opposite and for exchanged axes, too."""
    turned = Orientation.by_angles("yxz", [1.7, 0.3, 0.5])
    for kind, message in (
        (
            FixedJoint,
            snapshot(
                "the mechanism cannot be assembled from this placement: joint 'joint' closes where axis 1 of b is at 90 deg to axis 1 of a, and has to be parallel to it. Place the bodies nearer to the closed position, or orient the markers alike"
            ),
        ),
        (
            RevoluteJoint,
            snapshot(
                "the mechanism cannot be assembled from this placement: joint 'joint' closes where axis 3 of b is at 180 deg to axis 3 of a, and has to be parallel to it. Place the bodies nearer to the closed position, or orient the markers alike"
            ),
        ),
    ):
        system, body, _ = pair(orientation=turned)
        system.add(kind("joint", system.ground.point((0.0, 0.0, 0.0)), body.point("origin")))
        with refused(ModelError, message):
            simulate(system, 0.01)


def test_a_hinge_may_be_placed_with_opposite_axes() -> None:
    system, body, _ = pair(orientation=Orientation.by_angles("x", [np.pi]))
    system.add(RevoluteJoint("hinge", system.ground.point((0.0, 0.0, 0.0)), body.point("origin")))
    np.testing.assert_allclose(simulate(system, 0.01, "auto").channels(["hinge.angle"])[0], 0.0, atol=1e-12)


def test_a_rod_of_no_length() -> None:
    system, body, _ = pair()
    system.add(DistanceJoint("rod", system.ground.point((0.0, 0.0, 0.0)), body.point("origin")))
    with refused(
        ModelError,
        snapshot(
            "distance joint 'rod': its points ground(0.0, 0.0, 0.0) and body.origin coincide and no length is given; "
            "give a length, or use a spherical joint"
        ),
    ):
        simulate(system, 0.1)


def test_velocities_that_contradict_a_joint() -> None:
    system, body, _ = pair(angular_velocity=(1.0, 0.0, 0.0))
    system.add(RevoluteJoint("pin", system.ground, body.point("origin")))
    with refused(
        ModelError,
        snapshot(
            "the stated initial velocities contradict joint 'pin' by 1 (m/s or rad/s): body.angular_velocity is (1, 0, 0) rad/s (nearest possible: (0, 0, 0)). Correct them, or leave out those that follow from the joints"
        ),
    ):
        simulate(system, 0.1)


def test_other_components() -> None:
    system, body, _ = pair()
    with refused(
        InputError,
        snapshot(
            "PointMass 'flat' is not a component in space, as a SpatialSystem needs. Planar components belong to a System, those of dalembert.multibody.spatial to a SpatialSystem"
        ),
    ):
        system.add(planar.PointMass("flat", 1.0))
    with refused(InputError, snapshot("rigid body 'box': the point name 'centre' is reserved. Choose another name")):
        RigidBody("box", BOX, points={"centre": (0.0, 0.0, 0.0)})
    with refused(
        InputError,
        snapshot("Bushing 'bush': stiffness is a ndarray; expected six numbers, or a symmetric matrix (6, 6)"),
    ):
        Bushing("bush", system.ground, body.point("end"), np.arange(36.0).reshape(6, 6))
    with refused(
        InputError,
        snapshot(
            "SpatialSystem: gravity is (0.0, -9.81); expected three finite numbers in m/s^2, along x, y and z, such as (0.0, 0.0, -9.81)"
        ),
    ):
        SpatialSystem(gravity=(0.0, -9.81))
    with refused(
        InputError,
        snapshot(
            "friction: stribeck was given without a stribeck_rate. Give the rate at which Stribeck's friction has decreased to 1/e"
        ),
    ):
        Friction(stribeck=0.1)
    system.add(RevoluteJoint("pin", system.ground, body.point("origin"), friction=Friction(coefficient=0.1)))
    with refused(
        InputError,
        snapshot(
            "revolute joint 'pin': its friction has a coefficient without a radius, so it would have no lever; give the pin's radius in m"
        ),
    ):
        simulate(system, 0.1)


NO_NUMBERS = ["a", None, object(), [[1.0, 2.0], [3.0]], np.nan, np.eye(3), {"a": 1.0}, True]
ORIENTATIONS = {
    "angles": lambda wrong: Orientation.by_angles("zyx", wrong),
    "one angle": lambda wrong: Orientation.by_angles("z", [wrong]),
    "rotation vector": Orientation.by_rotation_vector,
    "quaternion": lambda wrong: Orientation.by_quaternion(1.0, 0.0, 0.0, wrong),
    "direction z": Orientation.by_axes,
    "direction x": lambda wrong: Orientation.by_axes((0.0, 0.0, 1.0), wrong) if wrong is not None else Orientation("x"),
    "rows": lambda wrong: Orientation(wrong if not isinstance(wrong, np.ndarray) else np.nan * wrong),
    "entry": lambda wrong: Orientation(((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, wrong))),
}


@pytest.mark.parametrize("argument", ORIENTATIONS)
@pytest.mark.parametrize("wrong", NO_NUMBERS, ids=lambda wrong: type(wrong).__name__)
def test_an_orientation_of_no_numbers_is_refused(argument: str, wrong) -> None:
    with pytest.raises(InputError, match=r"(Orientation: .*|rotation vector|direction x) (is|are) .*; expected "):
        ORIENTATIONS[argument](wrong)


@pytest.mark.parametrize("axes", [3, None, "", "ab", "Xy", "xyzx"])
def test_axes_of_no_letters_are_refused(axes) -> None:
    with pytest.raises(InputError, match=r"^Orientation: the axes are .*; expected one to three of 'xyz'"):
        Orientation.by_angles(axes, 0.1)


def test_a_single_angle_can_be_a_number() -> None:
    assert Orientation.by_angles("z", 0.3) == Orientation.by_angles("z", [0.3])
    slope = np.imag(Orientation.by_angles("z", 0.3 + 1e-30j).matrix) / 1e-30
    np.testing.assert_allclose(slope[0, :2], [-np.sin(0.3), -np.cos(0.3)], rtol=1e-15)
