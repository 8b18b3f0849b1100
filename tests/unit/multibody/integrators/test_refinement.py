"""Finer steps of all integrators, and what their difference says about the error of the response."""

import numpy as np
import pytest

from dalembert.forward import Distributed, Recorded, refined
from dalembert.multibody import (
    Automatic,
    Collocation,
    DistanceJoint,
    EnergyMomentum,
    GeneralizedAlpha,
    OdeSolver,
    PointMass,
    RadauIIA,
    RungeKutta4,
    System,
    TimeResponse,
    Variational,
)

TIMES = np.linspace(0, 2, 21)


def pendulum(length):
    system = System(gravity=(0.0, -9.81))
    bob = system.add(PointMass("bob", mass=1.0, position=(length, 0.0)))
    system.add(DistanceJoint("rod", system.ground.point(0.0, 0.0), bob.centre))
    return system


def model(solver):
    return TimeResponse(pendulum, {"length": (0.5, 2.0)}, ["bob.centre.x"], TIMES, solver=solver)


@pytest.fixture(scope="module")
def exact():
    return model(RadauIIA(tolerance=1e-12)).evaluate(np.array([[1.0]])).only()[0]


FIXED = {
    "generalized-alpha": GeneralizedAlpha(step=0.01),
    "without accelerations": GeneralizedAlpha(step=0.002, initial_acceleration="zero"),
    "RungeKutta4": RungeKutta4(step=0.02),
    "Variational": Variational(step=0.01),
    "EnergyMomentum": EnergyMomentum(step=0.01),
    "Collocation": Collocation(step=0.02),
    "Collocation at Gauss points": Collocation(step=0.05, degree=3, gauss_points=2),
    "RadauIIA": RadauIIA(step=0.1, stages=3),
}
ADAPTIVE = {
    "generalized-alpha": GeneralizedAlpha(step=1e-3, adaptive=True, tolerance=1e-5),
    "RadauIIA": RadauIIA(tolerance=1e-5, stages=3),
    "automatic": Automatic(tolerance=1e-5),
    "OdeSolver": OdeSolver("RK45", relative_tolerance=1e-5, absolute_tolerance=1e-5),
}


@pytest.mark.parametrize("solver", FIXED.values(), ids=FIXED)
def test_half_the_step_and_the_order_give_the_error(solver, exact):
    coarse = model(solver)
    finer = refined(coarse)
    assert finer.how == "at half the step"
    assert finer.model.solver.fixed_step == solver.fixed_step / 2
    assert finer.model.fingerprint != coarse.fingerprint
    response, half = (each.evaluate(np.array([[1.0]])).only()[0] for each in (coarse, finer.model))
    error = response - exact
    found = finer.factor * (response - half)
    assert np.max(np.abs(error)) > 1e-8
    np.testing.assert_allclose(found, error, atol=0.15 * np.max(np.abs(error)))


@pytest.mark.parametrize("solver", ADAPTIVE.values(), ids=ADAPTIVE)
def test_a_tighter_tolerance_gives_the_error(solver, exact):
    finer = refined(model(solver))
    assert finer.how == "at a tolerance 100 times tighter"
    response, tight = (each.evaluate(np.array([[1.0]])).only()[0] for each in (model(solver), finer.model))
    error = response - exact
    np.testing.assert_allclose(finer.factor * (response - tight), error, atol=0.3 * np.max(np.abs(error)) + 1e-9)


def test_the_tightest_tolerance_has_no_finer_one():
    assert refined(model(OdeSolver(relative_tolerance=1e-12))) is None


def test_wrapped_models_are_refined_inside():
    solver = GeneralizedAlpha(step=0.01)
    distributed = Distributed(model(solver), client=None, prefetched={("evaluate", 21, b""): ()})  # pyright: ignore
    finer = refined(Recorded(distributed, checkpoint=None)).model  # pyright: ignore
    assert finer.model.model.solver.fixed_step == 0.005
    assert finer.model.prefetched == {}
    assert distributed.prefetched
