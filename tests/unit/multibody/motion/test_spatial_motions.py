"""Motions in space: reactions, stored channels, restarts, ensembles, checkpoints and fits."""

import numpy as np
import pytest

import dalembert as da
from dalembert.forward import Checkpoint, Recorded
from dalembert.multibody import RadauIIA, RungeKutta4, simulate
from dalembert.multibody.spatial import (
    Bushing,
    Inertia,
    Orientation,
    RevoluteJoint,
    RigidBody,
    SpatialSystem,
    SphericalJoint,
)
from spatial_pendulum import BOX, CHANNELS, SOLVER, TIMES, TRUE, build, motion, records, response

BEGIN = 15


@pytest.fixture(scope="module")
def trajectory():
    return motion()


def test_reactions_balance_the_momenta(trajectory):
    """Force of the ball joint: sum of m (a - g); of the hinge on the lower body: m (a - g), torque: J w' + w x J w."""
    lower, g = Inertia.box(1.0, (0.1, 0.08, 0.4)), np.array([0.0, 0.0, -9.81])
    at = {body: trajectory.channels([f"{body}.centre.a{axis}" for axis in "xyz"]) - g for body in ("one", "two")}
    ball, hinge = trajectory.reactions("ball"), trajectory.reactions("hinge")
    assert ball.shape == (len(trajectory.times), 6)
    np.testing.assert_allclose(ball[:, :3], TRUE[0] * at["one"] + at["two"], atol=2e-3)
    np.testing.assert_allclose(ball[:, 3:], 0.0, atol=1e-12)
    np.testing.assert_allclose(hinge[:, :3], at["two"], atol=2e-3)
    axes = trajectory.drawing().axes["two"][:, 1:]
    tensor = np.einsum("fki,kl,flj->fij", axes, lower.tensor, axes)
    spin, rate = (trajectory.channels([f"two.centre.w{axis}{of}" for axis in "xyz"]) for of in ("", "_rate"))
    momentum = np.einsum("fij,fj->fi", tensor, spin)
    lever = trajectory.drawing().joints["hinge"] - trajectory.channels([f"two.centre.{axis}" for axis in "xyz"])
    about = np.einsum("fij,fj->fi", tensor, rate) + np.cross(spin, momentum) - np.cross(lever, hinge[:, :3])
    np.testing.assert_allclose(hinge[:, 3:], about, atol=2e-3)
    np.testing.assert_allclose(np.einsum("fi,fi->f", hinge[:, 3:], axes[:, 1]), 0.0, atol=1e-12)  # free about y


def test_planar_reactions_have_three_columns():
    system = da.System()
    bar = system.add(da.RigidBar("bar", 0.5, 1.0))
    system.add(da.RevoluteJoint("pin", system.ground, bar.start))
    assert simulate(system, 0.01).reactions("pin").shape[1] == 3


def test_contents_are_stored_with_units(trajectory, tmp_path):
    from xarray import load_dataset

    names = [*CHANNELS, "hinge.angle", "ball.force_z", "two.tip.wx_rate", "one.origin.q0"]
    trajectory.save(tmp_path / "motion.nc", names)
    stored = load_dataset(tmp_path / "motion.nc")
    np.testing.assert_array_equal(stored["hinge.angle"], trajectory.channels(["hinge.angle"])[:, 0])
    assert stored["two.tip.wx_rate"].units == "rad/s**2"
    assert set(trajectory.contents().variables) > set(trajectory.channel_names)


def test_the_summary_states_steps_and_violations(trajectory):
    facts = trajectory.facts()
    assert (facts["simulated"], facts["steps"]) == ("1 s", "500")
    violation = next(row for row in trajectory.tables()[0].rows if row[0].text == "largest violation, position")
    assert violation[1].value < 1e-13


@pytest.mark.slow
@pytest.mark.parametrize("solver", [RungeKutta4(step=1e-3), RadauIIA(tolerance=1e-10)], ids=["Runge-Kutta", "Radau"])
def test_a_segment_continues_the_motion(solver):
    model = response(solver)
    whole = model.restarted(0.0, TIMES, None, model.state_chart(TRUE, whole=True)).evaluate(TRUE).only()[0]
    chart = model.state_chart(TRUE, whole[BEGIN, len(CHANNELS) :])
    assert len(chart.names) == 8
    segment = model.restarted(TIMES[BEGIN], TIMES[BEGIN:] - TIMES[BEGIN], chart, chart)
    numbers = np.concatenate([TRUE, chart.values])
    values = segment.evaluate(numbers).only()[0]
    np.testing.assert_allclose(values[:, : len(CHANNELS)], whole[BEGIN:, : len(CHANNELS)], atol=1e-9)
    np.testing.assert_allclose(values[0, len(CHANNELS) :], chart.values, atol=1e-12)
    jacobian = segment.linearise(numbers)[1]
    step = 1e-6
    for column, unit in enumerate(np.eye(len(numbers))):
        ahead, behind = (segment.evaluate(numbers + sign * step * unit).only()[0] for sign in (1, -1))
        np.testing.assert_allclose(jacobian[:, :, column], (ahead - behind) / (2 * step), atol=5e-6, rtol=1e-5)


