"""Turns of angles that are counted in the integration, with output times that are turns apart."""

import numpy as np
import pytest

import dalembert.multibody as mb
import dalembert.multibody.spatial as sp
from dalembert.multibody.model.lowering import lower
from dalembert.multibody.model.turns import counted_angles

TIMES = np.array([0.0, 0.7, 1.9, 2.0])
START, MOMENT = 2.9, 0.5


def wheel(rate=30.0, torque=5.0, armature=0.0) -> sp.SpatialSystem:
    """A wheel that turns by 12 turns, seen by its joint and by a motor that is switched off."""
    system = sp.SpatialSystem(gravity=(0.0, 0.0, 0.0))
    turned = sp.Orientation.by_rotation_vector((0.0, 0.0, START))
    disc = sp.RigidBody(
        "disc", sp.Inertia(1.0, (0.3, 0.3, MOMENT)), (0.0, 0.0, 0.0), turned, angular_velocity=(0, 0, rate)
    )
    sides = system.ground.point((0.0, 0.0, 0.0)), system.add(disc).point("origin")
    system.add(sp.RevoluteJoint("pin", *sides))
    system.add(sp.Torque("load", disc.point("origin"), z=torque))
    system.add(sp.Motor("motor", *sides, torque_constant=1.0, current=0.0, armature_inertia=armature))
    return system


def angle(times: np.ndarray, rate=30.0, torque=5.0, armature=0.0) -> np.ndarray:
    """The angle of the wheel in closed form."""
    return START + rate * times + torque / (MOMENT + armature) * times**2 / 2


@pytest.mark.parametrize(
    ("solver", "tolerance"),
    [
        (mb.RadauIIA(tolerance=1e-9), 1e-8),
        (mb.RadauIIA(step=2e-2), 1e-5),
        (mb.GeneralizedAlpha(1e-3), 0.2),
        (mb.GeneralizedAlpha(1e-3, adaptive=True), 0.2),
        (mb.RungeKutta4(5e-3), 0.1),
        (mb.OdeSolver(), 1e-5),
        (mb.OdeSolver(stabilisation=mb.Partitioning()), 1e-5),
        (mb.EnergyMomentum(4e-3), 0.5),
        (mb.Variational(4e-3), 0.5),
        (mb.Collocation(1e-3), 1.5),
    ],
    ids=str,
)
def test_integrators_count_the_turns(solver: mb.Integrator, tolerance: float) -> None:
    """The errors are those of the methods, far less than a turn."""
    values = mb.simulate(wheel(), 2.0, solver, TIMES).channels(["pin.angle", "motor.angle"])
    np.testing.assert_allclose(values[:, 0], angle(TIMES), atol=tolerance)
    np.testing.assert_allclose(values[:, 1], values[:, 0], rtol=1e-13)


@pytest.mark.parametrize("solver", [mb.Variational(4e-3), mb.EnergyMomentum(4e-3)], ids=str)
def test_rotors_do_not_change_what_is_counted(solver: mb.Integrator) -> None:
    motion = mb.simulate(wheel(armature=0.5), 2.0, solver, TIMES)
    np.testing.assert_allclose(motion.channels(["pin.angle"])[:, 0], angle(TIMES, armature=0.5), atol=0.3)


def test_batches_and_derivatives_count_too() -> None:
    box = {"rate": (10.0, 40.0), "torque": (1.0, 10.0)}
    model = mb.TimeResponse(wheel, box, ["motor.angle"], TIMES, mb.RadauIIA(tolerance=1e-9))
    vectors = np.array([[30.0, 5.0], [10.0, 1.0], [40.0, 10.0], [20.0, 3.0]])
    batch = model.evaluate(vectors).only()[:, :, 0]
    np.testing.assert_allclose(batch, [angle(TIMES, *vector) for vector in vectors], atol=1e-8)
    response, jacobian = model.linearise(vectors[0])
    np.testing.assert_allclose(response[:, 0], batch[0], rtol=1e-13)
    np.testing.assert_allclose(jacobian[:, 0], np.stack([TIMES, TIMES**2], axis=1), atol=1e-8)
    many = mb.TimeResponse(wheel, box, ["pin.angle"], TIMES, mb.GeneralizedAlpha(1e-3)).evaluate(vectors).only()
    np.testing.assert_allclose(many[:, :, 0], [angle(TIMES, *vector) for vector in vectors], atol=0.4)


