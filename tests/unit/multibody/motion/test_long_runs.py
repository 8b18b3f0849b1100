"""Motions that would take too many steps are refused at once, with the number of steps."""

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.errors import InputError, SolveError
from support import says

YEARS = 1e9  # s


def pendulum(length: complex = 1.0) -> mb.System:
    system = mb.System()
    bar = system.add(mb.RigidBar("bar", length=length, mass=1.0))
    system.add(mb.RevoluteJoint("pin", system.ground.point(0.0, 0.0), bar.start))
    return system


@pytest.mark.parametrize(
    "solver", ["auto", mb.RadauIIA(), mb.OdeSolver(), mb.GeneralizedAlpha(step=1e-3, adaptive=True)]
)
def test_an_adaptive_method_is_tried_before_a_long_motion(solver: mb.Integrator | str) -> None:
    with pytest.raises(SolveError) as error:
        mb.simulate(pendulum(), YEARS, solver, times=[0.0, YEARS])  # type: ignore[arg-type]
    message = str(error.value)
    assert " took 2000 steps until t = " in message
    assert "At this rate the motion until 1e+09 s takes " in message
    assert message.endswith(
        "steps, and most_steps is 1e+06. Simulate a shorter motion, or increase tolerance or most_steps"
    )


@pytest.mark.parametrize("solver", [mb.RadauIIA(), mb.OdeSolver()])
def test_a_motion_on_undamped_springs_is_tried_too(solver: mb.Integrator) -> None:
    system = mb.System()
    bob = system.add(mb.PointMass("bob", mass=1.0, position=(0.0, -1.5)))
    system.add(mb.Spring("spring", system.ground.point(0.0, 0.0), bob.centre, 100.0, free_length=1.0))
    with pytest.raises(SolveError, match=r" took 2000 steps until t = "):
        mb.simulate(system, YEARS, solver, times=[0.0, YEARS])  # type: ignore[arg-type]


def test_a_motion_on_an_undamped_bushing_is_tried_too() -> None:
    system = mb.System()
    body = system.add(mb.RigidBody("body", 1.0, 1.0, position=(0.1, 0.0)))
    stiff = {"stiffness_x": 100.0, "stiffness_y": 100.0, "stiffness_angle": 10.0}
    system.add(mb.Bushing("bushing", system.ground.point(0.0, 0.0), body.centre, **stiff))
    with pytest.raises(SolveError, match=r" took 2000 steps until t = "):
        mb.simulate(system, YEARS, mb.RadauIIA(), times=[0.0, YEARS])  # type: ignore[arg-type]


def test_a_model_of_a_long_motion_is_refused_too() -> None:
    model = mb.TimeResponse(pendulum, {"length": (0.5, 2.0)}, ["bar.end.x"], np.array([0.0, YEARS]), mb.RadauIIA())
    with pytest.raises(SolveError, match=r"^RadauIIA.* took 2000 steps until"):
        model.evaluate([[1.0]])


def test_a_long_motion_of_few_steps_runs() -> None:
    system = mb.System(gravity=(0.0, 0.0))
    system.add(mb.PointMass("probe", mass=1.0, velocity=(2.0, 0.0)))
    assert mb.simulate(system, YEARS, "auto").channels("probe.centre.x")[-1] == pytest.approx(2 * YEARS)


def test_a_long_motion_that_decays_runs() -> None:
    system = mb.System()
    bob = system.add(mb.PointMass("bob", mass=1.0, position=(0.0, -1.5)))
    system.add(mb.Spring("spring", system.ground.point(0.0, 0.0), bob.centre, 100.0, free_length=1.0, damping=1.0))
    hanging = mb.simulate(system, 1e6, mb.RadauIIA(), times=[0.0, 1e6])  # type: ignore[arg-type]
    assert hanging.channels("bob.centre.y")[-1] == pytest.approx(-1.0 - 9.81 / 100)


def test_fixed_steps_have_a_limit_that_can_be_set() -> None:
    solver = mb.RungeKutta4(step=1e-3)
    with pytest.raises(InputError) as error:
        mb.simulate(pendulum(), YEARS, solver, times=[0.0, YEARS])  # type: ignore[arg-type]
    assert str(error.value).endswith(
        "until 1e+09 s takes 1e+12 steps; expected at most 1e+08, which take hours. Use larger steps or a shorter "
        "motion, or raise most_steps"
    )
    with pytest.raises(InputError, match=r"takes 1e\+03 steps; expected at most 100"):
        mb.simulate(pendulum(), 1.0, solver, most_steps=100)
    assert mb.simulate(pendulum(), 1.0, solver, most_steps=1000).times[-1] == 1.0
    with pytest.raises(InputError, match=says("simulate: most_steps is 'a'; expected a positive number")):
        mb.simulate(pendulum(), 1.0, solver, most_steps="a")  # type: ignore[arg-type]
