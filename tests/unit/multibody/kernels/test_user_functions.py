"""Forces and functions of time of the user's: compiled or not, failing, or not able to run in complex numbers."""

import math

import numba
import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.errors import InputError, ModelError, SolveError
from mechanisms import compiled_wind, plate, wind
from support import says

TIMES = np.array([0.0, 0.05, 0.1])
CHANNELS = ("plate.grip.x", "plate.grip.y", "plate.grip.angle")


def gust(function, **placed) -> mb.System:
    """A plate in a wind that reacts on a mass."""
    system = mb.System()
    mass = system.add(mb.PointMass("mass", 3.0, (1.0, 0.5)))
    body = system.add(plate(velocity=(1.0, 2.0), angular_velocity=0.7, **placed))
    system.add(mb.UserForce("gust", body.point("grip"), function, against=mass.centre))
    return system


def turned_by(motion: mb.Custom) -> mb.System:
    """A pinned bar under a torque."""
    system = mb.System()
    bar = system.add(mb.RigidBar("bar", 1.0, 1.0))
    system.add(mb.RevoluteJoint("pin", system.ground, bar.start))
    system.add(mb.Torque("motor", bar.end, motion))
    return system


def test_plain_and_compiled_functions_give_the_same_motion() -> None:
    plain, compiled = (mb.simulate(gust(function), 0.1).channels(CHANNELS) for function in (wind, compiled_wind))
    np.testing.assert_allclose(plain, compiled, rtol=1e-13, atol=1e-13)
    assert np.abs(plain - mb.simulate(gust(lambda *_: (0.0, 0.0, 0.0)), 0.1).channels(CHANNELS)).max() > 1e-3


def test_a_plain_force_is_the_component_that_it_imitates() -> None:
    def spring(t, at, against):
        gap = against[:2] - at[:2]
        length = np.sqrt(gap @ gap)
        pull = 40.0 * (length - 0.3) * gap / length
        return pull[0], pull[1], 0.0

    system = gust(lambda *_: (0.0, 0.0, 0.0))
    system.add(
        mb.Spring("spring", system.bodies[0].point("centre"), system.bodies[1].point("grip"), 40.0, free_length=0.3)
    )
    given = mb.simulate(gust(spring), 0.1).channels(CHANNELS)
    np.testing.assert_allclose(given, mb.simulate(system, 0.1).channels(CHANNELS), rtol=1e-12)


def response(builder, channel: str) -> mb.TimeResponse:
    return mb.TimeResponse(builder, {"p": (1.0, 2.0)}, [channel], TIMES, mb.GeneralizedAlpha(1e-3))


@pytest.mark.parametrize("wrap", [lambda function: function, numba.njit])
def test_a_force_that_closes_over_a_parameter_has_exact_derivatives(wrap) -> None:
    def builder(p):
        def function(t, at, against):
            return p * at[1] * at[2], p * p * t, -p * at[4]

        return gust(wrap(function))

    model = response(builder, "plate.grip.x")
    h = 1e-3
    ahead, behind = model.evaluate([[1.5 + h], [1.5 - h]]).only()
    exact = model.jacobian([1.5])[:, 0, 0]
    np.testing.assert_allclose(exact, (ahead - behind)[:, 0] / (2 * h), rtol=1e-6, atol=1e-9)
    assert abs(exact[-1]) > 1e-4


def driven(p) -> mb.System:
    """A bar that a function of the user's drives."""
    system = turned_by(mb.Custom(lambda t: 0.0))
    bar = system.bodies[0]
    system.add(mb.PrescribedMotion("drive", system.ground.point(0.0, 0.0), bar.point("start"), "angle", _course(p)))
    return system


def _course(p) -> mb.Custom:
    return mb.Custom(lambda t: p * np.sin(t), lambda t: p * np.cos(t), lambda t: -p * np.sin(t))


def test_a_prescribed_function_that_closes_over_a_parameter_has_exact_derivatives() -> None:
    exact = response(driven, "bar.end.angle").jacobian([1.5])[:, 0, 0]
    np.testing.assert_allclose(exact, np.sin(TIMES), rtol=1e-12, atol=1e-13)


