"""Whether motions of odd harmonics alone are possible: opposite displacements have opposite forces."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from dalembert.errors import InputError
from dalembert.vibration.interface.lowering import Lowered
from dalembert.vibration.laws.law_block import LawBlock
from dalembert.vibration.laws.sampled_sums import forces_from_rest
from dalembert.vibration.system.harmonic_force import StaticForce

SIZES = 10.0 ** np.arange(-9, 7, 3)
"""Sizes of the motions, m, at which laws are compared with their opposites."""


def require_symmetry(lowered: Lowered) -> None:
    """Raise InputError where a force or an element causes a mean or even harmonics."""
    lopsided = [f"the static force on {force.dof!r}" for force in lowered.forces if isinstance(force, StaticForce)]
    lopsided += [f"the normal direction of {lowered.contacts[b.contacts[0]]!r}" for b in lowered.blocks if b.normal]
    lopsided += [
        f"the element {name!r}"
        for block in lowered.laws
        for element, name in enumerate(block.names)
        if not _odd(partial(_force, block, element), block.rows.shape[1])
    ]
    lopsided += [
        f"the element {element.name!r}" for rows, element in lowered.functions if not _odd(element.function, len(rows))
    ]
    if lopsided:
        raise InputError(
            f"HarmonicBalance: odd_only=True, but {lopsided[0]} causes a mean or even harmonics; use odd_only=False"
        )


def _force(block: LawBlock, element: int, u: np.ndarray) -> np.ndarray:
    """Forces of an element of a block over motions (columns, samples), from rest."""
    single, motion = replace(block, numbers=block.numbers[[element]]), u[None].astype(complex)
    return np.real(forces_from_rest(single, motion, 0 * motion))[0]


@np.errstate(all="ignore")
def _odd(force: Callable[[np.ndarray], np.ndarray], count: int) -> bool:
    """Whether opposite displacements have opposite forces, at displacements of many sizes."""
    for size in SIZES:
        u = size * np.random.default_rng(0).normal(size=(count, 16))
        # λ(-u) = -λ(u) is what motions of odd harmonics alone need. Random motions of many sizes find a mean or even
        # harmonics at gaps and
        # limits from 1e-9 to 1e6 m.
        forces, back = force(u), force(-u)
        scale = np.abs(forces).max(initial=0.0)
        if np.isfinite(scale) and not np.allclose(forces, -back, rtol=1e-9, atol=1e-12 * scale):
            return False
    return True
