"""A servo with its pendulum: motor, friction and gear from encoder records at three gains, tried on a fourth gain.

As a command (``python tests/servo_pendulum.py 100``) it identifies them from that many drawn sets of records on two
cores, and writes the table tests/recovery/references/servo_pendulum.csv.
"""

import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import NamedTuple

import numpy as np

import dalembert as da

TABLE = Path(__file__).parent / "recovery" / "references" / "servo_pendulum.csv"
TRUE = {
    "torque_constant": 1.6, "armature_inertia": 0.004, "efficiency": 0.8, "viscous": 0.03, "coulomb": 0.06,
    "stribeck": 0.05, "stribeck_rate": 0.8,
}  # fmt: skip
"""Behind the gear: N m/A, kg m^2, 1, N m s, N m, N m, rad/s."""
BOX = {name: (0.3 * value, 3 * value) for name, value in TRUE.items()} | {"efficiency": (0.5, 1.0)}
GAINS = {"low": 10.0, "middle": 20.0, "high": 40.0}
"""V/rad."""
UNSEEN = 28.0
CHANNEL = "bar.pivot.angle"
COUNT = 2 * np.pi / 4096
"""Of the encoder, rad."""
TIMES = np.arange(1, 601) / 200
"""Samples of the angle, at 200 Hz."""
OFF = 2.4
"""The motor is switched off at this time, s; then the pendulum swings freely."""
SHARE = 3.0
"""Deviations within which all identified numbers should lie."""
NOISE = COUNT / np.sqrt(12)
"""Standard deviation of the rounding to counts, which is nearly uniform where the angle moves by many counts."""


NAMES_IN_TABLE = [*(entry for name in TRUE for entry in (name, f"{name} error")), "read", "moved", "simulations"]


class Outcome(NamedTuple):
    """A fit, its errors in deviations (7,), and the shares of the record at the unseen gain within the 95 % bands.

    ``read`` is the share of the readings in the band of readings, ``moved`` the share of the true angles in that of the
    response.
    """

    fit: da.Fit
    errors: np.ndarray
    read: float
    moved: float


def goal(draw: np.random.Generator) -> da.signals.Table:
    """Goal positions at 200 Hz: a sum of three sines about the lowest position."""
    times = np.append(0.0, TIMES)
    rates, phases = 2 * np.pi * draw.uniform([0.4, 1.0, 1.8], [0.6, 1.2, 2.0]), draw.uniform(0, 2 * np.pi, 3)
    return da.signals.Table(times, np.sin(rates * times[:, None] + phases) @ [0.5, 0.35, 0.2] - np.pi / 2, "linear")


def model(gain: float, target: da.signals.Table, begin: float, step: float = 5e-4) -> da.TimeResponse:
    """A pendulum of 1 kg on a servo."""

    def build(torque_constant, armature_inertia, efficiency, viscous, coulomb, stribeck, stribeck_rate):
        system = da.System()
        bar = da.RigidBody("bar", 1.0, 0.005, angle=begin, points={"pivot": (-0.15, 0.0)}, anchor="pivot")
        pivot = system.add(bar).point("pivot")
        friction = {"viscous": viscous, "coulomb": coulomb, "stribeck": stribeck, "stribeck_rate": stribeck_rate}
        system.add(da.RevoluteJoint("pin", system.ground, pivot, **friction, slip_rate=0.1))
        motor = {"torque_constant": torque_constant, "armature_inertia": armature_inertia, "efficiency": efficiency}
        motor |= {"resistance": 3.5, "voltage_limit": 15.0, "enabled": da.signals.Step(1.0, -1.0, OFF)}
        system.add(da.Servo("servo", system.ground, pivot, **motor, goal=target, kp=gain))
        return system

    return da.TimeResponse(build, BOX, [CHANNEL], TIMES, da.GeneralizedAlpha(step=step))


def experiment(name: str, gain: float, seed: int, number: int) -> tuple[da.Experiment, np.ndarray]:
    """A record of the encoder, and the true angle in rad (samples,), computed with steps five times smaller."""
    draw = np.random.default_rng([seed, number])
    target, begin = goal(draw), draw.uniform(-0.3, 0.3) - np.pi / 2
    angle = model(gain, target, begin, 1e-4).evaluate(np.array(list(TRUE.values()))).only()[0, :, 0]
    counted = COUNT * np.round(angle / COUNT)
    data = da.Measurements.of(TIMES, {CHANNEL: counted}, deviations={CHANNEL: NOISE})
    return da.Experiment(name, model(gain, target, begin), data), angle


def identified(seed: int) -> Outcome:
    """The numbers from the records at three gains, and the prediction of a record at an unseen one."""
    records = [experiment(name, gain, seed, number)[0] for number, (name, gain) in enumerate(GAINS.items())]
    fit = da.identify(records, starts=1)
    errors = [(fit.estimates[name] - value) / fit.deviations[k] for k, (name, value) in enumerate(TRUE.items())]
    unseen, angle = experiment("unseen", UNSEEN, seed, len(GAINS))
    band = da.predict(unseen.model, fit)
    response, deviations = band.response[:, 0], band.deviations[:, 0]
    read = np.abs(unseen.data.values[:, 0] - response) <= band.quantile * np.hypot(deviations, NOISE)
    moved = np.abs(angle - response) <= band.quantile * deviations
    return Outcome(fit, np.array(errors), float(np.mean(read)), float(np.mean(moved)))


def row(seed: int) -> str:
    """A line of the table."""
    fit, errors, read, moved = identified(seed)
    numbers = ",".join(f"{fit.estimates[name]:.6g},{error:.2f}" for name, error in zip(TRUE, errors, strict=True))
    return f"{seed},{numbers},{read:.4f},{moved:.4f},{fit.simulations}"


def main() -> None:
    """Write the table."""
    with ProcessPoolExecutor(2) as pool:
        rows = list(pool.map(row, range(int(sys.argv[1]) if len(sys.argv) > 1 else 100)))
    numbers = (f"{name},its error in deviations" for name in TRUE)
    head = ",".join(["seed", *numbers, "unseen readings in their band", "unseen motion in its band", "simulations"])
    TABLE.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
