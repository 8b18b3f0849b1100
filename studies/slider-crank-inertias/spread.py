"""Print how far the inertias are off at each level of noise: median, mean and spread over many draws of the noise."""

import sys

import numpy as np
from make_data import COLUMNS, LEVELS, TIMES, TRUTH, model, noisy

from dalembert import Measurements, ResponseSensitivity, identify

START = np.array([3.5e-4, 0.9e-3])
STEPS = 10  # of the data in one of the identification


def errors(level: float, seeds: int) -> np.ndarray:
    """Relative errors, shape (seeds, 2), where the data of so many seeds have a noise of so many per cent."""
    engine, motion = model(), model(STEPS).evaluate(TRUTH[None]).only()[0]
    deviations = dict(zip(COLUMNS, level / 100 * motion.std(axis=0), strict=True))
    found = []
    for seed in range(seeds):
        channels = dict(zip(COLUMNS, noisy(motion, level, seed).T, strict=True))
        data = Measurements.of(TIMES, channels, deviations)
        found.append(identify(engine, data, method=ResponseSensitivity(), starts=1, start=START).values)
    return np.array(found) / TRUTH - 1


def main(seeds: int = 20) -> None:
    """Print the table."""
    print(f"errors of J1 and J2 over {seeds} seeds, %\nnoise %   median of size     mean (bias)        spread")
    for level in LEVELS:
        off = 100 * errors(level, seeds)
        rows = (np.median(np.abs(off), axis=0), off.mean(axis=0), off.std(axis=0, ddof=1))
        print(f"{level:7g}   " + "   ".join(f"{first:7.4f} {second:7.4f}" for first, second in rows))


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
