"""Initial states by angles, displacements and rates of joints: open and closed chains, derivatives, refusals."""

import numpy as np
import pytest

import dalembert as da
from dalembert.errors import InputError, ModelError
from dalembert.multibody.spatial import (
    ConstantVelocityJoint,
    CylindricalJoint,
    FixedJoint,
    GearJoint,
    Inertia,
    Orientation,
    PlanarJoint,
    PointMass,
    PointOnLineJoint,
    Pose,
    PrismaticJoint,
    RelativeSensor,
    RigidBody,
    ScrewJoint,
    SpatialSystem,
    SphericalJoint,
    UniversalJoint,
)
from dalembert.multibody.spatial import DistanceJoint as Rod
from dalembert.multibody.spatial import PrescribedMotion as SpatialMotion
from dalembert.multibody.spatial import RevoluteJoint as Hinge
from support import says

ROD = Inertia.cylinder(mass=1.0, radius=0.01, length=0.5).moved((0.0, 0.0, -0.25))
AXES = {"hip": (0.0, 1.0, 0.0), "knee": (0.3, 1.0, 0.2), "ankle": (1.0, 0.0, 0.0)}


def leg(first=(0.1, 0.0, 0.2)):
    """Three bodies below each other on hinges."""
    system, side = SpatialSystem(), None
    for name, axis in AXES.items():
        body = system.add(RigidBody(f"{name} rod", ROD, side or first, points={"end": (0.0, 0.0, -0.5)}))
        system.add(Hinge(name, side or system.ground.point(first), body.point("origin"), axis=axis))
        side = body.point("end")
    return system


def start(system, *channels):
    return da.simulate(system, 0.01).channels(list(channels))[0]


@pytest.mark.parametrize("angles", [(0.3, -1.0, 0.5), (2.9, -2.5, 3.0), (-3.0, 1.0, -1.5)])
def test_open_chains_begin_at_the_stated_angles_and_rates(angles):
    system = leg()
    rates = 1.0, -2.0, 0.5
    system.pose(dict(zip(AXES, angles, strict=True)), rates=dict(zip(AXES, rates, strict=True)))
    np.testing.assert_allclose(start(system, *(f"{name}.angle" for name in AXES)), angles, atol=1e-12)
    np.testing.assert_allclose(start(system, *(f"{name}.rate" for name in AXES)), rates, atol=1e-12)
    # the end of the chain by products of rotations, v = sum of rate_i axis_i x lever
    turn, place, places, axes = np.eye(3), np.array([0.1, 0.0, 0.2]), [], []
    for axis, angle in zip(AXES.values(), angles, strict=True):
        unit = np.array(axis) / np.linalg.norm(axis)
        places.append(place)
        axes.append(turn @ unit)
        skew = np.cross(np.eye(3), unit)
        turn = turn @ (np.eye(3) + np.sin(angle) * skew + (1 - np.cos(angle)) * skew @ skew)
        place = place + turn @ np.array([0.0, 0.0, -0.5])
    np.testing.assert_allclose(start(system, *(f"ankle rod.end.{axis}" for axis in "xyz")), place, atol=1e-12)
    speed = sum(rate * np.cross(axis, place - own) for rate, axis, own in zip(rates, axes, places, strict=True))
    np.testing.assert_allclose(start(system, *(f"ankle rod.end.v{axis}" for axis in "xyz")), speed, atol=1e-12)


def test_joints_that_are_not_stated_keep_their_coordinates_and_are_at_rest():
    system = leg()
    system.pose({"knee": 1.2}, rates={"ankle": 2.0})
    found = start(system, *(f"{name}.{what}" for name in AXES for what in ("angle", "rate")))
    np.testing.assert_allclose(found, [0.0, 0.0, 1.2, 0.0, 0.0, 2.0], atol=1e-12)


