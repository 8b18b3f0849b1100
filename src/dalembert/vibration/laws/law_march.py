r"""Compiled: a law along a periodic motion, from sample to sample or between its events.

The displacement is a trigonometric polynomial :math:`u(\tau) = \sum_j U_j \varphi_j(\tau)`,
:math:`\tau = \omega t`. The law goes from node to node and keeps its internal state. The Fourier coefficients of its
force are

.. math:: F_j = \frac{1}{\pi} \int_0^{2\pi} \lambda(\tau)\, \varphi_j(\tau)\, \mathrm{d}\tau

(half of that for the mean), by a rule whose nodes lie in each interval. Events of the law divide intervals, so that the
rule integrates smooth pieces only, and the state at an event is exact.

Derivatives are complex steps along coefficients, ω or states at the start; events move with them.
"""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Address, Complexes, Complexes2, Complexes3, Integers, Reals, Reals3
from dalembert.vibration.dense import dot
from dalembert.vibration.laws.law import call_law
from dalembert.vibration.laws.sampled_sums import STEP
from dalembert.vibration.laws.signal_zeros import waves

MOST = 12
"""Events in an interval, at most."""
REFINEMENTS = 80
"""Steps to a zero, at most."""
NEAR = 1e-6
"""Part of a piece behind its begin at which the signs of events are taken: at an event itself one is zero."""
UNPERTURBED = -1
"""Direction of a march without a complex step."""


class Rule(NamedTuple):
    """Quadrature of a period. ``offsets`` and ``weights`` (nodes,) of the nodes in an interval, as parts of it;
    ``nodes`` (2, intervals · nodes, coefficients): waves and their derivatives at the nodes; ``orders`` of the
    harmonics, and 1 in ``mean`` if 0 is among them.
    """

    offsets: Reals
    weights: Reals
    nodes: Reals3
    orders: Integers
    mean: int


class Motion(NamedTuple):
    """Coefficients (columns, coefficients) and ω (1,), displacements and velocities (columns, nodes) at the nodes.

    ``along`` (2,) is the direction of differentiation: column and coefficient, ω after all columns, or ``UNPERTURBED``.
    """

    coefficients: Complexes2
    omega: Complexes
    place: Complexes2
    velocity: Complexes2
    along: Integers


class Called(NamedTuple):
    """A law and its events by their addresses, the number of events (0: none are looked for), and its numbers."""

    law: Address
    events: Address
    event_count: int
    numbers: Complexes


class MarchWorkspace(NamedTuple):
    """Displacements, velocities, forces (columns,), events at the begin, at the end and between; waves (2, 1, -)."""

    u: Complexes
    v: Complexes
    force: Complexes
    first: Complexes
    last: Complexes
    values: Complexes
    table: Complexes3


@inner
def _perturb(motion, table, row, scratch):
    """Add the complex step of displacements and velocities, from waves (2, -, coefficients) in a row."""
    column, coefficient = motion.along[0], motion.along[1]
    if column == len(scratch.v):
        for c in range(len(scratch.v)):
            scratch.v[c] += 1j * STEP * scratch.v[c] / motion.omega[0]
    elif column >= 0:
        scratch.u[column] += 1j * STEP * table[0, row, coefficient]
        scratch.v[column] += 1j * STEP * motion.omega[0] * table[1, row, coefficient]


@inner
def _move(tau, motion, rule, scratch):
    """Set displacements and velocities to those at an angle."""
    waves(tau, rule.orders, rule.mean, scratch.table[:, 0], 2)
    for c in range(len(scratch.u)):
        scratch.u[c] = dot(motion.coefficients[c], scratch.table[0, 0])
        scratch.v[c] = motion.omega[0] * dot(motion.coefficients[c], scratch.table[1, 0])
    _perturb(motion, scratch.table, 0, scratch)


@inner
def _move_to_node(node, motion, rule, scratch):
    """The same at a node, where they are known."""
    for c in range(len(scratch.u)):
        scratch.u[c], scratch.v[c] = motion.place[c, node], motion.velocity[c, node]
    _perturb(motion, rule.nodes, node, scratch)


@inner
def _events(law, tau, motion, z, rule, scratch, values):
    """Values of the events' functions at an angle."""
    _move(tau, motion, rule, scratch)
    call_law(law.events, scratch.u, scratch.v, z, law.numbers, values)


