"""Write the records of the servo: goal and switch, and the angle in counts of the encoder, at four gains."""

from pathlib import Path

import numpy as np

import dalembert as da

FOLDER = Path(__file__).parent
GAINS = {"low": 10.0, "middle": 20.0, "high": 40.0, "unseen": 28.0}  # V/rad
COUNT = 360 / 4096  # degrees
TIMES = np.arange(601) / 200
OFF = 2.4  # s


def goal(draw: np.random.Generator) -> np.ndarray:
    """Three sines about the lowest position, which begin smoothly, in degrees to 0.01."""
    rates, phases = 2 * np.pi * draw.uniform([0.4, 1.0, 1.8], [0.6, 1.2, 2.0]), draw.uniform(0, 2 * np.pi, 3)
    waves = np.sin(rates * TIMES[:, None] + phases) @ [30.0, 20.0, 12.0]
    return np.round(waves * (1 - np.exp(-((TIMES / 0.2) ** 2))) - 90, 2)


def angle(gain: float, target: np.ndarray, on: np.ndarray) -> np.ndarray:
    """Angle of the bar in degrees, (samples,)."""
    system = da.System()
    bar = da.RigidBody("bar", 1.0, 0.005, angle=-np.pi / 2, points={"pivot": (-0.15, 0.0)}, anchor="pivot")
    pivot = system.add(bar).point("pivot")
    friction = {"viscous": 0.03, "coulomb": 0.06, "stribeck": 0.05, "stribeck_rate": 0.8, "slip_rate": 0.1}
    system.add(da.RevoluteJoint("pin", system.ground, pivot, **friction))
    motor = {"torque_constant": 1.6, "armature_inertia": 0.004, "efficiency": 0.8, "resistance": 3.5, "kp": gain}
    signals = {
        "goal": da.signals.Table(TIMES, np.deg2rad(target), "linear"),
        "enabled": da.signals.Table(TIMES, on, "held"),
    }
    system.add(da.Servo("servo", system.ground, pivot, **motor, **signals, voltage_limit=15.0))
    motion = da.simulate(system, TIMES[-1], da.GeneralizedAlpha(step=1e-4), TIMES)
    return np.rad2deg(motion.channels(["bar.pivot.angle"])[:, 0])


def main() -> None:
    """Write the files."""
    draw = np.random.default_rng(0)
    on = (TIMES < OFF).astype(float)
    for name, gain in GAINS.items():
        target = goal(draw)
        counted = COUNT * np.round(angle(gain, target, on) / COUNT)
        rows = np.column_stack([TIMES, target, on, counted])
        path, head = FOLDER / f"{name}.csv", "t,goal,on,angle"
        np.savetxt(path, rows, fmt=["%.3f", "%.2f", "%.0f", "%.4f"], delimiter=",", header=head, comments="")


if __name__ == "__main__":
    main()