def test_displacements_and_angles_of_cylindrical_joints():
    system = SpatialSystem()
    body = system.add(RigidBody("bolt", ROD))
    system.add(CylindricalJoint("sleeve", system.ground, body.point("origin"), axis=(1.0, 1.0, 0.0)))
    system.pose({"sleeve.displacement": 0.4, "sleeve.angle": 2.0}, rates={"sleeve.displacement": -0.3})
    channels = [f"sleeve.{what}" for what in ("displacement", "angle", "speed", "rate")]
    np.testing.assert_allclose(start(system, *channels), [0.4, 2.0, -0.3, 0.0], atol=1e-12)
    with pytest.raises(
        InputError,
        match=says(
            "SpatialSystem.pose, coordinates: joint 'sleeve' has angle and displacement; write 'sleeve.angle', for example"
        ),
    ):
        system.pose({"sleeve": 0.4})


def crank(angle=None, rate=None, drive=False, stroke=None):
    """A slider-crank in space: crank, rod on two ball joints, slide beside the plane of the crank."""
    system = SpatialSystem()
    wheel = system.add(RigidBody("crank", Inertia.box(1.0, (0.1, 0.02, 0.02)), points={"pin": (0.1, 0.0, 0.0)}))
    rod = system.add(RigidBody("rod", Inertia.box(1.0, (0.4, 0.02, 0.02)), (0.3, 0.0, 0.0),
                               points={"a": (-0.2, 0.0, 0.0), "b": (0.2, 0.0, 0.0)}))  # fmt: skip
    block = system.add(RigidBody("block", Inertia.box(0.5, (0.05, 0.05, 0.05)), (0.5, 0.0, 0.05)))
    pin = system.add(Hinge("pin", system.ground, wheel.point("origin"), axis=(0.0, 0.0, 1.0)))
    system.add(SphericalJoint("ball", wheel.point("pin"), rod.point("a")))
    system.add(SphericalJoint("second ball", rod.point("b"), block.point("origin")))
    system.add(
        PrismaticJoint("slide", system.ground.point((0.5, 0.0, 0.05)), block.point("origin"), axis=(1.0, 0.0, 0.0))
    )
    if drive:
        system.add(SpatialMotion("motor", pin.a, pin.b, motion=da.signals.Polynomial((0.7, 3.0))))
    stated = {"pin": angle, "slide": stroke}
    system.pose(
        {name: value for name, value in stated.items() if value is not None}, None if rate is None else {"pin": rate}
    )
    return system


def test_closed_chains_begin_at_the_stated_angle_and_rate():
    for angle in (0.4, 1.5, -2.2):
        found = start(crank(angle, 3.0), "pin.angle", "pin.rate", "block.origin.x", "slide.speed")
        # x of the block from rod^2 = (x - r cos)^2 + (r sin)^2 + z^2, and its rate
        away = np.sqrt(0.16 - (0.1 * np.sin(angle)) ** 2 - 0.05**2)
        speed = -0.3 * np.sin(angle) - 0.03 * np.sin(angle) * np.cos(angle) / away
        np.testing.assert_allclose(found, [angle, 3.0, 0.1 * np.cos(angle) + away, speed], atol=1e-10)


def test_coordinates_that_do_not_fit_are_told():
    with pytest.raises(
        ModelError, match=r"^the joints cannot have the stated coordinates pin.angle = 0.4 rad, slide.dis"
    ):
        start(crank(0.4, stroke=0.3), "pin.angle")
    with pytest.raises(
        ModelError, match=r"^the joints cannot have the stated coordinates slide.displacement = 0.9 m: the"
    ):
        start(crank(stroke=0.9), "pin.angle")


def test_rates_that_do_not_fit_are_told():
    assert start(crank(0.7, 3.0, drive=True), "pin.rate")[0] == pytest.approx(3.0)
    with pytest.raises(ModelError, match=r"^the joints cannot have the stated rates pin.angle = 2 rad/s: "):
        start(crank(0.7, 2.0, drive=True), "pin.angle")


