"""How often each finding warns although the model is right and the noise is as assumed.

``python tests/false_alarms.py 400`` fits all families of records by seed and writes the table
tests/verification/references/false_alarms.csv: a row a family and a code, with the number of seeds that have it.
``python tests/false_alarms.py 400 "two channels" pendulum`` replaces the rows of these families.
Right warnings do not count: correlated residuals of AR(1) noise that is not estimated, and others in ``TRUE``.
"""

import csv
import sys
import warnings
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from functools import cache, partial
from pathlib import Path

import numpy as np

import dalembert as da
from correlated_noise import autoregressive
from free_oscillations import BOX, oscillation

TABLE = Path(__file__).parent / "verification" / "references" / "false_alarms.csv"
TRUE = {
    ("oscillation, AR(1) noise", "correlated-residuals"),
    ("pendulum", "integration-bias"),
    ("posterior with one mode", "chains-differ"),
    ("posterior with one mode", "few-draws"),
}
"""Warnings that are right."""

TRUTH = {"stiffness": 30.0, "damping": 0.2, "start": 0.3}
LONG = np.linspace(0.0, 8.0, 201)
SHORT = np.linspace(0.0, 1.0, 21)
SWING = np.linspace(0.0, 2.0, 81)


def straight_line(seed: int) -> da.Fit:
    """A line of 21 samples, noise of unknown deviation."""
    line = da.PythonModel(
        lambda offset, slope: offset + slope * SHORT, {"offset": (-5.0, 5.0), "slope": (-5.0, 5.0)}, ["x"], SHORT
    )
    data = da.Measurements.of(SHORT, {"x": 1.0 + 2.0 * SHORT + 0.1 * autoregressive(seed, len(SHORT), 0.0)})
    return da.identify(line, data)


def oscillator(seed: int, correlation: float = 0.0, deviation: float | None = None) -> da.Fit:
    """A damped oscillation of 201 samples with white or AR(1) noise."""
    model = da.PythonModel(lambda **values: oscillation(LONG, **values), BOX, ["x"], LONG)
    noise = 0.005 * autoregressive(seed, len(LONG), correlation)
    return da.identify(model, da.Measurements.of(LONG, {"x": oscillation(LONG, **TRUTH) + noise}, deviation), seed=seed)


def estimated_noise(seed: int) -> da.Fit:
    """AR(1) noise that is estimated with the parameters."""
    model = da.PythonModel(lambda **values: oscillation(LONG, **values), BOX, ["x"], LONG)
    noise = 0.005 * autoregressive(seed, len(LONG), 0.6)
    data = da.Measurements.of(LONG, {"x": oscillation(LONG, **TRUTH) + noise})
    return da.identify(model, data, noise=da.AutoregressiveNoise(), start=TRUTH)


def two_channels(seed: int, ratio: float = 10.0) -> da.Fit:
    """Displacement and velocity with noise of different size, in m/s and in m a ratio apart."""

    def motion(**values: float) -> np.ndarray:
        x = oscillation(LONG, **values)
        return np.stack([x, np.gradient(x, LONG, edge_order=2)], axis=1)

    exact = motion(**TRUTH)
    noise = autoregressive(seed, len(LONG), 0.0, 2).T * [0.003, 0.003 * ratio]
    columns = {"x": (exact + noise)[:, 0], "v": (exact + noise)[:, 1]}
    model = da.PythonModel(motion, BOX, ["x", "v"], LONG)
    return da.identify(model, da.Measurements.of(LONG, columns), start=TRUTH)


def two_experiments(seed: int) -> da.Fit:
    """Two releases of one oscillator, each from an unknown displacement."""
    model = da.PythonModel(lambda **values: oscillation(LONG, **values), BOX, ["x"], LONG)
    noise = 0.005 * autoregressive(seed, len(LONG), 0.0, 2)
    experiments = [
        da.Experiment(
            f"release {k + 1}",
            model,
            da.Measurements.of(LONG, {"x": oscillation(LONG, **{**TRUTH, "start": start}) + noise[k]}),
            local=("start",),
        )
        for k, start in enumerate((0.3, 0.2))
    ]
    return da.identify(experiments)


def uneven(seed: int) -> da.Fit:
    """An oscillation at random times."""
    times = np.sort(np.random.default_rng((seed, 1)).uniform(0.0, 8.0, 150))
    model = da.PythonModel(lambda **values: oscillation(times, **values), BOX, ["x"], times)
    noise = 0.005 * autoregressive(seed, len(times), 0.0)
    return da.identify(model, da.Measurements.of(times, {"x": oscillation(times, **TRUTH) + noise}), start=TRUTH)


def held_out(seed: int) -> da.Fit:
    """The last third of an oscillation is predicted."""
    model = da.PythonModel(lambda **values: oscillation(LONG, **values), BOX, ["x"], LONG)
    noise = 0.005 * autoregressive(seed, len(LONG), 0.0)
    data = da.Measurements.of(LONG, {"x": oscillation(LONG, **TRUTH) + noise})
    return da.identify(model, data, validation=0.33, start=TRUTH)


