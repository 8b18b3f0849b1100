"""Small studies that provoke every figure and every sentence of reports and summaries, with the sentences of each."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import dalembert as da
from correlated_noise import autoregressive
from dalembert.data import Bands, Measurements
from dalembert.forward import Channel, PythonModel
from dalembert.inverse import Experiment, GlobalSurrogate, design, identifiability, predict, profile
from dalembert.multibody import Force, PointMass, Spring, System, equilibrium_path
from dalembert.multibody.spatial import Inertia, Orientation, RigidBody, SpatialSystem, SphericalJoint
from dalembert.optimize import LeastSquares, Minimiser, ParticleSwarm, ResponseSensitivity
from dalembert.parameter import Parameter
from dalembert.study import load, run_study
from dalembert.study.tasks.assessments import foreseen
from dalembert.surrogate import Adaptive, Tensor, TotalDegree
from dalembert.uncertainty import Chebyshev, LatinHypercube, MonteCarlo, Optimise, Scan, Taylor, Vertex
from decay_cases import DECAY_CASES
from free_oscillations import NOISE, TRUTH, oscillation, oscillator, recorded, rubbing
from free_oscillations import TIMES as OSCILLATING
from frequency_cases import FREQUENCY_CASES
from inertial_cases import INERTIAL_CASES
from inseparable import stepped_product
from mistake_cases import MISTAKE_CASES
from posterior_cases import POSTERIOR_CASES
from regularised_cases import REGULARISED_CASES
from report_case import Case
from sensitivity_cases import SENSITIVITY_CASES
from small_models import DECAY, LINE, TIMES, banded, measured
from specimen_cases import SPECIMEN_CASES
from stepped_models import TIMES as STEPPED_TIMES
from stepped_models import Stepped, decay_in_steps, exact, failing, growing_in_steps, quick_in_steps, slow_in_steps

NOW = np.zeros(1)
DISC = PythonModel(lambda x, y: np.array([x**2 + y**2]), {"x": (-2.0, 2.0), "y": (-2.0, 2.0)}, ["r"], NOW)
AT_ZERO = Measurements.of(NOW, {"r": [0.0]})
SUM = PythonModel(lambda a, b: (a + b) * TIMES, {"a": (0.0, 2.0), "b": (0.0, 2.0)}, ["x"], TIMES)
SLOPE = PythonModel(lambda a: a * TIMES, {"a": Parameter("a", 0.0, 2.0, start=0.5)}, ["x"], TIMES)
GHOST = PythonModel(lambda a, ghost: a * TIMES + 0 * ghost, {"a": (0.0, 2.0), "ghost": (0.0, 1.0)}, ["x"], TIMES)
WAVE = PythonModel(lambda rate: np.cos(rate * TIMES), {"rate": (1.0, 20.0)}, ["x"], TIMES)
NEAR_POLE = PythonModel(lambda a: np.array([1 / (1.02 - a)]), {"a": (-1.0, 1.0)}, ["x"], np.zeros(1))
LONG = np.linspace(0, 4, 201)
LINE_IN_TIME = PythonModel(
    lambda offset, slope: offset + slope * LONG, {"offset": (-5.0, 5.0), "slope": (-5.0, 5.0)}, ["x"], LONG
)
THRICE = PythonModel(
    lambda offset, slope: np.stack(3 * [offset + slope * LONG], axis=1), LINE_IN_TIME.parameters, ["x", "y", "z"], LONG
)
ALMOST_AT_ONCE = np.concatenate([np.linspace(0, 0.1, 30), [2.0]])
FAR_SAMPLE = PythonModel(
    lambda offset, slope: offset + slope * ALMOST_AT_ONCE, LINE_IN_TIME.parameters, ["x"], ALMOST_AT_ONCE
)
BANDS = banded(DECAY, [1.8, 0.7], [2.2, 0.9], points=2)


def _model(function: Callable, channels: str = "x", **box: Any) -> PythonModel:
    return PythonModel(function, box, channels.split(), TIMES)


def _integrators(fine: float, **early: int) -> Any:
    system = da.System(gravity=(0.0, -9.81))
    bar = system.add(da.RigidBar("bar", length=1.0, mass=1.0))
    system.add(da.RevoluteJoint("pin", system.ground, bar.start))
    series = {"fixed": [da.GeneralizedAlpha(step=step) for step in (0.02, 0.002)]}
    if early:
        series["adaptive"] = [da.GeneralizedAlpha(step=0.01, adaptive=True, **early)]
    references = [da.GeneralizedAlpha(step=fine), da.GeneralizedAlpha(step=2 * fine)]
    return da.work_precision(system, 1.0, ["bar.end.x"], series, reference=references, repeats=1)


def _with_outliers() -> da.Measurements:
    """A decay with noise as stated, and two readings that are far off."""
    data = _exact(DECAY, [2.0, 0.8], noise=0.02, deviations=0.02)
    values = data.values.copy()
    values[[7, 30]] += 1.0
    return replace(data, values=values)


def _noisy(outliers: Mapping[int, float] = {}, factor: Any = 1.0, added: Any = 0.0) -> Measurements:
    """A line with noise of one fault."""
    errors = 0.1 * np.random.default_rng(0).standard_normal(201) * factor + added
    errors[list(outliers)] += list(outliers.values())
    return Measurements.of(LONG, {"x": 1 + LONG / 2 + errors})


PARABOLA = PythonModel(
    lambda offset, slope, bend: offset + slope * LONG + bend * LONG**2,
    {"offset": (-5.0, 5.0), "slope": (-5.0, 5.0), "bend": (-5.0, 5.0)},
    ["x"],
    LONG,
)
BENT = _noisy(added=0.1 * LONG**2)


def _of_four_blocks() -> str:
    fits = {"line": da.identify(LINE_IN_TIME, _noisy()), "bent": da.identify(PARABOLA, _noisy())}
    return da.compare_models(fits, leave_out="blocks", blocks=4).summary()


def _cross_validated(*, converged: bool) -> da.CrossValidation:
    found = da.cross_validate(PARABOLA, BENT, fit=da.identify(PARABOLA, BENT), blocks=4)
    return replace(found, converged=np.array([True, converged, True, True]))


def _drifting() -> Measurements:
    return Measurements.of(LONG, {"x": 1 + LONG / 2 + 0.05 * autoregressive(0, 201, 0.9)})


SHORT = np.linspace(0.0, 2.0, 30)
SQUARED = PythonModel(lambda a, b: a * a + b * SHORT, {"a": (-3.0, 3.0), "b": (-5.0, 5.0)}, ["x"], SHORT)
SQUARES = Measurements.of(SHORT, {"x": 2 + SHORT + 0.1 * np.random.default_rng(0).standard_normal(30)})


def _signs_stay() -> Measurements:
    """Heavy tails hide a drift from the autocorrelation, not from the signs."""
    errors = 0.04 * np.random.default_rng(8).standard_cauchy(201).clip(-40, 40) + 0.06 * np.sign(np.sin(4.5 * LONG))
    return Measurements.of(LONG, {"x": 1 + LONG / 2 + errors})


def _exact(model: PythonModel, values: list[float], **options: Any) -> Measurements:
    return measured(model, values, **options)


def _of_the_same_steps() -> Measurements:
    noise = 1e-3 * np.random.default_rng(1).standard_normal(101)
    return Measurements.of(STEPPED_TIMES, {"x": decay_in_steps(0.8, 2.0, 0.8) + noise}, 1e-3)


def _experiments(noise: float = 0.02, names: str = "ab") -> list[Experiment]:
    return [
        Experiment(name, DECAY, measured(DECAY, [2.0, 0.8], noise, seed, deviations=0.02))
        for seed, name in enumerate(names)
    ]


def _slope(method: Any, **options: Any) -> Any:
    """A fit of one slope, whose message at the end is the method's."""
    return da.identify(SLOPE, _exact(SLOPE, [1.0], noise=0.1), method=method, starts=1, horizon=None, **options)