def test_derivatives_by_stated_numbers_are_exact():
    def build(angle, rate, stroke):
        system = leg((0.1, stroke, 0.2))
        system.pose({"hip": 0.5, "knee": angle}, rates={"hip": rate, "ankle": 1.0})
        return system

    channels = [f"ankle rod.end.{axis}" for axis in ("x", "y", "z", "vx", "vy", "vz")]
    box = {"angle": (-2.0, 2.0), "rate": (-3.0, 3.0), "stroke": (-1.0, 1.0)}
    model = da.TimeResponse(build, box, channels, [0.0, 0.1], da.GeneralizedAlpha(step=2e-3))
    at, step = np.array([1.2, 2.0, 0.3]), 1e-3
    jacobian = model.jacobian(at)
    for column, unit in enumerate(np.eye(3)):
        runs = [model.evaluate(at + k * step * unit).only()[0] for k in (-2, -1, 1, 2)]
        differences = (runs[0] - 8 * runs[1] + 8 * runs[2] - runs[3]) / (12 * step)
        np.testing.assert_allclose(jacobian[:, :, column], differences, atol=1e-8)


def four_bar(angle):
    system = da.System()
    crank = system.add(da.RigidBar("crank", length=0.2, mass=1.0, angle=1.5))
    coupler = system.add(da.RigidBar("coupler", start=crank.end, length=0.5, mass=1.0))
    rocker = system.add(da.RigidBar("rocker", start=(0.5, 0.0), length=0.4, mass=1.0, angle=1.4))
    system.add(da.RevoluteJoint("O", system.ground, crank.start))
    system.add(da.RevoluteJoint("A", crank.end, coupler.start))
    system.add(da.RevoluteJoint("B", coupler.end, rocker.end))
    system.add(da.RevoluteJoint("C", system.ground, rocker.start))
    system.pose({"O": angle}, rates={"O": 4.0})
    return system


def test_planar_loops_begin_at_the_stated_angle():
    for angle in (0.9, 2.0, 4.0):
        found = start(four_bar(angle), "crank.end.angle", "crank.end.rate")
        np.testing.assert_allclose(found, [angle, 4.0], atol=1e-11)


def test_what_cannot_be_stated_is_told():
    system = crank(0.3)
    sentence = "SpatialSystem.pose, coordinates: unknown joint with coordinates 'bal'; did you mean 'ball'?"
    with pytest.raises(InputError, match=says(sentence)):
        system.pose({"bal": 0.1})
    sentence = (
        "SpatialSystem.pose, coordinates: joint 'ball' has rotation_x, rotation_y and rotation_z; "
        "write 'ball.rotation_x', for example"
    )
    with pytest.raises(InputError, match=says(sentence)):
        system.pose({"ball": 0.1})
    with pytest.raises(
        InputError, match=says("SpatialSystem.pose, rates, 'pin': 'fast' was given; expected a finite number")
    ):
        system.pose(rates={"pin": "fast"})
    resting = SpatialSystem(start="equilibrium")
    sentence = "SpatialSystem.pose: the system starts at its equilibrium; leave out start or the stated coordinates"
    with pytest.raises(InputError, match=says(sentence)):
        resting.pose()


def test_coupled_joints_follow_the_stated_one():
    system, joints = SpatialSystem(), []
    for name, x in (("pinion", 0.0), ("wheel", 0.4)):
        disc = Inertia.cylinder(mass=1.0, radius=0.1, length=0.02)
        body = system.add(RigidBody(name, disc, (x, 0.0, 0.0)))
        joints.append(system.add(Hinge(f"{name} bearing", system.ground, body.point("origin"))))
    system.add(GearJoint("gear", *joints, ratio=-0.5, offset=0.0))
    system.pose({"pinion bearing": 1.0}, rates={"wheel bearing": 2.0})
    channels = [f"{name} bearing.{what}" for name in ("pinion", "wheel") for what in ("angle", "rate")]
    np.testing.assert_allclose(start(system, *channels), [1.0, -4.0, -0.5, 2.0], atol=1e-12)


