"""Write high.csv and low.csv: the angles of the pendulum let go high and low, with 0.5 degrees of noise."""

from pathlib import Path

import numpy as np

from dalembert.study import load

FOLDER = Path(__file__).parent
BEGINS = {"high": (-20.0, 10.0), "low": (-50.0, -50.0)}  # of upper and lower bar, degrees
TIMES = np.arange(151) * 0.02
NOISE = np.deg2rad(0.5)


def main() -> None:
    """Write the files."""
    study, draw = load(FOLDER / "simulate.toml"), np.random.default_rng(0)
    for name, begins in BEGINS.items():
        begun = dict(zip(("alpha", "beta"), np.deg2rad(begins).tolist(), strict=True))
        motion = study.varied(begun, {}).motion(TIMES[-1], times=TIMES)
        angles = motion.channels(["upper.centre.angle", "lower.centre.angle"])
        angles += NOISE * draw.standard_normal(angles.shape)
        rows = np.column_stack([TIMES, angles])
        np.savetxt(
            FOLDER / f"{name}.csv",
            rows,
            fmt=["%.2f", "%.6f", "%.6f"],
            delimiter=",",
            header="t,upper,lower",
            comments="",
        )


if __name__ == "__main__":
    main()
