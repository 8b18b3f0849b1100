"""What is given from Python and cannot be meant: one error of the package that says what, where and what to do."""

from collections.abc import Callable

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.errors import DalembertError
from dalembert.forward import PythonModel

TIMES = np.linspace(0.0, 1.0, 21)
DECAY = np.exp(-1.3 * TIMES)


def pendulum(length: complex = 1.0) -> mb.System:
    system = mb.System()
    bob = system.add(mb.PointMass("bob", mass=1.0, position=(length, 0.0)))
    system.add(mb.DistanceJoint("rod", system.ground.point(0.0, 0.0), bob.centre))
    return system


def hanging() -> mb.Equilibrium:
    system = mb.System()
    bob = system.add(mb.PointMass("bob", mass=1.0, position=(0.0, -1.0)))
    system.add(mb.Spring("spring", system.ground.point(0.0, 0.0), bob.centre, 100.0, free_length=1.0))
    return mb.equilibrium(system)


def at_rest(length: complex) -> mb.Equilibrium:
    return hanging()


def motion(builder=pendulum, channels=("bob.centre.x",), times=TIMES, **options) -> mb.TimeResponse:
    return mb.TimeResponse(builder, {"length": (0.5, 2.0)}, channels, times, **options)


def decay(rate: complex) -> np.ndarray:
    return np.exp(-rate * TIMES)


def model() -> PythonModel:
    return PythonModel(decay, {"rate": (0.1, 3.0)}, ["x"], TIMES)


def other_name(laenge: complex) -> mb.System:
    return pendulum(laenge)


def forgets(length: complex) -> None:
    pendulum(length)


def raises(length: complex) -> mb.System:
    return {"pendulum": length}["double pendulum"]


def place(function: Callable, line: int = 0) -> str:
    return f"test_python_inputs.py, line {function.__code__.co_firstlineno + line}"


SYSTEM = "expected a System"
VECTORS = "expected an array (batch, 1) with one column each for"
CASES: dict[str, tuple[Callable[[], object], str]] = {
    "an equilibrium simulated": (
        lambda: mb.simulate(hanging(), 1.0),  # type: ignore[arg-type]
        f"an Equilibrium was given as the mechanism; {SYSTEM}; give its system, in which the bodies are placed as they "
        "begin",
    ),
    "nothing simulated": (lambda: mb.simulate(None, 1.0), f"None was given as the mechanism; {SYSTEM}"),  # type: ignore[arg-type]
    "a builder simulated": (
        lambda: mb.simulate(pendulum, 1.0),  # type: ignore[arg-type]
        f"a function was given as the mechanism; {SYSTEM}",
    ),
    "an equilibrium as a model": (
        lambda: motion(at_rest).evaluate([[1.0]]),
        f"the model's function ({place(at_rest)}) returned an Equilibrium; {SYSTEM}: end it with 'return'",
    ),
    "a builder that returns nothing": (
        lambda: motion(forgets).channels,
        f"the model's function ({place(forgets)}) returned None; {SYSTEM}: end it with 'return'",
    ),
    "a builder of other names": (
        lambda: motion(other_name),
        f"TimeResponse: the model's function ({place(other_name)}) cannot be called with length: missing a required "
        "argument: 'laenge'. Name its arguments as the parameters",
    ),
    "a builder that raises": (
        lambda: motion(raises).evaluate([[1.0]]),
        f"KeyError: 'double pendulum' ({place(raises, 1)})",
    ),
    "a builder that is none": (
        lambda: motion(pendulum(1.0)),
        "TimeResponse: a System was given as the model's function; expected a function",
    ),
    "channels that are numbers": (
        lambda: motion(channels=[3]),
        "TimeResponse: channels is 3; expected names, such as ['AB.end.x', 'AB.end.y']",
    ),
    "two values for one parameter": (
        lambda: motion().evaluate([1.0, 2.0]),
        f"parameter vectors of shape (2,) were given; {VECTORS} length",
    ),
    "two columns for one parameter": (
        lambda: model().evaluate([[1.0, 2.0]]),
        f"parameter vectors of shape (1, 2) were given; {VECTORS} rate",
    ),
    "a jacobian at two values": (
        lambda: model().jacobian([1.0, 2.0]),
        "a parameter vector of shape (2,) was given; expected (1,) for rate",
    ),
    "a complex value": (
        lambda: model().evaluate([1.0 + 1.0j]),
        f"parameter vectors are [(1+1j)]; expected real numbers, {VECTORS.removeprefix('expected ')} rate",
    ),
    "a jacobian at a complex value": (
        lambda: model().jacobian([1.0 + 1.0j]),
        "parameters are [(1+1j)]; expected real numbers",
    ),
    "a text as a value": (
        lambda: model().jacobian({"rate": "fast"}),  # type: ignore[dict-item]
        "parameter 'rate' is 'fast'; expected a number",
    ),
    "a motion until a text": (
        lambda: mb.simulate(pendulum(), "1"),  # type: ignore[arg-type]
        "simulate: end is '1'; expected a positive number of seconds",
    ),
    "times that are texts": (
        lambda: motion(times=["a", "b"]),
        "times is ['a', 'b']; expected a list of increasing numbers of seconds",
    ),
    "a solver that is a number": (
        lambda: mb.simulate(pendulum(), 1.0, 5),  # type: ignore[arg-type]
        "solver is 5; expected 'auto' or an integrator, such as GeneralizedAlpha(step=1e-3)",
    ),
    "a solver that is a class": (
        lambda: mb.simulate(pendulum(), 1.0, mb.GeneralizedAlpha),  # type: ignore[arg-type]
        "solver is the class GeneralizedAlpha; expected 'auto' or an integrator, such as GeneralizedAlpha(step=1e-3); "
        "write GeneralizedAlpha(...)",
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_it_is_refused_in_one_sentence(case: str) -> None:
    run, sentence = CASES[case]
    with pytest.raises(DalembertError) as error:
        run()
    assert str(error.value) == sentence


def test_one_channel_needs_no_list() -> None:
    assert motion(channels="bob.centre.x").evaluate([[1.0]]).values.shape == (1, 21, 1)
    assert PythonModel(decay, {"rate": (0.1, 3.0)}, "displacement", TIMES).channels[0].name == "displacement"
    assert mb.simulate(pendulum(), 0.1).channels("bob.centre.x").shape == (1001, 1)
    assert hanging().channels("bob.centre.y").shape == (1,)
