"""Compiled: forces of elements at an instant and their slopes: cells of friction, laws, functions of arrays."""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.views import call_with, stack
from dalembert.kernels.words import Address, Bytes, Complexes, Integers, Integers2, Reals, Reals2
from dalembert.vibration.laws.friction_law import FRICTION, NORMAL, SEPARATED, SLIPPING, STUCK, TANGENTIAL, update
from dalembert.vibration.laws.law import call_law
from dalembert.vibration.laws.sampled_sums import STEP

COLUMNS, NUMBERS, STATES, NUMBER, STATE = range(5)
"""Columns of the layout of elements with a law: how many of each, and where numbers and states begin."""


PERIODS = 3
"""Periods in which a motion's past is settled; sliders in one dimension need two."""


class Ruled(NamedTuple):
    """Elements that follow a law. ``laws`` (elements,): addresses. ``layout`` (elements, 5): see above. ``rows``
    (elements, columns), ``numbers``: of all elements, one after the other. ``u``, ``v``, ``z`` and ``force`` are
    workspace for one of them.
    """

    laws: Integers
    layout: Integers2
    rows: Integers2
    numbers: Complexes
    u: Complexes
    v: Complexes
    z: Complexes
    force: Complexes


class Elements(NamedTuple):
    """Elements of a system. Cells of friction: ``rows`` (cells, 3), ``tangents``, ``normal`` (0 or 1), ``numbers``
    (cells, 5) as the friction law takes them, ``contacts`` (cells,). ``ruled``: elements that follow a law.
    """

    rows: Integers2
    tangents: Integers
    normal: Integers
    numbers: Reals2
    contacts: Integers
    ruled: Ruled


class Instant(NamedTuple):
    """What elements see: ``u`` (rows,) displacements, and velocities ``rate + factor · u``; and what they remember.

    ``sliders`` (cells, 2); ``states`` of all elements that follow a law, one after the other.
    """

    u: Reals
    rate: Reals
    factor: float
    sliders: Reals2
    states: Reals


class Reaction(NamedTuple):
    """What elements answer to displacements of the rows that they see. ``force`` (rows,); ``slopes`` (rows, rows);
    ``moved`` (cells, 2): where sliders go; ``next``: states of laws after; ``states`` (contacts,).
    """

    force: Reals
    slopes: Reals2
    moved: Reals2
    next: Reals
    states: Bytes


def reaction(rows: int, elements: Elements, contacts: int) -> Reaction:
    """Workspace for a reaction."""
    return Reaction(
        np.zeros(rows), np.zeros((rows, rows)), np.zeros((len(elements.tangents), 2)),
        np.zeros(int(elements.ruled.layout[:, STATES].sum())), np.zeros(contacts, dtype=np.uint8),
    )  # fmt: skip


@inner
def _cell(elements, c, u, sliders, moved, force, slopes, states):
    """Add the forces of a cell and their slopes; where its slider goes."""
    rows, t, numbers, normal = elements.rows[c], elements.tangents[c], elements.numbers[c], elements.normal[c] != 0
    d, own, direction = stack(u, 3), stack(u, 3), stack(u, 2)
    for i in range(t + elements.normal[c]):
        d[i] = u[rows[i]]
    for i in range(t):
        # The trial force, of which the slope of a slip in two directions takes the direction.
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
def _follow(ruled, e, instant, reaction):
    """Add the forces of an element that follows a law, and their slopes; its state after."""
    own, rows = ruled.layout[e], ruled.rows[e]
    columns, states, begin = own[COLUMNS], own[STATES], own[STATE]
    u, v, z, force = ruled.u[:columns], ruled.v[:columns], ruled.z[:states], ruled.force[:columns]
    numbers = ruled.numbers[own[NUMBER] : own[NUMBER] + own[NUMBERS]]
    for direction in range(columns):
        for i in range(columns):
            u[i] = instant.u[rows[i]]
            v[i] = instant.rate[rows[i]] + instant.factor * instant.u[rows[i]]
        for i in range(states):
            z[i] = instant.states[begin + i]
        u[direction] += 1j * STEP
        v[direction] += 1j * STEP * instant.factor
        call_law(ruled.laws[e], u, v, z, numbers, force)
        for i in range(columns):
            reaction.slopes[rows[i], rows[direction]] += force[i].imag / STEP
    for i in range(columns):
        reaction.force[rows[i]] += force[i].real
    for i in range(states):
        reaction.next[begin + i] = z[i].real


@inner
def answer(elements, users, instant, reaction):
    """As :func:`react`."""
    force, slopes, states = reaction.force, reaction.slopes, reaction.states
    force[:] = 0.0
    slopes[:] = 0.0
    states[:] = 0
    for c in range(len(elements.tangents)):
        _cell(elements, c, instant.u, instant.sliders, reaction.moved, force, slopes, states)
    for e in range(len(elements.ruled.laws)):
        _follow(elements.ruled, e, instant, reaction)
    if users != 0:
        call_with(users, instant.u, force, slopes)


@kernel
def react(elements: Elements, users: Address, instant: Instant, reaction: Reaction) -> None:
    """The reaction of all elements at an instant; ``users`` adds that of functions of arrays, if there are any."""
    answer(elements, users, instant, reaction)


@kernel
def settle(
    elements: Elements, users: Address, displacements: Reals2, velocities: Reals2, sliders: Reals2, states: Reals,
    reaction: Reaction,
) -> None:  # fmt: skip
    """Move sliders (cells, 2) and states to where they end in a period (steps, rows) gone through repeatedly."""
    # The motion is known: sliders and states follow it from rest until its past no longer matters.
    for _ in range(PERIODS):
        for t in range(len(displacements)):
            answer(elements, users, Instant(displacements[t], velocities[t], 0.0, sliders, states), reaction)
            for c in range(len(sliders)):
                sliders[c, 0], sliders[c, 1] = reaction.moved[c, 0], reaction.moved[c, 1]
            for i in range(len(states)):
                states[i] = reaction.next[i]