def _fragile(a: float) -> np.ndarray:
    if np.real(a) > 0.6:
        raise ArithmeticError("the motion runs away")
    return a * TIMES


RUNS_AWAY = f"ArithmeticError: the motion runs away (report_cases.py, line {_fragile.__code__.co_firstlineno + 2})"
FRAGILE = PythonModel(_fragile, {"a": Parameter("a", 0.0, 2.0, start=1.9)}, ["x"], TIMES)


def _real_alone(a: Any) -> np.ndarray:
    """A response whose complex step fails beyond 1.2."""
    if np.iscomplexobj(a) and np.real(a) > 1.2:
        raise ArithmeticError("no complex numbers there")
    return np.exp(a) * TIMES


def _turned(factor: float) -> Any:
    start = {"a": Parameter("a", 1e-3, 1e3, start=0.5)}
    model = PythonModel(lambda a: a * TIMES, start, [Channel("x", "rad")], TIMES)
    return da.identify(model, Measurements.of(TIMES, {"x": 0.6 * factor * TIMES}))


def _unsimulated(method: Any, start: float, starts: int) -> Any:
    return da.identify(FRAGILE, _exact(FRAGILE, [0.4], noise=0.1), method=method, starts=starts, start=[start])


def _jump(rate: Any) -> np.ndarray:
    return np.exp(-rate * TIMES) + np.where(np.real(rate) > 1.02, 1e200, 0.0)


def _broken_profile(function: Callable) -> Any:
    model = _model(function, rate=(0.5, 2.0))
    data = Measurements.of(TIMES, {"x": np.exp(-TIMES)}, deviations=0.1)
    with np.errstate(over="ignore"):
        return profile(model, data, da.identify(model, data, start=[1.0], starts=1))


def _one_rubs() -> Any:
    motions = {"a": oscillation(OSCILLATING, 30.0, 0.1, 0.3), "b": rubbing(OSCILLATING, 30.0, 0.1, 0.3, 0.3)}
    return da.identify(
        [Experiment(name, oscillator(), recorded(x), local=("damping", "start")) for name, x in motions.items()]
    )


def _two_late() -> Any:
    def both(stiffness: Any, damping: Any, start: Any) -> np.ndarray:
        x = oscillation(OSCILLATING, stiffness, damping, start)
        return np.stack([x, x + x**2], axis=1)

    x = oscillation(np.maximum(OSCILLATING - 0.02, 0), *TRUTH)
    noise = NOISE * np.random.default_rng(0).standard_normal((2, len(x)))
    model = PythonModel(both, oscillator().parameters, ["x", "y"], OSCILLATING)
    return da.identify(model, Measurements.of(OSCILLATING, {"x": x + noise[0], "y": x + x**2 + noise[1]}))


def _profiled(model: PythonModel, data: Measurements, **options: Any) -> Any:
    return profile(model, data, da.identify(model, data), **options)


def _asymmetric() -> Any:
    times = np.linspace(0, 4, 9)
    model = PythonModel(lambda rate: np.exp(-rate * times), {"rate": (0.1, 50.0)}, ["x"], times)
    return _profiled(model, measured(model, [3.0], deviations=0.06))


def _no_minimum() -> Any:
    data = _exact(LINE, [1.0, -0.5], noise=0.1, deviations=0.1)
    fit = da.identify(LINE, data)
    return profile(LINE, data, replace(fit, values=fit.values + 3 * fit.deviations))


def _blind() -> tuple[Any, Any]:
    """A fit without sensitivities, and what a model with sensitivities foretells from it."""
    model = _model(lambda a: float(np.real(a)) * TIMES, a=(0.0, 2.0))
    fit = da.identify(model, _exact(SLOPE, [1.0]), method=ParticleSwarm(10, 20))
    return fit, {"prediction": predict(SLOPE, fit)}


def _spiked() -> Any:
    """A spike between the surrogate's runs, on a corner of the inner box that a smooth model has."""
    corner = da.identify_set(DISC, AT_ZERO, error=1.0, scheme=Tensor(4)).inner.upper

    def spiked(x: float, y: float) -> np.ndarray:
        return np.array([x**2 + y**2 + np.exp(-(((x - corner[0]) / 1e-6) ** 2) - ((y - corner[1]) / 1e-6) ** 2)])

    return da.identify_set(PythonModel(spiked, DISC.parameters, ["r"], NOW), AT_ZERO, error=1.0, scheme=Tensor(4))


def _far(x: float, y: float) -> np.ndarray:
    if x + y > 2.9:
        raise RuntimeError("too far")
    return np.array([x**2 + y**2])


def _noisy_bands() -> Bands:
    noise = 0.01 * np.random.default_rng(2).standard_normal((2, 41))
    lower, upper = np.sort([BANDS.lower[:, 0] + noise[0], BANDS.upper[:, 0] + noise[1]], axis=0)
    return Bands.of(TIMES, {"x": (lower, upper)})


def _spoilt_bands() -> Bands:
    upper = BANDS.upper[:, 0].copy()
    upper[20] += 0.5
    return Bands.of(TIMES, {"x": (BANDS.lower[:, 0], upper)})


def _tired() -> Any:
    """The surrogate is made of runs on a root grid; at the corners of the answer the model fails."""
    runs = []

    def tired(size: float, rate: float) -> np.ndarray:
        runs.append((size, rate))
        if len(runs) > 4 + 81:
            raise RuntimeError("enough")
        return DECAY.function(size, rate)

    model = PythonModel(tired, DECAY.parameters, ["x"], TIMES)
    return da.identify_bands(model, BANDS, method=GlobalSurrogate(Tensor(8), tolerance=1.0))


def _trembling() -> Any:
    """Bands so wide apart from noise that a radius is hardly told."""
    noise = 0.05 * np.random.default_rng(1).standard_normal(41)
    value = DECAY.function(2.0, 0.8)
    wobble = 0.01 * np.abs(np.random.default_rng(3).standard_normal(41))
    return da.identify_bands(DECAY, Bands.of(TIMES, {"x": (value + noise - wobble, value + noise + wobble)}))


