"""Two steel bars that overlap, bolted by two bolts: one bar is clamped, friction alone holds the other one.

Bricks of 20 nodes; each pair of nodes of the two faces is a contact.
"""

from dataclasses import replace
from functools import cache

import numpy as np

from dalembert import (
    ElasticSlider,
    FrictionContact,
    HarmonicForce,
    Material,
    Rayleigh,
    StaticForce,
    Structure,
    VibrationSystem,
    combine,
    pairs,
    solid,
)
from dalembert.structure.solid import grid

LENGTH, WIDTH, THICKNESS, OVERLAP = 0.20, 0.025, 0.010, 0.060  # m
STEEL = Material(210e9, 0.3, 7800.0)
BOLTS = 0.75, 0.25
"""Places of the bolts, as parts of the overlap from the end of the clamped bar."""
WASHER = 0.0085  # m, radius
END = 2 * LENGTH - OVERLAP
ALONG, ACROSS = 12, 5
"""Elements of the overlap: 215 pairs of nodes."""


def build(force: float = 4.0, bolt: float = 10_000.0, friction: float = 0.3) -> VibrationSystem:
    """The joint, driven across its faces at the free end.

    Parameters
    ----------
    force : float
        N, amplitude at the free end.
    bolt : float
        N, of each of the two bolts.
    friction : float
        Coefficient of friction of the faces.
    """
    bars, between = mesh()
    system = VibrationSystem(bars)
    if force:
        system.add(HarmonicForce("tip.z", force))
    places, names = bars.nodes.places, bars.nodes.names
    for part in BOLTS:
        distance = np.hypot(places[:, 0] - LENGTH + part * OVERLAP, places[:, 1] - WIDTH / 2)
        for height, sense in ((0.0, 1.0), (2 * THICKNESS, -1.0)):
            under = np.flatnonzero((distance < WASHER) & (np.abs(places[:, 2] - height) < 1e-9))
            for row in under:
                system.add(StaticForce(f"{names[row]}.z", sense * bolt / len(under)))
    law = ElasticSlider(2e9 / len(between), 4e9 / len(between))
    for number, (upper, lower) in enumerate(between, 1):
        sides = {"tangential": ("x", "y"), "normal": "-z"}
        system.add(FrictionContact(f"pair {number}", upper, lower, **sides, friction=friction, law=law))
    return system


@cache
def mesh() -> tuple[Structure, list[tuple[str, str]]]:
    """The bars, the first clamped at its end, and the pairs of nodes of their faces."""
    inner = np.linspace(LENGTH - OVERLAP, LENGTH, ALONG + 1)
    first = np.concatenate([np.linspace(0, LENGTH - OVERLAP, 7)[:-1], inner])
    second = np.concatenate([inner, np.linspace(LENGTH, END, 7)[1:]])
    y, z = np.linspace(0, WIDTH, ACROSS + 1), np.linspace(0, THICKNESS, 2)
    both = combine({"a": solid(grid(first, y, z), STEEL), "b": solid(grid(second, y, z + THICKNESS), STEEL)})
    nodes = both.nodes
    places, names = nodes.places, np.array(nodes.names)
    on_face = (places[:, 0] > LENGTH - OVERLAP - 1e-9) & (places[:, 0] < LENGTH + 1e-9)
    on_face &= np.abs(places[:, 2] - THICKNESS) < 1e-9
    of_first = np.char.startswith(names, "a/")
    sets = {"lower": tuple(names[on_face & of_first]), "upper": tuple(names[on_face & ~of_first])}
    tip = int(np.argmin(np.linalg.norm(places - [END, WIDTH / 2, 2 * THICKNESS], axis=1)))
    both = replace(both, nodes=replace(nodes, sets={**nodes.sets, **sets}))
    both = renamed(both, str(names[tip]), "tip").fixed("a/left").with_damping(Rayleigh(mass=2.0))
    return both, list(pairs(both, "upper", "lower", 1e-7))


def renamed(structure: Structure, before: str, after: str) -> Structure:
    """The structure with another name of a node."""
    dofs = tuple(
        f"{after}.{axis}" if node == before else f"{node}.{axis}"
        for node, _, axis in (name.rpartition(".") for name in structure.dofs.names)
    )
    nodes = tuple(after if name == before else name for name in structure.nodes.names)
    sets = {
        name: tuple(after if node == before else node for node in members)
        for name, members in structure.nodes.sets.items()
    }
    return replace(
        structure, dofs=replace(structure.dofs, names=dofs), nodes=replace(structure.nodes, names=nodes, sets=sets)
    )