@inner
def _zero(law, k, low, high, first, last, motion, z, rule, scratch):
    """The angle between two angles at which an event's function is zero, by regula falsi (Illinois)."""
    side = 0
    for _ in range(REFINEMENTS):
        # Regula falsi keeps its bracket without derivatives of the user's function; Illinois halves the value of an end
        # that stays, which makes it superlinear (Dowell and Jarratt, BIT 11, 1971).
        place = low + (high - low) * first / (first - last)
        if not low < place < high:
            break
        _events(law, place + 0j, motion, z, rule, scratch, scratch.values)
        value = scratch.values[k].real
        if value == 0.0 or high - low < 1e-15:
            return place
        if (value > 0.0) == (first > 0.0):
            low, first = place, value
            last = 0.5 * last if side == 1 else last
            side = 1
        else:
            high, last = place, value
            first = 0.5 * first if side == -1 else first
            side = -1
    return low if abs(first) < abs(last) else high


@inner
def _next_event(law, begin, end, motion, z, rule, scratch):
    """The next event between two angles and whether there is one, else the end."""
    # At an event its own function is zero with either sign: the signs are taken a little behind it.
    low = (begin + NEAR * (end - begin)).real
    _events(law, low + 0j, motion, z, rule, scratch, scratch.first)
    _events(law, end + 0j, motion, z, rule, scratch, scratch.last)
    event, angle = -1, end
    for k in range(law.event_count):
        first, last = scratch.first[k].real, scratch.last[k].real
        # Only a change of sign between both ends counts: an event function that touches zero between two samples
        # divides nothing, since the law is smooth there.
        if (first > 0.0) != (last > 0.0):
            zero = _zero(law, k, low, end, first, last, motion, z, rule, scratch)
            if zero < angle or event < 0:
                event, angle = k, zero
    if event < 0:
        return end + 0j, False
    # Newton's step in complex numbers: the event moves with the direction of differentiation.
    _events(law, angle + 0j, motion, z, rule, scratch, scratch.values)
    value = scratch.values[event]
    _events(law, angle + 1j * STEP, motion, z, rule, scratch, scratch.values)
    slope = (scratch.values[event] - value).imag / STEP
    return angle - 1j * (value.imag / slope if slope != 0.0 else 0.0), True


@inner
def _act(law, z, largest, scratch):
    """The law at the present displacements and velocities."""
    call_law(law.law, scratch.u, scratch.v, z, law.numbers, scratch.force)
    for s in range(len(z)):
        largest[s] = max(largest[s], abs(z[s].real))


@inner
def _march(law, motion, z, largest, rule, scratch, sampled, pieces):
    """A period from a state (states,), which it replaces by the end. It writes the forces at nodes ``sampled``
    (columns, nodes) of intervals without events, and adds the integrals over all others to ``pieces``
    (columns, coefficients).
    """
    nodes = len(rule.offsets)
    intervals = rule.nodes.shape[1] // nodes
    width = 2.0 * np.pi / intervals
    for t in range(intervals):
        begin, end, event = t * width + 0j, (t + 1) * width + 0j, False
        if law.event_count > 0:
            end, event = _next_event(law, begin, (t + 1) * width, motion, z, rule, scratch)
        if not event:
            for k in range(t * nodes, (t + 1) * nodes):
                _move_to_node(k, motion, rule, scratch)
                _act(law, z, largest, scratch)
                for c in range(len(scratch.force)):
                    sampled[c, k] = scratch.force[c]
            continue
        # Pieces between events: Gauss's rule on each, so that kinks cost no order.
        for _ in range(MOST):
            for k in range(nodes):
                _move(begin + (end - begin) * rule.offsets[k], motion, rule, scratch)
                _act(law, z, largest, scratch)
                for c in range(len(scratch.force)):
                    for j in range(pieces.shape[1]):
                        pieces[c, j] += rule.weights[k] * (end - begin) * scratch.force[c] * scratch.table[0, 0, j]
            if not event:
                break
            _move(end, motion, rule, scratch)
            _act(law, z, largest, scratch)
            begin = end
            end, event = _next_event(law, begin, (t + 1) * width, motion, z, rule, scratch)


@kernel
def marches(
    law: Called, motion: Motion, start: Complexes2, directions: Integers, periods: int, rule: Rule,
    scratch: MarchWorkspace,
    largest: Reals, sampled: Complexes3, pieces: Complexes3,
) -> None:  # fmt: skip
    """A march of some periods in each direction from each start (directions, states), which it replaces by the end.
    ``sampled`` (directions, columns, nodes) and ``pieces`` (directions, columns, coefficients), see :func:`_march`, are
    of the last period.
    """
    count = pieces.shape[2]
    for d in range(len(directions)):
        motion.along[0], motion.along[1] = directions[d] // count, directions[d] % count
        for _ in range(periods):
            sampled[d], pieces[d] = 0.0, 0.0
            largest[:] = 0.0
            _march(law, motion, start[d], largest, rule, scratch, sampled[d], pieces[d])
