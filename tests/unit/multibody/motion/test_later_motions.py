"""Motions that start at a later time of their signals: each is the rest of the whole motion."""

from collections.abc import Callable

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.errors import InputError, ModelError, shown
from support import says

BEGIN = 0.3
END = 0.8
KNOTS = np.linspace(0.0, 1.0, 11)
STATE = ("bar.start.angle", "bar.start.rate")

SMOOTH = {
    "harmonic": lambda size: mb.Harmonic(size, 9.0, phase=0.3, offset=0.1),
    "polynomial": lambda size: mb.Polynomial([0.0, size, -2.0 * size, 3.0]),
    "cubic table": lambda size: mb.Table(KNOTS, [size * np.sin(9.0 * t) for t in KNOTS]),
    "custom": lambda size: mb.Custom(lambda t: size * np.sin(9.0 * t) * np.exp(-t)),
}
LOADS = SMOOTH | {
    "constant": mb.Constant,
    "step": lambda size: mb.Step(size, 0.25, 0.55),
    "step at the start": lambda size: mb.Step(size, BEGIN),
    "step at the end": lambda size: mb.Step(size, 0.1, END),
    "linear table": lambda size: mb.Table(KNOTS, [size * np.sin(9.0 * t) for t in KNOTS], "linear"),
}
SOLVERS = {
    "generalized-alpha": (mb.GeneralizedAlpha(step=2e-4), 2e-6),
    "adaptive": (mb.GeneralizedAlpha(adaptive=True, step=1e-3, tolerance=1e-8), 1e-5),
    "Radau": (mb.RadauIIA(tolerance=1e-9), 1e-7),
    "Runge-Kutta": (mb.RungeKutta4(step=5e-4), 1e-7),
    "Runge-Kutta of SciPy": (mb.OdeSolver(), 1e-7),
    "energy-momentum": (mb.EnergyMomentum(step=2e-4), 2e-6),
    "variational": (mb.Variational(step=2e-4), 2e-6),
}


def turned(course: Callable) -> Callable:
    """A bar on a pin under its weight and a torque."""

    def build(angle, rate, size):
        system = mb.System()
        bar = system.add(mb.RigidBar("bar", 0.5, 1.0, angle=angle, angular_velocity=rate))
        system.add(mb.RevoluteJoint("pin", system.ground, bar.start))
        system.add(mb.Torque("drive", bar.start, course(size)))
        return system

    return build


def carried(course: Callable) -> Callable:
    """A bar that hangs on a carriage, which follows a function of time."""

    def build(angle, rate, size):
        system = mb.System()
        carriage = system.add(mb.PointMass("carriage", 1.0))
        bar = system.add(mb.RigidBar("bar", 0.5, 1.0, angle=angle, angular_velocity=rate))
        system.add(mb.RevoluteJoint("pin", carriage.centre, bar.start))
        system.add(mb.PrescribedMotion("rail", system.ground.point(0.0, 0.0), carriage.centre, "y"))
        system.add(mb.PrescribedMotion("drive", system.ground.point(0.0, 0.0), carriage.centre, "x", course(size)))
        return system

    return build


def compared(build: Callable, solver: mb.Integrator, channels: tuple[str, ...], tolerance: float) -> None:
    """Responses and derivatives of the rest of a motion, from the state at its start, against the whole motion."""
    box = {"angle": (-2.0, 2.0), "rate": (-20.0, 20.0), "size": (0.1, 2.0)}
    times = np.array([BEGIN, 0.45, 0.6, END])
    whole = mb.TimeResponse(build, box, channels, times, solver)
    vector = np.array([-1.0, 0.5, 0.7])
    values, slopes = whole.linearise(vector)
    later = whole.later(BEGIN, times[1:] - BEGIN)
    rest, own = later.linearise(np.array([*values[0, :2], vector[2]]))
    np.testing.assert_allclose(rest, values[1:], rtol=0, atol=tolerance)
    alone = later.evaluate(np.array([*values[0, :2], vector[2]])).only()[0]
    np.testing.assert_allclose(alone, rest, rtol=0, atol=tolerance)
    chained = own[:, :, :2] @ slopes[0, :2]
    chained[:, :, 2] += own[:, :, 2]
    np.testing.assert_allclose(chained, slopes[1:], rtol=0, atol=10 * tolerance)
    assert np.ptp(values[1:], axis=0).min() > 0.01


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("kind", ["harmonic", "step"])
def test_every_integrator_reads_loads_at_the_later_time(kind: str, solver: str) -> None:
    compared(turned(LOADS[kind]), SOLVERS[solver][0], STATE, SOLVERS[solver][1])


