"""The force that balances the energy of a midpoint step without touching momenta: Gonzalez's correction.

A force c M v' resists the step, with v' the velocities in its middle less the rigid motions that the surroundings leave
free: it does no work on them, so the momenta stay. c is such that the energy at the end is that of the first start and
what loads and losses have worked in the middles of the steps.
"""

from typing import NamedTuple

import numpy as np

from dalembert.multibody.integrators import midpoint_step as midpoint
from dalembert.multibody.integrators.lifting import lift
from dalembert.multibody.integrators.matrices import add_product
from dalembert.multibody.integrators.settling import weigh_along
from dalembert.multibody.kernels.assembly import energies
from dalembert.multibody.kernels.compiled import compiled, kernel, template
from dalembert.multibody.kernels.dual import STEP, reciprocal

_ROUNDING = 1e-15  # of the energies' sizes
_MOST = 12  # strengths that are tried
_STRONGEST = 0.5  # part of the velocities that the force may take or give in a step


class Rigid(NamedTuple):
    """Rigid motions that are free, as velocities ``spin`` sign x[partner] + shift of the coordinates.

    ``partner`` and ``sign`` (n,), ``spin`` (motions,), ``shift`` (motions, n), ``shifts`` (directions, motions, n): the
    same with the imaginary step along the directions of differentiation.
    """

    partner: np.ndarray
    sign: np.ndarray
    spin: np.ndarray
    shift: np.ndarray
    shifts: np.ndarray


class Room(NamedTuple):
    """Rigid motions, their momenta, direction of the force, in real and in complex numbers; sums of energies."""

    motions: np.ndarray
    weighed: np.ndarray
    force: np.ndarray
    totals: np.ndarray
    lifted_motions: np.ndarray
    lifted_weighed: np.ndarray
    lifted_force: np.ndarray
    lifted_totals: np.ndarray


@compiled
def room(count, width):
    """Room for the balance of a step."""
    return Room(
        np.zeros((count, width)), np.zeros((count, width)), np.zeros(width), np.zeros(3),
        np.zeros((count, width), np.complex128), np.zeros((count, width), np.complex128),
        np.zeros(width, np.complex128), np.zeros(3, np.complex128),
    )  # fmt: skip


@kernel
def _fill_motions(n, rigid, shift, x, motions):
    for j in range(len(rigid.spin)):
        for i in range(n):
            motions[j, i] = rigid.spin[j] * rigid.sign[i] * x[rigid.partner[i]] + shift[j, i]


@kernel
def _product(n, a, b):
    whole = a[0] * b[0]
    for i in range(1, n):
        whole += a[i] * b[i]
    return whole


@kernel
def _remove(n, motions, weighed, force):
    """Take the momenta of rigid motions out of the momentum ``force``; motions become orthogonal."""
    for j in range(len(motions)):
        whole = _product(n, motions[j], weighed[j]).real
        for i in range(j):
            own = _product(n, motions[i], weighed[i])
            if own.real > 0.0:
                share = _product(n, motions[i], weighed[j]) * reciprocal(own)
                for k in range(n):
                    motions[j, k] -= share * motions[i, k]
                    weighed[j, k] -= share * weighed[i, k]
        own = _product(n, motions[j], weighed[j])
        if own.real <= 1e-10 * whole:  # the same as those before: a point does not turn
            for k in range(n):
                motions[j, k], weighed[j, k] = 0.0, 0.0
        else:
            share = _product(n, motions[j], force) * reciprocal(own)
            for k in range(n):
                force[k] -= share * weighed[j, k]


@kernel
def _direct(n, pattern, matrices, rigid, s, e):
    """Fill the direction of the force; its power."""
    _fill_motions(n, rigid, rigid.shift, s[midpoint.XM], e.motions)
    for i in range(n):
        e.force[i] = 0.0
        for j in range(len(e.weighed)):
            e.weighed[j, i] = 0.0
    for j in range(len(e.weighed)):
        add_product(n, pattern, matrices.mass, e.motions[j], 1.0, e.weighed[j])
    add_product(n, pattern, matrices.mass, s[midpoint.VM], 1.0, e.force)
    _remove(n, e.motions, e.weighed, e.force)
    return _product(n, s[midpoint.VM], e.force)


