"""The force that balances the energy of eight samples side by side: :mod:`energy_balance`, with a strength for each."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import vector_kernel
from dalembert.kernels.lanes import WIDTH, entry, lane_vector, lane_zeros, lanes2
from dalembert.kernels.views import address_of
from dalembert.kernels.words import Address, Integers, Reals, Reals2, Reals3
from dalembert.multibody.integrators.midpoint.energy_balance import (
    MOST_STRENGTHS,
    FreeRigidMotions,
    direct,
    energy_of_step,
    is_balanced,
    stronger,
)
from dalembert.multibody.integrators.midpoint.lanes_step import (
    ARRIVED,
    PENDING,
    RATE,
    LanesStep,
    converge_lanes,
    lane_rows,
)
from dalembert.multibody.integrators.shared.lane_states import lane_masses
from dalembert.multibody.integrators.shared.problem import IntegrationProblem
from dalembert.multibody.kernels.elementary import where

ENERGY, GAIN, STRENGTH, EXCESS, SEARCHES, IS_FREE, WANTED, HAS_ARRIVED, FIRST_RATE = range(9)
"""Rows of the numbers of lanes: see :class:`LanesBalance`."""


class LaneMotions(NamedTuple):
    """Rigid motions of lanes: as of `energy_balance.FreeRigidMotions`, with ``shift`` (motions, N + 1, 8)."""

    partner: Integers
    sign: Reals
    spin: Reals
    shift: Reals3


class LaneDirection(NamedTuple):
    """What :func:`energy_balance.direct` needs: rigid motions, workspace for them and for their momenta, the force."""

    rigid: LaneMotions
    motions: Reals3
    weighed: Reals3
    force: Reals2


class LanesBalance(NamedTuple):
    """Work of the balance. ``totals`` (3, 8): energies. ``numbers`` (9, 8): the energy that the next step must have,
    the work in a step, strength of the force, excess of energy before, whether a lane searches, whether no strength
    serves, whether its step is to be done, whether all its iterations converged, contraction without the force.
    ``converge``: address of the kernel, 0 if the energy is not balanced.
    """

    direction: LaneDirection
    totals: Reals2
    numbers: Reals2
    converge: Address


def lanes_balance(width: int, motions: Sequence[FreeRigidMotions], energies: Sequence[float]) -> LanesBalance:
    """Workspace for the balance of eight samples, by their rigid motions and energies at the start, in J; of none."""
    # Without balance the kernel of the balance is not even compiled.
    if not motions:
        none, stack = lane_zeros(0), lane_zeros(0, width)
        rigid = LaneMotions(np.zeros(0, np.int64), np.zeros(0), np.zeros(0), stack)
        return LanesBalance(LaneDirection(rigid, stack, stack, none), none, lane_zeros(9), 0)
    first, count = motions[0], len(motions[0].spin)
    shift, numbers = lane_zeros(count, width), lane_zeros(9)
    numbers[ENERGY] = energies
    for lane, own in enumerate(motions):
        shift[:, : len(first.partner), lane] = own.shift
    rigid = LaneMotions(first.partner, first.sign, first.spin, shift)
    direction = LaneDirection(rigid, lane_zeros(count, width), lane_zeros(count, width), lane_zeros(width))
    return LanesBalance(direction, lane_zeros(3), numbers, balance_lanes.address)


@vector_kernel
def balance_lanes(
    problem: IntegrationProblem, h: float, tolerance: float, least: Reals, step: LanesStep, balance: LanesBalance
) -> None:
    """Steps of the pending lanes whose energy is that of the start and the work since: `energy_balance.converge`."""
    n, s, values, own, width = problem.n, lane_rows(step.rows), balance.numbers, balance.direction, step.rows.shape[1]
    numbers, totals, push = lane_vector(values), lane_vector(balance.totals), lane_vector(step.push)
    count = own.motions.shape[0]
    rigid = LaneMotions(
        own.rigid.partner, own.rigid.sign, own.rigid.spin, lanes2(address_of(own.rigid.shift), count, width)
    )
    direction = LaneDirection(
        rigid, lanes2(address_of(own.motions), count, width), lanes2(address_of(own.weighed), count, width),
        lane_vector(own.force),
    )  # fmt: skip
    # All lanes begin without the force, and search a strength for themselves.
    for lane in range(WIDTH):
        wanted = step.numbers[PENDING, lane]
        values[WANTED, lane] = values[SEARCHES, lane] = values[HAS_ARRIVED, lane] = wanted
        values[GAIN, lane], values[STRENGTH, lane], values[EXCESS, lane], values[IS_FREE, lane] = 0.0, 0.0, 1e300, 0.0
    for attempt in range(MOST_STRENGTHS):
        # The directions are those of the last solutions, so the balance is a fixed point over both.
        power = direct(n, lane_masses(step.masses), s, direction)
        for k in range(n):
            push[k] = numbers[STRENGTH] * direction.force[k]
        # Only lanes that search take the step again: the others keep their solution.
        for lane in range(WIDTH):
            step.numbers[PENDING, lane] = values[SEARCHES, lane]
        converge_lanes(problem, h, tolerance, least, s, step)
        energy, gain = energy_of_step(step.model, h, s, step.middle, step.end, totals)
        # The work of lanes that search no more stays.
        numbers[GAIN] = where(numbers[SEARCHES] != 0.0, gain, numbers[GAIN])
        running = False
        for lane in range(WIDTH):
            if values[SEARCHES, lane] == 0.0:
                continue
            # The contraction without the force says how old the matrices are.
            if attempt == 0:
                values[FIRST_RATE, lane] = step.numbers[RATE, lane]
            if step.numbers[ARRIVED, lane] == 0.0:
                values[SEARCHES, lane], values[HAS_ARRIVED, lane] = 0.0, 0.0
                continue
            # Energy at the end less that of the start and the work of loads and losses since.
            excess = entry(energy, lane) - (values[ENERGY, lane] + values[GAIN, lane])
            size = abs(balance.totals[0, lane]) + abs(balance.totals[1, lane])
            if values[IS_FREE, lane] == 1.0 or is_balanced(
                attempt, excess, values[EXCESS, lane], entry(power, lane), size
            ):
                values[SEARCHES, lane] = 0.0
                continue
            values[EXCESS, lane] = abs(excess)
            strength, is_free = stronger(h, values[STRENGTH, lane], excess, entry(power, lane))
            values[STRENGTH, lane], values[IS_FREE, lane] = strength, 1.0 if is_free else 0.0
            running = True
        if not running:
            break
    for lane in range(WIDTH):
        step.numbers[PENDING, lane], step.numbers[ARRIVED, lane] = values[WANTED, lane], values[HAS_ARRIVED, lane]
        step.numbers[RATE, lane] = values[FIRST_RATE, lane]
