"""Write free.csv and driven.csv: the angle of the pendulum without and with its motor, with 0.5 degrees of noise."""

from pathlib import Path

import numpy as np

from dalembert.study import load

FOLDER = Path(__file__).parent
DRIVES = {"free": 0.0, "driven": 0.8}  # amplitude of the motor's torque, N m
TIMES = np.arange(201) * 0.02
NOISE = np.deg2rad(0.5)


def main() -> None:
    """Write the files."""
    study, draw = load(FOLDER / "simulate.toml"), np.random.default_rng(0)
    for name, drive in DRIVES.items():
        angle = study.varied({"drive": drive}, {}).motion(TIMES[-1], times=TIMES).channels(["bar.centre.angle"])
        rows = np.column_stack([TIMES, angle + NOISE * draw.standard_normal(angle.shape)])
        np.savetxt(FOLDER / f"{name}.csv", rows, fmt=["%.2f", "%.6f"], delimiter=",", header="t,angle", comments="")


if __name__ == "__main__":
    main()