def _study(text: str, model: str) -> Callable[[Path], Any]:
    def make(folder: Path) -> Any:
        (folder / "model.py").write_text(model)
        (folder / "study.toml").write_text(text)
        return run_study(load(folder / "study.toml"), folder / "run")[1].result

    return make


SWEEP = """
[parameters]
rate = { lower = 0.1, upper = 3.0 }
[model]
forward = "model.py:decay"
[sweep]
at = 1.0
channels = ["x"]
over = { rate = { count = 5 } }
"""
DECAYING = """
import numpy as np
from dalembert import PythonModel
TIMES = np.linspace(0.0, 2.0, 21)
def response(rate):
    if np.real(rate) > 2.5:
        raise ValueError("too fast")
    return np.exp(-rate * TIMES)
def decay(parameters):
    return PythonModel(response, parameters, ["x"], TIMES)
"""


def _pendulum(gravity: float = -9.81) -> Any:
    system = da.System(gravity=(0.0, gravity))
    bar = system.add(da.RigidBar("bar", length=1.0, mass=1.0, angle=-0.5))
    system.add(da.RevoluteJoint("pin", system.ground, bar.start))
    return da.simulate(system, end=0.1, solver=da.GeneralizedAlpha(step=2e-3))


def _ball() -> Any:
    system = SpatialSystem()
    rod = Inertia.box(1.0, (0.1, 0.1, 0.5)).moved((0.0, 0.0, -0.25))
    body = system.add(RigidBody("rod", rod, orientation=Orientation.by_angles("x", [0.5])))
    system.add(SphericalJoint("ball", system.ground, body.point("origin")))
    return da.simulate(system, end=0.1, solver=da.GeneralizedAlpha(step=2e-3))


def _arch() -> Any:
    """A flat arch of two springs that snaps through."""

    def build(load: float) -> System:
        system = System(gravity=(0.0, 0.0))
        apex = system.add(PointMass("apex", mass=1.0, position=(0.0, 0.1)))
        for name, x in (("left", -1.0), ("right", 1.0)):
            ground = system.ground.point(x, 0.0)
            system.add(Spring(name, ground, apex.centre, stiffness=1e4, free_length=1.01**0.5))
        system.add(Force("push", apex.centre, y=-load))
        return system

    return equilibrium_path(build, 0.0, 8.0, channels=["apex.centre.y"], parameter="push", unit="N")


def _moved_fit() -> tuple[Any, Any]:
    model = _model(lambda a: np.stack([a * TIMES, -TIMES], axis=1), "bar.end.x bar.end.y", a=(0.0, 2.0))
    return da.identify(model, _exact(model, [1.0], noise=0.1)), {"trajectory": _pendulum()}


def _all_told() -> tuple[Any, Any]:
    data = _exact(DECAY, [1.0, 0.8], noise=0.05, deviations=0.05)
    fit = da.identify(DECAY, data, method=ResponseSensitivity(), starts=3)
    return fit, {"profiles": profile(DECAY, data, fit), "prediction": predict(DECAY, fit)}


def _moved_experiments() -> tuple[Any, Any]:
    experiments = _experiments()
    fit = da.identify(experiments)
    told = {item.name: predict(item, fit) for item in experiments}
    return fit, {"trajectory": {"a": _pendulum()}, "prediction": told}