NOT_COMPLEX = {
    "force": lambda p: gust(lambda t, at, against: (p * math.sin(at[0]), 0.0, 0.0)),
    "compiled force": lambda p: gust(numba.njit(lambda t, at, against: (math.sin(at[0]), 0.0, 0.0)), position=(p, 0.0)),
    "function of time": lambda p: turned_by(mb.Custom(lambda t: math.cos(p * t))),
}


@pytest.mark.parametrize("kind", NOT_COMPLEX)
def test_a_function_that_cannot_run_in_complex_numbers_moves_the_mechanism(kind: str) -> None:
    channel = "bar.end.y" if kind == "function of time" else "plate.grip.x"
    values = response(NOT_COMPLEX[kind], channel).evaluate([[1.2], [1.5]]).only()
    assert abs(values[0, -1, 0] - values[1, -1, 0]) > 1e-7


@pytest.mark.parametrize(
    ("kind", "reason"),
    [
        ("force", "Casting complex values to real discards the imaginary part, in the function of 'gust'"),
        ("compiled force", "Numba cannot compile it for complex numbers, in the function of 'gust'"),
        ("function of time", "must be real number, not complex, in the function of 'motor'"),
    ],
)
def test_its_derivatives_are_refused(kind: str, reason: str) -> None:
    model = response(NOT_COMPLEX[kind], "bar.end.y" if kind == "function of time" else "plate.grip.x")
    sentence = (
        f"the model's function cannot run in complex numbers, as exact derivatives by 'p' need ({reason}); "
        "use NumPy's functions instead of those of math, dalembert's absolute, norm, hypot and atan2, and no float() "
        "or comparison on parameters; or give derivative='central-differences'"
    )
    with pytest.raises(InputError, match=says(sentence)):
        model.jacobian([1.5])


@pytest.mark.parametrize("convert", [math.sqrt, lambda p: float(np.cos(p))])
def test_a_builder_that_cannot_run_in_complex_numbers_is_told(convert) -> None:
    model = response(lambda p: gust(wind, angle=convert(p)), "plate.grip.x")
    start = "the model's function cannot run in complex numbers, as exact derivatives by 'p' need ("
    with pytest.raises(InputError) as told:
        model.jacobian([1.5])
    assert str(told.value).startswith(start)


@pytest.mark.parametrize(
    ("system", "reason"),
    [
        (lambda: gust(lambda t, at, against: (1 / 0, 0.0, 0.0)), "ZeroDivisionError: division by zero"),
    ],
)
def test_a_function_that_raises_is_named(system, reason: str) -> None:
    sentence = f"a function of the user's failed near t = 0 s: {reason}, in the function of 'gust'"
    with pytest.raises(SolveError, match=says(sentence)):
        mb.simulate(system(), 0.1)


def late_nan(t, at, against):
    return (0.0 if t < 0.03 else np.nan), 0.0, 0.0


THREE = "expected three finite numbers (fx, fy, torque)"
WRONG_ANSWERS = {
    "nothing": (lambda: gust(lambda t, at, against: None), f"'gust' returned None at t = 0 s; {THREE}"),
    "too few": (lambda: gust(lambda t, at, against: (1.0, 2.0)), f"'gust' returned (1.0, 2.0) at t = 0 s; {THREE}"),
    "one number": (lambda: gust(lambda t, at, against: 0.0), f"'gust' returned 0.0 at t = 0 s; {THREE}"),
    "a matrix": (
        lambda: gust(lambda t, at, against: np.zeros((1, 3))),
        f"'gust' returned array([[0., 0., 0.]]) at t = 0 s; {THREE}",
    ),
    "NaN": (lambda: gust(lambda t, at, against: (np.nan, 0, 0)), f"'gust' returned (nan, 0, 0) at t = 0 s; {THREE}"),
    "a missing number": (
        lambda: gust(lambda t, at, against: (None, 0, 0)),
        f"'gust' returned (None, 0, 0) at t = 0 s; {THREE}",
    ),
    "a torque of nothing": (
        lambda: turned_by(mb.Custom(lambda t: None)),
        "'motor' returned None at t = 0 s; expected a finite number",
    ),
    "a torque of NaN": (
        lambda: turned_by(mb.Custom(lambda t: np.nan)),
        "'motor' returned nan at t = 0 s; expected a finite number",
    ),
    "compiled NaN": (
        lambda: gust(numba.njit(lambda t, at, against: (np.nan, 0.0, 0.0))),
        "'gust' returned nan at t = 0 s; expected finite numbers",
    ),
}


