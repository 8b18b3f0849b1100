"""Functions of time: their values and rates, and what jumps do to a motion."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import dalembert.multibody as mb
from dalembert.errors import InputError, ModelError
from dalembert.multibody.model.evaluate import constraint_rates, residual
from dalembert.multibody.model.lowering import lower
from support import says

KNOTS, VALUES = [0.1, 0.3, 0.4, 0.8], [1.0, -0.5, 0.25, 2.0]
SIGNALS = {
    "number": (1.5, lambda t: 1.5),
    "constant": (mb.Constant(-2.0), lambda t: -2.0),
    "step": (mb.Step(3.0, 0.2, 0.6), lambda t: 3.0 if 0.2 <= t < 0.6 else 0.0),
    "harmonic": (mb.Harmonic(2.0, 7.0, phase=0.3, offset=-1.0), lambda t: 2 * np.sin(7 * t + 0.3) - 1),
    "polynomial": (mb.Polynomial([1.0, -2.0, 0.5, 4.0]), lambda t: 1 - 2 * t + 0.5 * t**2 + 4 * t**3),
    "linear table": (mb.Table(KNOTS, VALUES, "linear"), lambda t: np.interp(t, KNOTS, VALUES)),
    "cubic table": (
        mb.Table(KNOTS, VALUES),
        lambda t: float(CubicSpline(KNOTS, VALUES, bc_type="natural")(np.clip(t, 0.1, 0.8))),
    ),
    "custom": (mb.Custom(lambda t: np.exp(-t) * np.sin(5 * t)), lambda t: np.exp(-t) * np.sin(5 * t)),
}
TIMES = np.array([0.03, 0.17, 0.33, 0.5, 0.77, 0.95])  # before, between and after the knots


@pytest.mark.parametrize("kind", SIGNALS)
def test_it_has_its_value(kind: str) -> None:
    signal, formula = SIGNALS[kind]
    system = mb.System(gravity=(0.0, 0.0))
    system.add(mb.Force("push", system.add(mb.PointMass("mass", 1.0)).centre, y=signal))
    lowered = lower(system)
    zero = np.zeros_like(lowered.x)
    given = [-residual(lowered, lowered.real, zero, zero, zero, t)[1] for t in TIMES]
    np.testing.assert_allclose(given, [formula(t) for t in TIMES], rtol=1e-13, atol=1e-13)


@pytest.mark.parametrize("kind", [name for name in SIGNALS if name not in ("step", "linear table")])
def test_its_rates_are_its_slopes(kind: str) -> None:
    signal, formula = SIGNALS[kind]
    system = mb.System()
    mass = system.add(mb.PointMass("mass", 1.0))
    system.add(mb.PrescribedMotion("course", system.ground.point(0.0, 0.0), mass.centre, "x", signal))
    lowered = lower(system)
    zero, h = np.zeros_like(lowered.x), 1e-3
    for t in TIMES:
        rates = constraint_rates(lowered, lowered.real, zero, zero, zero, t)
        at = [formula(t + k * h) for k in (-2, -1, 0, 1, 2)]
        slope = (at[0] - 8 * at[1] + 8 * at[3] - at[4]) / (12 * h)
        bend = (-at[0] + 16 * at[1] - 30 * at[2] + 16 * at[3] - at[4]) / (12 * h * h)
        np.testing.assert_allclose(-np.ravel(rates), [slope, bend], rtol=1e-6, atol=2e-5)


def test_given_rates_of_a_function_are_used() -> None:
    system = mb.System()
    mass = system.add(mb.PointMass("mass", 1.0))
    course = mb.Custom(lambda t: t**2, rate=lambda t: 20 * t, second=lambda t: 300.0)
    system.add(mb.PrescribedMotion("course", system.ground.point(0.0, 0.0), mass.centre, "x", course))
    lowered = lower(system)
    zero = np.zeros_like(lowered.x)
    assert np.ravel(constraint_rates(lowered, lowered.real, zero, zero, zero, 0.5)).tolist() == [-10.0, -300.0]


def pushed(step: float, **options) -> mb.Trajectory:
    """A mass that a force pushes from 0.0321 to 0.0712 s: no multiple of the step."""
    system = mb.System(gravity=(0.0, 0.0))
    mass = system.add(mb.PointMass("mass", 2.0, velocity=(0.1, 0.0)))
    system.add(mb.Force("push", mass.centre, x=mb.Step(6.0, 0.0321, 0.0712)))
    return mb.simulate(system, 0.1, mb.GeneralizedAlpha(step, **options))


@pytest.mark.parametrize("options", [{}, {"spectral_radius": 0.0}, {"adaptive": True}])
def test_the_motion_starts_anew_where_a_load_jumps(options: dict) -> None:
    trajectory = pushed(0.7e-3, **options)
    t = trajectory.times
    on, off = np.clip(t - 0.0321, 0, None), np.clip(t - 0.0712, 0, None)
    names = ["mass.centre.x", "mass.centre.vx"]
    given = np.stack([0.1 * t + 1.5 * (on**2 - off**2), 0.1 + 3 * (on - off)], axis=1)
    np.testing.assert_allclose(trajectory.channels(names), given, rtol=0, atol=1e-12)
    np.testing.assert_allclose(trajectory.energies["balance"], 0, atol=1e-4 if options.get("adaptive") else 1e-14)


def test_a_pendulum_under_a_step_follows_both_pieces() -> None:
    """Small swings about a moved middle: closed form piece by piece."""

    def swing(t: np.ndarray) -> np.ndarray:
        omega, middle = 3.0, 0.4  # of x'' = -9 x + 3.6 while the force acts
        first = middle * (1 - np.cos(omega * t))
        x, v = middle * (1 - np.cos(omega * 0.35)), middle * omega * np.sin(omega * 0.35)
        later = x * np.cos(omega * (t - 0.35)) + v / omega * np.sin(omega * (t - 0.35))
        return np.where(t < 0.35, first, later)

    system = mb.System(gravity=(0.0, 0.0))
    mass = system.add(mb.PointMass("mass", 2.0))
    system.add(mb.PrescribedMotion("rail", system.ground.point(0.0, 0.0), mass.centre, "y"))
    system.add(mb.Spring("spring", system.ground.point(-1.0, 0.0), mass.centre, 18.0))
    system.add(mb.Force("push", mass.centre, x=mb.Step(7.2, end=0.35)))
    trajectory = mb.simulate(system, 0.8, mb.GeneralizedAlpha(5e-5, spectral_radius=1.0))
    np.testing.assert_allclose(trajectory.channels(["mass.centre.x"])[:, 0], swing(trajectory.times), rtol=0, atol=1e-8)


@pytest.mark.parametrize("motion", [mb.Polynomial([0.0, 0.5, -2.0]), mb.Custom(lambda t: 0.5 * t - 2.0 * t * t)])
def test_a_prescribed_motion_is_followed(motion: mb.Signal) -> None:
    system = mb.System()
    crank = system.add(mb.RigidBar("crank", 1.0, 1.0))
    system.add(mb.RevoluteJoint("pin", system.ground, crank.start))
    system.add(mb.PrescribedMotion("drive", system.ground.point(0.0, 0.0), crank.start, "angle", motion))
    trajectory = mb.simulate(system, 0.5)
    t = trajectory.times
    np.testing.assert_allclose(trajectory.channels(["crank.end.angle"])[:, 0], 0.5 * t - 2 * t * t, rtol=0, atol=1e-13)
    torque = np.cos(0.5 * t - 2 * t * t) * 9.81 / 2 - 4.0 / 3
    np.testing.assert_allclose(trajectory.reactions("drive")[5:, 2], torque[5:], rtol=0, atol=1e-3)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: mb.Step(1.0, 2.0, 2.0), "Step: start is 2.0 s and end is 2.0 s; expected start before end"),
        (
            lambda: mb.Step(1.0, 1 + 1e-30j),
            "Step: start is (1+1e-30j); expected a real number in s, which depends on no parameter",
        ),
        (
            lambda: mb.Table([0.0, 1.0], [1.0]),
            "Table: 2 times and 1 values were given; expected as many, at least two",
        ),
        (
            lambda: mb.Table([0.0, 1.0, 1.0], [1.0, 2.0, 3.0]),
            "Table: times must increase; sort them and remove repeated ones",
        ),
        (
            lambda: mb.Table([0.0, 1.0], [1.0, 2.0], "cubical"),
            "Table: unknown interpolation 'cubical'; did you mean 'cubic'?",
        ),
    ],
)
def test_a_function_of_time_that_cannot_be_meant_is_refused(make, sentence: str) -> None:
    with pytest.raises(InputError, match=says(sentence)):
        make()


@pytest.mark.parametrize(
    "motion",
    [
        mb.Step(1.0, 0.1),
        mb.Table([0.0, 1.0], [0.0, 1.0], "linear"),
        mb.Table([0.0, 1.0], [0.0, 1.0], "held"),
        mb.Table([0.0, 1.0], [0.0, 1.0], "held", integrals=1),
    ],
)
def test_a_motion_whose_velocity_jumps_is_refused(motion: mb.Signal) -> None:
    sentence = (
        f"prescribed motion 'drive': the velocity of its {type(motion).__name__} jumps, which no mechanism can follow; "
        "expected a smooth function of time, such as a cubic Table or a Polynomial"
    )
    system = mb.System()
    with pytest.raises(InputError, match=says(sentence)):
        mb.PrescribedMotion("drive", system.ground, mb.RigidBar("bar", 1.0, 1.0).start, "angle", motion)


def driven(course: mb.Table) -> mb.System:
    system = mb.System()
    crank = system.add(mb.RigidBar("crank", 1.0, 1.0))
    system.add(mb.RevoluteJoint("pin", system.ground, crank.start))
    system.add(mb.PrescribedMotion("drive", system.ground.point(0.0, 0.0), crank.start, "angle", course))
    return system


def test_a_table_that_ends_in_full_motion_is_refused() -> None:
    course = mb.Table([0.0, 0.1, 0.2, 0.3], [0.0, 0.1, 0.2, 0.3])
    sentence = (
        "prescribed motion 'drive': its Table begins or ends at 0.3 s with a slope, within the motion of 0.5 s, so "
        "its velocity would jump, which no mechanism can follow; give values for all of the motion, or let them come "
        "to rest"
    )
    with pytest.raises(ModelError, match=says(sentence)):
        mb.simulate(driven(course), 0.5)
    with pytest.raises(ModelError, match=says(sentence)):
        mb.TimeResponse(lambda: driven(course), {}, ["crank.end.x"], [0.5]).evaluate(np.empty((1, 0)))
    assert mb.simulate(driven(course), 0.3).times[-1] == 0.3


def test_a_table_that_comes_to_rest_may_end_before_the_motion() -> None:
    course = mb.Table([0.0, 1.0, 2.0, 3.0], [1.0, 1.0, 1.0, 1.0])
    assert mb.simulate(driven(course), 4.0).times[-1] == 4.0