@kernel
def _energy(model, h, at, middle, end, totals):
    """Energy at the end of a step, and the work of loads and losses in it; ``totals`` are those of the end."""
    energies(model, at[midpoint.XM], at[midpoint.VM], middle, totals)
    gain = h * totals[2]
    energies(model, at[midpoint.X1], at[midpoint.V1], end, totals)
    return totals[0] + totals[1], gain


@template
def converge(
    problem, pattern, matrices, model, rigid, conserving, middle, end, h, goal, s, push, b, e, tolerance, least
):  # fmt: skip
    """A step whose energy is ``goal`` and the work in it, if ``conserving``.

    Answers whether it converged, iterations, contraction, unknown that moved most, strength of the force, the work.
    """
    strength, gain, before, iterations, rate, worst = 0.0, 0.0, 1e300, 0, 1.0, 0
    converged, free = False, False
    for attempt in range(_MOST):
        power = 0.0
        if conserving:
            power = _direct(problem.n, pattern, matrices, rigid, s, e)
        for k in range(problem.n):
            push[k] = strength * e.force[k]
        converged, more, contraction, worst = midpoint.converge(
            problem, pattern, matrices, model, middle, end, h, s, push, b, tolerance, least
        )
        iterations += more
        rate = contraction if attempt == 0 else rate
        if not converged or not conserving:
            break
        energy, gain = _energy(model, h, s, middle, end, e.totals)
        excess = energy - (goal + gain)
        near = abs(excess) <= _ROUNDING * (abs(e.totals[0]) + abs(e.totals[1]))
        if free or near or power == 0.0 or (attempt > 3 and abs(excess) > 0.5 * before):
            break
        before = abs(excess)
        strength += excess / (h * power)
        if not abs(h * strength) < _STRONGEST:  # at a standstill; the next steps make up for it
            strength, free = 0.0, True
    return converged, iterations, rate, worst, strength, gain


@kernel
def _direct_along(tilted, n, rigid, shift, at, middle, buffers, e):
    """The direction of the force in complex numbers."""
    _fill_motions(n, rigid, shift, at[midpoint.XM], e.lifted_motions)
    for j in range(len(e.lifted_weighed)):
        weigh_along(tilted, n, at[midpoint.XM], e.lifted_motions[j], middle, buffers, e.lifted_weighed[j])
    weigh_along(tilted, n, at[midpoint.XM], at[midpoint.VM], middle, buffers, e.lifted_force)
    _remove(n, e.lifted_motions, e.lifted_weighed, e.lifted_force)


@template
def converge_along(
    problem, pattern, matrices, tilted, rigid, shift, strength, middle, end, h, dgoal, s, ds, dpush, b, e, lifted
):  # fmt: skip
    """Derivative of the step along a direction; the derivative of the work in it."""
    n, at = problem.n, lifted[: midpoint.ROWS]
    slope, dgain, before = 0.0, 0.0, 1e300
    for attempt in range(2 * _MOST):
        power = 0.0
        if strength != 0.0:
            midpoint.lift_step(s, ds, at)
            _direct_along(tilted, n, rigid, shift, at, middle, lifted[12:], e)
            for k in range(n):
                dpush[k] = (complex(strength, STEP * slope) * e.lifted_force[k]).imag / STEP
                power += s[midpoint.VM, k] * e.lifted_force[k].real
        else:
            for k in range(n):
                dpush[k] = 0.0
        midpoint.converge_along(problem, pattern, matrices, tilted, middle, end, h, s, ds, dpush, b, lifted)
        midpoint.lift_step(s, ds, at)
        energy, gain = _energy(tilted, h, at, middle, end, e.lifted_totals)
        dgain = gain.imag / STEP
        excess = energy.imag / STEP - (dgoal + dgain)
        size = (abs(e.lifted_totals[0].imag) + abs(e.lifted_totals[1].imag)) / STEP + abs(dgoal)
        if strength == 0.0 or abs(excess) <= 1e-14 * size or (attempt > 3 and abs(excess) > 0.5 * before):
            break
        before = abs(excess)
        slope += excess / (h * power)
    return dgain


@compiled
def first_energy(model, n, state, work, totals):
    """Energy of a state; the signals in ``work`` hold the time."""
    energies(model, state.x, state.v, work, totals)
    return totals[0] + totals[1]


@compiled
def first_energy_along(tilted, n, state, dstate, work, lifted, totals):
    """Its derivative along a direction."""
    lift(n, state, dstate, lifted)
    energies(tilted, lifted[0], lifted[1], work, totals)
    return (totals[0] + totals[1]).imag / STEP
