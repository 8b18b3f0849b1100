"""Forces of redundant joints are those of least norm, by every integrator that takes such joints, with derivatives."""

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.multibody.model.evaluate import constraint_jacobian
from dalembert.multibody.model.lowered import scales

SOLVERS = {
    "RK4": mb.RungeKutta4(2e-3),
    "RK4, partitioning": mb.RungeKutta4(2e-3, mb.Partitioning()),
    "DOP853": mb.OdeSolver("DOP853", 1e-10, 1e-12),
    "Radau, partitioning": mb.OdeSolver("Radau", 1e-9, 1e-11, mb.Partitioning()),
    "auto": mb.Automatic(tolerance=1e-10),
}
TIMES = np.linspace(0.0, 2.0, 21)
FORCES = [f"{joint}{k}.force_{axis}" for joint in ("head", "foot") for k in range(3) for axis in "xy"]


def hanging(stiffness: complex = 10.0) -> mb.System:
    """A plate on three parallel bars of different masses at uneven places: its self-stress turns with the bars."""
    system = mb.System()
    feet = (-1.0, 0.3, 1.0)
    bars = [
        system.add(mb.RigidBar(f"bar{k}", 1.0, mass, angle=-1.2, start=system.ground.point(x, 0.0)))
        for k, (x, mass) in enumerate(zip(feet, (0.3, 1.1, 0.7), strict=True))
    ]
    holes = {f"hole{k}": (x + 0.2, -0.1) for k, x in enumerate(feet)}
    plate = system.add(mb.RigidBody("plate", 2.0, 0.7, bars[0].end, anchor="hole0", points=holes))
    for k, bar in enumerate(bars):
        system.add(mb.RevoluteJoint(f"foot{k}", system.ground, bar.start))
        system.add(mb.RevoluteJoint(f"head{k}", bar.end, plate.point(f"hole{k}")))
    system.add(mb.Spring("spring", system.ground.point(2.0, 0.5), plate.centre, stiffness, free_length=1.0))
    return system


@pytest.fixture(scope="module")
def reference() -> np.ndarray:
    return mb.simulate(hanging(), 2.0, SOLVERS["RK4"], TIMES).channels(FORCES)


@pytest.mark.parametrize("name", SOLVERS)
def test_all_integrators_give_the_same_forces(reference, name: str) -> None:
    ours = mb.simulate(hanging(), 2.0, SOLVERS[name], TIMES).channels(FORCES)
    np.testing.assert_allclose(ours, reference, rtol=0, atol=1e-8)


def test_they_have_no_self_stress() -> None:
    """By a pseudo-inverse of the Jacobian: at the end as at the start, in long steps as in short ones."""
    for solver in (mb.RungeKutta4(0.02), SOLVERS["auto"]):
        trajectory = mb.simulate(hanging(), 2.0, solver, TIMES)
        n = trajectory.lowered.structure.n
        for x in trajectory.states.x:
            jacobian = constraint_jacobian(trajectory.lowered, x).toarray()
            least = np.linalg.pinv(jacobian.T, rcond=1e-9) @ (jacobian.T @ x[n:-1])
            np.testing.assert_allclose(x[n:-1], least, rtol=0, atol=1e-11)


@pytest.mark.parametrize(
    "solver",
    [mb.RungeKutta4(5e-3), mb.RungeKutta4(5e-3, mb.Partitioning()), mb.OdeSolver("DOP853", 1e-10, 1e-12)],
    ids=["RK4", "RK4, partitioning", "DOP853"],
)
def test_their_derivatives_are_those_of_the_simulation(solver) -> None:
    model = mb.TimeResponse(hanging, {"stiffness": (5.0, 20.0)}, FORCES, TIMES, solver)
    exact = model.jacobian(np.array([10.0]))[:, :, 0]
    after, before = model.evaluate(np.array([[10.0 + 1e-3], [10.0 - 1e-3]])).only()
    slope = (after - before) / 2e-3
    assert np.max(np.abs(slope)) > 0.1
    np.testing.assert_allclose(exact, slope, rtol=0, atol=2e-8)


