"""The force that balances the energy of a midpoint step without touching momenta: Gonzalez's correction.

A force c M v' resists the step, with v' the velocities in its middle less the rigid motions that the surroundings leave
free: it does no work on them, so the momenta stay. c is such that the energy at the end is that of the first start and
what loads and losses have worked in the middles of the steps.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from dalembert.kernels.duals import DIRECTIONS, Dual, as_duals
from dalembert.kernels.kernel import inlined, inner, kernel
from dalembert.kernels.words import Address, Complexes3, Integers, Reals, Reals2, Reals4
from dalembert.multibody.integrators.midpoint import midpoint_step as midpoint
from dalembert.multibody.integrators.midpoint.midpoint_step import MidpointStep, converge_along, perturb_step
from dalembert.multibody.integrators.shared.matrices import Matrices, add_product
from dalembert.multibody.integrators.shared.problem import IntegrationProblem
from dalembert.multibody.integrators.shared.settling import weigh_along
from dalembert.multibody.kernels.assembly import energies
from dalembert.multibody.kernels.block_table import BlockModel
from dalembert.multibody.kernels.elementary import STEP, reciprocal, size_of, where
from dalembert.multibody.kernels.records import model_at
from dalembert.multibody.kernels.slopes import SlopeWork, arrays_of, joined, share_of, slope_of, slope_work
from dalembert.multibody.kernels.states import MotionState
from dalembert.multibody.model import evaluate
from dalembert.multibody.model.lowered import Lowered

MOST_STRENGTHS = 12  # that are tried
_ROUNDING = 1e-15  # of the energies' sizes
_STRONGEST = 0.5  # part of the velocities that the force may take or give in a step


class FreeRigidMotions(NamedTuple):
    """Rigid motions that are free, as velocities ``spin`` sign x[partner] + shift of the coordinates. ``partner`` and
    ``sign`` (n,), ``spin`` (motions,), ``shift`` (motions, n), ``shifts`` (directions, motions, n): the same with the
    imaginary step along the directions of differentiation.
    """

    partner: Integers
    sign: Reals
    spin: Reals
    shift: Reals2
    shifts: Complexes3


class BalanceAlong(NamedTuple):
    """In complex or dual numbers: shifts of rigid motions; motions, momenta, direction of the force, sums of energies.

    The arrays are those of `Balance`.
    """

    shift: Reals2
    motions: Reals2
    weighed: Reals2
    force: Reals
    totals: Reals


class Balance(NamedTuple):
    """Rigid motions; workspace for them, their momenta, the direction of the force and sums of energies. Along
    directions: motions, momenta and force in ``numbers`` (2 motions + 1), sums of energies in ``sums`` (1), and shifts
    of the rigid motions (groups, motions, n, doubles). ``converge`` is the address of this kernel, 0 if the energy is
    not balanced.
    """

    rigid: FreeRigidMotions
    motions: Reals2
    weighed: Reals2
    force: Reals
    totals: Reals
    numbers: SlopeWork
    sums: SlopeWork
    shifts: Reals4
    converge: Address


def balance_workspace(width: int, rigid: FreeRigidMotions | None = None, *, together: bool = False) -> Balance:
    """Workspace for the balance of N + 1 = ``width`` unknowns; without rigid motions the energy is not balanced."""
    none = np.zeros(0)
    own = rigid or FreeRigidMotions(np.zeros(0, np.int64), none, none, np.zeros((0, 0)), np.zeros((0, 0, 0), complex))
    count, groups = len(own.spin), range(0, len(own.shifts), DIRECTIONS)
    motions, weighed = np.zeros((2, count, width))
    shifts = own.shifts.view(float).reshape(*own.shifts.shape, 2)
    if together:
        slopes = np.imag(own.shifts) / STEP
        shifts = np.array([as_duals(own.shift, slopes[first : first + DIRECTIONS]) for first in groups])
    return Balance(
        own, motions, weighed, np.zeros(width), np.zeros(3), slope_work(width, 0, 2 * count + 1, together),
        slope_work(3, 0, 1, together), shifts, converge.address if rigid else 0,
    )  # fmt: skip


@inlined
def balance_along(like, balance, g):
    """Work of the balance along a group of directions."""
    numbers, count = arrays_of(like, balance.numbers)[0], len(balance.rigid.spin)
    shift = arrays_of(like, SlopeWork(balance.shifts[g], balance.shifts[g]))[0]  # whose slopes are not used
    totals = arrays_of(like, balance.sums)[0][0]
    return BalanceAlong(shift, numbers[:count], numbers[count : 2 * count], numbers[2 * count], totals)


def first_energies(
    lowered: Lowered, directions: Sequence[BlockModel], start: MotionState, dstarts: MotionState, within: float
) -> tuple[float, np.ndarray]:
    """Energy in J at the start (N + 1,), and its derivatives (directions,); ``within`` the first smooth stretch."""
    energy, slopes = _energy_at_start(lowered.real, start.x, start.v, within), []
    for number, model in enumerate(directions):
        if model.dtype is Dual:
            group = slice(DIRECTIONS * number, DIRECTIONS * (number + 1))
            x, v = as_duals(start.x, dstarts.x[group]), as_duals(start.v, dstarts.v[group])
            slopes += _energy_at_start(model, x, v, within)[1:].tolist()
        else:
            x, v = start.x + 1j * STEP * dstarts.x[number], start.v + 1j * STEP * dstarts.v[number]
            slopes.append(_energy_at_start(model, x, v, within).imag / STEP)
    return float(energy), np.array(slopes[: len(dstarts.x)])


def _energy_at_start(model: BlockModel, x: np.ndarray, v: np.ndarray, within: float) -> Any:
    totals = evaluate.energies(model, x[None], v[None], np.zeros(1), np.array([within]))
    return totals[0, 0] + totals[0, 1]


@inner
def _fill_motions(n, rigid, shift, x, motions):
    for j in range(len(rigid.spin)):
        for i in range(n):
            motions[j, i] = rigid.spin[j] * rigid.sign[i] * x[rigid.partner[i]] + shift[j, i]


@inner
def _product(n, a, b):
    whole = a[0] * b[0]
    for i in range(1, n):
        whole += a[i] * b[i]
    return whole


@inner
def _remove(n, motions, weighed, force):
    """Take the momenta of rigid motions out of the momentum ``force``; motions become orthogonal."""
    for j in range(len(motions)):
        whole = _product(n, motions[j], weighed[j]).real
        for i in range(j):
            # Gram and Schmidt with the masses as metric; in complex numbers the derivative of the motions is carried
            # along. A motion that was removed has no mass.
            own, shared = _product(n, motions[i], weighed[i]), _product(n, motions[i], weighed[j])
            share = where(own.real > 0.0, shared * reciprocal(own), 0.0 * shared)
            for k in range(n):
                motions[j, k] -= share * motions[i, k]
                weighed[j, k] -= share * weighed[i, k]
        # What is left of the motion, and its share of the momentum.
        own, shared = _product(n, motions[j], weighed[j]), _product(n, motions[j], force)
        is_new = own.real > 1e-10 * whole  # not the same as those before: a point does not turn
        share = where(is_new, shared * reciprocal(own), 0.0 * shared)
        for k in range(n):
            force[k] -= share * weighed[j, k]
            motions[j, k] = where(is_new, motions[j, k], 0.0 * motions[j, k])
            weighed[j, k] = where(is_new, weighed[j, k], 0.0 * weighed[j, k])


@inner
def direct(n, matrices, s, e):
    """Fill the direction of the force; its power."""
    rigid, motions, weighed, force, mass = e.rigid, e.motions, e.weighed, e.force, matrices.mass
    _fill_motions(n, rigid, rigid.shift, s.xm, motions)
    for i in range(n):
        force[i] = 0.0
        for j in range(len(weighed)):
            weighed[j, i] = 0.0
    # M times each rigid motion, and M times the velocities of the middle: their momenta.
    for j in range(len(weighed)):
        add_product(n, matrices, mass, motions[j], 1.0, weighed[j])
    add_product(n, matrices, mass, s.vm, 1.0, force)
    _remove(n, motions, weighed, force)
    return _product(n, s.vm, force)


@inner
def energy_of_step(model, h, at, middle, end, totals):
    """Energy at the end of a step, and the work of loads and losses in it; ``totals`` are those of the end."""
    # Work of loads and losses by the midpoint rule, as the step itself weighs them.
    energies(model_at(model).middle, at.xm, at.vm, middle, totals)
    gain = h * totals[2]
    energies(model, at.x1, at.v1, end, totals)
    return totals[0] + totals[1], gain


@kernel
def converge(
    problem: IntegrationProblem, matrices: Matrices, model: Address, h: float, goal: float, step: MidpointStep,
    balance: Balance,
    tolerance: float, least: float,
) -> tuple[bool, int, float, int, float, float]:  # fmt: skip
    """A step whose energy is ``goal`` and the work in it.

    Answers whether it converged, iterations, contraction, unknown that moved most, strength of the force, the work.
    """
    n, s, push, middle, end = problem.n, step.rows, step.push, step.middle, step.end
    force, totals = balance.force, balance.totals
    strength, gain, before, iterations, rate, worst = 0.0, 0.0, 1e300, 0, 1.0, 0
    converged, free = False, False
    for attempt in range(MOST_STRENGTHS):
        # The direction is that of the last solution, so the balance is a fixed point over both.
        power = direct(n, matrices, s, balance)
        for k in range(n):
            push[k] = strength * force[k]
        converged, more, contraction, worst = midpoint.converge(problem, matrices, model, h, step, tolerance, least)
        iterations += more
        rate = contraction if attempt == 0 else rate
        if not converged:
            break
        energy, gain = energy_of_step(model, h, s, middle, end, totals)
        excess = energy - (goal + gain)
        if free or is_balanced(attempt, excess, before, power, abs(totals[0]) + abs(totals[1])):
            break
        before = abs(excess)
        strength, free = stronger(h, strength, excess, power)
    return converged, iterations, rate, worst, strength, gain


@inner
def is_balanced(attempt, excess, before, power, size):
    """Whether the search for the strength ends: the energy is met, or no strength meets it better."""
    return abs(excess) <= _ROUNDING * size or power == 0.0 or (attempt > 3 and abs(excess) > 0.5 * before)


@inner
def stronger(h, strength, excess, power):
    """The next strength, and whether there is none: then the next steps make up for it."""
    # A force c M v' takes the energy h c v'^T M v' in the step, to first order: a secant in the strength.
    strength += excess / (h * power)
    free = not abs(h * strength) < _STRONGEST  # at a standstill
    return 0.0 if free else strength, free


@inner
def converge_along_with_energy(problem, matrices, perturbed, strength, h, dgoal, s, along, rigid, balance):
    """Derivatives of the step along directions; those of the work in it. ``dgoal``: of the energy that it must have."""
    n, ds, at, push, force, totals = problem.n, along.rows, along.at, along.push, balance.force, balance.totals
    middle, end, buffers = along.middle, along.end, along.vectors[4:]
    slope, dgain, before = 0.0 * dgoal, 0.0 * dgoal, 1e300
    for attempt in range(2 * MOST_STRENGTHS):
        power = 0.0
        for k in range(n):
            push[k] = 0.0
        if strength != 0.0:
            # The direction of the force moves with the step, and so do the rigid motions that it leaves out.
            perturb_step(s, ds, at)
            _fill_motions(n, rigid, balance.shift, at.xm, balance.motions)
            for j in range(len(balance.weighed)):
                weigh_along(perturbed, n, at.xm, balance.motions[j], middle, buffers, balance.weighed[j])
            weigh_along(perturbed, n, at.xm, at.vm, middle, buffers, force)
            _remove(n, balance.motions, balance.weighed, force)
            for k in range(n):
                push[k] = slope_of(joined(strength, slope) * force[k])
                power += s.vm[k] * force[k].real
        converge_along(problem, matrices, perturbed, h, s, along)
        perturb_step(s, ds, at)
        energy, gain = energy_of_step(perturbed, h, at, middle, end, totals)
        dgain = slope_of(gain)
        excess = slope_of(energy) - (dgoal + dgain)
        size = size_of(slope_of(totals[0])) + size_of(slope_of(totals[1])) + size_of(dgoal)
        left = share_of(size_of(excess), size)
        if strength == 0.0 or left <= 1e-14 or (attempt > 3 and left > 0.5 * before):
            break
        before = left
        # The same secant for the derivative of the strength.
        slope = slope + excess / (h * power)
    return dgain