POSE = [f"rel.{what}" for what in ("x", "y", "z", "rotation_x", "rotation_y", "rotation_z")]
MOTION = [f"rel.{what}" for what in ("vx", "vy", "vz", "wx", "wy", "wz")]
FREE = (
    Hinge, UniversalJoint, SphericalJoint, CylindricalJoint, PrismaticJoint, PlanarJoint, FixedJoint,
    ConstantVelocityJoint, PointOnLineJoint, Rod, ScrewJoint,
)  # fmt: skip


def arm(joint, *, at_marker=True, turned=(), far=(0.0, 0.0, 0.0), pose=None, rates=None):
    """A body on a hinge, and a second one on a joint of any kind, which closes no loop."""
    inertia, axes = Inertia.box(1.0, (0.1, 0.2, 0.3)), Orientation.by_angles("xyz", [0.3, 0.7, -0.4])
    system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    first = system.add(RigidBody("a", inertia, points={"end": Pose((0.5, 0.1, -0.2), axes)}))
    points = {"in": Pose(far, Orientation.by_angles("xyz", turned) if turned else Orientation())}
    place = (first.point("end"),) if at_marker else ((0.5, 0.1, -0.2), axes)
    second = system.add(RigidBody("b", inertia, *place, points=points))
    system.add(Hinge("hip", system.ground, first.point("origin")))
    options = {"lead": 0.1} if joint is ScrewJoint else {}
    system.add(joint("x", first.point("end"), second.point("in"), **options))
    system.add(RelativeSensor("rel", first.point("end"), second.point("in")))
    system.pose(pose or {}, rates)
    return system


