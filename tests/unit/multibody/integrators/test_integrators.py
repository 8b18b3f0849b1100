"""What integrators have in common: derivatives of their discrete solutions, batches, jumps of loads."""

import numpy as np
import pytest

import dalembert.multibody as mb
from driven_rope import response
from slopes import errors

BATCHED = (mb.RadauIIA(tolerance=1e-5), mb.Variational(step=2e-3))
JUMPING = (mb.RadauIIA(), mb.Variational(step=0.02))


def name(solver: mb.Integrator) -> str:
    return type(solver).__name__


@pytest.mark.parametrize(
    "solver",
    [
        mb.Variational(step=8e-3),
        mb.EnergyMomentum(step=8e-3),
        *(mb.RadauIIA(step=8e-3, stages=stages) for stages in (3, 5, 7)),
    ],
    ids=lambda solver: name(solver) + str(getattr(solver, "stages", "")),
)
def test_derivatives_are_slopes_of_its_own_motion(solver: mb.Integrator) -> None:
    """With losses and loads; outputs lie on the steps and between them."""
    error, size = errors(response(solver))
    assert min(size.values()) > 1e-5
    assert max(error.values()) < 1e-6


@pytest.mark.parametrize("solver", BATCHED, ids=name)
def test_a_batch_has_the_bits_of_single_runs(solver: mb.Integrator) -> None:
    model = response(solver, 2)
    vectors = np.array([[2e5, 1.0, 0.3, 20.0, 2.0], [5e5, 0.6, 0.5, 40.0, 1.2], [4e5, 1.5, 0.4, 15.0, 3.0]])
    together = model.evaluate(vectors)
    assert together.failures == (None,) * 3
    for vector, values in zip(vectors, together.values, strict=True):
        np.testing.assert_array_equal(model.evaluate(vector).only()[0], values)


@pytest.mark.parametrize("solver", JUMPING, ids=name)
def test_a_step_ends_where_a_load_jumps(solver: mb.Integrator) -> None:
    """A mass under a force that is switched on and off: a parabola, exact by the midpoint rule too, then a line."""
    system = mb.System(gravity=(0.0, 0.0))
    mass = system.add(mb.PointMass("mass", 2.0, (0.0, 0.0)))
    system.add(mb.Force("push", mass.centre, x=mb.Step(6.0, 0.31, 0.73)))
    times = np.array([0.2, 0.31, 0.5, 0.73, 1.0])
    values = mb.simulate(system, 1.0, solver, times).channels(["mass.centre.x", "mass.centre.vx"])
    speed = 3.0 * np.clip(times - 0.31, 0.0, 0.42)
    place = 1.5 * np.clip(times - 0.31, 0.0, 0.42) ** 2 + 3.0 * 0.42 * np.clip(times - 0.73, 0.0, None)
    np.testing.assert_allclose(values, np.column_stack([place, speed]), atol=1e-13)


def pushed(force: float) -> mb.System:
    """A bar on a pin under a force that acts from the start on."""
    system = mb.System()
    bar = system.add(mb.RigidBar("bar", 1.0, 1.0, angle=-0.5))
    system.add(mb.RevoluteJoint("O", system.ground, bar.start))
    system.add(mb.Force("push", bar.end, x=force))
    return system


@pytest.mark.parametrize(
    "solver",
    [mb.Variational(step=2e-3), mb.EnergyMomentum(step=2e-3), mb.RadauIIA()],
    ids=lambda own: type(own).__name__,
)
def test_a_parameter_of_a_load_at_the_start_counts_as_no_mass(solver: mb.Integrator) -> None:
    model = mb.TimeResponse(pushed, {"force": (1.0, 3.0)}, ["bar.end.x"], np.linspace(0.0, 1.0, 6), solver)
    at, h = np.array([2.0]), 1e-4
    slope = (model.evaluate(at + h).only()[0] - model.evaluate(at - h).only()[0]) / (2 * h)
    np.testing.assert_allclose(model.jacobian(at)[:, :, 0], slope, atol=1e-6 * np.abs(slope).max())
