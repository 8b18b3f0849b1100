"""A pendulum driven by a recorded torque: torque constant, delay and friction from records with drawn noise.

As a command (``python tests/driven_pendulum.py 100``) it identifies them from that many records, and writes the table
tests/recovery/references/driven_pendulum.csv.
"""

import sys
from pathlib import Path

import numpy as np

import dalembert as da

TABLE = Path(__file__).parent / "recovery" / "references" / "driven_pendulum.csv"
TRUE = {"constant": 0.35, "delay": 0.007, "friction": 0.02}
BOX = {"constant": (0.1, 1.0), "delay": (0.0, 0.03), "friction": (0.0, 0.1)}
TIMES = np.arange(401) * 0.01
"""Samples of the angle, at 100 Hz."""
DRIVEN = np.arange(2001) * 0.002
"""Samples of the current, at 500 Hz."""
NOISE = np.deg2rad(0.3)
SHARE = 2.0
"""Deviations within which 95 % of the identified numbers should lie."""


def current(seed: int, times: np.ndarray) -> np.ndarray:
    """A multisine in A with random phases, (samples,)."""
    rates = 2 * np.pi * np.arange(0.5, 5.1, 0.5)
    phases = np.random.default_rng([seed, 1]).uniform(0, 2 * np.pi, len(rates))
    return 0.8 * np.sin(rates * times[:, None] + phases).sum(axis=1) / np.sqrt(len(rates))


def model(times: np.ndarray, driving: np.ndarray, kind: str, step: float) -> da.TimeResponse:
    """A bar on a pin with friction, under a torque of the current."""

    def build(constant, delay, friction):
        system = da.System()
        bar = system.add(da.RigidBar("bar", 0.5, 0.4, angle=-np.pi / 2))
        system.add(da.RevoluteJoint("pin", system.ground, bar.start, viscous=friction))
        system.add(da.Torque("motor", bar.start, da.signals.Table(times, driving, kind, scale=constant, delay=delay)))
        return system

    return da.TimeResponse(build, BOX, ["bar.start.angle"], TIMES, da.GeneralizedAlpha(step=step))


def record(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Recorded current in A, rounded to 1 mA, and angle in rad with noise.

    The pendulum moved under the current itself, which no sample knows: here a spline at 10 kHz, from before the record.
    """
    fine = np.arange(-200, 40_001) * 1e-4
    true = model(fine, current(seed, fine), "cubic", 5e-4)
    angle = true.evaluate(np.array(list(TRUE.values()))).only()[0, :, 0]
    noise = NOISE * np.random.default_rng([seed, 2]).standard_normal(len(TIMES))
    return np.round(current(seed, DRIVEN), 3), angle + noise


def identified(seed: int) -> tuple[da.Fit, np.ndarray]:
    """The fit to a record, with no deviations given, and the errors in deviations, (3,)."""
    driving, angle = record(seed)
    data = da.Measurements.of(TIMES, {"bar.start.angle": angle})
    fit = da.identify(model(DRIVEN, driving, "linear", 2e-3), data, starts=1, start=[0.5, 0.0, 0.05])
    errors = [(fit.estimates[name] - value) / fit.deviations[k] for k, (name, value) in enumerate(TRUE.items())]
    return fit, np.array(errors)


def row(seed: int) -> str:
    """A line of the table."""
    fit, errors = identified(seed)
    numbers = ",".join(f"{fit.estimates[name]:.6g},{error:.2f}" for name, error in zip(TRUE, errors, strict=True))
    return f"{seed},{numbers},{fit.simulations}"


def main() -> None:
    """Write the table."""
    rows = map(row, range(int(sys.argv[1]) if len(sys.argv) > 1 else 100))
    head = ",".join(["seed", *(f"{name},its error in deviations" for name in TRUE), "simulations"])
    TABLE.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
