"""Write motion.csv: the engine's motion on the step of the studies, on a tenth of it, and that with noise."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from dalembert import TimeResponse
from dalembert.study import load

FOLDER = Path(__file__).parent
TRUTH = np.array([2e-4, 1.5e-3])  # J1 and J2, kg m²
TIMES = np.linspace(0, 2, 1001)
LEVELS = (1, 5, 10)  # of the noise, % of each channel's standard deviation
COLUMNS = {"crank.centre.angle": "crank", "rod.centre.angle": "rod", "piston.centre.x": "piston"}


def model(parts: int = 1) -> TimeResponse:
    """The engine's response by so many steps in one of the studies'."""
    study = load(FOLDER / "simulate.toml")
    solver = replace(study.solver, step=study.solver.step / parts)
    return TimeResponse(study.builder, study.parameters, list(COLUMNS), TIMES, solver=solver)


def noisy(motion: np.ndarray, level: float, seed: int) -> np.ndarray:
    """A motion, shape (samples, channels), with normal noise of so many per cent of each channel's deviation."""
    noise = np.random.default_rng(seed).standard_normal(motion.shape)
    return motion + level / 100 * motion.std(axis=0) * noise


def main() -> None:
    """Write the file."""
    same, fine = (model(parts).evaluate(TRUTH[None]).only()[0] for parts in (1, 10))
    motions = {"": same, "_fine": fine, **{f"_{level}": noisy(fine, level, level) for level in LEVELS}}
    np.savetxt(
        FOLDER / "motion.csv",
        np.column_stack([TIMES, *motions.values()]),
        fmt=["%.3f", *["%.12g"] * 6, *["%.5g"] * 3 * len(LEVELS)],
        delimiter=",",
        header=",".join(["t", *(name + suffix for suffix in motions for name in COLUMNS.values())]),
        comments="",
    )
    print("standard deviations of the channels:", dict(zip(COLUMNS, fine.std(axis=0), strict=True)))


if __name__ == "__main__":
    main()
