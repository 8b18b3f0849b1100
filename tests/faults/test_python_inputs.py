"""What is given from Python and cannot be meant: one error of the package that says what, where and what to do."""

from collections.abc import Callable

import numpy as np
import pytest
from inline_snapshot import snapshot

import dalembert.multibody as mb
from conclusions import codes, only
from dalembert.data import Bands, Measurements
from dalembert.errors import DalembertError
from dalembert.forward import PythonModel
from dalembert.inverse import Fit, identify, identify_bands, identify_set
from dalembert.optimize import LeastSquares
from dalembert.parameter import Parameter
from dalembert.uncertainty import propagate

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


def measured(values: object = DECAY, **options) -> Measurements:
    return Measurements.of(TIMES, {"x": values}, **options)


def fitted(data: Measurements | None = None, **options) -> object:
    return identify(model(), measured() if data is None else data, **options)


def other_name(laenge: complex) -> mb.System:
    return pendulum(laenge)


def body(length: complex) -> object:
    return pendulum(length).bodies[0]


def forgets(length: complex) -> None:
    pendulum(length)


def raises(length: complex) -> mb.System:
    return {"pendulum": length}["double pendulum"]


def place(function: Callable, line: int = 0) -> str:
    return f"test_python_inputs.py, line {function.__code__.co_firstlineno + line}"


