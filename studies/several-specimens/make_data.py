"""Write part-1.csv to part-8.csv: vibrations of eight parts by the closed form, with noise; nothing of dalembert.

The stiffness of the parts is normal, 100 N/m with a spread of 5 N/m. All have the same damping.
"""

from pathlib import Path

import numpy as np

FOLDER = Path(__file__).parent
MASS, RELEASE, DAMPING = 1.0, 0.1, 2.0
STIFFNESS, SPREAD, NOISE = 100.0, 5.0, 0.002
TIMES = np.arange(61) * 0.025


def displacement(stiffness):
    """Displacement over time of a mass that is released at rest."""
    decay = DAMPING / (2 * MASS)
    frequency = np.sqrt(stiffness / MASS - decay**2)
    return (
        RELEASE * np.exp(-decay * TIMES) * (np.cos(frequency * TIMES) + decay / frequency * np.sin(frequency * TIMES))
    )


def main():
    """Write the files."""
    draw = np.random.default_rng(12)
    for number, stiffness in enumerate(STIFFNESS + SPREAD * draw.standard_normal(8), start=1):
        values = 1.0 + displacement(stiffness) + NOISE * draw.standard_normal(len(TIMES))
        np.savetxt(
            FOLDER / f"part-{number}.csv",
            np.column_stack([TIMES, values]),
            fmt=["%.3f", "%.6f"],
            delimiter=",",
            header="t,x",
            comments="",
        )
        print(f"part {number}: {stiffness:.3f} N/m")


if __name__ == "__main__":
    main()
