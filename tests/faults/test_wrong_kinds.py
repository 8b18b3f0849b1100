"""Each argument of the public functions, given something of a wrong kind: a sentence that names it, or an answer."""

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import dalembert as da
import dalembert.multibody as mb
from dalembert.errors import DalembertError

TIMES = np.linspace(0.0, 1.0, 21)


def decay(rate: complex) -> np.ndarray:
    return np.exp(-rate * TIMES)


def pendulum(length: complex = 1.0) -> mb.System:
    system = mb.System()
    bob = system.add(mb.PointMass("bob", mass=1.0, position=(length, 0.0)))
    system.add(mb.DistanceJoint("rod", system.ground.point(0.0, 0.0), bob.centre))
    return system


def hanging() -> mb.System:
    system = mb.System()
    bob = system.add(mb.PointMass("bob", mass=1.0, position=(0.0, -1.0)))
    system.add(mb.Spring("spring", system.ground.point(0.0, 0.0), bob.centre, 100.0, free_length=1.0))
    return system


MODEL = da.PythonModel(decay, {"rate": (0.1, 3.0)}, ["x"], TIMES)
MOTION = mb.TimeResponse(pendulum, {"length": (0.5, 2.0)}, ["bob.centre.x"], TIMES)
DATA = da.Measurements.of(TIMES, {"x": decay(1.3)}, deviations=0.01)
BANDS = da.Bands.of(TIMES, {"x": (decay(1.4), decay(1.2))})
FIT = da.identify(MODEL, DATA)
BOX = {"rate": (1.0, 2.0)}
NOBODY = {"on_event": None, "executor": None}


class Something:
    """An object that no function expects."""


WRONG = {"None": None, "a text": "text", "a number": 3.5, "an empty list": [], "an object": Something()}


def bounded(method: type) -> Callable[..., object]:
    return lambda **settings: da.propagate(MODEL, BOX, method(**settings))


def integrated(method: type, **usual: Any) -> Callable[..., object]:
    return lambda **settings: da.simulate(pendulum(), 0.05, method(**{**usual, **settings}))


def fitted(method: type, **usual: Any) -> Callable[..., object]:
    return lambda **settings: da.identify(MODEL, DATA, starts=1, method=method(**{**usual, **settings}))


def settings_of(kind: type) -> dict[str, Any]:
    """Names of the settings of a class, each to be left out but where it is wrong."""
    return dict.fromkeys(inspect.signature(kind).parameters, inspect.Parameter.empty)


