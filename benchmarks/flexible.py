"""Beams in space: error against time of a cantilever that falls under its weight, for ours and Exudyn's.

All candidates take the same steps, so that the error is that of the elements; the reference has eight elements of
degree 3. Times are those of whole runs less those of runs of a few steps: of a step alone.
"""

import numpy as np

import dalembert as da
import dalembert.multibody.spatial as sp
from benchmarks import timing
from benchmarks.peers import exudyn_beams as peers

LENGTH, SIDE, MODULUS, RATIO, DENSITY = 1.0, 0.02, 1e9, 0.3, 1000.0
GRAVITY, END, STEP, RADIUS, SHORT = (0.0, 30.0, 60.0), 0.5, 5e-4, 0.9, 20
AREA, MOMENT, SHEAR = SIDE**2, SIDE**4 / 12, MODULUS / (2 * (1 + RATIO))
STIFFNESS = np.array([MODULUS * AREA, *[5 / 6 * SHEAR * AREA] * 2, SHEAR * 0.1406 * SIDE**4, *[MODULUS * MOMENT] * 2])
INERTIA = DENSITY * AREA, DENSITY * MOMENT
OURS = {1: (8, 16, 32), 2: (2, 4, 8), 3: (1, 2, 4)}
THEIRS = {peers.EXACT: (4, 8, 16, 32), peers.CABLE: (4, 8, 16)}


def main() -> list[dict[str, object]]:
    reference = ours(3, 8, END)()
    rows = []
    for degree, counts in OURS.items():
        rows += [
            _row(f"degree {degree}", count, ours(degree, count, END), ours(degree, count, SHORT * STEP), reference)
            for count in counts
        ]
    for kind, counts in THEIRS.items():
        for count in counts:
            both = [
                _row(
                    f"Exudyn {kind}",
                    count,
                    *(theirs(kind, count, end, dense) for end in (END, SHORT * STEP)),
                    reference,
                )
                for dense in (True, False)
            ]
            rows.append(min(both, key=lambda row: float(str(row["microseconds a step"]))))
    timing.report(
        "flexible", "Cantilever in space that falls: error of its tip against time a step, generalized-alpha", rows
    )
    return rows


def _row(element: str, count: int, run, short, reference: np.ndarray) -> dict[str, object]:
    times = timing.interleaved({"long": run, "short": short}, 5)
    each = (times["long"] - times["short"]) / (round(END / STEP) - SHORT)
    error = float(np.linalg.norm(run() - reference))
    return {"element": element, "elements": count, "microseconds a step": each * 1e6, "error, m": error}


def ours(degree: int, count: int, end: float):
    """A run of ours, which returns the tip."""

    def run() -> np.ndarray:
        section = sp.Section(tuple(STIFFNESS), INERTIA[0], (INERTIA[1],) * 2)
        system = sp.SpatialSystem(gravity=GRAVITY)
        beam = system.add(sp.Beam("beam", section, LENGTH, count, degree))
        system.add(sp.FixedJoint("clamp", system.ground, beam.start))
        solver = da.GeneralizedAlpha(step=STEP, spectral_radius=RADIUS)
        motion = da.simulate(system, end, solver, times=np.array([end]))
        return motion.channels(["beam.end.x", "beam.end.y", "beam.end.z"])[-1]

    return run


def theirs(kind: str, count: int, end: float, dense: bool):
    """A run of Exudyn."""
    return peers.cantilever(kind, count, STIFFNESS, INERTIA, LENGTH, GRAVITY, end, STEP, RADIUS, dense)


if __name__ == "__main__":
    main()
