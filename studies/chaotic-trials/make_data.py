"""Write the records of three trials: both angles over 10 s at 100 Hz, with noise of 0.5 % of each channel's spread."""

import sys
from pathlib import Path

import numpy as np

from dalembert.study import load

FOLDER = Path(__file__).parent
CHANNELS = ["upper.centre.angle", "lower.centre.angle"]
SHARED = {"length1": 0.3, "length2": 0.25, "mass2": 0.7, "friction1": 0.002, "friction2": 0.001}
TRIALS = {
    "first": {"angle1": 0.3, "angle2": 0.8, "rate1": 0.0, "rate2": 0.0},
    "second": {"angle1": 1.0, "angle2": -0.2, "rate1": 1.0, "rate2": -2.0},
    "third": {"angle1": -3.0, "angle2": 0.1, "rate1": 0.0, "rate2": 3.0},
}
NOISE = 0.005  # of each channel's standard deviation
END, SAMPLES = 10.0, 1001


def stamps(rng: np.random.Generator, *, even: bool) -> np.ndarray:
    """Time stamps in s; uneven ones are between 2 and 18 ms apart."""
    if even:
        return np.linspace(0.0, END, SAMPLES)
    apart = rng.uniform(0.2, 1.8, SAMPLES - 1)
    return np.concatenate([[0.0], np.cumsum(apart)]) * END / np.sum(apart)


def write(folder: Path, seed: int = 0, *, even: bool = True) -> None:
    """Write the three files of a seed to a folder that holds identify.toml and pendulum.toml."""
    rng = np.random.default_rng(seed)
    study = load(FOLDER / "simulate.toml")
    for name, begins in TRIALS.items():
        times = stamps(rng, even=even)
        trial = study.varied({**SHARED, **begins}, {})
        angles = trial.motion(END, times=times).channels(CHANNELS)
        noisy = angles + NOISE * np.std(angles, axis=0) * rng.standard_normal(angles.shape)
        rows = np.column_stack([times, noisy])
        np.savetxt(folder / f"{name}.csv", rows, fmt="%.6f", delimiter=",", header="t,upper,lower", comments="")


if __name__ == "__main__":
    write(FOLDER, int(sys.argv[1]) if len(sys.argv) > 1 else 0)
