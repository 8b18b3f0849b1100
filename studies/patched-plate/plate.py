"""A clamped steel plate with four arched aluminium patches whose feet rub on it, reduced to some 240 coordinates.

What the source does not tell is chosen: the measures of a patch (see :class:`dalembert.Patch`), where the forces act,
and that a foot touches the plate at four nodes, each of which carries the preload and may slip both ways and lift off.
"""

import hashlib
import inspect
import os
import tempfile
from functools import cache
from pathlib import Path

import numpy as np

import dalembert
from dalembert import (
    Dofs,
    FrictionContact,
    HarmonicForce,
    Modal,
    Nodes,
    ReducedStructure,
    Rigid,
    Structure,
    VibrationSystem,
    craig_bampton,
    foot_pairs,
    patched_plate,
)
from dalembert import structure as structure_package

MODES = 50
ELEMENTS = 6
SIDE = 0.405
FORCED = {"left": (0.38, 0.5), "right": (0.62, 0.5), "front": (0.5, 0.38), "back": (0.5, 0.62)}
"""Where the forces act, as parts of the side; one after the other by a quarter of a period.

The response and the best preload grow with the motion of the fifth mode at these points, so the places are chosen to
have the best preload near the published 80 N.
"""
FOLDER = Path(__file__).parent / "runs" / "reduced"


def build(
    friction: complex = 0.6,
    preload: complex = 80.0,
    force: complex = 15.0,
    damping_ratio: complex = 0.002,
) -> VibrationSystem:
    """The plate, its forces and its contacts.

    Parameters
    ----------
    friction : float
        Coefficient of friction.
    preload : float
        N, at each of the four nodes of a foot. With 0 the feet do not touch the plate at all.
    force : float
        N, at each of the four points "left", "right", "front" and "back".
    damping_ratio : float
        Of all modes of the plate with its feet free.
    """
    plate, pairs = reduced()
    system = VibrationSystem(plate.with_damping(Modal(damping_ratio)))
    for quarter, point in enumerate(FORCED):
        system.add(HarmonicForce(f"{point}.z", force, phase=quarter * np.pi / 2))
    if preload == 0:
        return system
    law = Rigid()
    for name, foot, below in pairs:
        contact = FrictionContact(
            name, foot, below, tangential=("x", "y"), normal="-z", friction=friction, preload=preload, law=law
        )
        system.add(contact)
    return system


@cache
def reduced() -> tuple[ReducedStructure, tuple[tuple[str, str, str], ...]]:
    """The reduced plate with free feet, and its contacts: name, node of a foot, node of the plate below it.

    Kept on disk by what it is made from; made anew, in some fifteen seconds, if that changes.
    """
    path = FOLDER / f"{_key()}.npz"
    if not path.exists():
        _keep(path, *_reduce(full()))
    with np.load(path) as kept:
        nodes = Nodes(tuple(kept["node_names"].tolist()), kept["places"], {}, kept["faces"])
        plate = ReducedStructure(
            kept["mass"], kept["stiffness"], Dofs(tuple(kept["names"].tolist())), None, nodes,
            basis=kept["basis"], full_dofs=Dofs(tuple(kept["full_names"].tolist())),
        )  # fmt: skip
        return plate, tuple(map(tuple, kept["pairs"].tolist()))


def full() -> Structure:
    """The clamped plate with free feet, all of its degrees of freedom."""
    return patched_plate(side=SIDE, elements=ELEMENTS).fixed("plate/edge")


def masters(plate: Structure) -> tuple[dict[str, str], tuple[tuple[str, str, str], ...]]:
    """Nodes of the full plate on which forces act, by their names here, and contacts."""
    top = plate.nodes.members("plate/top")
    places = plate.nodes.places[plate.nodes.rows(top)]
    forced = {
        name: top[int(np.linalg.norm(places[:, :2] - SIDE * np.array(at), axis=1).argmin())]
        for name, at in FORCED.items()
    }
    pairs = tuple(
        (f"patch {number // 8 + 1} {'outer' if number % 8 < 4 else 'inner'} {number % 4 + 1}", *pair)
        for number, pair in enumerate(foot_pairs(plate))
    )
    return forced, pairs


def _reduce(plate: Structure) -> tuple[ReducedStructure, dict[str, str], tuple[tuple[str, str, str], ...]]:
    forced, pairs = masters(plate)
    touching = [node for _, *pair in pairs for node in pair]
    return craig_bampton(plate, [*touching, *(f"{node}.z" for node in forced.values())], MODES), forced, pairs


def _keep(path: Path, plate: ReducedStructure, forced: dict[str, str], pairs: tuple[tuple[str, str, str], ...]) -> None:
    """Write what is needed later: all matrices, and the motion of the nodes that pictures show. Whole or not at all."""
    touching = [node for _, *pair in pairs for node in pair]
    shown = np.union1d(plate.nodes.faces, plate.nodes.rows(touching))  # contacts have places, too
    names = np.array(plate.nodes.names)[shown]
    rows = [row for row, name in enumerate(plate.full_dofs.names) if name.rpartition(".")[0] in set(names)]
    called = {node: name for name, node in forced.items()}  # nodes and degrees of freedom, so that forces have places
    called |= {f"{node}.{axis}": f"{name}.{axis}" for node, name in called.items() for axis in "xyz"}
    full_names = [called.get(name, name) for name in np.array(plate.full_dofs.names)[rows].tolist()]
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, part = tempfile.mkstemp(dir=path.parent, suffix=".part")
    with os.fdopen(handle, "wb") as file:
        np.savez(
            file, mass=plate.mass, stiffness=plate.stiffness, pairs=pairs,
            names=[called.get(name, name) for name in plate.dofs.names],
            basis=plate.basis[rows], full_names=full_names,
            node_names=[called.get(name, name) for name in names.tolist()],
            places=plate.nodes.places[shown], faces=np.searchsorted(shown, plate.nodes.faces),
        )  # fmt: skip
    Path(part).replace(path)


def _key() -> str:
    """Digest of this file, of the code that makes structures, and of the version."""
    sources = sorted(Path(inspect.getfile(structure_package)).parent.glob("*.py"))
    digest = hashlib.sha256(dalembert.__version__.encode())
    for source in (Path(__file__), *sources):
        digest.update(source.read_bytes())
    return digest.hexdigest()[:16]
