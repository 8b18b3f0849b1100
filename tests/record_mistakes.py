"""Whether mistakes in records are named by their findings, and whether right records raise none.

``python tests/record_mistakes.py CASE KINDS SHARE 100`` repeats a case with kinds of mistakes, such as ``late,rate``, over 100
seeds, and writes the counts into a table. The criteria were chosen with other seeds.
"""

import json
import sys
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np

import dalembert as da

TABLE = Path(__file__).parent / "verification" / "references" / "record_mistakes.json"
CODES = {
    "sign": "suspect-sign",
    "swap": "suspect-swap",
    "late": "suspect-clock",
    "rate": "suspect-clock-rate",
    "clipped": "clipped-samples",
    "zeros": "zero-dropouts",
    "repeated": "repeated-samples",
}
FIRST = 10_000
"""First seed of the table."""

LATE, RATE = 0.3, 0.03
"""s, and the relative error of a clock."""

LENGTH, DRAG, ANGLE = 1.0, 0.15, 0.6
TIMES = np.linspace(0.0, 5.0, 101)
FINE = np.linspace(-1.0, 7.0, 1601)


@dataclass(frozen=True)
class Case:
    """A model, its true response at any times (channels, samples), and the channels that a mistake concerns.

    ``several`` experiments share the parameters; the mistake is in the first one.
    """

    model: Callable[[], Any]
    truth: Callable[[np.ndarray], np.ndarray]
    channels: tuple[str, ...]
    several: int = 1
    settings: Callable[[], dict[str, Any]] = dict


def pendulum(drag: float, angle: float) -> da.System:
    """A rigid bar of 1 kg and 1 m that swings with viscous friction in its pin."""
    system = da.System(gravity=(0.0, -9.81))
    bar = system.add(da.RigidBar("bar", length=LENGTH, mass=1.0, angle=angle - np.pi / 2))
    system.add(da.RevoluteJoint("pin", system.ground, bar.start, viscous=drag))
    return system


BOX = {"drag": (0.0, 1.0), "angle": (0.2, 1.2)}
POINTS = ("bar.end.x", "bar.end.y")


@cache
def mechanism(channels: tuple[str, ...] = POINTS) -> da.TimeResponse:
    """The end of the pendulum over 5 s."""
    return da.TimeResponse(pendulum, BOX, list(channels), TIMES, solver=da.GeneralizedAlpha(step=0.025))


@cache
def _swing() -> tuple[np.ndarray, np.ndarray]:
    """Times from 0 and the true motion of the end of the pendulum."""
    later = FINE[FINE >= 0]
    fine = da.TimeResponse(pendulum, BOX, list(POINTS), later, solver=da.GeneralizedAlpha(step=0.005))
    return later, fine.evaluate([[DRAG, ANGLE]]).values[0].T


def swing(times: np.ndarray) -> np.ndarray:
    """The true motion of the end of the pendulum, which is at rest before time 0."""
    later, motion = _swing()
    return np.stack([np.interp(np.maximum(times, 0.0), later, channel) for channel in motion])


def oscillation(rate: float, damping: float, size: float, times: np.ndarray) -> np.ndarray:
    """Two channels of a damped oscillation, the second a quarter of a period later and smaller."""
    decay = size * np.exp(-damping * times)
    return np.stack([decay * np.cos(rate * times), 0.6 * decay * np.sin(rate * times) + 0.2 * times / 5.0])


@cache
def plain() -> da.PythonModel:
    """Two channels of a damped oscillation of known frequency."""
    return da.PythonModel(
        lambda damping, size: oscillation(4.0, damping, size, TIMES).T,
        {"damping": (0.0, 1.0), "size": (0.3, 3.0)}, ["x", "y"], TIMES,
    )  # fmt: skip


def oscillates(times: np.ndarray) -> np.ndarray:
    """The true oscillation."""
    return oscillation(4.0, 0.2, 1.0, times)


CASES = {
    "pendulum": Case(mechanism, swing, POINTS),
    "pendulum, two experiments": Case(mechanism, swing, POINTS, several=2),
    "function": Case(plain, oscillates, ("x", "y")),
    "function, two experiments": Case(plain, oscillates, ("x", "y"), several=2),
    "function, estimated noise": Case(
        plain, oscillates, ("x", "y"), settings=lambda: {"noise": da.AutoregressiveNoise(order=1)}
    ),
}


