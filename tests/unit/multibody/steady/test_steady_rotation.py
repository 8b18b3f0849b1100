"""Modes about steady rotations: what is steady, which frame, and what is refused."""

import numpy as np
import pytest

import dalembert as da
from dalembert.errors import InputError, ModelError
from dalembert.multibody.spatial import (
    Bushing,
    Inertia,
    RevoluteJoint,
    RigidBody,
    SpatialSystem,
    SphericalJoint,
    Spring,
    UniversalJoint,
)
from dalembert.multibody.start.assemble import assembled
from dalembert.multibody.steady.steady_motion import steady_equations
from support import says


def rotor(speed, moments=(1.0, 1.0, 1.6), stiffness=(3e4, 3e4), centre=(0.0, 0.0, 0.0)):
    """A body on a ball joint and two horizontal springs at its axis."""
    system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    inertia, tip = Inertia(1.0, moments).moved(centre), {"tip": (0.0, 0.0, 1.0)}
    disc = system.add(RigidBody("disc", inertia, points=tip, angular_velocity=(0.0, 0.0, speed)))
    system.add(SphericalJoint("ball", system.ground, disc.point("origin")))
    for name, place, rate in zip("xy", ((2.0, 0.0, 1.0), (0.0, 2.0, 1.0)), stiffness, strict=True):
        system.add(Spring(name, system.ground.point(place), disc.point("tip"), stiffness=rate, free_length=2.0))
    return system


def jeffcott(speed, eccentricity=0.0, damping=0.0):
    """A disc in the plane, with an unbalance, whose centre is held by springs and driven at a speed."""
    system = da.System(gravity=(0.0, 0.0))
    points = {"shaft": (-eccentricity, 0.0)}
    disc = system.add(
        da.RigidBody("disc", mass=2.0, inertia=0.1, points=points, anchor="shaft", angular_velocity=speed)
    )
    system.add(da.Bushing("supports", system.ground.point(0.0, 0.0), disc.point("shaft"), stiffness_x=8e3, stiffness_y=8e3,
                          damping_x=damping, damping_y=damping))  # fmt: skip
    drive = da.signals.Polynomial((0.0, speed))
    system.add(da.PrescribedMotion("drive", system.ground, disc.point("shaft"), motion=drive))
    return system


def test_rest_has_no_whirl():
    found = da.modes(rotor(0.0))
    np.testing.assert_allclose(found.frequencies, np.sqrt(3e4) / (2 * np.pi), rtol=1e-9)
    assert (found.frame, found.speed, found.growth) == ("fixed", 0.0, 0.0)
    assert not found.whirl.any()
    np.testing.assert_allclose(found.roots, np.sqrt(3e4) * 1j, rtol=1e-9)


def test_damping_of_supports_is_in_the_roots():
    found = da.modes(jeffcott(30.0, damping=40.0))
    root = -40.0 / 4.0 + 1j * np.sqrt(8e3 / 2.0 - (40.0 / 4.0) ** 2)
    np.testing.assert_allclose(found.roots, [root, root], rtol=1e-9)
    assert found.frame == "fixed"


def test_an_unbalanced_rotor_whirls_steadily_in_the_rotating_frame():
    speed, eccentricity = 40.0, 1e-2
    equations = steady_equations(assembled(jeffcott(speed, eccentricity)))
    assert equations.frame == "rotating"
    # the centre of mass at e/(1 - W^2/w^2) from the axis
    square = 8e3 / 2.0
    away = eccentricity * square / (square - speed**2)
    assert np.hypot(*equations.x[:2]) == pytest.approx(away, rel=1e-9)
    found = da.modes(jeffcott(speed, eccentricity))
    np.testing.assert_allclose(found.frequencies * 2 * np.pi, np.sqrt(square) + np.array([-speed, speed]), rtol=1e-9)
    np.testing.assert_allclose(found.whirl, [1.0, -1.0], atol=1e-9)


def test_a_rotor_on_a_turntable_is_seen_from_the_table():
    system, table_speed = SpatialSystem(gravity=(0.0, 0.0, 0.0)), 5.0
    around = {"angular_velocity": (0.0, 0.0, table_speed), "points": {"mount": (0.4, 0.0, 0.2)}}
    table = system.add(RigidBody("table", Inertia(10.0, (1.0, 1.0, 2.0)), **around))
    mount, ball = table.point("mount"), Inertia(1.0, (0.01, 0.01, 0.01))
    wheel = Inertia(1.0, (0.01, 0.01, 0.016))
    gyro = system.add(RigidBody("gyro", wheel, mount, angular_velocity=(0.0, 0.0, 100.0)))
    bob = system.add(RigidBody("bob", ball, mount, angular_velocity=(0.0, 0.0, table_speed)))
    system.add(RevoluteJoint("base", system.ground, table.point("origin")))
    system.add(RevoluteJoint("axle", mount, gyro.point("origin")))
    system.add(UniversalJoint("cross", mount, bob.point("origin")))
    system.add(Bushing("springs", mount, bob.point("origin"), stiffness=(0.0, 0.0, 0.0, 5.0, 5.0, 0.0)))
    found = da.modes(system)
    assert (found.frame, found.frame_speed, found.speed) == ("rotating", table_speed, 100.0)
    # the bob is a ball: w^2 - W w - k/I = 0 in the frame of the table
    np.testing.assert_allclose(found.frequencies * 2 * np.pi, [20.0, 25.0], rtol=1e-7)


