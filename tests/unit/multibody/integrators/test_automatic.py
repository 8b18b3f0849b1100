"""The integrator that suits the mechanism is chosen by whether anything in it bends."""

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.multibody import (
    AncfCable,
    Automatic,
    GeneralizedAlpha,
    OdeSolver,
    Partitioning,
    RadauIIA,
    RevoluteJoint,
    RigidBar,
    System,
    TimeResponse,
    simulate,
)
from dalembert.multibody.model.lowering import lower
from support import says


def rigid(length: float = 1.0) -> System:
    system = System(gravity=(0.0, -9.81))
    bar = system.add(RigidBar("bar", length=length, mass=1.0))
    system.add(RevoluteJoint("pin", system.ground, bar.start))
    return system


def flexible() -> System:
    system = System(gravity=(0.0, -9.81))
    bar = system.add(AncfCable("bar", 1.0, 2, 2e8, height=0.04, width=0.04, density=5540.0))
    system.add(RevoluteJoint("pin", system.ground, bar.start))
    return system


def test_a_rigid_mechanism_gets_the_high_order() -> None:
    trajectory = simulate(rigid(), 0.5, solver="auto")
    assert trajectory.solver == RadauIIA(tolerance=1e-6)
    fine = simulate(rigid(), 0.5, solver=GeneralizedAlpha(step=1e-4), times=trajectory.times)
    apart = trajectory.channels(["bar.end.y"]) - fine.channels(["bar.end.y"])
    assert np.max(np.abs(apart)) < 1e-6


def test_a_flexible_one_gets_generalized_alpha() -> None:
    trajectory = simulate(flexible(), 0.1, solver=Automatic(tolerance=1e-4))
    assert trajectory.solver == GeneralizedAlpha(step=1e-4, adaptive=True, tolerance=1e-4)


@pytest.mark.parametrize(
    ("slip_rate", "expected"),
    [(1e-3, GeneralizedAlpha(step=1e-3, adaptive=True)), (1e-5, RadauIIA(tolerance=1e-6))],
)
def test_a_flexible_one_with_stiff_friction_gets_radau(slip_rate: float, expected: object) -> None:
    """Friction of 100 N m holds the cable but for its creep."""
    system = System(gravity=(0.0, -9.81))
    bar = system.add(AncfCable("bar", 1.0, 2, 2e8, height=0.04, width=0.04, density=5540.0))
    system.add(RevoluteJoint("pin", system.ground, bar.start, coulomb=100.0, slip_rate=slip_rate))
    assert Automatic().suiting(lower(system), 1.0) == expected
    rates = simulate(system, 0.01, "auto").channels(["pin.rate"])
    assert np.max(np.abs(rates)) < slip_rate


def test_redundant_constraints_get_a_method_that_takes_them() -> None:
    system = rigid()
    system.add(RevoluteJoint("again", system.ground, system.bodies[0].start))
    trajectory = simulate(system, 0.5, solver="auto")
    assert trajectory.solver == OdeSolver("DOP853", 1e-6, 1e-6, Partitioning())
    twin = simulate(rigid(), 0.5, solver="auto", times=trajectory.times)
    apart = trajectory.channels(["bar.end.y"]) - twin.channels(["bar.end.y"])
    assert np.max(np.abs(apart)) < 1e-5


def test_a_forward_model_takes_the_same_choice() -> None:
    times = np.array([0.0, 0.25, 0.5])
    chosen = TimeResponse(rigid, {"length": (0.5, 2.0)}, ["bar.end.y"], times, solver="auto")
    named = TimeResponse(rigid, {"length": (0.5, 2.0)}, ["bar.end.y"], times, solver=RadauIIA(tolerance=1e-6))
    for given, expected in zip(chosen.linearise(np.ones(1)), named.linearise(np.ones(1)), strict=True):
        np.testing.assert_array_equal(given, expected)


def test_another_word_is_no_solver() -> None:
    sentence = (
        "unknown solver 'automatic'; did you mean 'auto'? Or give an integrator, such as GeneralizedAlpha(step=1e-3)"
    )
    with pytest.raises(InputError, match=says(sentence)):
        simulate(rigid(), 0.5, solver="automatic")


def test_the_tolerance_is_positive() -> None:
    with pytest.raises(InputError, match=says("Automatic: tolerance is 0; expected a positive number")):
        Automatic(tolerance=0.0)
