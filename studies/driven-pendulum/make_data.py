"""Write driven.csv: recorded current and measured angle of the pendulum, and unseen.csv with another current."""

from pathlib import Path

import numpy as np

import dalembert as da

FOLDER = Path(__file__).parent
CONSTANT, DELAY, FRICTION = 0.35, 0.007, 0.02  # N m/A, s, N m s
NOISE = np.deg2rad(0.3)
TIMES = np.arange(2001) * 0.002
FINE = np.arange(-200, 40_001) * 1e-4
"""Times at which the current itself is known, from before the record."""


def current(draw: np.random.Generator, highest: float) -> tuple[np.ndarray, np.ndarray]:
    """A multisine with frequencies up to the highest (Hz), in A: recorded to 1 mA, and itself at the fine times."""
    rates = 2 * np.pi * np.arange(0.5, highest + 0.1, 0.5)
    phases = draw.uniform(0, 2 * np.pi, len(rates))
    recorded, itself = (
        0.8 * np.sin(rates * times[:, None] + phases).sum(axis=1) / np.sqrt(len(rates)) for times in (TIMES, FINE)
    )
    return np.round(recorded, 3), itself


def angle(itself: np.ndarray) -> np.ndarray:
    """Angle of the pendulum in rad, (samples,)."""
    system = da.System()
    bar = system.add(da.RigidBar("bar", 0.5, 0.4, angle=-np.pi / 2))
    system.add(da.RevoluteJoint("pin", system.ground, bar.start, viscous=FRICTION))
    system.add(da.Torque("motor", bar.start, da.signals.Table(FINE, itself, "cubic", scale=CONSTANT, delay=DELAY)))
    motion = da.simulate(system, TIMES[-1], da.GeneralizedAlpha(step=5e-4), TIMES)
    return motion.channels(["bar.start.angle"])[:, 0]


def main() -> None:
    """Write the files."""
    draw = np.random.default_rng(1)
    for name, highest in (("driven", 5.0), ("unseen", 3.0)):
        recorded, itself = current(draw, highest)
        measured = angle(itself) + NOISE * draw.standard_normal(len(TIMES))
        rows = np.column_stack([TIMES, 1000 * recorded, np.rad2deg(measured)])
        np.savetxt(
            FOLDER / f"{name}.csv", rows, fmt=["%.3f", "%.0f", "%.2f"], delimiter=",", header="t,mA,deg", comments=""
        )


if __name__ == "__main__":
    main()
