"""What fits say of right and of wrong cases drawn by seed, and how much of unseen records their bands cover.

As a command (``python tests/unseen_records.py``) it goes through all cases of CASES and writes the table
tests/verification/references/unseen_records.csv.
"""

import csv
import sys
from dataclasses import astuple, dataclass, fields
from pathlib import Path

import numpy as np

from correlated_noise import autoregressive
from dalembert.data import Measurements
from dalembert.forward import PythonModel
from dalembert.inverse import identify, predict
from free_oscillations import oscillation, rubbing

TABLE = Path(__file__).parent / "verification" / "references" / "unseen_records.csv"
CASES = {"right": 200, "unit": 10, "delay": 10, "model": 10}
WARNINGS = {
    "unit": {"suspect-unit"},
    "delay": {"suspect-delay"},
    "model": {"model-misfit", "systematic-residuals", "parameters-drift"},
}
BOX = {"stiffness": (20.0, 40.0), "damping": (0.01, 2.0), "cubic": (1.0, 500.0), "start": (0.05, 0.5)}


@dataclass(frozen=True)
class Row:
    """A case, what the fit warns of, and the share of an unseen record that the 95 % bands cover, NaN if not looked at.

    ``at`` is where a model is said to be wrong from, NaN where it is not.
    """

    case: str
    seed: int
    motion: str
    noise: str
    known: bool
    unit: bool
    delay: bool
    model: bool
    at: float
    covered: float


def hardening(times, stiffness, damping, cubic, start):
    """Displacement of a Duffing oscillator of mass 1 that starts at rest, by Runge–Kutta steps of a sample."""
    step, x, v, found = times[1] - times[0], start, 0.0 * start, [start]

    def rates(x, v):
        return v, -stiffness * x - damping * v - cubic * x**3

    for _ in times[1:]:
        a = rates(x, v)
        b = rates(x + step / 2 * a[0], v + step / 2 * a[1])
        c = rates(x + step / 2 * b[0], v + step / 2 * b[1])
        d = rates(x + step * c[0], v + step * c[1])
        x = x + step / 6 * (a[0] + 2 * b[0] + 2 * c[0] + d[0])
        v = v + step / 6 * (a[1] + 2 * b[1] + 2 * c[1] + d[1])
        found.append(x)
    return np.array(found)


MOTIONS = {"linear": oscillation, "hardening": hardening}


def model_of(motion, times, **fixed):
    """A motion as a model, some of its parameters fixed."""
    names = [name for name in BOX if (name != "cubic" or motion == "hardening") and name not in fixed]
    return PythonModel(
        lambda **values: MOTIONS[motion](times, **values, **fixed), {name: BOX[name] for name in names}, ["x"], times
    )


def row(case, seed):
    """Draw a case and fit it."""
    rng = np.random.default_rng([list(CASES).index(case), seed])
    motion = "linear" if seed % 2 else "hardening"
    white, known = seed % 4 < 2, bool(rng.random() < 0.5)
    times = np.linspace(0.0, rng.uniform(5.0, 9.0), int(rng.integers(250, 450)))
    truth = {
        "stiffness": rng.uniform(24.0, 36.0),
        "damping": rng.uniform(0.1, 0.4),
        "start": rng.uniform(0.15, 0.35),
    }
    if motion == "hardening":
        truth["cubic"] = rng.uniform(50.0, 200.0)
    sigma = truth["start"] * rng.uniform(0.005, 0.03 if case == "right" else 0.01)
    correlation = 0.0 if white else rng.uniform(0.3, 0.85)
    exact = _exact(case, motion, times, truth, rng)
    scale = 1000.0 if case == "unit" else 1.0

    def noisy(exact, record):
        noise = autoregressive([*map(int, rng.integers(0, 2**31, 2)), record], len(times), correlation)
        return scale * (exact + sigma * noise)

    data = Measurements.of(times, {"x": noisy(exact, 0)}, scale * sigma if known else None)
    fit = identify(model_of(motion, times), data, start=truth)
    codes = {finding.code for finding in fit.findings}
    at = [finding.values["at"] for finding in fit.findings if finding.code == "model-misfit"]
    warned = {name: bool(own & codes) for name, own in WARNINGS.items()}
    covered = np.nan
    if case == "right":
        start = truth["start"] * rng.uniform(0.6, 1.1)
        unseen = noisy(MOTIONS[motion](times, **{**truth, "start": start}), 1)
        bands = predict(model_of(motion, times, start=start), fit)
        lower, upper = bands.measured_lower[:, 0], bands.measured_upper[:, 0]
        there = np.isfinite(lower)  # beyond, the band has ended
        covered = float(np.mean((lower <= unseen)[there] & (unseen <= upper)[there]))
    noise = "white" if white else "AR(1)"
    return Row(
        case, seed, motion, noise, known, **warned, at=round(min(at, default=np.nan), 4), covered=round(covered, 4)
    )


def _exact(case, motion, times, truth, rng):
    """The motion that is measured."""
    if case == "delay":
        late = np.concatenate([[0.0], times]) - rng.uniform(0.008, 0.03)
        fine = np.linspace(0.0, times[-1], 20 * len(times))
        return np.interp(np.maximum(late[1:], 0.0), fine, MOTIONS[motion](fine, **truth))
    if case == "model":  # both models lack dry friction
        linear = {name: value for name, value in truth.items() if name != "cubic"}
        return rubbing(times, **linear, friction=rng.uniform(0.2, 0.4) * truth["start"] / 0.3)
    return MOTIONS[motion](times, **truth)


def table():
    """Rows of the committed table."""
    with TABLE.open(encoding="utf-8", newline="") as file:
        return [_read(entries) for entries in csv.DictReader(file)]


def _read(entries):
    kinds = {item.name: item.type for item in fields(Row)}
    read = {bool: lambda text: text == "True", int: int, float: float, str: str}
    return Row(**{name: read[kinds[name]](text) for name, text in entries.items()})


def main():
    rows = [row(case, seed) for case, count in CASES.items() for seed in range(count)]
    with TABLE.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([item.name for item in fields(Row)])
        writer.writerows(map(astuple, rows))
    sys.stdout.write(f"{len(rows)} cases in {TABLE}\n")


if __name__ == "__main__":
    main()
