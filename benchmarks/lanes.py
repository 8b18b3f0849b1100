"""Batches of samples side by side, beside the same samples one by one: samples a second on one core."""

import numba
import numpy as np

import dalembert as da
from benchmarks import ours, timing
from benchmarks.cases import PENDULUM
from benchmarks.sensitivities import BEAM, CABLE

SAMPLES = 32


def main() -> list[dict[str, object]]:
    numba.set_num_threads(1)
    rows = [
        _row("flexible pendulum, 2 + 4 beams", ours.beam_pendulum, BEAM),
        _row("flexible pendulum, 2 + 4 cables", ours.cable_pendulum, CABLE),
        _row("two-link arm of rigid bars", arm, {"first": 0.8, "second": 0.5, "mass": 2.0}),
    ]
    timing.report("lanes", f"Batch of {SAMPLES}: eight samples side by side, and one by one (one core)", rows)
    return rows


def arm(first: float, second: float, mass: float) -> da.System:
    """Two rigid bars on pins."""
    system = da.System(gravity=(0.0, -9.81))
    upper = system.add(da.RigidBar("OA", 1.0, mass, angle=-first))
    lower = system.add(da.RigidBar("AB", 1.0, mass, angle=-second, start=upper.end))
    system.add(da.RevoluteJoint("O", system.ground, upper.start))
    system.add(da.RevoluteJoint("A", upper.end, lower.start))
    return system


def _row(name: str, builder, values: dict[str, float]) -> dict[str, object]:
    chosen = dict(list(values.items())[:4])
    channels = ours.JOINT_AND_TIP if builder is not arm else ("AB.end.x", "AB.end.y")
    model = da.TimeResponse(
        builder,
        parameters={key: (0.9 * value, 1.1 * value) for key, value in chosen.items()},
        channels=channels,
        times=PENDULUM.integration.times,
        solver=ours.solver(PENDULUM.integration),
        workers=1,
    )
    chance = np.random.default_rng(0)
    batch = np.array(list(chosen.values())) * chance.uniform(0.95, 1.05, (SAMPLES, len(chosen)))
    times = timing.interleaved(
        {
            "together": lambda: model.evaluate(batch).only(),
            "alone": lambda: [model.evaluate(vector).only() for vector in batch],
        },
        repeats=7,
    )
    same = np.array_equal(model.evaluate(batch).only(), np.stack([model.evaluate(row).only()[0] for row in batch]))
    return {
        "model": name,
        "samples a second, side by side": SAMPLES / times["together"],
        "one by one": SAMPLES / times["alone"],
        "times faster": times["alone"] / times["together"],
        "same bits": same,
    }


if __name__ == "__main__":
    main()