CASES: dict[str, tuple[Callable[..., object], dict[str, Any]]] = {
    "identify": (
        da.identify,
        {
            **dict(model=MODEL, data=DATA, method=None, starts=1, seed=0, start=None, weights=None, polish=False),
            **dict(horizon=None, spread="sobol", loss="linear", loss_scale=None, validation=None, shooting=None),
            **NOBODY,
        },
    ),
    "identify_bands": (
        da.identify_bands,
        {"model": MODEL, "bands": BANDS, "intervals": None, "method": None, "weights": None, "seed": 0, **NOBODY},
    ),
    "identify_set": (
        da.identify_set,
        {
            **dict(model=MODEL, data=DATA, error=0.1, scheme=None, resolution=None, most_boxes=1000, seed=0),
            **NOBODY,
        },
    ),
    "predict": (da.predict, {"model": MODEL, "fit": FIT, "level": 0.9}),
    "profile": (
        da.profile,
        {"model": MODEL, "data": DATA, "fit": FIT, "names": None, "level": 0.9, "points": 4, **NOBODY},
    ),
    "design": (
        da.design,
        {"model": MODEL, "at": None, "deviations": 0.1, "sensors": "singles", "horizons": None, "criterion": "D"},
    ),
    "identifiability": (da.identifiability, {"model": MODEL, "at": None, "data": None, "deviations": 0.1}),
    "propagate": (da.propagate, {"model": MODEL, "intervals": BOX, "method": "vertex", "seed": 0, **NOBODY}),
    "compare": (
        da.compare,
        {"model": MODEL, "intervals": BOX, "methods": ["vertex"], "reference": "scan", "seed": 0, **NOBODY},
    ),
    "simulate": (
        da.simulate,
        {"system": pendulum(), "end": 0.05, "solver": None, "times": None, "most_steps": 1e8},
    ),
    "equilibrium": (da.equilibrium, {"system": hanging()}),
    "modes": (mb.modes, {"state": hanging(), "count": None}),
    "work_precision": (
        da.work_precision,
        {
            **dict(system=pendulum(), end=0.05, channels=["bob.centre.x"], solvers={"a": [da.RungeKutta4(step=0.01)]}),
            **dict(reference=[da.RungeKutta4(step=1e-3), da.RungeKutta4(step=2e-3)], samples=5, repeats=1),
            **dict(checkpoint=None, on_row=None),
        },
    ),
    "derivative": (da.derivative, {"data": DATA, "channel": "x", "order": 1, "window": None, "degree": 3}),
    "PythonModel": (
        da.PythonModel,
        {
            **dict(function=decay, parameters={"rate": (0.1, 3.0)}, channels=["x"], samples=TIMES),
            **dict(derivative="complex-step", kept=None),
        },
    ),
    "TimeResponse": (
        mb.TimeResponse,
        {
            **dict(builder=pendulum, parameters={"length": (0.5, 2.0)}, channels=["bob.centre.x"], times=TIMES),
            **dict(solver=None, derivative="complex-step"),
        },
    ),
    "Parameter": (
        da.Parameter,
        {
            **dict(name="k", lower=0.0, upper=1.0, unit="m", scale=None, start=None, log=None, deviation=None),
        },
    ),
    "Parameters.of": (da.Parameters.of, {"parameters": {"k": (0.0, 1.0)}}),
    "Experiment": (da.Experiment, {"name": "A", "model": MODEL, "data": DATA, "local": ()}),
    "Sensors": (da.Sensors, {"model": MODEL, "sensors": {"x": da.Sensor(gain=(0.5, 2.0))}, "times": None}),
    "Measurements.of": (
        da.Measurements.of,
        {"coordinate": TIMES, "channels": {"x": decay(1.0)}, "deviations": None, "missing": "refuse", "wraps": ()},
    ),
    "Bands.of": (da.Bands.of, {"coordinate": TIMES, "channels": {"x": (decay(1.4), decay(1.2))}}),
    "Interval": (da.Interval, {"lower": 0.0, "upper": 1.0}),
    "Interval.about": (da.Interval.about, {"middle": 1.0, "radius": 0.1}),
    "Box.of": (da.Box.of, {"intervals": BOX}),
    "evaluate": (MODEL.evaluate, {"vectors": [[1.0]]}),
    "jacobian": (MODEL.jacobian, {"vector": [1.0]}),
    "evaluate a motion": (MOTION.evaluate, {"vectors": [[1.0]]}),
    "LeastSquares": (fitted(da.LeastSquares), settings_of(da.LeastSquares)),
    "ResponseSensitivity": (fitted(da.ResponseSensitivity), settings_of(da.ResponseSensitivity)),
    "ParticleSwarm": (fitted(da.ParticleSwarm, particles=4, iterations=2), settings_of(da.ParticleSwarm)),
    "Firefly": (fitted(da.Firefly, fireflies=4, generations=2), settings_of(da.Firefly)),
    **{
        kind.__name__: (bounded(kind), settings_of(kind))
        for kind in (da.MonteCarlo, da.LatinHypercube, da.Scan, da.Taylor, da.Optimise, da.Chebyshev)
    },
    "GeneralizedAlpha": (integrated(da.GeneralizedAlpha, step=0.01), settings_of(da.GeneralizedAlpha)),
    "RungeKutta4": (integrated(da.RungeKutta4, step=0.01), settings_of(da.RungeKutta4)),
    "RadauIIA": (integrated(da.RadauIIA), settings_of(da.RadauIIA)),
    "OdeSolver": (integrated(da.OdeSolver), settings_of(da.OdeSolver)),
    "Automatic": (integrated(da.Automatic), settings_of(da.Automatic)),
}
OTHER_WORDS = {
    "Bands.of: coordinate": ("the time", "one value a time"),
    "Box.of: intervals": ("intervals are",),
    "GeneralizedAlpha: newton_tolerance": ("Newton's iteration did not converge",),  # so large a tolerance
    "Measurements.of: coordinate": ("the time", "one value a time"),
    "Parameters.of: parameters": ("parameters are",),
    "TimeResponse: builder": ("the model's function",),
    "compare: reference": ("method",),
    "equilibrium: system": ("the mechanism",),
    "identify: method": ("minimiser",),
    "identify: model": ("no experiments were given", "experiments have their own data"),
    "identify: start": ("parameter vector",),
    "jacobian: vector": ("parameters",),
    "simulate: system": ("the mechanism",),
    "work_precision: channels": ("unknown channel",),
}
"""What a sentence has in place of the argument's name."""


@pytest.mark.parametrize("wrong", WRONG)
@pytest.mark.parametrize(
    ("case", "argument"), [(case, argument) for case, (_, usual) in CASES.items() for argument in usual]
)
def test_an_argument_of_a_wrong_kind_is_named(case: str, argument: str, wrong: str) -> None:
    function, usual = CASES[case]
    if argument == "executor" and wrong == "a text":
        pytest.skip("an address, which is waited for")
    given = {name: value for name, value in usual.items() if value is not inspect.Parameter.empty}
    words = (argument, argument.replace("_", " "), *OTHER_WORDS.get(f"{case}: {argument}", ()))
    try:
        function(**{**given, argument: WRONG[wrong]})
    except DalembertError as error:
        assert any(word in str(error) for word in words), str(error)  # noqa: PT017 (some wrong kinds have a meaning)


@pytest.mark.parametrize("case", CASES)
def test_an_object_is_refused(case: str) -> None:
    """Where an object is accepted, nothing looks at the argument."""
    function, usual = CASES[case]
    given = {name: value for name, value in usual.items() if value is not inspect.Parameter.empty}
    for argument in usual:
        with pytest.raises(DalembertError):
            function(**{**given, argument: WRONG["an object"]})