def test_equal_supports_carry_equal_shares() -> None:
    """A bar that swings on two pins at the same place: each carries half of what one pin carries."""

    def swinging(pins: int) -> mb.System:
        system = mb.System()
        bar = system.add(mb.RigidBar("bar", 1.0, 2.0, angle=0.3, angular_velocity=1.0))
        for k in range(pins):
            system.add(mb.RevoluteJoint(f"pin{k}", system.ground.point(0.0, 0.0), bar.start))
        return system

    whole, shared = (mb.simulate(swinging(pins), 1.0, mb.RungeKutta4(1e-3), TIMES / 2) for pins in (1, 2))
    for k in range(2):
        np.testing.assert_allclose(2 * shared.reactions(f"pin{k}"), whole.reactions("pin0"), rtol=0, atol=1e-10)


@pytest.mark.parametrize("size", [1.0, 1e-2, 1e3])
def test_torques_count_by_the_extent_of_the_mechanism(size: float) -> None:
    """A weight W on two welds at a distance d: the far one carries W / (2 + d^2 / 2 l^2), each a torque of d / 2 of it.

    The least of (W - g)^2 + g^2 + 2 (d g / 2 l)^2, with the lever l = d, whatever the size.
    """
    system = mb.System()
    block = system.add(mb.RigidBody("block", 3.0, 0.1 * size**2, points={"far": (size, 0.0)}))
    system.add(mb.FixedJoint("near", system.ground, block.centre))
    system.add(mb.FixedJoint("far", system.ground, block.point("far")))
    trajectory = mb.simulate(system, 0.1, mb.RungeKutta4(0.01))
    assert scales(trajectory.lowered)[0] == size
    weight = 3.0 * 9.81
    far = weight / 2.5
    for name, expected in (("near", [0.0, weight - far, -far * size / 2]), ("far", [0.0, far, -far * size / 2])):
        found = trajectory.reactions(name) / [weight, weight, weight * size]
        given = np.array(expected) / [weight, weight, weight * size]
        np.testing.assert_allclose(found, np.tile(given, (len(found), 1)), rtol=0, atol=1e-12)


def test_derivatives_of_forces_and_torques_together() -> None:
    """A slider on two guides, whose forces and torques share the load."""

    def guided(stiffness: complex) -> mb.System:
        system = mb.System()
        crank = system.add(mb.RigidBar("crank", 0.3, 1.0, angle=0.4, angular_velocity=3.0))
        rod = system.add(mb.RigidBar("rod", 0.8, 1.0, start=crank.end, angle=-np.arcsin(0.3 * np.sin(0.4) / 0.8)))
        slider = system.add(mb.RigidBody("slider", 0.5, 0.1, position=rod.end, points={"back": (0.5, 0.0)}))
        system.add(mb.RevoluteJoint("O", system.ground, crank.start))
        system.add(mb.RevoluteJoint("A", crank.end, rod.start))
        system.add(mb.RevoluteJoint("B", rod.end, slider.centre))
        for name, point in (("guide", slider.centre), ("second", slider.point("back"))):
            system.add(mb.PrismaticJoint(name, system.ground.point(0.0, 0.0), point))
        system.add(mb.Spring("spring", system.ground.point(0.3, 1.0), slider.point("back"), stiffness, free_length=0.5))
        return system

    names = [f"{joint}.{entry}" for joint in ("guide", "second") for entry in ("force_y", "torque")]
    times = np.linspace(0.0, 0.5, 11)
    model = mb.TimeResponse(guided, {"stiffness": (5.0, 20.0)}, names, times, mb.RungeKutta4(5e-3))
    exact = model.jacobian(np.array([10.0]))[:, :, 0]
    after, before = model.evaluate(np.array([[10.0 + 1e-3], [10.0 - 1e-3]])).only()
    np.testing.assert_allclose(exact, (after - before) / 2e-3, rtol=0, atol=1e-7)
