"""A small ring-down that provokes the sentences and figures of its report."""

import numpy as np

import dalembert as da
from report_case import Case

TIMES = np.arange(2000) / 1000


def measured() -> da.Measurements:
    """A decay of 20 Hz at two sensors, with noise."""
    wave = np.exp(-TIMES) * np.cos(2 * np.pi * 20 * TIMES)
    noise = 2e-3 * np.random.default_rng(0).normal(size=(2, len(TIMES)))
    return da.Measurements.of(TIMES, {"tip": wave + noise[0], "middle": 0.4 * wave + noise[1]})


DECAY_CASES = {
    "ring-down": Case(
        lambda: da.ring_down(measured(), quantity="displacement"),
        (
            "Those of the periodic motion with the same amplitude; bars are two standard deviations. Windows overlap, so "
            "that neighbours are not independent.",
            "Frequency and damping of the decay itself. The two methods are independent: where they differ, look again.",
            "Shape of the mode, displacements over that of the reference",
        ),
        ("ring-down", "decay"),
    ),
}