def priors(seed: int, number: int = 6) -> da.Fit:
    """Levels with priors around the truth, each measured four times."""
    drawn = np.random.default_rng((seed, 2)).normal(0.0, 0.1, number)
    times = np.arange(4.0 * number)
    level = np.repeat(np.eye(number), 4, axis=0)
    box = {
        f"level {k}": da.Parameter(f"level {k}", -5.0, 5.0, start=mean, prior=da.priors.Normal(mean, 0.1))
        for k, mean in enumerate(1.0 + drawn)
    }
    model = da.PythonModel(lambda **values: level @ np.array(list(values.values())), box, ["x"], times)
    data = da.Measurements.of(times, {"x": level @ np.ones(number) + 0.2 * autoregressive(seed, len(times), 0.0)}, 0.2)
    return da.identify(model, data)


def posterior(seed: int) -> da.Posterior:
    """The posterior of a decay with a single mode, by chains that are too short to agree."""
    model = da.PythonModel(
        lambda rate, height: height * np.exp(-rate * SHORT), {"rate": (0.1, 10.0), "height": (0.1, 5.0)}, ["x"], SHORT
    )
    noise = 0.05 * autoregressive(seed, len(SHORT), 0.0)
    data = da.Measurements.of(SHORT, {"x": np.exp(-2.0 * SHORT) + noise}, 0.05)
    return da.sample(model, data, seed=seed, chains=4, draws=60, warmup=60)


def rounded(seed: int) -> da.Fit:
    """Values rounded to two digits, and noise below the rounding."""
    model = da.PythonModel(lambda **values: oscillation(LONG, **values), BOX, ["x"], LONG)
    exact = oscillation(LONG, **TRUTH) + 0.002 * autoregressive(seed, len(LONG), 0.0)
    return da.identify(model, da.Measurements.of(LONG, {"x": np.round(exact, 2)}), start=TRUTH)


def pendulum(length: float, drag: float) -> da.System:
    """A rigid bar of 1 kg that swings with viscous friction in its pin."""
    system = da.System(gravity=(0.0, -9.81))
    bar = system.add(da.RigidBar("bar", length=length, mass=1.0, angle=-0.5))
    system.add(da.RevoluteJoint("pin", system.ground, bar.start, viscous=drag))
    return system


@cache
def swing() -> tuple[da.TimeResponse, np.ndarray]:
    """The motion of the pendulum's tip, and its response at length 1 m and drag 0.1 N·m·s."""
    channels = ["bar.end.x", "bar.end.y"]
    box = {"length": (0.6, 1.4), "drag": (0.0, 1.0)}
    model = da.TimeResponse(pendulum, box, channels, SWING, solver=da.GeneralizedAlpha(step=0.005))
    return model, model.evaluate(np.array([1.0, 0.1])).only()[0]


def mechanism(seed: int) -> da.Fit:
    """The tip of a swinging bar in both directions."""
    model, exact = swing()
    noisy = exact + 0.002 * autoregressive(seed, len(SWING), 0.0, 2).T
    data = da.Measurements.of(SWING, {"bar.end.x": noisy[:, 0], "bar.end.y": noisy[:, 1]})
    return da.identify(model, data, start={"length": 0.9, "drag": 0.2})


FAMILIES: dict[str, Callable[[int], da.Fit | da.Posterior]] = {
    "line, 21 samples": straight_line,
    "oscillation": oscillator,
    "oscillation, known deviations": partial(oscillator, deviation=0.005),
    "oscillation, AR(1) noise": partial(oscillator, correlation=0.6),
    "oscillation, AR(1) noise estimated": estimated_noise,
    "oscillation, rounded": rounded,
    "two channels": two_channels,
    "two channels, the second less exact": partial(two_channels, ratio=100.0),
    "two experiments": two_experiments,
    "uneven samples": uneven,
    "held-out samples": held_out,
    "six priors": priors,
    "posterior with one mode": posterior,
    "pendulum": mechanism,
}


def alarms(family: str, seed: int) -> list[str]:
    """Return the codes of the warnings and errors of one fit."""
    result = FAMILIES[family](seed)
    conclusions = result.conclusions if isinstance(result, da.Fit) else (*result.outcome, *result.findings)
    return sorted({finding.code for finding in conclusions if finding.severity != "note"})


def table() -> dict[tuple[str, str], tuple[int, int]]:
    """Return the committed table by family and code: seeds with the code, and all; "" are seeds without a warning."""
    with TABLE.open(encoding="utf-8", newline="") as file:
        rows = csv.DictReader(file)
        return {(row["family"], row["code"]): (int(row["seeds"]), int(row["of"])) for row in rows}


def main(seeds: int, *families: str) -> None:
    """Fit families, all by default, and write their rows of the table."""
    warnings.simplefilter("error")
    with ProcessPoolExecutor() as pool:
        for family in families or FAMILIES:
            found = list(pool.map(partial(alarms, family), range(seeds), chunksize=10))
            counts = Counter(code for codes in found for code in codes or [""])
            rows = {key: row for key, row in table().items() if key[0] != family and key[0] in FAMILIES}
            rows |= {(family, code): (number, seeds) for code, number in counts.items()}
            with TABLE.open("w", encoding="utf-8", newline="") as file:
                writer = csv.writer(file, lineterminator="\n")
                writer.writerow(["family", "code", "seeds", "of"])
                writer.writerows((*key, *rows[key]) for key in sorted(rows))
            sys.stdout.write(f"{family}: {dict(counts)}\n")
            sys.stdout.flush()


if __name__ == "__main__":
    main(int(sys.argv[1]), *sys.argv[2:])
