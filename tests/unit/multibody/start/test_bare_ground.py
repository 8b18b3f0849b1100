"""Joints, springs and bushings to the ground without a place hold bodies as these are placed, in the plane."""

import pytest

import dalembert.multibody as mb

ANGLE = 0.5
BODIES = {
    "rigid": lambda: mb.RigidBar("bar", 1.0, 1.0, start=(0.2, 0.1), angle=ANGLE),
    "beam": lambda: mb.AncfCable("bar", 1.0, 1, 1e8, 900.0, 0.02, 0.02, start=(0.2, 0.1), angle=ANGLE),
}


@pytest.mark.parametrize("body", BODIES.values(), ids=BODIES)
@pytest.mark.parametrize("joint", [mb.FixedJoint, mb.PrismaticJoint])
@pytest.mark.parametrize("swapped", [False, True])
def test_joints_keep_the_angle(joint, body, swapped) -> None:
    system = mb.System(gravity=(0.0, 0.0))
    sides = system.ground, system.add(body()).start
    system.add(joint("clamp", *(sides[::-1] if swapped else sides)))
    found = mb.simulate(system, 1e-4).channels([f"bar.start.{name}" for name in ("x", "y", "angle")])[0]
    assert found == pytest.approx([0.2, 0.1, ANGLE], abs=1e-9)


@pytest.mark.parametrize("body", BODIES.values(), ids=BODIES)
def test_springs_are_at_rest(body) -> None:
    system = mb.System(gravity=(0.0, 0.0))
    sides = system.ground, system.add(body()).start
    system.add(mb.TorsionSpring("coil", *sides, 2.0))
    system.add(mb.Bushing("rubber", *sides, 1.0, 1.0, 3.0))
    found = mb.simulate(system, 1e-4).channels(["coil.force", "rubber.force_x", "rubber.force_y", "rubber.torque"])[0]
    assert found == pytest.approx([0.0] * 4, abs=1e-6)