SYSTEM = "expected a System"
FROM_EQUILIBRIUM = "give its system. To start a motion at the equilibrium, make the system with start='equilibrium'"
VECTORS = "expected an array (batch, 1) with one column each for"
CASES: dict[str, tuple[Callable[[], object], str]] = {
    "an equilibrium simulated": (
        lambda: mb.simulate(hanging(), 1.0),  # type: ignore[arg-type]
        f"an Equilibrium was given as the mechanism; {SYSTEM}: {FROM_EQUILIBRIUM}",
    ),
    "a motion simulated": (
        lambda: mb.simulate(mb.simulate(pendulum(), 0.1), 1.0),  # type: ignore[arg-type]
        f"a Trajectory was given as the mechanism; {SYSTEM}: give its system",
    ),
    "nothing simulated": (lambda: mb.simulate(None, 1.0), f"None was given as the mechanism; {SYSTEM}"),  # type: ignore[arg-type]
    "a builder simulated": (
        lambda: mb.simulate(pendulum, 1.0),  # type: ignore[arg-type]
        f"a function was given as the mechanism; {SYSTEM}",
    ),
    "an equilibrium as a model": (
        lambda: motion(at_rest).evaluate([[1.0]]),
        f"the model's function ({place(at_rest)}) returned an Equilibrium; {SYSTEM}: {FROM_EQUILIBRIUM}",
    ),
    "a body as a model": (
        lambda: motion(body).channels,
        f"the model's function ({place(body)}) returned a PointMass; {SYSTEM}: return the System",
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
    "no parameter that varies": (
        lambda: identify(PythonModel(decay, {"rate": (1.0, 1.0)}, ["x"], TIMES), measured()),
        "identify: every parameter of the model is fixed by equal bounds; expected at least one parameter whose bounds "
        "differ",
    ),
    "a text as a bound": (
        lambda: Parameter("rate", "a", 1.0),  # type: ignore[arg-type]
        "parameter 'rate': lower is 'a'; expected a number",
    ),
    "a motion of decades": (
        lambda: motion(times=np.array([0.0, 1e9]), solver=mb.GeneralizedAlpha(step=1e-3)),
        "TimeResponse: GeneralizedAlpha(step=0.001) until 1e+09 s takes 1e+12 steps; expected at most 1e+09, which "
        "take hours. Use larger steps or a shorter motion",
    ),
    "texts as data": (lambda: measured(["a"] * 21), "channel 'x', sample 0: 'a'; expected a number"),
    "texts as times of data": (
        lambda: Measurements.of([0.0, "b"], {"x": [1.0, 2.0]}),
        "the time, sample 1: 'b'; expected a number",
    ),
    "rows of unequal length as data": (
        lambda: measured([[1.0], [1.0, 2.0]]),
        "channel 'x' is [[1.0], [1.0, 2.0]]; expected numbers, in rows of equal length",
    ),
    "complex data": (
        lambda: measured(DECAY + 1j),
        "channel 'x' has complex values, such as (1+1j); expected real numbers; give the real and the imaginary part, "
        "or amplitude and phase, as two channels",
    ),
    "dates as times of data": (
        lambda: Measurements.of(np.array(["2020-01-01"], dtype="M8[D]"), {"x": [1.0]}),
        "the time has dates or time spans, such as 2020-01-01; expected numbers in SI units",
    ),
    "a number as a channel's name": (
        lambda: Measurements.of([0.0], {3: [1.0]}),  # type: ignore[dict-item]
        "Measurements: channels is 3; expected names, such as ['AB.end.x', 'AB.end.y']",
    ),
    "data without names": (
        lambda: Measurements.of([0.0], [1.0]),  # type: ignore[arg-type]
        "the channels are [1.0]; expected columns by their names, such as {'AB.end.x': values}",
    ),
    "a text as deviation": (
        lambda: measured(deviations={"x": "a"}),
        "the deviation of channel 'x': 'a'; expected a number",
    ),
    "a number as bands": (
        lambda: Bands.of([0.0], {"x": 3.0}),  # type: ignore[dict-item]
        "channel 'x' is 3.0; expected two columns, (lower, upper)",
    ),
    "huge data": (
        lambda: fitted(measured(1e200 * DECAY)),
        "channel 'x': its largest absolute value is 1e+200; expected at most 1e+50; use other units",
    ),
    "tiny data": (
        lambda: fitted(measured(1e-200 * DECAY)),
        "the weighted data, √W·|data|, are 1e-200 at most; expected 1e-50 to 1e+50, in which squares can be computed; "
        "use other units or other weights",
    ),
    "huge deviations": (
        lambda: fitted(measured(deviations=1e300)),
        "channel 'x': its deviation is 1e+300; expected 1e-50 to 1e+50; use other units",
    ),
    "tiny deviations": (
        lambda: fitted(measured(deviations=1e-300)),
        "channel 'x': its deviation is 1e-300; expected 1e-50 to 1e+50; use other units",
    ),
    "half a start": (lambda: fitted(starts=2.5), "identify: starts is 2.5; expected a whole number, at least 1"),
    "True as starts": (lambda: fitted(starts=True), "identify: starts is True; expected a whole number, at least 1"),
    "NaN as starts": (lambda: fitted(starts=np.nan), "identify: starts is nan; expected a whole number, at least 1"),
    "a text as seed": (lambda: fitted(seed="a"), "identify: seed is 'a'; expected a whole number, at least 0"),
    "texts as weights": (
        lambda: fitted(weights=["a"]),
        "weights are ['a']; expected an array of numbers, (channels,) or (samples, channels)",
    ),
    "a text as scale of a loss": (
        lambda: fitted(loss="huber", loss_scale="a"),
        "loss_scale is 'a'; expected a positive number",
    ),
    "a number as loss": (
        lambda: fitted(loss=5),
        "unknown loss '5'; known: cauchy, huber, linear, soft-l1",
    ),
    "a class as method": (
        lambda: fitted(method=LeastSquares),
        "method is the class LeastSquares; expected LeastSquares(), ResponseSensitivity(), ParticleSwarm(), "
        "ImprovedParticleSwarm(), Firefly(), or a Minimiser or its name; write LeastSquares(...)",
    ),
    "a function as the model of a fit": (
        lambda: identify(decay, measured()),  # type: ignore[arg-type]
        "identify: a function was given as the model; expected a forward model, such as TimeResponse or PythonModel",
    ),
    "a list as the data of a fit": (
        lambda: identify(model(), [1.0]),  # type: ignore[arg-type]
        "identify: [1.0] was given as the data; expected Measurements, see Measurements.of",
    ),
    "measurements as bands": (
        lambda: identify_bands(model(), measured()),  # type: ignore[arg-type]
        "identify_bands: a Measurements was given as the data; expected Bands, see Bands.of",
    ),
    "half a seed of a set": (
        lambda: identify_set(model(), measured(), error=0.1, seed=0.5),  # type: ignore[arg-type]
        "identify_set: seed is 0.5; expected a whole number, at least 0",
    ),
    "half a seed of bounds": (
        lambda: propagate(model(), {"rate": (0.5, 1.0)}, seed=0.5),  # type: ignore[arg-type]
        "propagate: seed is 0.5; expected a whole number, at least 0",
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


def test_lists_make_measurements() -> None:
    data = Measurements([0.0, 1.0], ["x"], [[1.0], [2.0]], [0.1])  # type: ignore[arg-type]
    assert data.coordinate.values.tolist() == [0.0, 1.0]
    assert (data.channels, data.values.shape) == (("x",), (2, 1))


@pytest.mark.parametrize(
    ("response", "data", "message"),
    [
        (decay, 0 * DECAY, snapshot("The data are constant: the explained share of their variation is not defined.")),
        (
            lambda rate: 1e100 * decay(rate),
            DECAY,
            snapshot(
                "The response explains nothing of the data's variation: the misfit is larger than that variation."
            ),
        ),
    ],
)
def test_a_response_that_explains_nothing_is_described(response: Callable, data: np.ndarray, message: str) -> None:
    fit = identify(PythonModel(response, {"rate": (0.1, 3.0)}, ["x"], TIMES), measured(data))
    assert only(fit, "explained-variation").message == message


def test_bands_without_width_have_a_finite_misfit() -> None:
    fit = identify_bands(model(), Bands.of(TIMES, {"x": (DECAY, DECAY)}))
    finding = only(fit, "bands-differ")
    assert 0 < finding.values["rms"] < 1e-8
    assert "inf" not in finding.message


def of_three(samples: int, deviations: float | None = None) -> Fit:
    """A fit of three parameters to few samples."""
    times = TIMES[:samples]
    few = PythonModel(
        lambda rate, height, floor: height * np.exp(-rate * times) + floor,
        {"rate": (0.1, 3.0), "height": (0.5, 2.0), "floor": (-1.0, 1.0)},
        ["x"],
        times,
    )
    return identify(few, Measurements.of(times, {"x": DECAY[:samples]}, deviations=deviations))


@pytest.mark.parametrize("deviations", [None, 0.01])
def test_fewer_data_than_parameters_are_no_plain_success(deviations: float | None) -> None:
    fit = of_three(2, deviations)
    finding = next(finding for finding in fit.findings if finding.code == "too-few-data")
    assert (finding.severity, dict(finding.values)) == ("warning", {"values": 2, "parameters": 3})
    assert only(fit, "converged").message == snapshot(
        "Converged to one of many solutions: the data have fewer values than there are parameters."
    )
    assert "misfit-at-noise" not in codes(fit)
    assert not np.any(np.isfinite(fit.deviations))
    assert finding in fit.doubts
    assert finding.message in fit.summary()


def test_as_many_data_as_parameters_leave_the_deviations_unknown() -> None:
    fit = of_three(3)
    assert [finding.code for finding in fit.findings] == ["too-few-data"]
    assert np.all(np.isnan(fit.deviations))
    assert of_three(3, 0.01).findings == of_three(4).findings == ()


def test_fixed_parameters_make_the_data_enough() -> None:
    times = TIMES[:2]
    model = PythonModel(
        lambda rate, height: height * np.exp(-rate * times), {"rate": (1.3, 1.3), "height": (0.5, 2.0)}, ["x"], times
    )
    assert identify(model, Measurements.of(times, {"x": DECAY[:2]})).findings == ()