def test_a_batch_is_its_single_simulations():
    model = response()
    lower, upper = np.array(list(BOX.values())).T
    rows = np.random.default_rng(0).uniform(lower, upper, (12, 3))
    batch = model.evaluate(rows).only()
    for row in (0, 5, 11):
        np.testing.assert_array_equal(batch[row], model.evaluate(rows[row]).only()[0])
        single = simulate(build(*rows[row]), TIMES[-1], SOLVER, TIMES).channels(CHANNELS)
        np.testing.assert_allclose(batch[row], single, atol=1e-11)  # lengths scale the tolerance of Newton's method


def test_a_fit_continues_from_a_checkpoint(tmp_path):
    data = records()
    with Checkpoint(tmp_path / "checkpoint") as checkpoint:
        first = da.identify(Recorded(response(), checkpoint), data, starts=1, start=TRUE * 1.1)
    with Checkpoint(tmp_path / "checkpoint") as checkpoint:
        again = da.identify(Recorded(response(), checkpoint), data, starts=1, start=TRUE * 1.1)
        assert checkpoint.spared > 0
    np.testing.assert_array_equal(first.values, again.values)
    assert np.all(np.abs(first.values - TRUE) < 5 * first.deviations)


@pytest.mark.slow
def test_a_motion_begins_at_its_equilibrium():
    """A body on a bushing sinks by m g / k; the sinking follows the stiffness with its derivative."""

    def hung(stiffness):
        system = SpatialSystem(start="equilibrium")
        rod = system.add(RigidBody("rod", Inertia.box(2.0, (0.1, 0.1, 0.4)), points={"top": (0, 0, 0.2)}, anchor="top"))
        rates = (2e4, 3e4, stiffness, 20.0, 30.0, 40.0)
        system.add(Bushing("bush", system.ground.point((0.0, 0.0, 0.0)), rod.point("top"), stiffness=rates))
        return system

    model = da.TimeResponse(hung, {"stiffness": (1e4, 1e5)}, ["rod.top.z"], np.linspace(0.0, 0.2, 3))
    response, jacobian = model.linearise(np.array([5e4]))
    np.testing.assert_allclose(response[:, 0], -2 * 9.81 / 5e4, rtol=1e-10)
    np.testing.assert_allclose(jacobian[:, 0, 0], 2 * 9.81 / 5e4**2, rtol=1e-8)


def test_an_equilibrium_is_found_from_an_inclined_start():
    system = SpatialSystem()
    tilted = Orientation.by_angles("xy", [0.9, 0.7])
    box = Inertia.box(2.0, (0.1, 0.1, 0.4)).moved((0.0, 0.0, -0.2))
    rod = system.add(RigidBody("rod", box, orientation=tilted))
    system.add(SphericalJoint("ball", system.ground, rod.point("origin")))
    rest = da.equilibrium(system)
    np.testing.assert_allclose(rest.channels(["rod.centre.x", "rod.centre.y", "rod.centre.z"]), (0, 0, -0.2), atol=1e-9)


@pytest.mark.parametrize("offset", [-0.4, -0.3])
def test_a_door_at_rest_stays_at_rest(offset):
    """Corrections of velocities that vanish end in the rounding of what they take away."""
    system = SpatialSystem(gravity=(0.0, 0.0, -9.81))
    door = system.add(RigidBody("door", Inertia.box(20.0, (0.8, 0.04, 2.0)), points={"hinge": (offset, 0.0, 0.0)}))
    side = system.ground.point((offset, 0.0, 0.0))
    system.add(RevoluteJoint("pin", side, door.point("hinge"), axis=(0.0, 0.0, 1.0)))
    motion = simulate(system, 0.3, RadauIIA())
    np.testing.assert_allclose(motion.channels(["pin.angle", "pin.rate"]), 0.0, atol=1e-15)