def mistaken(case: Case, kind: str, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Data without noise (channels, samples) of a kind of mistake, and the noise of unit variance, which is mistaken too."""
    random = np.random.default_rng(seed)
    noise = random.standard_normal((len(case.channels), len(TIMES)))
    exact = case.truth(TIMES)
    channel = seed % len(case.channels)
    if kind == "late":
        return case.truth(TIMES - LATE * (1 if seed % 2 else -1)), noise
    if kind == "rate":
        return case.truth(TIMES / (1 + RATE * (1 if seed % 2 else -1))), noise
    if kind == "sign":
        exact[channel] *= -1
    if kind == "swap":
        exact = exact[::-1]
    return exact, noise


def spoilt(kind: str, seed: int, values: np.ndarray) -> np.ndarray:
    """Noisy values (channels, samples) with samples that are clipped, lost or repeated."""
    random, found = np.random.default_rng((seed, 1)), values.copy()
    channel = seed % len(values)
    own = found[channel]
    if kind == "clipped":
        level = np.mean(own) + 0.5 * np.ptp(own) / 2
        found[channel] = np.minimum(own, level)
    if kind == "zeros":
        found[channel, random.random(len(own)) < 0.1] = 0.0
    if kind == "repeated":
        begin = 10
        while begin < len(own) - 12:  # the logger stands still for some samples
            length = int(random.integers(4, 9))
            found[channel, begin : begin + length] = found[channel, begin]
            begin += length + int(random.integers(4, 12))
    return found


def fit_of(case: Case, records: list[np.ndarray], deviation: float | None, seed: int, **settings: Any) -> da.Fit:
    """The fit of records (channels, samples), from the first guesses."""
    settings = {"seed": seed, "starts": 1, **settings}
    data = [
        da.Measurements.of(TIMES, dict(zip(case.channels, record, strict=True)), deviations=deviation)
        for record in records
    ]
    if case.several == 1:
        return da.identify(case.model(), data[0], **settings)
    return da.identify([da.Experiment(f"run{k}", case.model(), one) for k, one in enumerate(data)], **settings)


def _draw(kind: str, seed: int) -> int:
    """A seed with the same data without noise."""
    return seed if kind in ("zeros", "repeated") else seed % 2


@cache
def noise_of(name: str, kind: str, share: float, seed: int) -> float:
    """Standard deviation of noise beside which a mistake causes a share of the misfit."""
    case = CASES[name]
    wrong = spoilt(kind, seed, mistaken(case, kind, seed)[0])
    alone = fit_of(case, [wrong, *[case.truth(TIMES)] * (case.several - 1)], None, seed)
    return float(np.sqrt(np.mean(alone.residuals**2) * (1 - share) / share))


def fitted(name: str, kind: str, share: float, seed: int) -> da.Fit:
    """The fit of a case with a kind of mistake, or with none ("right"), that causes a share of the misfit.

    The misfit of a fit without noise is that of the mistake.
    """
    case = CASES[name]
    exact = case.truth(TIMES)
    wrong, noise = mistaken(case, kind, seed)
    sigma = share * float(np.std(exact)) if kind == "right" else noise_of(name, kind, share, _draw(kind, seed))
    others = [
        exact + sigma * np.random.default_rng((seed, number)).standard_normal(exact.shape)
        for number in range(1, case.several)
    ]
    known = sigma if seed % 4 < 2 and not case.settings() else None
    return fit_of(case, [spoilt(kind, seed, wrong + sigma * noise), *others], known, seed, **case.settings())


def codes(name: str, kind: str, share: float, seed: int) -> list[str]:
    """Codes of the findings on mistakes."""
    return [finding.code for finding in fitted(name, kind, share, seed).findings if finding.code in CODES.values()]


def main(name: str, kind: str, share: float, count: int) -> None:
    """Repeat a case over seeds and write the counts into the table."""
    with ProcessPoolExecutor(2) as pool:
        found = list(pool.map(partial(codes, name, kind, share), range(FIRST, FIRST + count), chunksize=5))
    named = sum(CODES.get(kind) in one for one in found)
    others = Counter(code for one in found for code in one if code != CODES.get(kind))
    row = {"seeds": count, "named": named, "others": dict(others), "flagged": sum(bool(one) for one in found)}
    table = json.loads(TABLE.read_text(encoding="utf-8")) if TABLE.exists() else {}
    table.setdefault(f"{name}, {share:g}", {})[kind] = row
    TABLE.write_text(json.dumps(table, indent=1, sort_keys=True) + "\n", encoding="utf-8")
    sys.stdout.write(f"{name}, {share:g}, {kind}: {row}\n")


if __name__ == "__main__":
    for kind in sys.argv[2].split(","):
        main(sys.argv[1], kind, float(sys.argv[3]), int(sys.argv[4]))
