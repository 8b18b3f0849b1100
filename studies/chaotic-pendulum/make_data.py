"""Write motion.csv: the angles of both bars, a reading every 50 ms, with 0.01 rad of noise."""

from pathlib import Path

import numpy as np

from dalembert.study import load

FOLDER = Path(__file__).parent
TIMES = np.arange(201) * 0.05
CHANNELS = ["upper.centre.angle", "lower.centre.angle"]
NOISE = 0.01  # rad


def main() -> None:
    """Write the file."""
    angles = load(FOLDER / "simulate.toml").motion(TIMES[-1], times=TIMES).channels(CHANNELS)
    noisy = angles + NOISE * np.random.default_rng(1).standard_normal(angles.shape)
    rows = np.column_stack([TIMES, noisy])
    np.savetxt(
        FOLDER / "motion.csv", rows, fmt=["%.2f", "%.5f", "%.5f"], delimiter=",", header="t,upper,lower", comments=""
    )


if __name__ == "__main__":
    main()