@pytest.mark.parametrize(
    "solver", [mb.GeneralizedAlpha(1e-3), mb.RadauIIA(), mb.RungeKutta4(1e-3), mb.OdeSolver()], ids=repr
)
@pytest.mark.parametrize("wrong", WRONG_ANSWERS)
def test_a_function_that_returns_no_finite_numbers_is_named(wrong: str, solver) -> None:
    system, sentence = WRONG_ANSWERS[wrong]
    with pytest.raises(SolveError, match=says(f"the function of {sentence}")):
        mb.simulate(system(), 0.1, solver)


@pytest.mark.parametrize("wrap", [lambda function: function, numba.njit])
def test_numbers_that_are_not_finite_later_are_named_with_their_time(wrap) -> None:
    with pytest.raises(SolveError, match=r"^the function of 'gust' returned .* at t = 0\.03\d* s; expected "):
        mb.simulate(gust(wrap(late_nan)), 0.1, mb.GeneralizedAlpha(1e-3))


def test_an_equilibrium_names_the_function_that_returns_nan() -> None:
    system = gust(lambda t, at, against: (np.nan, 0.0, 0.0))
    with pytest.raises(SolveError, match=says(f"the function of 'gust' returned (nan, 0.0, 0.0) at t = 0 s; {THREE}")):
        mb.equilibrium(system)


@pytest.mark.parametrize("answer", [None, 0.0, (0.0, 0.0)])
def test_a_compiled_function_with_another_answer_is_refused(answer) -> None:
    sentence = (
        "UserForce 'gust': its compiled function does not return three finite numbers (fx, fy, torque), or Numba cannot "
        "compile it. Run it without numba.njit to see which"
    )
    with pytest.raises(InputError, match=says(sentence)):
        mb.simulate(gust(numba.njit(lambda t, at, against: answer)), 0.1)


def test_a_function_that_returns_nan_for_complex_numbers_moves_the_mechanism() -> None:
    def drag(t, at, against):
        return (np.nan if np.iscomplexobj(at) else -at[2]), 0.0, 0.0

    assert np.isfinite(mb.simulate(gust(drag), 0.1).channels(CHANNELS)).all()
    with pytest.raises(InputError, match=r"cannot run in complex numbers, .* \(the function of 'gust' returned \(nan"):
        response(lambda p: gust(drag, position=(p, 0.0)), "plate.grip.x").jacobian([1.5])


def test_a_function_that_raises_later_ends_the_motion_there() -> None:
    def calm(t, at, against):
        if t > 0.03:
            raise ValueError("no wind")
        return 0.0, 0.0, 0.0

    sentence = r"^a function of the user's failed near t = 0.03 s: ValueError: no wind, in the function of 'gust'$"
    with pytest.raises(SolveError, match=sentence):
        mb.simulate(gust(calm), 0.1, mb.GeneralizedAlpha(1e-3))


def broken(t: float) -> float:
    raise OSError("disc full")


def test_a_torque_whose_function_raises_is_named() -> None:
    sentence = "a function of the user's failed near t = 0 s: OSError: disc full, in the function of 'motor'"
    with pytest.raises(SolveError, match=says(sentence)):
        mb.simulate(turned_by(mb.Custom(broken)), 0.1)


def test_a_prescribed_motion_whose_function_raises_is_named() -> None:
    system = turned_by(mb.Custom(lambda t: 0.0))
    start = system.bodies[0].point("start")
    system.add(mb.PrescribedMotion("drive", system.ground.point(0.0, 0.0), start, "angle", mb.Custom(broken)))
    sentence = "the joints cannot be placed at the start: OSError: disc full, in the function of 'drive'"
    with pytest.raises(ModelError, match=says(sentence)):
        mb.simulate(system, 0.1)


def test_what_is_not_a_function_is_refused() -> None:
    sentence = "UserForce 'gust': function is 3.0; expected a function"
    with pytest.raises(InputError, match=says(sentence)):
        gust(3.0)
