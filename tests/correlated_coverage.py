"""How often 95 % intervals of a line contain the truth under autoregressive noise that is not stated.

``python tests/correlated_coverage.py 1000 5000`` repeats it with 1000 seeds from 5000 on, and writes the shares into a table.
The correction was chosen with seeds below 5000.
"""

import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import dalembert as da
from correlated_noise import autoregressive
from dalembert.inverse.least_squares.estimate import estimate
from dalembert.inverse.noise.correlation.correlation import correlation
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import pose

TABLE = Path(__file__).parent / "verification" / "references" / "correlated_coverage.json"
LEVEL = 0.95
TRUTH = np.array([1.0, 0.5])
CASES = [(samples, lag1) for samples in (60, 200) for lag1 in (0.0, 0.4, 0.8)]


def covered(samples: int, lag1: float, seeds: range) -> dict[str, float]:
    """Return the shares of seeds, in percent, in which the interval of each parameter contains the truth.

    The model is linear, so that its minimum is that of linear least squares, and only the noise needs a study.
    """
    times = np.linspace(0.0, 10.0, samples)
    bounds = {"offset": (-9.0, 9.0), "slope": (-9.0, 9.0)}
    model = da.PythonModel(lambda offset, slope: offset + slope * times, bounds, ["x"], times)
    columns = np.stack([np.ones(samples), times], axis=1)
    scale = model.parameters.scale
    first = da.Measurements.of(times, {"x": columns @ TRUTH + 0.1 * autoregressive(seeds[0], samples, lag1)})
    fit = da.identify(model, first, starts=1, horizon=None)
    hits = np.zeros(2)
    for seed in seeds:
        data = da.Measurements.of(times, {"x": columns @ TRUTH + 0.1 * autoregressive(seed, samples, lag1)})
        values = np.linalg.lstsq(columns, data.values[:, 0], rcond=None)[0]
        response = (columns @ values)[:, None]
        residual, slopes = (response - data.values)[:, 0], columns * scale
        variance = float(residual @ residual) / (samples - 2)
        found = correlation(
            pose(model, data, None, Journal(samples)), response, slopes, residual, variance, known=False
        )
        deviations = estimate(slopes, scale, variance if found is None else found.noise).deviations
        one = replace(fit, data=data, values=values, deviations=deviations, correlated=found)
        if seed == seeds[0]:  # these are the numbers of an identification
            np.testing.assert_allclose([one.values, one.deviations], [fit.values, fit.deviations], rtol=1e-6)
        ends = np.array(list(one.intervals(LEVEL).values()))
        hits += (ends[:, 0] <= TRUTH) & (ends[:, 1] >= TRUTH)
    return dict(zip(model.parameters.names, (100 * hits / len(seeds)).round(2).tolist(), strict=True))


def main(count: int, first: int) -> None:
    seeds = range(first, first + count)
    table = [{"samples": samples, "lag1": lag1} | covered(samples, lag1, seeds) for samples, lag1 in CASES]
    TABLE.write_text(json.dumps({"seeds": count, "first": first, "cases": table}, indent=1) + "\n", encoding="utf-8")
    sys.stdout.write("".join(f"{row}\n" for row in table))


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
