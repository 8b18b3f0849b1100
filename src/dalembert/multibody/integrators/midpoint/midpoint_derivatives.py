"""Derivatives of the converged steps of the constrained midpoint rule, with and without balanced energy."""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import Compiled, inner
from dalembert.kernels.words import Address, Integers, Reals2, Reals3
from dalembert.multibody.integrators.midpoint import prediction
from dalembert.multibody.integrators.midpoint.energy_balance import (
    Balance,
    balance_along,
    converge_along_with_energy,
)
from dalembert.multibody.integrators.midpoint.midpoint_step import (
    MidpointStep,
    along_of,
    converge_along,
    read,
    takes_means,
)
from dalembert.multibody.integrators.shared.matrices import Matrices
from dalembert.multibody.integrators.shared.problem import VELOCITY, IntegrationProblem
from dalembert.multibody.integrators.shared.settling import settle_along
from dalembert.multibody.kernels.assembly import set_signals
from dalembert.multibody.kernels.records import call_at
from dalembert.multibody.kernels.slopes import (
    Number,
    SlopeWork,
    along_kernels,
    arrays_of,
    read_rows,
    read_states,
    slope_work,
    state_of,
    write_rows,
    write_states,
)
from dalembert.multibody.kernels.states import MotionState, MotionStates, copy

_NEW, _OLD, _MISSED, _ENERGY, _END = 15, 19, 23, 25, 26
"""First vectors of slopes behind those of a step: states at its ends, what it missed, the energy; and their end."""


class Derivatives(NamedTuple):
    """Work of the derivatives along directions: calls for the middle and the end of a step, vectors. ``slopes``
    (directions, 2, N + 1) are what a step missed; ``energies`` (directions, 1) are derivatives of the energy, at the
    start and then of the balanced one. ``differentiate`` is the address of the kernel, 0 if there are no directions.
    """

    middle: Address
    end: Address
    slopes: Reals3
    energies: Reals2
    work: SlopeWork
    differentiate: Address


def derivatives(
    middle: int, end: int, denergies: np.ndarray, width: int, is_balanced: bool, together: bool
) -> Derivatives:
    """Workspace; calls along directions for the ``middle`` and the ``end`` of a step."""
    directions = len(denergies)
    return Derivatives(
        middle, end, np.zeros((directions, 2, width)), denergies[:, None], slope_work(width, _END, 15, together),
        KERNELS[is_balanced, together].address if directions else 0,
    )  # fmt: skip


@inner
def _differentiate(
    like, problem, matrices, perturbed, g, step, balance, strength, h, last, t, target, within, new, dnews, moved,
    scratch
):  # fmt: skip
    """Derivatives of a step along a group of directions; ``balance`` is None where the energy is not balanced."""
    n, middle, end, lanes = problem.n, scratch.middle, scratch.end, scratch.work.slopes
    numbers, slopes = arrays_of(like, scratch.work)
    # Rows of the derivatives in and out: within the step those of a group lie side by side.
    dnew, dold, missed = state_of(slopes[_NEW:_OLD]), state_of(slopes[_OLD:_MISSED]), slopes[_MISSED:_ENERGY]
    along = along_of(middle, end, numbers, slopes)
    read_states(dnews, g, lanes[_NEW:_OLD])
    read_rows(scratch.slopes[:, 0], g, lanes[_MISSED])
    read_rows(scratch.slopes[:, 1], g, lanes[_MISSED + 1])
    copy(dnew, dold)
    # The signals and the prediction of the step itself, with their slopes.
    set_signals(perturbed, t + 0.5 * h, within, middle)
    set_signals(perturbed, target, within, end)
    call_at(middle).step = 0.0 if balance is None else h
    means = takes_means(perturbed, middle)
    if means:
        prediction.begin_by_means(n, h, last, dold, missed, along.rows)
    else:
        prediction.begin(n, h, dold, missed, along.rows)
    if balance is None:
        converge_along(problem, matrices, perturbed, h, step.rows, along)
    else:
        energies = slopes[_ENERGY]
        read_rows(scratch.energies, g, lanes[_ENERGY])
        energies[0] += converge_along_with_energy(
            problem, matrices, perturbed, strength, h, energies[0], step.rows, along, balance.rigid,
            balance_along(like, balance, g),
        )  # fmt: skip
        write_rows(lanes[_ENERGY], g, scratch.energies)
    if means:
        prediction.keep_means(n, h, last, along.rows, missed)
    else:
        prediction.keep_missed(n, dold, along.rows, missed)
    # The end of the step was moved onto the constraints, and so are its slopes.
    read(n, along.rows, dnew)
    settle_along(problem, matrices, perturbed, new, dnew, moved, end, VELOCITY, numbers, along.slopes)
    write_states(lanes[_NEW:_OLD], g, dnews)
    write_rows(lanes[_MISSED], g, scratch.slopes[:, 0])
    write_rows(lanes[_MISSED + 1], g, scratch.slopes[:, 1])


def _differentiate_plain(
    like: Number, problem: IntegrationProblem, matrices: Matrices, directions: Integers, step: MidpointStep,
    balance: Balance, strength: float, h: float, last: float, t: float, target: float, within: float, new: MotionState,
    dnews: MotionStates, moved: Reals2, scratch: Derivatives,
) -> None:  # fmt: skip
    """Derivatives of a step along all directions."""
    for g in range(len(directions)):
        _differentiate(
            like, problem, matrices, directions[g], g, step, None, strength, h, last, t, target, within, new, dnews,
            moved, scratch,
        )  # fmt: skip


def _differentiate_balanced(
    like: Number, problem: IntegrationProblem, matrices: Matrices, directions: Integers, step: MidpointStep,
    balance: Balance, strength: float, h: float, last: float, t: float, target: float, within: float, new: MotionState,
    dnews: MotionStates, moved: Reals2, scratch: Derivatives,
) -> None:  # fmt: skip
    """Derivatives of a step whose energy is balanced."""
    for g in range(len(directions)):
        _differentiate(
            like, problem, matrices, directions[g], g, step, balance, strength, h, last, t, target, within, new,
            dnews, moved, scratch,
        )  # fmt: skip


differentiate, differentiate_together = along_kernels(_differentiate_plain)
differentiate_balanced, differentiate_balanced_together = along_kernels(_differentiate_balanced)
KERNELS: dict[tuple[bool, bool], Compiled] = {
    (False, False): differentiate,
    (False, True): differentiate_together,
    (True, False): differentiate_balanced,
    (True, True): differentiate_balanced_together,
}
"""Kernels by whether the energy is balanced, and whether directions are taken together."""
