"""A slider-crank in space with a flexible rod: error against time a step, for ours and Exudyn's.

A constant torque turns the crank, a flywheel, from rest to 28 rad/s. So both sides begin at rest, with a straight
rod and no rates of its nodes. Neither prescribes a motion, for which the peer would call a Python function.

The error is that of the slider's way and of the rod's middle: root of the mean square of their distance at 30 times.
The rod vibrates, so an error at the end alone would depend on its phase. The reference has 16 elements of degree 3.
All candidates take the same steps, so the error is that of the elements. At this step the limits of both sides differ
by less than 1e-6 m: a row has Exudyn's, extrapolated from its two finest results.

Times are those of the processor, less those of a run of a few steps. Exudyn's dense or sparse solver is taken,
whichever is faster. Its tolerance is 1e-6: at 1e-8 it takes 20 % longer, and four digits of its error stay. Ours is the
default, near the rounding error.
"""

import time
from collections.abc import Callable
from itertools import product

import numpy as np

import dalembert as da
import dalembert.multibody.spatial as sp
from benchmarks import timing
from benchmarks.crank_case import SliderCrank
from benchmarks.peers import exudyn_beams, exudyn_crank

CASE, END, SAMPLES, STEP, RADIUS, SHORT, TOLERANCE = SliderCrank(), 0.3, 30, 2.5e-4, 0.9, 20, 1e-6
OURS, REFERENCE = ((2, 1), (2, 2), (2, 4), (2, 8), (3, 1), (3, 2), (3, 4)), (3, 16)
THEIRS, LARGEST_DENSE = (2, 4, 8, 16, 32, 64), 16
ALONG = (1.0, 0.0, 0.0)
PEER = f"Exudyn {exudyn_beams.EXACT}"
AT_ERROR, AT_NODES = "Exudyn's at this error / this", "Exudyn's with as many nodes / this"


def main() -> list[dict[str, object]]:
    reference = ours(*REFERENCE, END, SAMPLES)()
    found = {count: theirs(count, END, SAMPLES, dense=False)() for count in THEIRS}
    own, other = _times()
    peers = [_row(PEER, count, 1, other[count], found[count] - reference) for count in THEIRS]
    rows = []
    for degree, count in OURS:
        error = ours(degree, count, END, SAMPLES)() - reference
        row = _row(f"degree {degree}", count, degree, own[degree, count], error)
        rows.append(row | {AT_ERROR: _ratio(row, peers, "error, m"), AT_NODES: _ratio(row, peers, "nodes")})
    coarse, fine = (found[count] for count in THEIRS[-2:])
    limit = {"element": "Exudyn's limit, extrapolated", "error, m": _size(fine + (fine - coarse) / 3 - reference)}
    rows += [*peers, limit]
    timing.report("flexible-slider-crank", "Slider-crank in space with a flexible rod: error against time a step", rows)
    return rows


def _times() -> tuple[dict[tuple[int, int], float], dict[int, float]]:
    """Microseconds a step of ours and of theirs, all in turn."""
    runs = {("ours", *own): (ours(*own, END, SAMPLES), ours(*own, SHORT * STEP, 1)) for own in OURS}
    for count, dense in product(THEIRS, (True, False)):
        if not dense or count <= LARGEST_DENSE:
            runs["theirs", count, dense] = theirs(count, END, SAMPLES, dense), theirs(count, SHORT * STEP, 1, dense)
    parts = {f"{key} {part}": run for key, both in runs.items() for part, run in zip("ab", both, strict=True)}
    times = timing.interleaved(parts, 5, time.process_time)
    each = {key: (times[f"{key} a"] - times[f"{key} b"]) / (round(END / STEP) - SHORT) * 1e6 for key in runs}
    best = {count: min(each[key] for key in each if key[:2] == ("theirs", count)) for count in THEIRS}
    return {own: each["ours", *own] for own in OURS}, best


def _row(element: str, count: int, degree: int, each: float, error: np.ndarray) -> dict[str, object]:
    size = {"element": element, "elements": count, "nodes": degree * count + 1}
    return size | {"microseconds a step": each, "error, m": _size(error)}


def _size(error: np.ndarray) -> float:
    """Root of the mean square over the samples, m."""
    return float(np.sqrt(np.mean(np.sum(error**2, axis=1))))


def _ratio(row: dict[str, object], peers: list[dict[str, object]], at: str) -> object:
    """Time of the peers where they have the same number, between them by logarithms, as a multiple of the row's.

    Where the peer's error is larger with all of its elements: at least that of the finest.
    """
    places, times = (np.log([float(str(peer[name])) for peer in peers]) for name in (at, "microseconds a step"))
    order, place = np.argsort(places), np.log(float(str(row[at])))
    between = np.exp(np.interp(place, places[order], times[order])) / float(str(row["microseconds a step"]))
    return f"> {between:.4g}" if place < places.min() else float(between)


def ours(degree: int, count: int, end: float, samples: int) -> Callable[[], np.ndarray]:
    """A run of ours, which returns the slider's way and the position of the rod's middle, (samples, 4)."""
    last = degree * count
    # The middle is a node, or in the middle of a cubic element.
    shares = {last // 2: 1.0} if last % 2 == 0 else dict(enumerate(np.array([-1, 9, 9, -1]) / 16, (last - 3) // 2))
    channels = ["slider.origin.x", *(f"rod.node{node}.{axis}" for node in shares for axis in "xyz")]

    def run() -> np.ndarray:
        system = sp.SpatialSystem(gravity=CASE.gravity)
        (mass, moment), (load, other) = CASE.flywheel, CASE.slider
        flywheel, block = sp.Inertia(mass, (moment, moment, moment)), sp.Inertia(load, (other, other, other))
        arm = {"end": (0.0, 0.0, CASE.crank)}
        crank = system.add(sp.RigidBody("crank", flywheel, CASE.bearing, points=arm))
        placed = sp.Orientation.by_axes(z=tuple(CASE.axes[:, 2]), x=tuple(CASE.axes[:, 0]))
        rod = system.add(sp.Beam("rod", CASE.section, CASE.rod, count, degree, tuple(CASE.pin), placed))
        slider = system.add(sp.RigidBody("slider", block, (CASE.way, 0.0, 0.0)))
        system.add(sp.RevoluteJoint("bearing", system.ground.point(CASE.bearing), crank.point("origin"), axis=ALONG))
        system.add(sp.UniversalJoint("pin", crank.point("end"), rod.start, axis_a=ALONG, axis_b=(0.0, 0.0, 1.0)))
        system.add(sp.SphericalJoint("ball", rod.end, slider.point("origin")))
        system.add(sp.PrismaticJoint("slide", system.ground, slider.point("origin"), axis=ALONG))
        system.add(sp.Torque("drive", crank.point("origin"), x=CASE.torque))
        solver = da.GeneralizedAlpha(step=STEP, spectral_radius=RADIUS)
        motion = da.simulate(system, end, solver, times=np.linspace(end / samples, end, samples))
        way, *places = np.split(motion.channels(channels), range(1, len(channels), 3), axis=1)
        middle = sum(share * place for share, place in zip(shares.values(), places, strict=True))
        return np.hstack([way, middle])

    return run


def theirs(count: int, end: float, samples: int, dense: bool) -> Callable[[], np.ndarray]:
    """A run of Exudyn, which returns the same."""
    return exudyn_crank.slider_crank(CASE, count, end, STEP, RADIUS, samples, TOLERANCE, dense)


if __name__ == "__main__":
    main()
