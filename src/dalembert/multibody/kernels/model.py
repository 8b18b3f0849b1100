"""The compiled form of any model: arrays, one block a kind of component.

All arrays of unknowns have length N + 1 for n coordinates and m multipliers, N = n + m: coordinates, multipliers, and a
last entry that stays zero, to which absent slots of a component point.
"""

from typing import NamedTuple

import numpy as np

from dalembert.multibody.kernels import beam, body, cable, friction, joints, load, spring, user
from dalembert.multibody.kernels.compiled import compiled, inlined, template

#: The kinds in the order of the fields of `Model`.
KINDS = {
    "beams": beam,
    "cables": cable,
    "bodies": body,
    "joints": joints,
    "frictions": friction,
    "springs": spring,
    "loads": load,
    "users": user,
}
WIDEST = 12


class Block(NamedTuple):
    """Components of one kind: unknowns (count, width), integers (count, -) and numbers (count, -)."""

    index: np.ndarray
    meta: np.ndarray
    data: np.ndarray


class Signals(NamedTuple):
    """Functions of time, see :mod:`signals`."""

    index: np.ndarray
    knots: np.ndarray
    data: np.ndarray


class Model(NamedTuple):
    """A whole model in real numbers, or in complex ones as a direction of differentiation."""

    beams: Block
    cables: Block
    bodies: Block
    joints: Block
    frictions: Block
    springs: Block
    loads: Block
    users: Block
    signals: Signals
    callbacks: np.ndarray


class Slots(NamedTuple):
    """Places of the local matrix entries of each kind in a stored matrix, (count, width, width)."""

    beams: np.ndarray
    cables: np.ndarray
    bodies: np.ndarray
    joints: np.ndarray
    frictions: np.ndarray
    springs: np.ndarray
    loads: np.ndarray
    users: np.ndarray


class Work(NamedTuple):
    """Local vectors of one component, the signals' values, and a local vector and matrix in real numbers."""

    x: np.ndarray
    v: np.ndarray
    a: np.ndarray
    r: np.ndarray
    signals: np.ndarray
    real: np.ndarray
    matrix: np.ndarray


@template
def _select(stack, d):
    return Model(
        Block(stack.beams.index, stack.beams.meta, stack.beams.data[d]),
        Block(stack.cables.index, stack.cables.meta, stack.cables.data[d]),
        Block(stack.bodies.index, stack.bodies.meta, stack.bodies.data[d]),
        Block(stack.joints.index, stack.joints.meta, stack.joints.data[d]),
        Block(stack.frictions.index, stack.frictions.meta, stack.frictions.data[d]),
        Block(stack.springs.index, stack.springs.meta, stack.springs.data[d]),
        Block(stack.loads.index, stack.loads.meta, stack.loads.data[d]),
        Block(stack.users.index, stack.users.meta, stack.users.data[d]),
        Signals(stack.signals.index, stack.signals.knots, stack.signals.data[d]),
        stack.callbacks[d],
    )


@compiled
def select(stack, d):
    """Model ``d`` of a stack, whose numbers and callbacks have one more leading axis."""
    return _select(stack, d)


@inlined
def glance(stack, d):
    """The same inside functions that do not count references."""
    return _select(stack, d)


@compiled
def workspace(model):
    """Local vectors in the arithmetic of the model."""
    zero = model.signals.data[:1] * 0
    local = np.zeros((4, WIDEST), zero.dtype)
    values = np.zeros((len(model.signals.index), 3), zero.dtype)
    return Work(local[0], local[1], local[2], local[3], values, np.zeros(WIDEST), np.zeros((WIDEST, WIDEST)))