CASES: dict[str, Case] = {
    "a path of equilibria": Case(
        _arch,
        (
            "with 2 limit points.",
            "Solid: stable equilibria; dashed: unstable ones.",
            "The slider goes along the path; faint outlines are equilibria on it.",
            "equilibria are unstable, the first of them from 3.82988 N on.",
        ),
        ("mechanism", "equilibrium-path-1"),
    ),
    "motion in space": Case(_ball, ("Drag to turn, scroll to zoom.",), ("mechanism",)),
    # ── identification: how it went ─────────────────────────────────────────────────────────────────────────────────
    "exact data": Case(
        lambda: da.identify(DECAY, _exact(DECAY, [2.0, 0.8])),
        ("Converged.", "The misfit equals the noise level of the data (rounding errors of the arithmetic)."),
        ("parameters", "responses-1", "convergence", "correlation", "singular-values"),
    ),
    "rounded data": Case(
        lambda: da.identify(DECAY, Measurements.of(TIMES, {"x": DECAY.function(2.0, 0.8).round(4)})),
        ("(estimated from their rounding)",),
    ),
    "given deviations": Case(
        lambda: da.identify(DECAY, _exact(DECAY, [2.0, 0.8], noise=0.02, deviations=0.02)),
        ("(from the given standard deviations)", "starts converged to the smallest misfit."),
        ("starts",),
    ),
    "deviations too small": Case(
        lambda: da.identify(DECAY, _exact(DECAY, [2.0, 0.8], noise=0.05, deviations=0.02)),
        ("times as large as the given standard deviations allow. Check the standard deviations",),
    ),
    "fewer values than parameters": Case(
        lambda: da.identify(SUM.first(2), _exact(SUM, [1.0, 0.5]).first(2), weights=[[0.0], [1.0]]),
        (
            "Converged to one of many solutions: the data have fewer",
            "1 value cannot determine 2 parameters: other parameters explain",
        ),
    ),
    "as many values as parameters": Case(
        lambda: da.identify(SLOPE.first(2), _exact(SLOPE, [1.0]).first(2), weights=[[0.0], [1.0]]),
        ("There are as many parameters as values (1), so no residuals are left",),
    ),
    "noise unknown": Case(
        lambda: da.identify(DECAY, _exact(DECAY, [2.0, 0.8], noise=0.05)),
        ("% of the data's variation.", "The residuals are not correlated. Give the standard deviations"),
    ),
    "constant data": Case(
        lambda: da.identify(DECAY, Measurements.of(TIMES, {"x": np.zeros(41)})),
        ("The data are constant: the explained share of their variation is not defined.",),
    ),
    "another model's data": Case(
        lambda: da.identify(DECAY, Measurements.of(TIMES, {"x": 1 + np.cos(3 * TIMES)})),
        (
            "The residuals of 'x' are correlated (lag-1 autocorrelation",
            "They are not noise: the model lacks something.",
        ),
    ),
    "an outlier": Case(
        lambda: da.identify(LINE_IN_TIME, _noisy({140: 1.0})),
        (
            "1 sample is an outlier: 'x' at 2.8 s",
            "Without the largest, 'slope' changes by",
            "Leave out wrong ones, or use a robust loss",
            "Outliers, the largest first",
            "Samples with the largest influence.",
        ),
        ("residual-diagnostics",),
    ),
    "outliers of all kinds": Case(
        lambda: da.identify(LINE_IN_TIME, _noisy({20: 1.0, 60: -1.0, 100: 1.0, 140: -1.0})),
        ("4 samples are outliers:", ", and 1 more."),
    ),
    "a hum": Case(
        lambda: da.identify(LINE_IN_TIME, _noisy(added=0.1 * np.sin(23 * LONG))),
        ("have a periodic part:", "Look for its source, such as mains voltage"),
    ),
    "channels that share noise": Case(
        lambda: da.identify(THRICE, Measurements.of(LONG, dict.fromkeys("xyz", _noisy().values[:, 0]))),
        (
            "The residuals of 'x' and 'y' are correlated with each other",
            "and those of 2 more pairs.",
            "With this correlation they are 1.7 times as large.",
        ),
    ),
    "noise that grows": Case(
        lambda: da.identify(LINE_IN_TIME, _noisy(factor=0.2 + LONG)),
        ("The residuals of 'x' grow with", "Estimate how it grows:"),
    ),
    "noise that shrinks": Case(
        lambda: da.identify(LINE_IN_TIME, _noisy(factor=5.0 - LONG)),
        ("The residuals of 'x' shrink with", "Weight the samples by their noise:"),
    ),
    "signs that stay": Case(
        lambda: da.identify(LINE_IN_TIME, _signs_stay()),
        (
            "change their sign too rarely:",
            "Look at the residuals over time for what the model lacks.",
            "are not normally distributed (Anderson–Darling test). Look at the normal quantiles.",
        ),
    ),
    "one sample decides": Case(
        lambda: da.identify(FAR_SAMPLE, _exact(FAR_SAMPLE, [1.0, 0.5], noise=0.1, seed=1)),
        (
            "decides the fit (Cook's distance",
            "Check this sample for a mistake, and measure more samples under similar conditions.",
        ),
    ),
    "many channels": Case(
        lambda: da.identify(_experiments(names="abcdefghijklmn")),
        ("The figure has the 12 channels that the tests doubt most.", "Click a name in the legend"),
    ),
    "models compared": Case(
        lambda: da.compare_models({"line": da.identify(LINE_IN_TIME, BENT), "bent": da.identify(PARABOLA, BENT)}),
        (
            "'bent' predicts best: its log predictive density is larger",
            "The residuals of 'line' are correlated. AIC, AICc and BIC take values for independent",
            "left out together blocks of neighbouring samples",
            "A step is a part of the data that a model predicts worse.",
        ),
        ("model-differences", "difference-by-group"),
    ),
    "cross-validation": Case(
        lambda: _cross_validated(converged=True),
        ("Groups in the order of the data", "below, predicted minus measured", "rms of the prediction errors"),
        ("responses-1",),
    ),
    "cross-validation that did not converge": Case(
        lambda: _cross_validated(converged=False),
        ("1 of 4 fits without a group did not converge. Do not compare their densities; leave out smaller groups.",),
    ),
    "equal models": Case(
        lambda: da.compare_models(
            {"line": da.identify(LINE_IN_TIME, _noisy()), "bent": da.identify(PARABOLA, _noisy())}
        ),
        ("The data do not distinguish", "which means nothing. Prefer the simplest, 'line'"),
    ),
    "models of four blocks": Case(
        lambda: str(_of_four_blocks()),
        ("Only 4 groups were left out", "Leave out more, smaller groups."),
    ),
    "draws with correlated residuals": Case(
        lambda: da.sample(LINE_IN_TIME, _drifting(), chains=2, draws=20, warmup=20),
        (
            "The residuals of 'x' are correlated (lag-1 autocorrelation",
            "With correlated noise, deviations are up to",
            "The draws take the noise for independent",
        ),
    ),
    "draws of one of two minima": Case(
        lambda: da.sample(SQUARED, SQUARES, chains=2, draws=20, warmup=20),
        ("The posterior has 2 modes that no chain connects",),
    ),
    "correlated noise": Case(
        lambda: da.identify(
            DECAY, Measurements.of(TIMES, {"x": DECAY.function(2.0, 0.8) + 0.02 * autoregressive(0, 41, 0.6)}, 0.02)
        ),
        ("Check the model structure and the bounds, or increase `starts`.", "for independent residuals"),
    ),
    "noise estimated with the parameters": Case(
        lambda: da.identify(
            DECAY,
            Measurements.of(TIMES, {"x": DECAY.function(2.0, 0.8) + 0.02 * autoregressive(0, 41, 0.6)}),
            noise=da.AutoregressiveNoise(order=1, deviation=da.ConstantNoise(deviation=(1e-6, 0.01))),
        ),
        (
            "The noise is estimated with the parameters, of 'x': autoregressive of order 1, constant.",
            "Whitened by it, the residuals are not correlated.",
            "The noise parameter 'noise.x.deviation' is at its upper bound 0.01. Take a noise model without it",
            "Noise, estimated with the parameters",
        ),
    ),
    "a noise model that is too simple": Case(
        lambda: da.identify(
            DECAY,
            Measurements.of(TIMES, {"x": DECAY.function(2.0, 0.8) + 0.02 * autoregressive(0, 41, 0.9)}),
            noise="constant",
        ),
        ("The noise model does not describe the residuals of 'x': whitened by it, they are correlated",),
    ),
    "a record whose first part is fitted": Case(
        lambda: da.identify(_experiments(), validation={"b": 2.0}), ("after its first 2",)
    ),
    "friction that the model lacks": Case(
        lambda: da.identify(oscillator(), recorded(rubbing(OSCILLATING, 30.0, 0.1, 0.3, 0.3), deviations=NOISE)),
        (
            "The model does not follow the data from",
            "times the given deviation",
            "The two halves of the record have different parameters",
            "At the dashed line the residuals leave the noise",
            "(fitted to each half)",
        ),
    ),
    "friction in one of two experiments": Case(
        _one_rubs, ("The model does not follow the data of experiment 'b'", "(estimated from neighbouring residuals)")
    ),
    "a late sensor": Case(
        lambda: da.identify(oscillator(), recorded(oscillation(np.maximum(OSCILLATING - 0.02, 0), *TRUTH))),
        ("are late: a delay of about", "[sensors] 'x' = { delay = [0.0, 0.04] }"),
    ),
    "early data": Case(
        lambda: da.identify(oscillator(), recorded(oscillation(OSCILLATING + 0.02, *TRUTH))),
        ("are early: a delay of about −", "and the delays of measured inputs."),
    ),
    "two late sensors": Case(
        _two_late, ("The data of all channels are late", "Identify a delay of each sensor, up to")
    ),
    "two minima": Case(
        lambda: da.identify(
            _model(lambda a: a**2 * TIMES, a=(-3.0, 2.0)),
            _exact(_model(lambda a: a**2 * TIMES, a=(-3, 2)), [1.5], noise=0.1),
        ),
        ("Another minimum explains the data as well, within the noise: a =", "times as large."),
    ),
    "outliers": Case(
        lambda: da.identify(DECAY, _exact(DECAY, [2.0, 0.8], noise=0.05, deviations=0.02), loss="cauchy"),
        ("weighted residuals exceed", "count less than their squares."),
    ),
    "few outliers": Case(
        lambda: da.identify(DECAY, _with_outliers(), loss="huber"),
        ("Without the outliers, the residuals agree with the given standard deviations.",),
    ),
    "failing runs": Case(
        lambda: _unsimulated(None, 1.9, 4),
        (
            f"simulations failed and were left out; the first: {RUNS_AWAY}",
            f"the first point could not be simulated: {RUNS_AWAY} (at a = 1.9)",
        ),
    ),
    # ── identification: why a start ended ───────────────────────────────────────────────────────────────────────────
    "few trials": Case(
        lambda: da.identify(DECAY, _exact(DECAY, [2.0, 0.8]), method=LeastSquares(trials=2), starts=1, horizon=None),
        ("Not converged: stopped after 2 trial points, not converged; allow more with LeastSquares(trials=...)",),
    ),
    "perfect at once": Case(
        lambda: da.identify(SLOPE, _exact(SLOPE, [0.5]), starts=1), ("converged: the fit is perfect",)
    ),
    "nothing changes": Case(
        lambda: da.identify(
            _model(lambda a: TIMES + 0 * a, a=(0.0, 1.0)), Measurements.of(TIMES, {"x": TIMES + 1}), starts=1
        ),
        ("converged: the residual does not change with the parameters",),
    ),
    "less gained": Case(lambda: _slope(LeastSquares()), ("converged: the sum of squares falls no more",)),
    "no move": Case(
        lambda: _slope(LeastSquares(tolerance=0.5, gain=1e-15)), ("converged: the parameters move no more",)
    ),
    "no fall": Case(
        lambda: _slope(LeastSquares(tolerance=0.9, gain=0.9), start=[1.0]),
        ("converged: the sum of squares falls no more",),
    ),
    "no complex step": Case(
        lambda: da.identify(
            _model(_real_alone, a=(0.0, 3.0)),
            Measurements.of(TIMES, {"x": np.exp(2.0) * TIMES}),
            method=LeastSquares(),
            start=[0.5],
            starts=1,
            horizon=None,
        ),
        ("the sensitivities could not be computed: ",),
    ),
    "regularised, no move": Case(
        lambda: _slope(ResponseSensitivity(tolerance=0.1, gain=1e-15), start=[1.0]),
        ("converged: the parameters move no more",),
    ),
    "regularised, less gained": Case(
        lambda: da.identify(DECAY, _exact(DECAY, [2.0, 0.8], noise=0.05), method=ResponseSensitivity(), starts=1),
        ("converged: the sum of squares falls no more",),
    ),
    "regularised, within the noise": Case(
        lambda: _slope(ResponseSensitivity("discrepancy", noise=0.1), start=[1.0]),
        ("converged: what is left is within the noise",),
    ),
    "regularised, held": Case(
        lambda: da.identify(
            SLOPE, Measurements.of(TIMES, {"x": -TIMES}), method=ResponseSensitivity(), start=[0.0], starts=1
        ),
        ("converged: bounds hold all parameters that the residual changes with",),
    ),
    "regularised, perfect": Case(
        lambda: da.identify(SLOPE, _exact(SLOPE, [0.5]), method=ResponseSensitivity(), starts=1),
        ("converged: the fit is perfect",),
    ),
    "regularised, nothing changes": Case(
        lambda: da.identify(
            _model(lambda a: TIMES + 0 * a, a=(0.0, 1.0)),
            Measurements.of(TIMES, {"x": TIMES + 1}),
            method=ResponseSensitivity(),
            starts=1,
        ),
        ("converged: the residual does not change with the parameters",),
    ),
    "regularised, few steps": Case(
        lambda: da.identify(
            DECAY, _exact(DECAY, [2.0, 0.8]), method=ResponseSensitivity(iterations=1), starts=1, horizon=None
        ),
        ("stopped after 1 steps, not converged; allow more with ResponseSensitivity(iterations=...)",),
        ("l-curve", "steps"),
    ),
    "regularised, few trials": Case(
        lambda: da.identify(
            DECAY, _exact(DECAY, [2.0, 0.8]), method=ResponseSensitivity(trials=2), starts=1, horizon=None
        ),
        ("stopped after 2 trial points, not converged; allow more with ResponseSensitivity(trials=...)",),
    ),
    "regularised, unsimulated": Case(
        lambda: _unsimulated(ResponseSensitivity(), 1.9, 4), ("the first point could not be simulated",)
    ),
    "swarms": Case(
        lambda: _unsimulated(ParticleSwarm(1, 1), 1.9, 6), ("all 1 iterations done", "every sample of the swarm failed")
    ),
    "a minimiser of SciPy": Case(lambda: _unsimulated(Minimiser("Nelder-Mead"), 1.9, 6), ("every sample failed",)),
    # ── identification: the integrator ──────────────────────────────────────────────────────────────────────────────
    "coarse steps": Case(
        lambda: da.identify(Stepped(method=slow_in_steps), exact(1e-3, 1e-3), starts=1),
        ("The integrator biases", "with corrected values", "bias by the integrator", "leave residuals"),
    ),
    "coarse steps that bias no parameter": Case(
        lambda: da.identify(Stepped(method=quick_in_steps), exact(1e-3, 1e-3), starts=1),
        (
            "The integrator biases no parameter by more than 0.5 standard deviations.",
            "A fit with converged steps",
        ),
    ),
    "too narrow bands": Case(
        lambda: da.identify(
            DECAY,
            Measurements.of(TIMES, {"x": np.where(TIMES < 2.05, 2.0, 3.0) * np.exp(-0.8 * TIMES)}, 0.02),
            validation=0.4875,
        ),
        ("The 95 % bands contain", "% of the values that were not fitted", "of these values"),
    ),
    "data of the same steps": Case(
        lambda: da.identify(Stepped(), _of_the_same_steps(), starts=1),
        ("The data contain the same error, as data simulated with the same steps do.",),
    ),
    "a finer simulation that fails": Case(
        lambda: da.identify(Stepped(finer=failing), exact(1e-3, 1e-3), starts=1),
        ("The error of the integrator was not estimated: the simulation at half the step failed",),
    ),
    "segments that did not merge, of a model with steps": Case(
        lambda: da.identify(
            Stepped(),
            exact(deviations=1e-3),
            shooting=da.MultipleShooting({"size": da.ShootingState("x", 0.01, 4.0)}, segments=2),
            starts=1,
        ),
        ("the response is that of 2 segments, which one simulation does not follow",),
    ),
    "errors that grow, of a model with steps": Case(
        lambda: da.identify(
            Stepped(method=growing_in_steps),
            Measurements.of(STEPPED_TIMES, {"x": growing_in_steps(2.8, 2.0, 0.0)}, 1.0),
            shooting=da.MultipleShooting({"size": da.ShootingState("x", 0.01, 1e6)}, segments=4),
            starts=1,
        ),
        ("a small change of the initial state grows",),
    ),
    # ── identification: what was kept for validation, and several experiments ───────────────────────────────────────
    "a share of the samples": Case(
        lambda: da.identify(DECAY, _exact(DECAY, [2.0, 0.8], noise=0.02), validation=0.5),
        ("Not fitted: the last 20 of 41 samples. There the weighted residuals are", "times those of the fit."),
    ),
    "a share that is predicted badly": Case(
        lambda: da.identify(
            DECAY,
            Measurements.of(
                TIMES, {"x": DECAY.function(2.0, 0.8) + np.where(TIMES > 2, 0.5, 0.01 * np.sin(9 * TIMES))}
            ),
            validation=0.5,
        ),
        ("; the model lacks something that shows there, or the fitted data do not determine all parameters",),
    ),
    "a share that does not vary": Case(
        lambda: da.identify(
            DECAY,
            Measurements.of(TIMES, {"x": np.where(TIMES < 2.05, DECAY.function(2.0, 0.8), 0.4)}, 0.02),
            validation=0.4875,
        ),
        ("undefined (constant data)",),
    ),
    "an experiment that is predicted badly": Case(
        lambda: da.identify(
            [_experiments()[0], Experiment("b", DECAY, measured(DECAY, [3.0, 0.2], 0.02, 1, deviations=0.02))],
            validation="b",
        ),
        ("of the variation of the held-out record 'b'",),
    ),
    "a share beside a perfect fit": Case(
        lambda: da.identify(SLOPE, _exact(SLOPE, [0.5]), starts=1, validation=0.5), ("those of the fit 0.",)
    ),
    "several experiments": Case(
        lambda: da.identify(_experiments(), validation=0.25),
        ("Not fitted: what comes after", "% of each experiment's time.", "The shaded part was not fitted."),
        ("experiment-1-1", "experiment-2-1"),
    ),
    "an experiment for validation": Case(
        lambda: da.identify(_experiments(), validation="b"), ("Not fitted: the experiment 'b'.", "(predicted)")
    ),
    "experiments for validation": Case(
        lambda: da.identify(_experiments(names="abc"), validation=["b", "c"]),
        ("Not fitted: the experiments 'b', 'c'.",),
    ),
    # ── identification: what the data tell ──────────────────────────────────────────────────────────────────────────
    "on its lower bound": Case(
        lambda: da.identify(SLOPE, Measurements.of(TIMES, {"x": -TIMES})),
        ("'a' is at its lower bound 0. Widen the bound if the true value may lie beyond it.",),
    ),
    "on its upper bound": Case(
        lambda: da.identify(SLOPE, Measurements.of(TIMES, {"x": 3 * TIMES})), ("'a' is at its upper bound 2.",)
    ),
    "unseen": Case(
        lambda: da.identify(GHOST, _exact(GHOST, [1.0, 0.5], noise=0.1)),
        ("'ghost' is not identifiable: it, or a combination with it, does not change the response. Fix it,",),
    ),
    "hardly told": Case(
        lambda: da.identify(SLOPE, _exact(SLOPE, [1.0], noise=9.0, deviations=9.0)),
        ("'a' is hardly identifiable: its standard deviation",),
    ),
    "a combination that is unseen": Case(
        lambda: da.identify(SUM, _exact(SUM, [0.5, 1.0], noise=0.1, deviations=0.1)),
        ("Only a combination of 'a' and 'b' is identifiable: changing 'a' by +0.2 and 'b' by -0.2 together does not ",),
    ),
    "a combination within the noise": Case(
        lambda: da.identify(
            _model(lambda a, b: (a + b) * TIMES + 1e-3 * b * TIMES**2, a=(0.0, 2.0), b=(0.0, 2.0)),
            _exact(SUM, [0.5, 1.0], noise=0.1, deviations=0.1),
        ),
        ("together changes the response by less than its noise. Fix one of them",),
    ),
    "converged in part, a combination within the error of the integrator": Case(
        lambda: da.identify(*stepped_product(), starts=1, start=(0.8, 3.0), horizon=None),
        (
            "Converged, except along 1 direction that the data do not identify (change 'rate' by",
            "together changes the response by less than the error of the integrator. Fix one of them",
        ),
    ),
    "a pair": Case(
        lambda: da.identify(
            _model(lambda a, b: (a + b) * TIMES + 0.1 * b * TIMES**2, a=(0.0, 2.0), b=(0.0, 2.0)),
            _exact(SUM, [0.5, 1.0], noise=0.01, deviations=0.01),
        ),
        ("'a' and 'b' are hardly distinguishable (correlation -0.99",),
    ),
    "a prior": Case(
        lambda: identifiability(
            PythonModel(
                LINE.function,
                {"offset": (-5, 5), "slope": Parameter("slope", -5.0, 5.0, deviation=1e-5)},
                ["x", "y"],
                TIMES,
            ),
            deviations=0.1,
        ),
        (
            "The data add nothing to the prior of 'slope': its standard deviation is 1e-05 in the prior and 1e-05 with the data.",
        ),
    ),
    "two priors": Case(
        lambda: identifiability(
            PythonModel(SUM.function, {name: Parameter(name, 0.0, 2.0, deviation=0.1) for name in "ab"}, ["x"], TIMES),
            deviations=1e-3,
        ),
        ("Only the priors distinguish 'a' and 'b': changing 'a' by +0.1 and 'b' by -0.1 together changes",),
    ),
    "many priors": Case(
        lambda: identifiability(
            PythonModel(
                lambda **e: sum(e.values()) * TIMES,
                {f"e{k}": Parameter(f"e{k}", -1.0, 1.0, deviation=0.1) for k in range(9)},
                ["x"],
                TIMES,
            ),
            deviations=1e-3,
        ),
        (
            "The data add little to the priors of 8 combinations of the parameters 'e0', 'e1', 'e2', 'e3' and 5 others.",
            "This is usual for the coefficients of an unknown history. For other parameters, measure a quantity that depends on them.",
        ),
    ),
    "no sensitivities": Case(
        _blind,
        (
            "Identifiability is not known: the model has no sensitivities at the identified values.",
            "No bands: the fit has no standard deviations, since the model has no sensitivities.",
        ),
    ),
    "a look before": Case(
        lambda: "\n".join(foreseen(LINE, _exact(LINE, [1.0, -0.5], deviations=0.1))),
        ("At the first guesses: All parameters are identifiable.",),
    ),
    "a look before, noise unknown": Case(
        lambda: "\n".join(foreseen(LINE, _exact(LINE, [1.0, -0.5]))),
        (
            "The noise of the data is not given: only parameters that exact data of these channels cannot identify are listed.",
        ),
    ),
    "a look before that fails": Case(
        lambda: "\n".join(foreseen(FRAGILE, _exact(FRAGILE, [0.4]))),
        (f"Identifiability could not be computed in advance: {RUNS_AWAY}",),
    ),
    "a look before, data in another unit": Case(
        lambda: "\n".join(foreseen(SLOPE, _exact(SLOPE, [500.0], deviations=0.1))),
        (
            "At the first guesses: The data of 'x' vary 1e+03 times as much as the response at the first guesses.",
            "Is a metric prefix wrong, such as mm for m?",
            "Give the unit of the column in units.",
        ),
    ),
    "angles in degrees": Case(
        lambda: _turned(180 / np.pi),
        ("Are the data in degrees?", "The fit changes 'a' by such a factor to make up for it."),
    ),
    "angles that were converted twice": Case(
        lambda: _turned(np.pi / 180), ("Were data in radians converted from degrees?",)
    ),
    # ── integrators ──
    "integrators": Case(
        lambda: _integrators(1e-4),
        (
            "The reference is GeneralizedAlpha(step=0.0001); by a second one it is known to about",
            "compared",
        ),
        ("work-precision",),
    ),
    "integrators of which some end early": Case(
        lambda: _integrators(1e-4, most_steps=2),
        ("1 of 3 runs ended early; the table has the reasons.", "reached most_steps = 2"),
    ),
    "integrators beside a reference that is exact": Case(
        lambda: replace(_integrators(1e-4), apart=0.0), ("by a second one it is known to rounding",)
    ),
    "integrators that all end early": Case(
        lambda: replace(found := _integrators(1e-4, most_steps=2), rows=found.rows[-1:]), ("not compared",)
    ),
    # ── profiles, predictions, designs ──────────────────────────────────────────────────────────────────────────────
    "profiles and prediction": Case(
        _all_told,
        (
            "95 % intervals of 'size' and 'rate' from profile likelihoods, noise level from given standard deviations.",
            "The 95 % band of the response is at most",
            "The noise level follows from given standard deviations. The bands assume that the model is right",
        ),
        ("profile-1", "profile-2", "prediction-1", "l-curve", "steps"),
    ),
    "profiles, noise unknown": Case(
        lambda: _profiled(DECAY, _exact(DECAY, [1.0, 0.8], noise=0.05)), ("noise level from residuals.",)
    ),
    "prediction, noise unknown": Case(
        lambda: predict(DECAY, da.identify(DECAY, _exact(DECAY, [1.0, 0.8], noise=0.05))),
        ("The noise level follows from residuals.",),
    ),
    "open profiles": Case(
        lambda: _profiled(SUM, _exact(SUM, [0.5, 1.0], noise=0.01, deviations=0.01), names=["a"]),
        ("The data give no lower limit of 'a': all values up to its bound 0 explain them within their noise.",),
    ),
    "flat profile": Case(
        lambda: _profiled(GHOST, _exact(GHOST, [1.0, 0.5], noise=0.1, deviations=0.1), names=["ghost"]),
        ("'ghost' is not identifiable: all values between its bounds explain the data within their noise.",),
    ),
    "asymmetric profile": Case(_asymmetric, ("The interval of 'rate' is asymmetric,", "the standard deviation")),
    "profile in two pieces": Case(
        lambda: _profiled(
            _model(lambda a: a**2 * TIMES, a=(-3.0, 2.0)),
            _exact(_model(lambda a: a**2 * TIMES, a=(-3.0, 2.0)), [1.5], noise=0.1, deviations=0.1),
        ),
        ("The data also allow values of 'a' from",),
    ),
    "profile of no minimum": Case(_no_minimum, ("There is a better minimum near offset =",)),
    "profile into overflow": Case(
        lambda: _broken_profile(_jump),
        ("The upper side of the profile of 'rate' is incomplete: the misfit is not finite.",),
    ),
    "profile with few points": Case(
        lambda: _profiled(DECAY, _exact(DECAY, [1.0, 0.8], noise=0.5, deviations=0.5), points=4),
        ("is incomplete: the threshold was not reached; increase points.",),
    ),
    "band without an end": Case(
        lambda: predict(
            PythonModel(lambda a, b: np.stack([a * TIMES, (a + b) * TIMES], axis=1), SUM.parameters, ["y", "x"], TIMES),
            da.identify(SUM, _exact(SUM, [0.5, 1.0], noise=0.1, deviations=0.1)),
        ),
        ("The band of 'y' is infinitely wide: it depends on a combination of the parameters that the data do not",),
    ),
    "designs": Case(
        lambda: design(LINE, deviations=0.1, horizons=[1.0, 4.0]),
        ("The best design is", "of the scales.", "times worse.", "The ranking holds near offset ="),
        ("ranking", "horizons"),
    ),
    "designs by the largest deviation": Case(
        lambda: design(LINE, deviations=0.1, criterion="E"), ("largest standard deviation",)
    ),
    "designs that tell too little": Case(
        lambda: design(SUM, deviations=0.1), ("No design identifies all parameters:",)
    ),
    "designs of which some tell too little": Case(
        lambda: design(
            PythonModel(lambda a, b: np.stack([a * TIMES, (a + b) * TIMES], axis=1), SUM.parameters, ["p", "q"], TIMES),
            deviations=9.0,
            sensors=["p", ("p", "q")],
        ),
        ("would leave a combination of the parameters unidentifiable.", "Even the best design hardly identifies"),
    ),
    # ── intervals from bands ────────────────────────────────────────────────────────────────────────────────────────
    "exact bands": Case(
        lambda: da.identify_bands(DECAY, BANDS),
        ("points where the surrogate has its minima and maxima, it differs from runs of the model by at most",),
        ("intervals", "residual-bands-1", "convergence"),
        {"truth": {"size": (1.8, 2.2)}},
    ),
    "rounded bands": Case(
        lambda: da.identify_bands(
            DECAY, Bands.of(TIMES, {"x": (BANDS.lower[:, 0].round(4), BANDS.upper[:, 0].round(4))})
        ),
        ("The given bands are reproduced to the digits that they are rounded to.",),
    ),
    "bands of zero width": Case(
        lambda: da.identify_bands(DECAY, Bands.of(TIMES, {"x": (1 + np.cos(3 * TIMES), 1 + np.cos(3 * TIMES))})),
        ("(SI unit; the given bands have no width)",),
    ),
    "noisy bands": Case(
        lambda: da.identify_bands(DECAY, _noisy_bands()),
        ("of their mean width; the largest difference", "The remaining differences are not correlated."),
    ),
    "a slip in the bands": Case(
        lambda: da.identify_bands(DECAY, _spoilt_bands()), ("One bound is an outlier:", "Check it.")
    ),
    "bands of another model": Case(
        lambda: da.identify_bands(DECAY, Bands.of(TIMES, {"x": (np.cos(3 * TIMES) - 0.1, np.cos(3 * TIMES) + 0.1)})),
        ("The bands are inconsistent: no box of the parameters gives them.",),
    ),
    "an interval on its bound": Case(
        lambda: da.identify_bands(
            PythonModel(DECAY.function, {"size": (1.9, 4.0), "rate": (0.1, 3.0)}, ["x"], TIMES), BANDS
        ),
        ("The lower end of 'size' is at its bound 1.9.",),
    ),
    "a radius of zero": Case(
        lambda: da.identify_bands(DECAY, banded(DECAY, [2.0, 0.7], [2.0, 0.9])),
        ("The radius of 'size' is zero: one value of it explains the bands.",),
    ),
    "a radius that may be zero": Case(
        _trembling, ("does not differ significantly from zero: the bands do not show that it varies.",)
    ),
    "bands without a check": Case(
        lambda: da.identify_bands(DECAY, BANDS, method=GlobalSurrogate(Adaptive(1e-6), checks=0)),
        ("The bounds of the surrogate are not checked by runs of the model.",),
    ),
    "bands with one descent": Case(
        lambda: da.identify_bands(DECAY, BANDS, method=GlobalSurrogate(starts=1)),
        ("Only one of the descents reached the smallest misfit: another minimum may be better. Increase starts.",),
    ),
    "bands with failing runs": Case(_tired, ("simulations failed and were left out; the first: RuntimeError: enough",)),
    # ── sets ────────────────────────────────────────────────────────────────────────────────────────────────────────
    "a set": Case(
        lambda: da.identify_set(DISC, AT_ZERO, error=1.0),
        ("Paved: all boxes at the boundary of the set are as small as the resolution.",),
        ("paving-1",),
    ),
    "an empty set": Case(
        lambda: da.identify_set(DISC, Measurements.of(NOW, {"r": [10.0]}), error=0.5),
        (
            "No parameters within the bounds are consistent with the data:",
            "The nearest run, at x = 2, y = 2, differs by 4 times the error in channel 'r'",
        ),
    ),
    "a thin set": Case(
        lambda: da.identify_set(DISC, Measurements.of(NOW, {"r": [1.0]}), error=1e-3),
        ("Paved, but no box lies completely in the set:",),
    ),
    "too few boxes": Case(
        lambda: da.identify_set(DISC, AT_ZERO, error=1.0, resolution=1e-3, most_boxes=300),
        ("The paving stopped before all boxes at the boundary of the set were as small as the resolution:",),
    ),
    "a set by a coarse surrogate": Case(
        lambda: da.identify_set(
            PythonModel(lambda x: np.array([1 / (1 + 25 * x**2)]), {"x": (-1.0, 1.0)}, ["y"], NOW),
            Measurements.of(NOW, {"y": [1.0]}),
            error=0.2,
            scheme=Tensor(2),
        ),
        ("The surrogate's error is up to", "times that of the data and widens the boundary by as much."),
    ),
    "a set whose surrogate is wrong": Case(
        _spiked, ("At corners of the inner box, runs of the model differ from the data by more than their error:",)
    ),
    "a set with failing runs": Case(
        lambda: da.identify_set(
            PythonModel(_far, DISC.parameters, ["r"], NOW), AT_ZERO, error=1.0, scheme=TotalDegree(2, oversampling=4)
        ),
        ("simulations failed and were left out; the first: RuntimeError: too far",),
    ),
    # ── bounds ──────────────────────────────────────────────────────────────────────────────────────────────────────
    "bounds by optimisation": Case(
        lambda: da.propagate(DECAY, {"size": (1.8, 2.2), "rate": (0.7, 0.9)}, Optimise()),
        ("Every bound is the response of a run of the model. Further runs are not expected to widen the bounds.",),
        ("bands-1",),
    ),
    "bounds by too few runs": Case(
        lambda: da.propagate(WAVE, {"rate": (1.0, 20.0)}, Optimise(most_runs=20)),
        ("the search stopped at most_runs = 20 before it was finished. Increase most_runs.",),
    ),
    "bounds of a wave by its slope": Case(
        lambda: da.propagate(WAVE, {"rate": (1.0, 20.0)}, Taylor()),
        ("The error of the bounds is unknown: one linearised run", "Use method 'optimise' or 'chebyshev'."),
    ),
    "an enclosure that is wide": Case(
        lambda: da.propagate(NEAR_POLE, {"a": (-1.0, 1.0)}, Chebyshev(bounds="bernstein")),
        ("The enclosure by Bernstein coefficients is wider", 'Use Chebyshev(bounds="optimise") or a smaller box.'),
    ),
    "bounds where runs fail": Case(
        lambda: da.propagate(FRAGILE, {"a": (0.0, 1.0)}, Scan(11)), ("runs failed, the first:",)
    ),
    **{
        f"bounds by {type(method).__name__}{number}": Case(
            lambda method=method: da.propagate(DECAY, {"size": (1.8, 2.2), "rate": (0.7, 0.9)}, method), (sentence,)
        )
        for number, (method, sentence) in enumerate(
            [
                (Vertex(), "The bounds are the extremes over the corners of the box."),
                (Scan(5), "The bounds are the extremes over the points of a grid."),
                (MonteCarlo(9), "The bounds are the extremes over random points."),
                (LatinHypercube(9), "The bounds are the extremes over a Latin hypercube."),
                (Taylor(), "The response is linearised over the box,"),
                (Chebyshev(), "in place of the model, right within its estimated error."),
                (Chebyshev(bounds="scan"), "right within its estimated error but for peaks between the points"),
                (Chebyshev(bounds="bernstein"), "an enclosure of the surrogate, widened by its estimated error."),
            ]
        )
    },
    "methods compared": Case(
        lambda: da.compare(DECAY, {"size": (1.8, 2.2), "rate": (0.7, 0.9)}, ["vertex"]),
        ("Bounds of one response over one box. The error is the distance to optimise.",),
        ("methods", "differences"),
    ),
    "methods of which one gives up": Case(
        lambda: da.compare(WAVE, {"rate": (1.0, 20.0)}, [Chebyshev(Tensor(4))]),
        ("Not successful: ", "The table of methods has the reasons."),
    ),
    # ── multiple shooting ───────────────────────────────────────────────────────────────────────────────────────────
    "segments of data of unknown noise": Case(
        lambda: da.identify(
            DECAY,
            measured(DECAY, [2.0, 0.8], noise=0.01),
            shooting=da.MultipleShooting({"size": da.ShootingState("x", 0.0, 5.0)}, 4),
        ),
        ("The misfit equals the noise level of the data (estimated by local polynomials).",),
    ),
    "segments that must meet": Case(
        lambda: da.identify(
            DECAY,
            measured(DECAY, [2.0, 0.8], noise=0.01, deviations=0.01),
            shooting=da.MultipleShooting({"size": da.ShootingState("x", 0.0, 5.0)}, 4),
        ),
        (
            "The 4 segments meet within",
            "and merged into one run.",
            "By the last of these states a small change of the initial state has grown",
        ),
        ("gaps",),
    ),
    # ── motions and sweeps ──────────────────────────────────────────────────────────────────────────────────────────
    "a motion": Case(
        _pendulum,
        ("The energy balance is kept to", "% of the energy that moves; a smaller step lowers it."),
        ("mechanism", "energies", "violations", "newton"),
    ),
    "a motion with outputs": Case(
        lambda: (_pendulum(), {"channels": ("pin.angle",), "points": ("bar.end",)}),
        ("Outputs over time",),
        ("outputs-1",),
    ),
    "a motion that rests": Case(lambda: _pendulum(0.0), ("The motion was simulated to its end.",)),
    "a fit with its motion": Case(_moved_fit, ("Drawn to scale, played",), ("mechanism", "energies")),
    "experiments with their motions": Case(
        _moved_experiments,
        ("Not drawn: b.", "a: The 95 % band of the response"),
        ("mechanism-1", "energies-1", "prediction-1-1", "prediction-2-1"),
    ),
    "a sweep": Case(
        _study(SWEEP, DECAYING),
        ("one parameter varied at a time: rate.", "1 of them failed, see events.jsonl"),
        ("sweep-1",),
    ),
    **FREQUENCY_CASES,
    **INERTIAL_CASES,
    **MISTAKE_CASES,
    **POSTERIOR_CASES,
    **SENSITIVITY_CASES,
    **REGULARISED_CASES,
    **DECAY_CASES,
    **SPECIMEN_CASES,
}
