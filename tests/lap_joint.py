"""Two bars that overlap, held together by two bolts and by friction between their faces."""

from dataclasses import replace

import numpy as np

from dalembert.structure import Material, Rayleigh, Structure, combine, pairs, solid
from dalembert.structure.solid import grid
from dalembert.vibration import ElasticSlider, FrictionContact, HarmonicForce, StaticForce, VibrationSystem

LENGTH, WIDTH, THICKNESS, OVERLAP = 0.20, 0.025, 0.010, 0.060  # m
STEEL = Material(210e9, 0.3, 7800.0)
WASHER = 0.0085  # m
END = 2 * LENGTH - OVERLAP


def bars(along: int, across: int, outside: int = 6) -> tuple[Structure, list[tuple[str, str]]]:
    """The bars, clamped at one end, and the pairs of nodes of their faces. Elements: along and across the overlap."""
    inner = np.linspace(LENGTH - OVERLAP, LENGTH, along + 1)
    first = np.concatenate([np.linspace(0, LENGTH - OVERLAP, outside + 1)[:-1], inner])
    second = np.concatenate([inner, np.linspace(LENGTH, END, outside + 1)[1:]])
    y, z = np.linspace(0, WIDTH, across + 1), np.linspace(0, THICKNESS, 2)
    parts = {"a": solid(grid(first, y, z), STEEL), "b": solid(grid(second, y, z + THICKNESS), STEEL)}
    whole = combine(parts)
    assert whole.nodes is not None
    places, names = whole.nodes.places, np.array(whole.nodes.names)
    of_first = np.char.startswith(names, "a/")
    on_face = (np.abs(places[:, 0] - LENGTH + OVERLAP / 2) < OVERLAP / 2 + 1e-9) & (
        np.abs(places[:, 2] - THICKNESS) < 1e-9
    )
    sets = {"lower": tuple(names[on_face & of_first]), "upper": tuple(names[on_face & ~of_first])}
    whole = replace(whole, nodes=replace(whole.nodes, sets={**whole.nodes.sets, **sets})).fixed("a/left")
    return whole.with_damping(Rayleigh(mass=2.0)), list(pairs(whole, "upper", "lower", 1e-7))


def tip(structure: Structure) -> str:
    """The node at the middle of the free end, or the nearest one."""
    assert structure.nodes is not None
    return str(structure.nodes.nearest((END, WIDTH / 2, 2 * THICKNESS)))


def washers(structure: Structure) -> list[tuple[list[str], float]]:
    """Nodes under the washers of the bolts, and the direction in which these press."""
    assert structure.nodes is not None
    places, names = structure.nodes.places, structure.nodes.names
    result = []
    for part in (0.75, 0.25):
        distance = np.hypot(places[:, 0] - LENGTH + part * OVERLAP, places[:, 1] - WIDTH / 2)
        for height, sense in ((0.0, 1.0), (2 * THICKNESS, -1.0)):
            near = (distance < WASHER) & (np.abs(places[:, 2] - height) < 1e-9)
            result.append(([names[row] for row in np.flatnonzero(near)], sense))
    return result


def lap_joint(
    structure: Structure, mesh: Structure, between: list[tuple[str, str]], force: float, bolt: float
) -> VibrationSystem:
    """The joint of the bars, or of a reduction of their ``mesh``, driven at its tip."""
    system, end = VibrationSystem(structure), tip(mesh)
    system.add(HarmonicForce(f"{end}.z", force))
    for nodes, sense in washers(mesh):
        for node in nodes:
            system.add(StaticForce(f"{node}.z", sense * bolt / len(nodes)))
    count = len(between)
    law = ElasticSlider(2e9 / count, 4e9 / count)
    for number, (first, second) in enumerate(between):
        sides = {"tangential": ("x", "y"), "normal": "-z"}
        system.add(FrictionContact(f"pair {number}", first, second, **sides, friction=0.3, preload=1.0, law=law))
    return system