@pytest.mark.parametrize("at_marker", [True, False])
@pytest.mark.parametrize("joint", FREE)
def test_every_joint_that_is_not_stated_keeps_its_coordinates_and_is_at_rest(joint, at_marker):
    far = (0.2, 0.0, 0.0) if joint is Rod else (0.0, 0.0, 0.0)
    system = arm(joint, at_marker=at_marker, far=far, pose={"hip": 1.0}, rates={"hip": 2.0})
    np.testing.assert_allclose(start(system, *POSE), [*far, 0.0, 0.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(start(system, "hip.angle", "hip.rate", *MOTION), [1.0, 2.0, *[0.0] * 6], atol=1e-9)


def test_coordinates_are_kept_where_a_chart_of_them_is_singular():
    # half a turn between the markers, and a rod along the third axis: neither vector nor angles are differentiable
    ball = arm(SphericalJoint, turned=(np.pi, 0.0, 0.0), pose={"hip": 1.0}, rates={"hip": 2.0})
    assert abs(start(ball, "rel.rotation_x")[0]) == pytest.approx(np.pi)
    np.testing.assert_allclose(start(ball, *MOTION), 0.0, atol=1e-9)
    rod = arm(Rod, far=(0.0, 0.0, 0.2), pose={"hip": 1.0}, rates={"hip": 2.0})
    np.testing.assert_allclose(start(rod, *POSE), [0.0, 0.0, 0.2, 0.0, 0.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(start(rod, *MOTION), 0.0, atol=1e-9)


BALL = {f"x.rotation_{axis}": value for axis, value in zip("xyz", (1.0, -2.0, 0.5), strict=True)}
AWAY = 0.2 * np.array([np.cos(1.0) * np.cos(0.5), np.sin(1.0) * np.cos(0.5), -np.sin(0.5)])


@pytest.mark.parametrize(
    ("joint", "pose", "expected"),
    [
        (SphericalJoint, BALL, (0.0, 0.0, 0.0, 1.0, -2.0, 0.5)),
        (SphericalJoint, {"x.rotation_y": 2.5}, (0.0, 0.0, 0.0, 0.0, 2.5, 0.0)),
        (PointOnLineJoint, {"x.displacement": 0.3, **BALL}, (0.0, 0.0, 0.3, 1.0, -2.0, 0.5)),
        (ConstantVelocityJoint, {"x.rotation_1": 1.0, "x.rotation_2": -0.5}, (0.0, 0.0, 0.0, 1.0, -0.5, 0.0)),
        (PlanarJoint, {"x.displacement_1": 0.3, "x.displacement_2": -0.4, "x.angle": 2.0}, (0.3, -0.4, 0.0, 0.0, 0.0, 2.0)),
        (Rod, {"x.azimuth": 1.0, "x.elevation": -0.5}, (*AWAY, 0.0, 0.0, 0.0)),
    ],
)  # fmt: skip
def test_every_free_coordinate_can_be_stated(joint, pose, expected):
    far = (0.2, 0.0, 0.0) if joint is Rod else (0.0, 0.0, 0.0)
    np.testing.assert_allclose(start(arm(joint, far=far, pose=pose), *POSE), expected, atol=1e-9)


def test_angles_and_rates_of_universal_joints():
    stated = {"x.angle_a": 1.0, "x.angle_b": -2.0}
    system = arm(UniversalJoint, pose=stated, rates={"x.angle_b": 3.0})
    found = start(system, "x.angle_a", "x.angle_b", "x.rate_a", "x.rate_b")
    np.testing.assert_allclose(found, [1.0, -2.0, 0.0, 3.0], atol=1e-9)


def test_rates_of_rotations_are_angular_velocities_and_those_of_directions_are_their_rates():
    rates = {f"x.rotation_{axis}": value for axis, value in zip("xyz", (0.5, 0.2, -1.0), strict=True)}
    found = start(arm(SphericalJoint, pose=BALL, rates=rates), *MOTION)
    np.testing.assert_allclose(found, [0.0, 0.0, 0.0, 0.5, 0.2, -1.0], atol=1e-9)
    rod = arm(Rod, far=(0.2, 0.0, 0.0), pose={"x.azimuth": 1.0, "x.elevation": -0.5}, rates={"x.azimuth": 2.0})
    np.testing.assert_allclose(start(rod, *MOTION), [-2.0 * AWAY[1], 2.0 * AWAY[0], *[0.0] * 4], atol=1e-9)


def test_derivatives_by_stated_rotations_and_directions_are_exact():
    def build(p, q, place):
        system = arm(SphericalJoint, pose={"hip": q, "x.rotation_x": p, "x.rotation_y": 1.0},
                     rates={"x.rotation_x": 2.0, "x.rotation_z": q})  # fmt: skip
        ball = system.add(PointMass("ball", mass=1.0, position=(1.0, place, 0.4)))
        system.add(Rod("rod", system.body("b").point("in"), ball.centre))
        system.pose({"hip": q, "x.rotation_x": p, "x.rotation_y": 1.0, "rod.azimuth": p * q},
                    {"x.rotation_x": 2.0, "x.rotation_z": q, "rod.elevation": p})  # fmt: skip
        return system

    channels = [*POSE[3:], *MOTION[3:], *(f"ball.centre.{what}" for what in ("x", "y", "z", "vx", "vy", "vz"))]
    model = da.TimeResponse(
        build, {"p": (0, 2), "q": (0, 2), "place": (-1, 1)}, channels, [0.0, 0.01], da.GeneralizedAlpha(step=5e-3)
    )
    at, step = np.array([0.7, 0.9, 0.2]), 1e-3
    jacobian = model.jacobian(at)
    for column, unit in enumerate(np.eye(3)):
        runs = [model.evaluate(at + k * step * unit).only()[0] for k in (-2, -1, 1, 2)]
        differences = (runs[0] - 8 * runs[1] + 8 * runs[2] - runs[3]) / (12 * step)
        np.testing.assert_allclose(jacobian[:, :, column], differences, atol=1e-8)


@pytest.mark.parametrize("reverse", [False, True])
def test_rods_to_point_masses_turn_with_the_body_that_has_axes(reverse):
    system = arm(Hinge)
    ball = system.add(PointMass("ball", mass=1.0, position=(0.5, 0.1, 0.3)))
    sides = system.body("a").point("end"), ball.centre
    system.add(Rod("rod", *(sides[::-1] if reverse else sides)))
    system.pose({"hip": 1.0}, rates={"hip": 2.0})
    c, s = np.cos(1.0), np.sin(1.0)
    place = np.array([0.5 * c - 0.1 * s, 0.5 * s + 0.1 * c, 0.3])
    found = start(system, *(f"ball.centre.{what}" for what in ("x", "y", "z", "vx", "vy", "vz")))
    np.testing.assert_allclose(found, [*place, -2.0 * place[1], 2.0 * place[0], 0.0], atol=1e-9)


def planar_arm(joint, *, mass=False, pose=None, rates=None, **options):
    """A bar on a pin, and a second body on a joint that closes no loop, in the plane."""
    system = da.System(gravity=(0.0, 0.0))
    first = system.add(da.RigidBar("a", length=1.0, mass=1.0))
    place = (1.2, 0.1) if joint is da.DistanceJoint else (1.0, 0.0) if joint is da.RevoluteJoint else (1.3, 0.0)
    if mass:
        side = system.add(da.PointMass("b", mass=1.0, position=place)).centre
    else:
        side = system.add(da.RigidBar("b", length=1.0, mass=1.0, start=place, angle=0.4)).start
    system.add(da.RevoluteJoint("hip", system.ground, first.start))
    system.add(joint("x", first.end, side, **options))
    system.pose(pose or {}, rates)
    return system, place


@pytest.mark.parametrize(
    ("joint", "mass"),
    [
        (da.RevoluteJoint, False), (da.RevoluteJoint, True), (da.DistanceJoint, False), (da.DistanceJoint, True),
        (da.PrismaticJoint, False),
    ],
)  # fmt: skip
def test_joints_in_the_plane_keep_their_coordinates_and_are_at_rest(joint, mass):
    system, (x, y) = planar_arm(joint, mass=mass, pose={"hip": 1.0}, rates={"hip": 2.0})
    c, s = np.cos(1.0), np.sin(1.0)
    point, expected = ("centre" if mass else "start"), np.array([c * x - s * y, s * x + c * y])
    found = start(system, *(f"b.{point}.{what}" for what in ("x", "y", "vx", "vy")))
    np.testing.assert_allclose(found, [*expected, -2.0 * expected[1], 2.0 * expected[0]], atol=1e-9)
    if not mass:
        np.testing.assert_allclose(start(system, "b.start.angle", "b.start.rate"), [1.4, 2.0], atol=1e-9)


def test_directions_and_displacements_in_the_plane_can_be_stated():
    system, _ = planar_arm(
        da.DistanceJoint, length=0.5, pose={"x.direction": 2.0, "x.angle": 1.0}, rates={"x.direction": 3.0}
    )
    found = start(system, *(f"b.start.{what}" for what in ("x", "y", "vx", "vy", "angle", "rate")))
    c, s = 0.5 * np.cos(2.0), 0.5 * np.sin(2.0)
    np.testing.assert_allclose(found, [1.0 + c, s, -3.0 * s, 3.0 * c, 1.0, 0.0], atol=1e-9)
    system, _ = planar_arm(da.PrismaticJoint, angle=0.0, pose={"hip": np.pi / 2, "x": 0.7}, rates={"x": 0.2})
    found = start(system, *(f"b.start.{what}" for what in ("x", "y", "vx", "vy", "angle")))
    np.testing.assert_allclose(found, [0.0, 1.7, 0.0, 0.2, np.pi / 2 + 0.4], atol=1e-9)