def test_shapes_satisfy_the_joints_and_are_scaled():
    found = da.modes(rotor(200.0))
    np.testing.assert_allclose(np.abs(found.shapes).max(axis=0), 1.0)
    np.testing.assert_allclose(found.shapes[:3], 0.0, atol=1e-12)  # the ball joint holds the origin


def test_masses_that_move_along_a_line_vibrate_as_at_rest():
    system = da.System(gravity=(0.0, 0.0))
    ends = [system.add(da.PointMass(name, 2.0, (x, 0.0), velocity=(3.0, 0.0))) for name, x in (("a", 0.0), ("b", 1.0))]
    system.add(da.Spring("spring", ends[0].centre, ends[1].centre, stiffness=400.0, free_length=1.0))
    found = da.modes(system)
    np.testing.assert_allclose(found.frequencies * 2 * np.pi, [20.0], rtol=1e-9)
    assert (found.frame, found.speed) == ("fixed", 0.0)


def swinging():
    system = da.System()
    bar = system.add(da.RigidBar("bar", length=1.0, mass=1.0, angular_velocity=3.0))
    system.add(da.RevoluteJoint("pin", system.ground, bar.start))
    return system


def braked():
    system = da.System(gravity=(0.0, 0.0))
    wheel = system.add(da.RigidBody("wheel", mass=1.0, inertia=1.0, angular_velocity=3.0))
    system.add(da.RevoluteJoint("pin", system.ground, wheel.centre, viscous=0.1))
    return system


NOT_STEADY = {
    "swinging": (swinging, "forces on 'bar' are not in balance"),
    "braked": (braked, "forces on 'wheel' are not in balance"),
    "asymmetric on anisotropic supports": (
        lambda: rotor(200.0, (1.0, 1.2, 1.6), (3e4, 6e4)),
        r"in the fixed frame, the mass matrix changes along the motion; in the rotating frame, the stiffness matrix ",
    ),
}


@pytest.mark.parametrize("case", NOT_STEADY)
def test_what_is_not_steady_is_refused(case):
    make, reason = NOT_STEADY[case]
    with pytest.raises(ModelError, match=r"^the motion at the start is not steady: .*" + reason):
        da.modes(make())


def test_modes_about_rest_are_those_of_the_equilibrium():
    found = da.modes(da.equilibrium(swinging()))
    np.testing.assert_allclose(found.frequencies, [np.sqrt(1.5 * 9.81) / (2 * np.pi)], rtol=1e-9)


def test_a_frame_has_to_be_one():
    with pytest.raises(InputError, match=says("modes: unknown frame 'turning'; known: fixed, rotating")):
        da.modes(rotor(10.0), frame="turning")
    with pytest.raises(InputError, match=says("modes: frame is 'rotating', but no body turns; leave it out")):
        da.modes(rotor(0.0), frame="rotating")
    with pytest.raises(ModelError, match=r"^the motion at the start is not steady: in the fixed frame, the mass "):
        da.modes(rotor(10.0, (1.0, 1.2, 1.6)), frame="fixed")


def test_a_campbell_diagram_names_the_speed_that_is_not_steady():
    with pytest.raises(ModelError, match=r"^speed = 100 rad/s: the motion at the start is not steady"):
        da.campbell(lambda speed: rotor(speed, (1.0, 1.2, 1.6), (3e4, 6e4)), [0.0, 100.0])
    with pytest.raises(InputError, match=says("campbell: speeds is []; expected at least one finite number")):
        da.campbell(rotor, [])


def test_speeds_may_be_in_any_order_and_negative():
    found = da.campbell(rotor, [200.0, -100.0, 0.0], 2)
    np.testing.assert_allclose(found.speeds, [200.0, 100.0, 0.0], atol=1e-9)
    root = np.sqrt(160.0**2 + 4 * 3e4)
    np.testing.assert_allclose(np.sort(found.roots.imag[1]), [(root - 160.0) / 2, (root + 160.0) / 2], rtol=1e-9)
    assert found.frame == "fixed"


def test_functions_that_lose_the_complex_step_are_refused():
    system = jeffcott(30.0)
    system.add(
        da.UserForce("pull", system.body("disc").point("shaft"), lambda t, at, against: (-3.0 * at[2].real, 0.0, 0.0))
    )
    with pytest.raises(InputError, match="a force of 'pull' depends on the state, but its derivative is 0 by the"):
        da.modes(system)