def test_a_rate_that_rises_fast_loses_no_turn() -> None:
    """A wheel that rests, so that ends of steps are skipped, turns by 30 turns in the next half second."""
    system, jolt = wheel(0.0, 0.0), 1500.0  # rad/s^2
    load = mb.Step(MOMENT * jolt, 0.5)
    system.add(sp.Torque("jolt", system.bodies[0].point("origin"), z=load))
    times = np.array([0.0, 0.5, 1.0])
    for solver, tolerance in (
        (mb.RadauIIA(tolerance=1e-9), 1e-3),
        (mb.OdeSolver(), 1e-3),
        (mb.GeneralizedAlpha(2e-4), 1.0),
    ):
        found = mb.simulate(system, 1.0, solver, times).channels(["pin.angle"])[:, 0]
        np.testing.assert_allclose(found, [START, START, START + jolt / 8], atol=tolerance)


def test_both_angles_of_a_universal_joint_and_a_prescribed_one() -> None:
    system = sp.SpatialSystem(gravity=(0.0, 0.0, 0.0))
    rod = system.add(sp.RigidBody("rod", sp.Inertia(1.0, (0.3, 0.3, 0.5)), angular_velocity=(9.0, 0.0, 0.0)))
    other = system.add(sp.RigidBody("other", sp.Inertia(1.0, (0.3, 0.3, 0.5)), angular_velocity=(0.0, 8.0, 0.0)))
    system.add(sp.UniversalJoint("first", system.ground, rod.point("origin")))
    system.add(sp.UniversalJoint("second", system.ground, other.point("origin")))
    driven = system.add(sp.RigidBody("driven", sp.Inertia(1.0, (0.3, 0.3, 0.5)), angular_velocity=(0.0, 0.0, 7.0)))
    system.add(sp.RevoluteJoint("pin", system.ground, driven.point("origin")))
    turning = mb.Polynomial([0.0, 7.0])
    system.add(sp.PrescribedMotion("drive", system.ground, driven.point("origin"), motion=turning))
    channels = ["first.angle_a", "second.angle_b", "drive.angle"]
    found = mb.simulate(system, 2.0, "auto", times=np.array([0.0, 2.0])).channels(channels)[-1]
    np.testing.assert_allclose(found, [18.0, 16.0, 14.0], atol=1e-4)


def spinning(rate) -> mb.System:
    """A cable that turns about its start like a rod: the angle of its node is known up to whole turns."""
    system = mb.System(gravity=(0.0, 0.0))
    cable = system.add(mb.AncfCable("cable", 0.4, 1, 1e9, 1000.0, 0.02, 0.02, angular_velocity=rate))
    system.add(mb.RevoluteJoint("pin", system.ground, cable.start))
    return system


def test_angles_of_nodes_in_the_plane_are_counted_by_the_motion_and_by_its_adjoint() -> None:
    channels, solver = ["pin.angle", "cable.end.angle"], mb.GeneralizedAlpha(2e-3)
    fine = mb.simulate(spinning(9.0), 2.0, solver).channels(channels)
    sparse = mb.simulate(spinning(9.0), 2.0, solver, times=np.array([0.0, 2.0])).channels(channels)
    assert sparse[-1, 0] == pytest.approx(18.0, abs=1.0)
    np.testing.assert_allclose(sparse[-1], fine[-1], atol=1e-9)
    model = mb.TimeResponse(spinning, {"rate": (1.0, 20.0)}, channels, np.array([0.0, 2.0]), solver)
    np.testing.assert_allclose(model.pullback(np.array([9.0]))[0], model.evaluate(np.array([[9.0]])).only()[0])


def test_only_angles_that_need_it_are_counted() -> None:
    assert [angle.kind.name for angle in counted_angles(lower(wheel()))] == ["revolute_in_space", "motor_in_space"]
    planar = mb.System()
    bar = planar.add(mb.RigidBar("bar", length=1.0, mass=1.0))
    planar.add(mb.RevoluteJoint("pin", planar.ground, bar.start))
    assert counted_angles(lower(planar)) == ()
