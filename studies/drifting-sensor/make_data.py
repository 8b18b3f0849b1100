"""Write motion.csv: a damped oscillation by its closed form, with drift and noise of a sensor; nothing of dalembert.

The errors of the sensor are autoregressive of order 1: each is 0.95 of the one before, plus white noise.
"""

from pathlib import Path

import numpy as np

FOLDER = Path(__file__).parent
MASS, RELEASE, STIFFNESS, DAMPING = 1.0, 0.1, 100.0, 2.0
COEFFICIENT, NOISE = 0.95, 0.002
TIMES = np.arange(301) * 0.01


def displacement():
    """Displacement over time of a mass that is released at rest."""
    decay = DAMPING / (2 * MASS)
    frequency = np.sqrt(STIFFNESS / MASS - decay**2)
    return (
        RELEASE * np.exp(-decay * TIMES) * (np.cos(frequency * TIMES) + decay / frequency * np.sin(frequency * TIMES))
    )


def drift(draw):
    """Errors of the standard deviation ``NOISE``, each correlated with the one before."""
    errors = NOISE * draw.standard_normal(len(TIMES))
    for k in range(1, len(TIMES)):
        errors[k] = COEFFICIENT * errors[k - 1] + np.sqrt(1 - COEFFICIENT**2) * errors[k]
    return errors


def main():
    """Write the file."""
    values = 1.0 + displacement() + drift(np.random.default_rng(4))
    table = np.column_stack([TIMES, values])
    np.savetxt(FOLDER / "motion.csv", table, fmt=["%.2f", "%.6f"], delimiter=",", header="t,x", comments="")


if __name__ == "__main__":
    main()
