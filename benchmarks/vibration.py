"""Harmonic balance with friction: beside pyHarm a point, the cost of contacts and harmonics, and exact Jacobians."""

import statistics
from itertools import pairwise

import numpy as np

from benchmarks import timing
from benchmarks.peers import pyharm_models
from dalembert import (
    ElasticSlider,
    FrictionContact,
    HarmonicBalance,
    HarmonicForce,
    VibrationSystem,
    frequency_response,
)
from dalembert.structure import Dofs, Structure, lumped
from dalembert.threads import single_thread
from dalembert.vibration.balance.equations import equations

HARMONICS, SAMPLES, STEP, REPEATS = 7, 1024, 0.03, 1
CASES = {
    "one mass": (
        pyharm_models.Slider(np.eye(1), 0.04 * np.eye(1), np.eye(1), 0, 0, contact=0.8, friction=0.5, load=2.0),
        (0.8, 1.4),
    ),
    "two masses": (
        pyharm_models.Slider(
            np.eye(2), 0.02 * np.array([[2.0, -1.0], [-1.0, 1.5]]), np.array([[2.0, -1.0], [-1.0, 1.5]]), 0, 1,
            contact=1.5, friction=0.3, load=2.0,
        ),
        (0.6, 1.2),
    ),
}  # fmt: skip


def system(slider: pyharm_models.Slider) -> VibrationSystem:
    """The peer's system in ours."""
    dofs = Dofs(tuple(f"m{number}.x" for number in range(len(slider.mass))))
    own = VibrationSystem(Structure(slider.mass, slider.stiffness, dofs, slider.damping))
    own.add(HarmonicForce(dofs.names[slider.forced], 1.0))
    law = ElasticSlider(slider.contact)
    own.add(FrictionContact("slider", f"m{slider.rubbing}", friction=slider.friction, preload=slider.load, law=law))
    return own


def chain(contacts: int) -> VibrationSystem:
    """Masses in a row, each on a spring and a slider of its own."""
    names = [f"m{number}" for number in range(contacts)]
    springs = [(name, None, 0.3, 0.006) for name in names]
    springs += [(first, second, 1.0, 0.02) for first, second in pairwise(names)]
    own = VibrationSystem(lumped(dict.fromkeys(names, 1.0), springs))
    loads = np.random.default_rng(0).uniform(0.5, 1.5, contacts)
    for number, (name, load) in enumerate(zip(names, loads, strict=True)):
        own.add(HarmonicForce(name, 1.0, phase=0.5 * number / contacts))
        own.add(FrictionContact(f"slider {number}", name, friction=0.3, preload=float(load), law=ElasticSlider(0.8)))
    return own


def main() -> list[dict[str, object]]:
    rows = [_beside(name, slider, ends) for name, (slider, ends) in CASES.items()]
    title = f"Friction in frequency: milliseconds a point, {HARMONICS} harmonics, {SAMPLES} samples, tolerance 1e-10"
    timing.report("vibration", title, rows)
    title = (
        "Sliders that all slip in part: milliseconds a Newton iteration and its Jacobian, slope over what is doubled"
    )
    timing.report("vibration-cost", title, _costs())
    return rows


def _beside(name: str, slider: pyharm_models.Slider, ends: tuple[float, float]) -> dict[str, object]:
    """The peer chooses the points of its path; ours are at the same frequencies."""
    # Plain sums of samples, as the peer's: both have the same solutions.
    own, method = system(slider), HarmonicBalance(HARMONICS, samples=SAMPLES, events=False)
    _, omegas, sizes = pyharm_models.curve(slider, ends, HARMONICS, SAMPLES, STEP)
    curve = frequency_response(own, omegas / (2 * np.pi), method)
    difference = np.abs(curve.amplitude(f"m{slider.rubbing}", "harmonic 1") / sizes - 1).max()
    mine, peer = [], []
    for _ in range(REPEATS):
        mine.append(timing.seconds(lambda: frequency_response(own, omegas / (2 * np.pi), method)))
        peer.append(pyharm_models.curve(slider, ends, HARMONICS, SAMPLES, STEP)[0])
    mine, peer = (statistics.median(times) / len(omegas) * 1e3 for times in (mine, peer))
    return {
        "model": name, "points": len(omegas), "dalembert": mine, "pyHarm": peer, "ratio": peer / mine,
        "largest difference": float(difference),
    }  # fmt: skip


def _costs() -> list[dict[str, object]]:
    rows: list[dict[str, object]] = []
    for contacts, harmonics in ((20, 7), (40, 7), (80, 7), (160, 7), (40, 3), (40, 15)):
        rows.append(_cost(contacts, harmonics))
    for row in rows:
        before = next((one for one in rows if _halves(one, row)), None)
        factor = 1.0 if before is None else row["unknowns"] / before["unknowns"]  # type: ignore[operator]
        steeper = 0.0 if before is None else row["iteration"] / before["iteration"]  # type: ignore[operator]
        row["slope"] = "" if before is None else float(np.log(steeper) / np.log(factor))
    return rows


def _halves(one: dict[str, object], row: dict[str, object]) -> bool:
    """Whether one has half the contacts and the same harmonics, or about half the harmonics and the same contacts."""
    c, h, contacts, harmonics = (one["contacts"], one["harmonics"], row["contacts"], row["harmonics"])
    return (2 * c, h) == (contacts, harmonics) or (c, 2 * h + 1) == (contacts, harmonics)  # type: ignore[operator]


def _cost(contacts: int, harmonics: int) -> dict[str, object]:
    """One linearisation and solution at a point of the curve where the sliders slip, and the same by differences."""
    own = chain(contacts)
    omega = 0.9
    with single_thread():
        problem = equations(own, HarmonicBalance(harmonics, samples=512))
        solution = problem.first(omega)
        balance, point, unknowns = problem.balance(512), problem.condensation.at(omega), solution.unknowns

        def iteration() -> None:
            tangent = balance.linearised(point, unknowns)[1]
            tangent.solve(tangent.slope[:, :, None], 1e-6)

        def residual() -> None:
            balance.at(point, unknowns)

        times = timing.interleaved({"iteration": iteration, "residual": residual}, repeats=5)
        jacobian = timing.interleaved({"jacobian": lambda: balance.linearised(point, unknowns)}, repeats=5)["jacobian"]
    slipping = float(np.mean(np.concatenate([own.ravel() for own in solution.evaluation.states]) == 2))
    return {
        "contacts": contacts,
        "harmonics": harmonics,
        "unknowns": unknowns.size,
        "part of the period in slip": slipping,
        "iteration": times["iteration"] * 1e3,
        "exact Jacobian": jacobian * 1e3,
        "by differences": times["residual"] * unknowns.size * 1e3,
        "ratio": times["residual"] * unknowns.size / jacobian,
    }


if __name__ == "__main__":
    main()
