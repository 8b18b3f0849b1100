"""Beams in space: error against time of a cantilever that falls under its weight, for ours and Exudyn's.

All candidates take the same steps, so that the error is that of the elements; the reference has eight elements of
degree 3. Times are those of whole runs less those of runs of a few steps: of a step alone.
"""

import numpy as np

import dalembert as da
import dalembert.multibody.spatial as sp
from benchmarks import flexible_crank, timing
from benchmarks.peers import exudyn_beams as peers

LENGTH, SIDE, MODULUS, RATIO, DENSITY = 1.0, 0.02, 1e9, 0.3, 1000.0
GRAVITY, END, STEP, RADIUS, SHORT = (0.0, 30.0, 60.0), 0.5, 5e-4, 0.9, 20
AREA, MOMENT, SHEAR = SIDE**2, SIDE**4 / 12, MODULUS / (2 * (1 + RATIO))
STIFFNESS = np.array([MODULUS * AREA, *[5 / 6 * SHEAR * AREA] * 2, SHEAR * 0.1406 * SIDE**4, *[MODULUS * MOMENT] * 2])
INERTIA = DENSITY * AREA, DENSITY * MOMENT
OURS = {1: (8, 16, 32), 2: (2, 4, 8), 3: (1, 2, 4)}
THEIRS = {peers.EXACT: (4, 8, 16, 32), peers.CABLE: (4, 8, 16)}


ELBOW = np.array([1e6, 1e6, 1e6, 1e3, 1e3, 1e3])
"""Stiffness of the elbow of Simo and Vu-Quoc (1988): two legs of 10 m, 1 kg/m, with moments of 10 kg m."""
ELBOW_LENGTH, ELBOW_INERTIA, ELBOW_FORCE, ELBOW_END, ELBOW_STEP, ELBOW_RADIUS = 10.0, (1.0, 10.0), 25.0, 4.0, 5e-3, 0.95
ELBOWS, THEIR_ELBOWS, CHAINS = {2: (2, 4, 8), 3: (1, 2, 4)}, (5, 10, 20, 40), (10, 100, 1000)


def main() -> list[dict[str, object]]:
    elbows()
    flexible_crank.main()
    chains()
    return cantilevers()


def elbows() -> None:
    """An elbow whose corner is pushed out of its plane."""
    reference = our_elbow(3, 8, ELBOW_END)()
    short, steps = SHORT * ELBOW_STEP, round(ELBOW_END / ELBOW_STEP) - SHORT
    rows = []
    for degree, counts in ELBOWS.items():
        for count in counts:
            run, start = (our_elbow(degree, count, end) for end in (ELBOW_END, short))
            rows.append(_row(f"degree {degree}", count, run, start, reference, steps))
    for count in THEIR_ELBOWS:
        both = []
        for dense in (True, False):
            own = ELBOW, ELBOW_INERTIA, ELBOW_LENGTH, ELBOW_FORCE
            run, start = (peers.elbow(count, *own, end, ELBOW_STEP, ELBOW_RADIUS, dense) for end in (ELBOW_END, short))
            both.append(_row(f"Exudyn {peers.EXACT}", count, run, start, reference, steps))
        rows.append(min(both, key=lambda row: float(str(row["microseconds a step"]))))
    timing.report(
        "flexible-elbow",
        "Elbow in space, elements a leg: error of its tip against time a step",
        rows,
    )


def chains() -> None:
    """One beam of many elements: the cost of a step is in proportion to their number."""
    rows, before = [], 0.0
    for count in CHAINS:
        times = timing.interleaved({"long": ours(2, count, 220 * STEP), "short": ours(2, count, SHORT * STEP)}, 3)
        each = (times["long"] - times["short"]) / (220 - SHORT) * 1e6
        slope = {"slope": float(np.log10(each / before))} if before else {}
        rows.append({"elements": count, "microseconds a step": each, "a step and element": each / count} | slope)
        before = each
    timing.report("flexible-chains", "Cantilever in space of many quadratic elements: microseconds a step", rows)


def our_elbow(degree: int, count: int, end: float):
    """A run of ours, which returns the tip."""

    def run() -> np.ndarray:
        section = sp.Section(tuple(ELBOW), ELBOW_INERTIA[0], (ELBOW_INERTIA[1],) * 2)
        system = sp.SpatialSystem(gravity=(0.0, 0.0, 0.0))
        corner = sp.NodePoint("end", orientation=sp.Orientation.by_angles("z", np.pi / 2))
        first = system.add(sp.Beam("a", section, ELBOW_LENGTH, count, degree, points={"corner": corner}))
        second = system.add(sp.Beam("b", section, ELBOW_LENGTH, count, degree, first.point("corner")))
        system.add(sp.FixedJoint("clamp", system.ground, first.start))
        system.add(sp.FixedJoint("weld", first.point("corner"), second.start))
        system.add(sp.Force("push", first.end, z=ELBOW_FORCE))
        solver = da.GeneralizedAlpha(step=ELBOW_STEP, spectral_radius=ELBOW_RADIUS)
        motion = da.simulate(system, end, solver, times=np.array([end]))
        return motion.channels(["b.end.x", "b.end.y", "b.end.z"])[-1]

    return run


def cantilevers() -> list[dict[str, object]]:
    """A cantilever that falls under its weight."""
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


STEPS = round(END / STEP) - SHORT


def _row(element: str, count: int, run, short, reference: np.ndarray, steps: int = STEPS) -> dict[str, object]:
    times = timing.interleaved({"long": run, "short": short}, 5)
    each = (times["long"] - times["short"]) / steps
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