@pytest.mark.parametrize("kind", LOADS)
def test_every_load_is_read_at_the_later_time(kind: str) -> None:
    compared(turned(LOADS[kind]), mb.RadauIIA(tolerance=1e-9), STATE, 1e-7)


@pytest.mark.parametrize("kind", SMOOTH)
def test_every_motion_is_prescribed_from_the_later_time(kind: str) -> None:
    compared(carried(SMOOTH[kind]), mb.RadauIIA(tolerance=1e-9), (*STATE, "carriage.centre.x"), 1e-7)


def test_a_force_of_a_function_is_given_the_later_time() -> None:
    def build(angle, rate, size):
        system = turned(mb.Constant)(angle, rate, 0.0)
        (bar,) = system.bodies
        system.add(mb.UserForce("push", bar.end, lambda t, at, against: (size * t, 0.0, 0.0)))
        return system

    compared(build, mb.GeneralizedAlpha(step=1e-3), STATE, 1e-5)


def test_the_later_time_counts_from_the_start_of_the_model() -> None:
    model = mb.TimeResponse(turned(LOADS["harmonic"]), {"angle": (0, 1), "rate": (0, 1), "size": (0, 1)}, STATE, [1.0])
    later = model.later(0.2, [0.5, 1.0]).later(0.25, [0.3])
    assert later.begin == 0.45
    assert later.refined().model.begin == later.first(1).begin == later.part(0.5)[0].begin == 0.45
    assert later.fingerprint != model.later(0.0, [0.3]).fingerprint


def test_a_simulation_starts_at_the_later_time() -> None:
    """Closed form: a mass under a force that grows with time."""
    system = mb.System(gravity=(0.0, 0.0))
    mass = system.add(mb.PointMass("mass", 2.0))
    system.add(mb.Force("push", mass.centre, x=mb.Polynomial([0.0, 6.0])))
    trajectory = mb.simulate(system, 1.0, mb.RadauIIA(), [0.5, 1.0], begin=2.0)
    t = trajectory.times
    np.testing.assert_allclose(trajectory.channels(["mass.centre.x"])[:, 0], 3 * t**2 + t**3 / 2, rtol=1e-9)
    np.testing.assert_allclose(trajectory.energies["balance"], 0.0, atol=1e-3)


def test_the_end_of_a_table_is_refused_where_the_later_motion_meets_it() -> None:
    build = carried(lambda size: mb.Table([0.0, 0.5, 1.0], [0.0, 0.1, size]))
    model = mb.TimeResponse(build, {"angle": (-1, 1), "rate": (-1, 1), "size": (0, 1)}, STATE, [0.9])
    assert model.later(1.0, [0.5]).channels
    with pytest.raises(ModelError, match=r"its Table begins or ends at 0\.4 s with a slope"):
        model.later(0.6, [0.5]).fingerprint  # noqa: B018


@pytest.mark.parametrize("begin", [np.nan, "now", 1j])
def test_a_start_that_is_no_time_is_refused(begin: object) -> None:
    model = mb.TimeResponse(turned(LOADS["harmonic"]), {"angle": (0, 1), "rate": (0, 1), "size": (0, 1)}, STATE, [1.0])
    with pytest.raises(
        InputError, match=says(f"TimeResponse.later: begin is {shown(begin)}; expected a number of seconds")
    ):
        model.later(begin, [0.5])
