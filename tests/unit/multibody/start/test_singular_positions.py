"""Singular positions are recognised, with the joints that lose independence."""

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.errors import SolveError
from dalembert.multibody.start.assemble import assembled
from dalembert.multibody.start.singular_positions import dependent_joints, singular_position


def four_bar(angle: float) -> mb.System:
    """A parallelogram whose frame is as long as its bars, and a pendulum apart from it."""
    system = mb.System()
    left = system.add(mb.RigidBar("left", 1.0, 1.0, angle=angle))
    right = system.add(mb.RigidBar("right", 1.0, 1.0, angle=angle, start=(1.0, 0.0)))
    rod = system.add(mb.RigidBar("rod", 1.0, 1.0, start=left.end))
    pendulum = system.add(mb.RigidBar("pendulum", 1.0, 1.0, start=(5.0, 0.0)))
    for name, a, b in (
        ("A0", system.ground, left.start),
        ("A", left.end, rod.start),
        ("B", rod.end, right.end),
        ("B0", system.ground, right.start),
        ("P", system.ground, pendulum.start),
    ):
        system.add(mb.RevoluteJoint(name, a, b))
    return system


@pytest.mark.parametrize(
    ("angle", "joints"), [(0.0, ("A", "A0", "B", "B0")), (1e-5, ("A", "A0", "B", "B0")), (0.1, ())]
)
def test_the_joints_of_a_flat_four_bar(angle: float, joints: tuple[str, ...]) -> None:
    start, place = assembled(four_bar(1.0)), assembled(four_bar(angle))
    assert dependent_joints(start, place.x, 0.0) == joints
    assert isinstance(singular_position(start, place.x, 0.5), SolveError) == bool(joints)


def test_redundant_joints_are_not_taken_for_a_singular_position() -> None:
    system = four_bar(1.0)
    system.add(mb.RevoluteJoint("twin", system.ground, system.body("left").point("start")))
    lowered = assembled(system)
    assert dependent_joints(lowered, np.real(lowered.x), 0.0) == ()


def test_auto_passes_with_derivatives() -> None:
    """A four-bar that falls flat stops the first choice; steps that are chosen by the error roughen the differences."""
    names, times, solver = ["rod.centre.x", "rod.centre.y"], np.array([0.0, 1.0]), mb.Automatic(tolerance=1e-10)
    assert isinstance(mb.simulate(four_bar(1.0), 1.0, solver).solver, mb.OdeSolver)
    model = mb.TimeResponse(four_bar, {"angle": (0.9, 1.1)}, names, times, solver)
    exact = model.jacobian(np.array([1.0]))[-1, :, 0]
    after, before = model.evaluate(np.array([[1.0 + 1e-3], [1.0 - 1e-3]])).only()
    np.testing.assert_allclose(exact, (after - before)[-1] / 2e-3, rtol=3e-4)
