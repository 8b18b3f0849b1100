"""A bolted lap joint whose second bar the contacts alone hold, beside the same joint with 1 N/m to the ground."""

from dataclasses import replace

import numpy as np
from scipy.sparse import csc_array, diags_array

from benchmarks import timing
from dalembert import (
    ElasticSlider,
    FrictionContact,
    HarmonicBalance,
    HarmonicForce,
    StaticForce,
    VibrationSystem,
    frequency_response,
)
from dalembert.structure import Material, Rayleigh, Structure, combine, craig_bampton, pairs, solid
from dalembert.structure.solid import grid

STEEL = Material(210e9, 0.3, 7800.0)
LENGTH, WIDTH, THICKNESS, OVERLAP = 0.2, 0.025, 0.01, 0.06
BOLTS, WASHER = (LENGTH - 0.75 * OVERLAP, LENGTH - 0.25 * OVERLAP), 0.0085
CLAMPING, FORCE = 10_000.0, 4.0
"""Of each bolt, and of the excitation at the tip, N."""
TANGENTIAL, NORMAL = 2e9, 4e9
"""Stiffness of all contacts together, N/m."""
MODES = 60
FREQUENCIES = np.linspace(69.4, 72.27, 10)
CASES = ((4, 2, 3), (4, 2, 7), (8, 4, 3))
"""Elements along and across the overlap, and harmonics."""


def bars(along: int, across: int) -> Structure:
    """Two bars, one above the other in the overlap, the first of them clamped."""
    inner = np.linspace(LENGTH - OVERLAP, LENGTH, along + 1)
    first = np.append(np.linspace(0, LENGTH - OVERLAP, 7)[:-1], inner)
    second = np.append(inner, np.linspace(LENGTH, 2 * LENGTH - OVERLAP, 7)[1:])
    y, z = np.linspace(0, WIDTH, across + 1), np.linspace(0, THICKNESS, 2)
    both = combine({"a": solid(grid(first, y, z), STEEL), "b": solid(grid(second, y, z + THICKNESS), STEEL)})
    names = both.nodes.names
    lower = np.array([name.startswith("a/") for name in names])
    joint = np.isclose(both.nodes.places[:, 2], THICKNESS) & (
        np.abs(both.nodes.places[:, 0] - LENGTH + OVERLAP / 2) < OVERLAP / 2 + 1e-9
    )
    chosen = {"lower": joint & lower, "upper": joint & ~lower}
    sets = {name: tuple(np.array(names)[rows].tolist()) for name, rows in chosen.items()}
    return replace(both, nodes=replace(both.nodes, sets={**both.nodes.sets, **sets})).fixed("a/left")


def joint(along: int, across: int, spring: float) -> tuple[VibrationSystem, str, int]:
    """The system, the degree of freedom at its tip and its pairs; ``spring`` from the free bar to the ground, N/m."""
    whole = bars(along, across)
    names, places = np.array(whole.nodes.names), whole.nodes.places
    lower = np.array([name.startswith("a/") for name in names])
    tip = f"{names[np.argmin(np.linalg.norm(places - [2 * LENGTH - OVERLAP, WIDTH / 2, 2 * THICKNESS], axis=1))]}.z"
    near = [np.hypot(places[:, 0] - x, places[:, 1] - WIDTH / 2) < WASHER for x in BOLTS]
    pressed = [(1.0, names[own & lower & np.isclose(places[:, 2], 0.0)]) for own in near]
    pressed += [(-1.0, names[own & ~lower & np.isclose(places[:, 2], 2 * THICKNESS)]) for own in near]
    if spring:
        free = np.array([name.startswith("b/") for name in whole.dofs.names])
        held = csc_array(whole.stiffness + diags_array(free * spring / (free.sum() / 3)))
        whole = replace(whole, stiffness=held)
    touching = pairs(whole, "upper", "lower", 1e-7)
    masters = [*(node for pair in touching for node in pair), tip, *(f"{node}.z" for _, own in pressed for node in own)]
    system = VibrationSystem(craig_bampton(whole, masters, MODES).with_damping(Rayleigh(2.0, 0.0)))
    system.add(HarmonicForce(tip, FORCE))
    for way, washer in pressed:
        for node in washer:
            system.add(StaticForce(f"{node}.z", way * CLAMPING / len(washer)))
    law = ElasticSlider(TANGENTIAL / len(touching), NORMAL / len(touching))
    for number, (first, second) in enumerate(touching):
        contact = FrictionContact(
            f"c{number}", first, second, tangential=("x", "y"), normal="-z", friction=0.3, preload=1.0, law=law
        )
        system.add(contact)
    return system, tip, len(touching)


def main() -> list[dict[str, object]]:
    """Time a point of each, over the resonance."""
    rows = []
    for along, across, harmonics in CASES:
        method, curves = HarmonicBalance(harmonics, samples=128, events=False), {}
        (alone, tip, count), (soft, _, _) = joint(along, across, 0.0), joint(along, across, 1.0)

        def follow(system: VibrationSystem, name: str, method=method, tip=tip, curves=curves) -> None:
            curves[name] = frequency_response(system, FREQUENCIES, method, observe=[tip], check=False)

        times = timing.interleaved({
            "alone": lambda follow=follow, alone=alone: follow(alone, "alone"),
            "soft": lambda follow=follow, soft=soft: follow(soft, "soft"),
        }, repeats=5)  # fmt: skip
        sizes = {name: curve.amplitude(tip, "harmonic 1") for name, curve in curves.items()}
        rows.append({
            "pairs": count,
            "harmonics": harmonics,
            "contacts alone, ms a point": 1e3 * times["alone"] / len(FREQUENCIES),
            "with 1 N/m, ms a point": 1e3 * times["soft"] / len(FREQUENCIES),
            "ratio": times["alone"] / times["soft"],
            "found": f"{sum(int(curve.converged.sum()) for curve in curves.values())} of {2 * len(FREQUENCIES)}",
            "difference": float(np.abs(sizes["alone"] / sizes["soft"] - 1).max()),
        })  # fmt: skip
    timing.report("bolted", "Friction in frequency: a bolted joint that contacts alone hold", rows)
    return rows


if __name__ == "__main__":
    main()
