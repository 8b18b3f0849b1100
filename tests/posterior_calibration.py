"""Whether posteriors are calibrated: ranks of the truth among draws, and how often intervals contain the truth.

``python tests/posterior_calibration.py ranks|coverage decay|pendulum 200`` repeats it, and writes the results into a table.
"""

import json
import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import chi2

import dalembert as da
from dalembert.inverse.posterior.posed import with_priors
from dalembert.inverse.posterior.prior_density import PriorDensity

TABLE = Path(__file__).parent / "verification" / "references" / "posterior_calibration.json"
DRAWS = 99
"""Nearly independent draws with which the truth is ranked: 100 ranks."""

MORE = 10
"""Draws for intervals, in those for ranks: an interval from the 2.5 % quantile of few draws is too short."""

BINS = 20
TIMES = np.linspace(0.0, 2.0, 21)
SIGMA = 0.02  # rad, of the angle of the pendulum


@dataclass(frozen=True)
class Case:
    """A model, its noise, and how it is sampled; ``thin`` draws for each one that is ranked."""

    model: Callable[[], Any]
    noise: da.NoiseModel
    deviations: float | None
    settings: dict[str, Any]
    thin: int
    truth: dict[str, float] = field(default_factory=dict)


@cache
def decay() -> da.PythonModel:
    """A decay whose two parameters have log-normal and normal priors."""
    box = {
        "rate": da.Parameter("rate", 0.05, 10.0, prior=da.LogNormal(1.0, 0.4)),
        "height": da.Parameter("height", -2.0, 6.0, prior=da.Normal(2.0, 0.5)),
    }
    return da.PythonModel(lambda rate, height: height * np.exp(-rate * TIMES), box, ["x"], TIMES)


def pendulum(length: float, drag: float) -> da.System:
    """A rigid bar of 1 kg that swings with viscous friction in its pin."""
    system = da.System(gravity=(0.0, -9.81))
    bar = system.add(da.RigidBar("bar", length=length, mass=1.0, angle=-0.5))
    system.add(da.RevoluteJoint("pin", system.ground, bar.start, viscous=drag))
    return system


@cache
def mechanism() -> da.TimeResponse:
    """The angle of the pendulum over 2 s."""
    box = {
        "length": da.Parameter("length", 0.6, 1.4, prior=da.Normal(1.0, 0.03)),
        "drag": da.Parameter("drag", 0.0, 1.0, prior=da.HalfNormal(0.2)),
    }
    return da.TimeResponse(pendulum, box, ["bar.end.angle"], TIMES, solver=da.GeneralizedAlpha(step=0.01))


CASES = {
    "decay": Case(
        decay,
        da.ConstantNoise(deviation=(0.02, 0.2)),
        None,
        {"sampler": da.NUTS(), "chains": 1, "draws": 3 * DRAWS, "warmup": 80},
        thin=3,
        truth={"rate": 1.0, "height": 2.0, "noise.x.deviation": 0.1},
    ),
    "pendulum": Case(
        mechanism,
        da.KnownNoise(),
        SIGMA,
        {"surrogate": da.TotalDegree(4), "chains": 3, "draws": 66, "warmup": 200},
        thin=2,
        truth={"length": 1.0, "drag": 0.15},
    ),
}


def drawn(case: Case, seed: int) -> tuple[da.Parameters, np.ndarray]:
    """Parameters of a case, and a vector from their prior."""
    model = case.model()
    blank = da.Measurements.of(model.coordinate, _columns(model, np.zeros((len(TIMES), 1))), deviations=case.deviations)
    parameters = with_priors(da.likelihood(model, blank, noise=case.noise), None)
    return parameters, PriorDensity(parameters).draws(1, seed)[0]


def simulated(case: Case, parameters: da.Parameters, vector: np.ndarray, seed: int) -> da.Measurements:
    """Data of a case with the noise of a seed."""
    model = case.model()
    count = len(model.parameters)
    response = model.evaluate(vector[None, :count]).only()[0]
    sigma = case.deviations if case.deviations is not None else vector[count]
    noisy = response + sigma * np.random.default_rng([seed, 1]).standard_normal(response.shape)
    return da.Measurements.of(model.coordinate, _columns(model, noisy), deviations=case.deviations)


def ranks(name: str, seed: int) -> list[int]:
    """Ranks of a truth from the prior among draws of the posterior of its data, one for each parameter."""
    case = CASES[name]
    parameters, vector = drawn(case, seed)
    found = _sampled(case, simulated(case, parameters, vector, seed), vector, seed)
    return np.sum(found.flat[:: case.thin][:DRAWS] < vector, axis=0).tolist()


def covered(name: str, seed: int) -> list[bool]:
    """Whether 95 % intervals contain one truth, one for each parameter."""
    case = CASES[name]
    parameters, _ = drawn(case, 0)
    vector = parameters.vector(case.truth)
    data = simulated(case, parameters, vector, seed)
    intervals = _sampled(case, data, vector, seed, draws=MORE * case.settings["draws"]).intervals(0.95)
    return [bool(low <= value <= high) for value, (low, high) in zip(vector, intervals.values(), strict=True)]


def probability(ranked: list[list[int]], bins: int = BINS) -> list[float]:
    """Probability of a larger chi-square of ranks over bins if they are uniform, of each parameter."""
    table = np.array(ranked)
    counts = np.array([np.bincount(one * bins // (DRAWS + 1), minlength=bins) for one in table.T])
    expected = len(table) / bins
    return chi2.sf(np.sum((counts - expected) ** 2 / expected, axis=1), bins - 1).tolist()


def repeated(function: Callable[[str, int], Any], name: str, count: int, workers: int = 1) -> list[Any]:
    """Results of a function for the seeds from 0."""
    if workers == 1:
        return [function(name, seed) for seed in range(count)]
    with ProcessPoolExecutor(workers) as pool:
        return list(pool.map(partial(function, name), range(count), chunksize=5))


def _sampled(case: Case, data: da.Measurements, vector: np.ndarray, seed: int, **settings: int) -> da.Posterior:
    model = case.model()
    start = vector[: len(model.parameters)]
    return da.sample(model, data, noise=case.noise, start=start, seed=seed, **(case.settings | settings))


def _columns(model: Any, values: np.ndarray) -> dict[str, np.ndarray]:
    return {channel.name: values[:, column] for column, channel in enumerate(model.channels)}


def main(task: str, name: str, count: int) -> None:
    """Repeat a task and write its results into the table."""
    table = json.loads(TABLE.read_text(encoding="utf-8")) if TABLE.exists() else {}
    found = repeated({"ranks": ranks, "coverage": covered}[task], name, count, workers=2)
    result = {"repetitions": count}
    if task == "ranks":
        result |= {"probability": probability(found), "ranks": found}
    else:
        result["share"] = np.mean(found, axis=0).tolist()
    table[f"{task} {name}"] = result
    TABLE.write_text(json.dumps(table, indent=1, sort_keys=True) + "\n", encoding="utf-8")
    sys.stdout.write(f"{ {key: value for key, value in result.items() if key != 'ranks'} }\n")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], int(sys.argv[3]))
