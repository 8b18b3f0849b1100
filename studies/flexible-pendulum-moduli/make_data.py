"""Write motion.csv: joint and tip of the pendulum on half the step of the study, with 0.2 mm of noise."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from dalembert import simulate
from dalembert.study import load

FOLDER = Path(__file__).parent
CHANNELS = ["OA.end.x", "OA.end.y", "AB.end.x", "AB.end.y"]
TIMES = np.arange(101) * 0.02
NOISE = 2e-4  # m


def main() -> None:
    """Write the file."""
    study = load(FOLDER / "simulate.toml")
    solver = replace(study.solver, step=study.solver.step / 2)
    motion = simulate(study.system(), TIMES[-1], solver=solver, times=TIMES).channels(CHANNELS)
    motion += NOISE * np.random.default_rng(0).standard_normal(motion.shape)
    rows = np.column_stack([TIMES, motion])
    np.savetxt(
        FOLDER / "motion.csv", rows, fmt=["%.2f", *["%.6f"] * 4], delimiter=",", header="t,ax,ay,bx,by", comments=""
    )


if __name__ == "__main__":
    main()
