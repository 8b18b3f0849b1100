"""Initial states by angles, displacements and rates of joints: open and closed chains, derivatives, refusals."""

import numpy as np
import pytest

import dalembert as da
from dalembert.errors import InputError, ModelError
from dalembert.multibody.spatial import (
    CylindricalJoint,
    GearJoint,
    Inertia,
    PrismaticJoint,
    RigidBody,
    SpatialSystem,
    SphericalJoint,
)
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
    sentence = (
        "SpatialSystem.pose, coordinates: unknown joint with an angle or a displacement 'ball'; known: pin, slide"
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
