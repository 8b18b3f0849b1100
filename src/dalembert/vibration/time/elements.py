"""Compiled: forces of elements at an instant and their slopes: cells of friction, springs, laws of the user's."""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.views import call_with, stack
from dalembert.kernels.words import Address, Bytes, Integers, Integers2, Reals, Reals2
from dalembert.vibration.laws.friction_law import FRICTION, NORMAL, SEPARATED, SLIPPING, STUCK, TANGENTIAL, update

CUBIC, GAP, STOP = 0, 1, 2
"""Springs without memory."""


class Elements(NamedTuple):
    """Elements of a system.

    Cells of friction: ``rows`` (cells, 3), ``tangents``, ``normal`` (0 or 1), ``numbers`` (cells, 5) as the friction
    law takes them, ``contacts`` (cells,). Springs: ``kinds``, ``places``, ``values`` (springs, 2) of stiffness and gap.
    """

    rows: Integers2
    tangents: Integers
    normal: Integers
    numbers: Reals2
    contacts: Integers
    kinds: Integers
    places: Integers
    values: Reals2


class Reaction(NamedTuple):
    """What elements answer to displacements of the rows that they see.

    Parameters
    ----------
    force : array, shape (rows,)
    slopes : array, shape (rows, rows)
    moved : array, shape (cells, 2)
        Where sliders go.
    states : array of uint8, shape (contacts,)
    """

    force: Reals
    slopes: Reals2
    moved: Reals2
    states: Bytes


def reaction(rows: int, cells: int, contacts: int) -> Reaction:
    """Room for a reaction."""
    return Reaction(np.zeros(rows), np.zeros((rows, rows)), np.zeros((cells, 2)), np.zeros(contacts, dtype=np.uint8))


@inner
def _spring(kind, stiffness, gap, u):
    """Force of a spring without memory and its slope."""
    if kind == CUBIC:
        return stiffness * u**3, 3.0 * stiffness * u**2
    side = -1.0 if kind == STOP and u <= 0.0 else 1.0
    over = u - side * gap
    if side * over <= 0.0:
        return 0.0, 0.0
    return stiffness * over, stiffness


@inner
def _cell(elements, c, u, sliders, moved, force, slopes, states):
    """Add the forces of a cell and their slopes; where its slider goes."""
    rows, t, numbers, normal = elements.rows[c], elements.tangents[c], elements.numbers[c], elements.normal[c] != 0
    d, own, direction = stack(u, 3), stack(u, 3), stack(u, 2)
    for i in range(t + elements.normal[c]):
        d[i] = u[rows[i]]
    for i in range(t):
        direction[i] = numbers[TANGENTIAL] * (d[i] - sliders[c, i])
    for i in range(2):
        moved[c, i] = sliders[c, i]
    state, size = update(d, moved[c], own, numbers, t, normal, True)
    states[elements.contacts[c]] = max(states[elements.contacts[c]], state)
    for i in range(t + elements.normal[c]):
        force[rows[i]] += own[i]
    if state == SEPARATED:
        return
    if normal:
        slopes[rows[t], rows[t]] += numbers[NORMAL]
    if state == STUCK:
        for i in range(t):
            slopes[rows[i], rows[i]] += numbers[TANGENTIAL]
    elif state == SLIPPING:
        ratio = np.sqrt(own[0] * own[0] + (own[1] * own[1] if t == 2 else 0.0)) / size
        for i in range(t):
            direction[i] /= size
        for i in range(t):
            if normal:
                slopes[rows[i], rows[t]] += numbers[FRICTION] * numbers[NORMAL] * direction[i]
            if t == 2:
                slopes[rows[i], rows[i]] += numbers[TANGENTIAL] * ratio
                for j in range(t):
                    slopes[rows[i], rows[j]] -= numbers[TANGENTIAL] * ratio * direction[i] * direction[j]


@inner
def answer(elements, users, u, sliders, reaction):
    """As :func:`react`."""
    force, slopes, states = reaction.force, reaction.slopes, reaction.states
    force[:] = 0.0
    slopes[:] = 0.0
    states[:] = 0
    for c in range(len(elements.tangents)):
        _cell(elements, c, u, sliders, reaction.moved, force, slopes, states)
    for s in range(len(elements.kinds)):
        row = elements.places[s]
        value, slope = _spring(elements.kinds[s], elements.values[s, 0], elements.values[s, 1], u[row])
        force[row] += value
        slopes[row, row] += slope
    if users != 0:
        call_with(users, u, force, slopes)


@kernel
def react(elements: Elements, users: Address, u: Reals, sliders: Reals2, reaction: Reaction) -> None:
    """The reaction of all elements to displacements; ``users`` adds that of laws of the user's, if there are any."""
    answer(elements, users, u, sliders, reaction)


@kernel
def settle(elements: Elements, users: Address, displacements: Reals2, sliders: Reals2, reaction: Reaction) -> None:
    """Move sliders (cells, 2) to where they end in a period of displacements (steps, rows) gone through repeatedly."""
    for _ in range(3):
        for t in range(len(displacements)):
            answer(elements, users, displacements[t], sliders, reaction)
            for c in range(len(sliders)):
                sliders[c, 0], sliders[c, 1] = reaction.moved[c, 0], reaction.moved[c, 1]
