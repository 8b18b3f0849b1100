"""Swarms beside other minimisers on the published cases: 20 seeds each, 4,000 evaluations a run.

The response is that of a Chebyshev surrogate, made once a case from a few hundred simulations, so that 20 seeds of
eight methods take minutes and not days. Its error stands in the table: a misfit below the square of it is the
surrogate's own. The rows "on the simulation" repeat some seeds without it. The data of the deterministic cases are
our own simulation at the published truth, unrounded. Those of the interval cases are the printed tables: the unknowns
are midpoints and radii, and the misfit is that of the surrogate's bounds on the box that they make.
"""

import json
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks import timing
from benchmarks.minimisers import METHODS, Method
from dalembert.data import Bands, read_bands
from dalembert.forward import ForwardModel
from dalembert.study import load
from dalembert.surrogate import Adaptive, Surrogate, Tensor, bounds, fit
from dalembert.surrogate.scheme import Scheme

STUDIES = Path(__file__).parents[1] / "studies"
SEEDS = range(20)
SEEDS_SIMULATED = range(2)
TIP = ("AB.end.x", "AB.end.y")
TIMES = np.arange(41) * 0.05


@dataclass(frozen=True)
class Case:
    """A misfit over a box, the published values of the standard and the improved swarm, and the surrogate's error."""

    name: str
    misfit: Callable[[np.ndarray], np.ndarray]
    lower: np.ndarray
    upper: np.ndarray
    published: tuple[float, float]
    error: float


DETERMINISTIC = {
    "deterministic 1": ("identify", (np.pi / 4, np.pi / 6), (6.0323e-6, 1.6541e-8)),
    "deterministic 2": ("identify-case2", (np.pi / 3, np.pi / 4), (6.6317e-7, 2.1591e-8)),
}
INTERVAL = {
    "interval 1, Table A2": ("bands-a2", "table-a2.csv", (4.2303e-5, 2.1717e-6)),
    "interval 2, Table A3": ("bands-a3", "table-a3.csv", (1.5754e-4, 3.0576e-5)),
    "interval 3, Table A4": ("bands-a4", "table-a4.csv", (2.6023e-5, 6.0421e-5)),
}
"""Published: Guo & Jin 2025, 40 particles, 100 iterations, one value each: misfit of SPSO, of IPSO."""


def main(chosen: Sequence[str] = ()) -> list[dict[str, object]]:
    """All cases, or those whose name contains one of the chosen words; what is kept of the others stays."""
    rows = _kept()
    for name in [*DETERMINISTIC, *INTERVAL]:
        if not chosen or any(word in name for word in chosen):
            rows = [row for row in rows if not str(row["case"]).startswith(name)] + _rows(name)
            rows.sort(key=lambda row: str(row["case"]))
            timing.report("swarms", "Misfit after 4,000 evaluations", rows)
    return rows


def _rows(name: str) -> list[dict[str, object]]:
    if name in INTERVAL:
        study, table, published = INTERVAL[name]
        case = _interval(name, _model("interval-pendulum", study), _given(table), published)
        return [_row(case, method, SEEDS) for method in METHODS]
    study, truth, published = DETERMINISTIC[name]
    model = _model("flexible-pendulum", study)
    data = model.evaluate(np.array([truth])).only().reshape(-1)
    rows = [_row(_deterministic(name, model, data, published), method, SEEDS) for method in METHODS]
    return [*rows, _row(_simulated(name, model, data, published), "IPSO as published", SEEDS_SIMULATED)]


def _kept() -> list[dict[str, object]]:
    path = timing.RESULTS / "swarms.json"
    return json.loads(path.read_text())["rows"] if path.is_file() else []


def _row(case: Case, method: str, seeds: Sequence[int]) -> dict[str, object]:
    run: Method = METHODS[method]
    ends = np.array([run(case.misfit, case.lower, case.upper, seed) for seed in seeds])
    quartiles = np.quantile(ends, [0.25, 0.5, 0.75])
    return {
        "case": case.name,
        "method": method,
        "seeds": len(ends),
        "best": float(ends.min()),
        "quartile": float(quartiles[0]),
        "median": float(quartiles[1]),
        "third quartile": float(quartiles[2]),
        "worst": float(ends.max()),
        "published SPSO": case.published[0],
        "published IPSO": case.published[1],
        "surrogate error": case.error,
    }


def _model(folder: str, study: str) -> ForwardModel:
    return load(STUDIES / folder / f"{study}.toml").forward(TIP, TIMES)


def _given(table: str) -> Bands:
    columns = {"AB.end.x": ("x_lower", "x_upper"), "AB.end.y": ("y_lower", "y_upper")}
    return read_bands(STUDIES / "interval-pendulum" / table, columns=columns)


def _surrogate(model: ForwardModel, scheme: Scheme) -> Surrogate:
    box = model.parameters
    return fit(lambda x: model.evaluate(x).only().reshape(len(x), -1), box.lower, box.upper, scheme)


def _deterministic(name: str, model: ForwardModel, data: np.ndarray, published: tuple[float, float]) -> Case:
    surrogate, box = _surrogate(model, Tensor(16)), model.parameters
    return Case(
        name,
        lambda x: np.sum((surrogate(x) - data) ** 2, axis=1),
        box.lower,
        box.upper,
        published,
        float(np.max(surrogate.error)),
    )


def _simulated(name: str, model: ForwardModel, data: np.ndarray, published: tuple[float, float]) -> Case:
    def misfit(x: np.ndarray) -> np.ndarray:
        return np.sum((model.evaluate(x).values.reshape(len(x), -1) - data) ** 2, axis=1)

    return Case(f"{name}, on the simulation", misfit, model.parameters.lower, model.parameters.upper, published, 0.0)


def _interval(name: str, model: ForwardModel, given: Bands, published: tuple[float, float]) -> Case:
    """Midpoints anywhere in the search box, radii up to a quarter of its width, the box clipped to the search box."""
    box, d = model.parameters, len(model.parameters)
    surrogate = _surrogate(model, Tensor(12) if d == 2 else Adaptive(1e-4, most_runs=500))

    def misfit(x: np.ndarray) -> np.ndarray:
        middle, radius = x[:, :d], x[:, d:]
        found = bounds(surrogate.polynomial, box.clip(middle - radius), box.clip(middle + radius), points=6, starts=2)
        apart = np.stack([found.lower - given.lower.ravel(), found.upper - given.upper.ravel()])
        return np.sum(apart**2, axis=(0, 2))

    lower = np.concatenate([box.lower, np.zeros(d)])
    upper = np.concatenate([box.upper, (box.upper - box.lower) / 4])
    return Case(name, misfit, lower, upper, published, float(np.max(surrogate.error)))


if __name__ == "__main__":
    main(sys.argv[1:])
