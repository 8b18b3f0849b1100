"""Write motion.csv: the motor's angle (rad) and the shaft's displacements (mm) in a run-up, with noise."""

from pathlib import Path

import numpy as np

from dalembert.study import load

FOLDER = Path(__file__).parent
CHANNELS = ["motor.centre.angle", "mount.x", "mount.y"]
TIMES = np.arange(401) * 0.005
NOISE = np.array([np.deg2rad(0.5), 5e-5, 5e-5])


def main() -> None:
    """Write the file."""
    motion = load(FOLDER / "simulate.toml").motion(TIMES[-1], times=TIMES).channels(CHANNELS)
    motion += NOISE * np.random.default_rng(0).standard_normal(motion.shape)
    rows = np.column_stack([TIMES, motion * [1.0, 1e3, 1e3]])
    form = ["%.3f", "%.5f", "%.4f", "%.4f"]
    np.savetxt(FOLDER / "motion.csv", rows, fmt=form, delimiter=",", header="t,motor,x,y", comments="")


if __name__ == "__main__":
    main()
