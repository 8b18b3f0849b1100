"""Channels of the friction in joints, in the plane and in space."""

import numpy as np

import dalembert as da
import dalembert.multibody as mb
import dalembert.multibody.spatial as sp

END, SOLVER = 0.2, mb.RadauIIA(tolerance=1e-10)


def test_friction_of_a_hinge_in_space_slows_the_disc() -> None:
    """J w' = friction torque; it grows with the reaction, m g."""
    system = sp.SpatialSystem()
    disc = system.add(sp.RigidBody("disc", sp.Inertia(2.0, (0.02, 0.02, 0.03)), angular_velocity=(0.0, 0.0, 5.0)))
    friction = sp.Friction(viscous=0.01, coulomb=0.05, coefficient=0.2, radius=0.02, slip=1e-3)
    system.add(sp.RevoluteJoint("pin", system.ground.point((0.0, 0.0, 0.0)), disc.point("origin"), friction=friction))
    motion = mb.simulate(system, END, SOLVER)
    torque, rate, acceleration = motion.channels(["pin.friction.torque", "pin.rate", "disc.origin.wz_rate"]).T
    np.testing.assert_allclose(torque, 0.03 * acceleration, rtol=1e-9)
    np.testing.assert_allclose(torque, -0.01 * rate - 0.05 - 0.2 * 0.02 * 2.0 * 9.81, rtol=1e-9)


def test_friction_of_a_slide_in_space() -> None:
    system = sp.SpatialSystem()
    block = system.add(sp.RigidBody("block", sp.Inertia(2.0, (0.02, 0.02, 0.03)), velocity=(1.5, 0.0, 0.0)))
    friction = sp.Friction(viscous=0.3, coefficient=0.1, slip=1e-4)
    ground = system.ground.point((0.0, 0.0, 0.0))
    system.add(sp.PrismaticJoint("slide", ground, block.point("origin"), axis=(1.0, 0.0, 0.0), friction=friction))
    motion = mb.simulate(system, END, SOLVER)
    force, speed, acceleration = motion.channels(["slide.friction.force", "slide.speed", "block.origin.ax"]).T
    np.testing.assert_allclose(force, 2.0 * acceleration, rtol=1e-9)
    np.testing.assert_allclose(force, -0.3 * speed - 0.1 * 2.0 * 9.81, rtol=1e-9)


def test_friction_in_the_plane() -> None:
    system = da.System()
    wheel = system.add(da.RigidBody("wheel", 2.0, 0.03, angular_velocity=5.0))
    system.add(da.RevoluteJoint("pin", system.ground, wheel.point("centre"), viscous=0.01, coulomb=0.05))
    block = system.add(da.RigidBody("block", 2.0, 0.03, velocity=(1.5, 0.0)))
    system.add(da.PrismaticJoint("slide", system.ground, block.point("centre"), friction_coefficient=0.1))
    motion = mb.simulate(system, END, SOLVER)
    names = ["pin.friction.torque", "slide.friction.force", "pin.rate"]
    torque, force, rate = motion.channels(names).T
    np.testing.assert_allclose(torque, -0.01 * rate - 0.05, rtol=1e-9)
    np.testing.assert_allclose(force, -0.1 * 2.0 * 9.81, rtol=1e-9)


def test_joints_without_friction_have_no_such_channel() -> None:
    system = sp.SpatialSystem()
    disc = system.add(sp.RigidBody("disc", sp.Inertia(2.0, (0.02, 0.02, 0.03))))
    system.add(sp.RevoluteJoint("pin", system.ground, disc.point("origin")))
    assert not [name for name in mb.simulate(system, 0.01).channel_names if "friction" in name]
