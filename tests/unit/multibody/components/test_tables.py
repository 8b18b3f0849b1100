"""Tables of values: held, scaled, shifted, delayed and integrated, and what they do to a motion."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import dalembert.multibody as mb
from dalembert.data import Measurements
from dalembert.errors import InputError, ModelError
from dalembert.multibody.model.evaluate import constraint_rates, residual
from dalembert.multibody.model.lowering import lower
from support import says

KNOTS = np.array([0.1, 0.3, 0.4, 0.8])
VALUES = np.array([1.0, -0.5, 0.25, 2.0])
TIMES = np.array([0.03, 0.17, 0.33, 0.5, 0.77, 0.83, 0.95])


def held(t: float, knots: np.ndarray = KNOTS, values: np.ndarray = VALUES) -> float:
    return values[np.clip(np.searchsorted(knots, t, side="right") - 1, 0, len(values) - 1)]


FORMULAS = {
    "held": held,
    "linear": lambda t: np.interp(t, KNOTS, VALUES),
    "cubic": lambda t: float(CubicSpline(KNOTS, VALUES, bc_type="natural")(np.clip(t, 0.1, 0.8))),
}


def pushed(course: mb.Signal) -> mb.System:
    """A mass of 2 kg under a force and nothing else."""
    system = mb.System(gravity=(0.0, 0.0))
    mass = system.add(mb.PointMass("mass", 2.0))
    system.add(mb.Force("push", mass.centre, x=course))
    return system


@pytest.mark.parametrize("kind", FORMULAS)
def test_it_has_its_scaled_shifted_and_delayed_value(kind: str) -> None:
    lowered = lower(pushed(mb.Table(KNOTS, VALUES, kind, scale=3.0, offset=-0.2, delay=0.05)))
    zero = np.zeros_like(lowered.x)
    given = [-residual(lowered, lowered.real, zero, zero, zero, t)[0] for t in TIMES]
    np.testing.assert_allclose(given, [3.0 * FORMULAS[kind](t - 0.05) - 0.2 for t in TIMES], rtol=1e-13)


def test_a_held_table_has_the_mean_of_both_sides_at_a_change() -> None:
    lowered = lower(pushed(mb.Table(KNOTS, VALUES, "held")))
    zero = np.zeros_like(lowered.x)
    given = [-residual(lowered, lowered.real, zero, zero, zero, t)[0] for t in KNOTS]
    np.testing.assert_allclose(given, [1.0, 0.25, -0.125, 1.125], rtol=1e-15)


@pytest.mark.parametrize("kind", ["linear", "cubic"])
def test_it_is_integrated_once_and_twice_from_its_start(kind: str) -> None:
    """Against quadrature of the values, with rates that are the integral before."""
    system = mb.System()
    mass = system.add(mb.PointMass("mass", 1.0))
    course = mb.Table(KNOTS, VALUES, kind, scale=3.0, offset=-0.2, delay=0.05, integrals=2)
    system.add(mb.PrescribedMotion("base", system.ground.point(0.0, 0.0), mass.centre, "x", course))
    lowered = lower(system)
    zero = np.zeros_like(lowered.x)
    fine = np.linspace(0.15, 0.85, 700_001)
    value = 3.0 * np.array([FORMULAS[kind](t - 0.05) for t in fine[::100]])
    value = (
        np.interp(fine, fine[::100], value) - 0.2 if kind == "linear" else CubicSpline(fine[::100], value)(fine) - 0.2
    )
    once = np.concatenate([[0.0], np.cumsum((value[1:] + value[:-1]) / 2 * 1e-6)])
    twice = np.concatenate([[0.0], np.cumsum((once[1:] + once[:-1]) / 2 * 1e-6)])
    for t in (0.16, 0.2, 0.42, 0.7):
        at = round((t - 0.15) / 1e-6)
        place = -residual(lowered, lowered.real, zero, zero, zero, t)[-1]
        rate, second = -np.ravel(constraint_rates(lowered, lowered.real, zero, zero, zero, t))
        np.testing.assert_allclose([place, rate, second], [twice[at], once[at], value[at]], rtol=1e-5, atol=1e-9)


def test_a_measured_acceleration_moves_the_base() -> None:
    """A pendulum on an accelerated base swings as one in a field that is tilted by the acceleration."""
    t = np.linspace(0.0, 1.0, 2001)
    acceleration = 3.0 * np.sin(8.0 * t)

    def swung(carried: bool) -> np.ndarray:
        system = mb.System()
        bar = system.add(mb.RigidBar("bar", 0.5, 1.0, angle=-np.pi / 2))
        if carried:
            base = system.add(mb.PointMass("base", 1.0))
            ground = system.ground.point(0.0, 0.0)
            course = mb.Table(t, acceleration, "cubic", integrals=2)
            system.add(mb.PrescribedMotion("shaker", ground, base.centre, "x", course))
            system.add(mb.PrescribedMotion("rail", ground, base.centre, "y"))
            system.add(mb.RevoluteJoint("pin", base.centre, bar.start))
        else:
            system.add(mb.RevoluteJoint("pin", system.ground, bar.start))
            inertia = mb.Table(t, acceleration, "cubic", scale=-1.0)
            system.add(mb.Force("field", bar.centre, x=inertia))
        return mb.simulate(system, 1.0, mb.RadauIIA(), [0.3, 0.6, 1.0]).channels(["bar.start.angle"])

    found = swung(carried=True)
    assert np.ptp(found) > 0.05
    np.testing.assert_allclose(found, swung(carried=False), rtol=0, atol=1e-6)


def test_the_motion_must_end_with_an_integrated_table() -> None:
    system = mb.System()
    mass = system.add(mb.PointMass("mass", 1.0))
    course = mb.Table(KNOTS, VALUES, "linear", integrals=2)
    system.add(mb.PrescribedMotion("base", system.ground.point(0.0, 0.0), mass.centre, "x", course))
    assert mb.simulate(system, 0.8).times[-1] == 0.8
    with pytest.raises(ModelError, match=r"^prescribed motion 'base': its Table begins or ends at 0\.8 s with a slope"):
        mb.simulate(system, 0.9)


@pytest.mark.parametrize("solver", [mb.RadauIIA(), mb.RungeKutta4(step=0.05), mb.EnergyMomentum(step=0.05)])
def test_methods_that_start_anew_follow_a_held_force_exactly(solver: mb.Integrator) -> None:
    times = np.array([0.2, 0.3, 0.35, 0.7, 1.0])
    found = mb.simulate(pushed(mb.Table(KNOTS, VALUES, "held")), 1.0, solver, times)
    fine = np.linspace(0.0, 1.0, 100_001)
    rate = np.concatenate([[0.0], np.cumsum([held(t) for t in fine[:-1] + 5e-6])]) * 1e-5 / 2.0
    place = np.concatenate([[0.0], np.cumsum((rate[1:] + rate[:-1]) / 2)]) * 1e-5
    at = np.rint(times / 1e-5).astype(int)
    values = found.channels(["mass.centre.x", "mass.centre.vx"])
    np.testing.assert_allclose(values, np.column_stack([place, rate])[at], rtol=0, atol=1e-9)


def swinging(course: Callable) -> Callable:
    def build(scale, offset, delay):
        system = mb.System()
        bar = system.add(mb.RigidBar("bar", 0.5, 1.0, angle=-1.0))
        system.add(mb.RevoluteJoint("pin", system.ground, bar.start))
        system.add(mb.Torque("drive", bar.start, course(scale, offset, delay)))
        return system

    return build


RECORD = np.linspace(0.0, 1.0, 201)
TORQUE = np.sin(9.0 * RECORD) + 0.4 * np.cos(31.0 * RECORD)
BOX = {"scale": (0.1, 2.0), "offset": (-1.0, 1.0), "delay": (0.0, 0.1)}
AT = np.array([0.6, 0.03, 0.0123])


def response(course: Callable, solver: mb.Integrator) -> mb.TimeResponse:
    return mb.TimeResponse(swinging(course), BOX, ["bar.end.angle"], np.linspace(0.1, 1.0, 10), solver)


def test_generalized_alpha_passes_changes_of_a_held_value_without_starting_anew() -> None:
    """Its steps end there, and the error falls with the square of the step."""

    def driven(solver: mb.Integrator) -> np.ndarray:
        course = mb.Table(RECORD, TORQUE, "held")
        return mb.simulate(swinging(lambda *_: course)(*AT), 1.0, solver, [0.503, 1.0]).channels(["bar.end.angle"])

    exact = driven(mb.RadauIIA(tolerance=1e-11))
    errors = [np.abs(driven(mb.GeneralizedAlpha(step=step)) - exact).max() for step in (5e-3, 1.25e-3)]
    assert errors[0] < 1e-3
    assert errors[1] < errors[0] / 10
    coarse = mb.simulate(swinging(lambda *_: mb.Table(RECORD, TORQUE, "held"))(*AT), 1.0, mb.GeneralizedAlpha(step=0.1))
    assert coarse.run.counts[0] == 200
    np.testing.assert_allclose(coarse.run.ends, RECORD[1:], rtol=1e-12)


def test_steps_end_at_changes_of_a_held_value_and_at_jumps_together() -> None:
    """A jump within rounding of a change is one with it, and motion starts anew there."""
    system = pushed(mb.Table(RECORD, TORQUE, "held"))
    mass = system.bodies[0]
    system.add(mb.Force("step", mass.centre, y=mb.Step(4.0, 0.1 * 3)))
    trajectory = mb.simulate(system, 1.0, mb.GeneralizedAlpha(step=0.1))
    assert trajectory.run.counts[0] == 200
    t = trajectory.times
    np.testing.assert_allclose(
        trajectory.channels(["mass.centre.vy"])[:, 0], 2.0 * np.clip(t - 0.3, 0, None), atol=1e-12
    )


@pytest.mark.parametrize("solver", [mb.GeneralizedAlpha(step=1e-3), mb.RadauIIA(step=2e-3)], ids=["alpha", "Radau"])
@pytest.mark.parametrize("kind", ["linear", "cubic", "held"])
def test_scale_offset_and_delay_have_exact_sensitivities(kind: str, solver: mb.Integrator) -> None:
    names = list(BOX)[: 2 if kind == "held" else 3]
    given = dict(zip(BOX, AT, strict=True))

    def course(*values):
        own = dict(zip(BOX, values, strict=True))
        return mb.Table(RECORD, TORQUE, kind, **{**own, "delay": own["delay"] if kind != "held" else 0.0123})

    model = response(course, solver)
    slopes = model.jacobian(AT)
    for column, name in enumerate(names):
        h = 1e-5
        ends = [np.array(list({**given, name: given[name] + sign * h}.values())) for sign in (1, -1)]
        above, below = (model.evaluate(end).only()[0] for end in ends)
        difference = (above - below) / (2 * h)
        assert np.abs(difference).max() > 1e-3
        np.testing.assert_allclose(slopes[:, :, column], difference, rtol=0, atol=2e-4 * np.abs(difference).max())


def test_a_held_table_has_no_derivative_by_its_delay() -> None:
    model = response(lambda *given: mb.Table(RECORD, TORQUE, "held", *given), mb.GeneralizedAlpha(step=1e-3))
    assert model.evaluate(AT).failures == (None,)
    sentence = (
        "Table: the response to a held value has no derivative by its delay, since each change of the value moves in "
        "time as a jump; take interpolation = 'linear', or a delay that depends on no parameter"
    )
    with pytest.raises(InputError, match=says(sentence)):
        model.jacobian(AT)


@pytest.mark.parametrize("kind", ["linear", "cubic", "held"])
def test_it_is_read_at_a_later_time(kind: str) -> None:
    def build(angle, rate):
        system = mb.System()
        bar = system.add(mb.RigidBar("bar", 0.5, 1.0, angle=angle, angular_velocity=rate))
        system.add(mb.RevoluteJoint("pin", system.ground, bar.start))
        system.add(mb.Torque("drive", bar.start, mb.Table(RECORD, TORQUE, kind, delay=0.0123)))
        return system

    channels = ["bar.start.angle", "bar.start.rate"]
    whole = mb.TimeResponse(
        build, {"angle": (-2, 2), "rate": (-20, 20)}, channels, [0.4, 0.7], mb.RadauIIA(tolerance=1e-10)
    )
    values = whole.evaluate(np.array([-1.0, 0.3])).only()[0]
    rest = whole.later(0.4, [0.3]).evaluate(values[0]).only()[0]
    np.testing.assert_allclose(rest, values[1:], rtol=0, atol=1e-7)


def test_a_measured_channel_becomes_a_table() -> None:
    angle = np.array([3.0, np.nan, -3.0, -2.8])
    data = Measurements.of([0.0, 0.1, 0.2, 0.3], {"goal": angle, "x": np.zeros(4)}, missing="leave-out", wraps=["goal"])
    table = mb.Table.of(data, "goal", "cubic", delay=0.02)
    assert (table.interpolation, table.delay) == ("cubic", 0.02)
    np.testing.assert_allclose(table.times, [0.0, 0.2, 0.3])
    np.testing.assert_allclose(table.values, [3.0, 2 * np.pi - 3.0, 2 * np.pi - 2.8])
    with pytest.raises(InputError, match=says("Table.of: unknown channel 'gaol'; did you mean 'goal'?")):
        mb.Table.of(data, "gaol")


def test_integrals_are_none_one_or_two() -> None:
    with pytest.raises(InputError, match=says("Table: integrals is 3; expected 0, 1 or 2")):
        mb.Table(KNOTS, VALUES, integrals=3)
