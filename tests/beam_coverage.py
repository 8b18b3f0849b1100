"""How often 95 % intervals of four stiffnesses of a short beam contain the truth, from the noisy motion of its tip.

``python tests/beam_coverage.py`` repeats it with the 400 seeds of the table, and writes the counts into it.
"""

import json
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from pathlib import Path

import numpy as np

import dalembert as da
import dalembert.multibody as mb
import dalembert.multibody.spatial as sp

TABLE = Path(__file__).parent / "verification" / "references" / "beam_coverage.json"
SEEDS, FIRST, NOISE = 400, 1000, 2e-4  # m
LENGTH, WIDTH, HEIGHT = 0.4, 0.1, 0.08  # m
AREA, SECOND_Y, SECOND_Z = WIDTH * HEIGHT, WIDTH * HEIGHT**3 / 12, HEIGHT * WIDTH**3 / 12
DENSITY = 1000.0
TRUTH = {"modulus": 1e6, "shear": 2700.0, "torsion": 3.2, "offset": 0.012}  # Pa, N, N m^2, m
BOUNDS = {"modulus": (5e5, 2e6), "shear": (1000.0, 8000.0), "torsion": (1.5, 6.0), "offset": (-0.03, 0.03)}
CHANNELS = [f"beam.{point}.{axis}" for point in ("end", "corner") for axis in "xyz"]


def build(modulus, shear, torsion, offset) -> sp.SpatialSystem:
    """A block of rubber, five times as long as high, clamped and pushed beside its axis in both directions."""
    stiffness = (modulus * AREA, shear, shear, torsion, modulus * SECOND_Y, modulus * SECOND_Z)
    section = sp.Section(
        stiffness, DENSITY * AREA, (DENSITY * SECOND_Y, DENSITY * SECOND_Z), shear_centre=(offset, 0.0)
    )
    system = sp.SpatialSystem(gravity=(0.0, 0.0, 0.0))
    corner = sp.NodePoint("end", (0.0, WIDTH / 2, HEIGHT / 2))
    beam = system.add(sp.Beam("beam", section, LENGTH, 2, points={"corner": corner}, damping=5e-3))
    system.add(sp.FixedJoint("clamp", system.ground, beam.start))
    push = {"y": mb.Harmonic(4.0, 11.0), "z": mb.Harmonic(5.0, 17.0)}
    system.add(sp.Force("push", beam.point("corner"), **push))
    return system


@cache
def model() -> mb.TimeResponse:
    """The response of the tip."""
    times = np.linspace(0.0, 1.0, 81)
    return mb.TimeResponse(build, BOUNDS, CHANNELS, times, mb.GeneralizedAlpha(step=5e-3))


@cache
def exact() -> np.ndarray:
    """The motion of the tip with the true values."""
    return model().evaluate(np.array([list(TRUTH.values())])).only()[0]


def contains(seed: int) -> list[bool]:
    """Whether the interval of each parameter contains the truth."""
    noise = NOISE * np.random.default_rng(seed).standard_normal(exact().shape)
    values = dict(zip(CHANNELS, (exact() + noise).T, strict=True))
    data = da.Measurements.of(np.linspace(0.0, 1.0, 81), values, deviations=NOISE)
    fit = da.identify(model(), data, starts=1, horizon=None, start=TRUTH)
    ends = fit.intervals(0.95)
    return [lower <= TRUTH[name] <= upper for name, (lower, upper) in ends.items()]


def main() -> None:
    with ProcessPoolExecutor() as pool:
        found = np.array(list(pool.map(contains, range(FIRST, FIRST + SEEDS), chunksize=10)))
    table = {
        "seeds": SEEDS,
        "first": FIRST,
        "contained": dict(zip(TRUTH, found.sum(axis=0).tolist(), strict=True)),
        "in the first ten": found[:10].sum(axis=0).tolist(),
    }
    TABLE.write_text(json.dumps(table, indent=1) + "\n", encoding="utf-8")
    sys.stdout.write(f"{table}\n")


if __name__ == "__main__":
    main()
