r"""Compiled: the sums of :mod:`dalembert.vibration.laws.event_sums` for contacts that slip in two directions.

The slider's motion is periodic: its two numbers y at the start of a period, see
:mod:`dalembert.vibration.laws.march_in_plane`, are those at its end. Newton's method finds them with K = dy(end)/dy,
and their gradients are :math:`(1 - K)^{-1}` times those of y(end).
"""

import numpy as np

from dalembert.kernels.arithmetic import Numbers2, Numbers3, kernels
from dalembert.kernels.blas import product
from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Address, Bytes2, Complexes, Integers, Integers2, Reals2, Reals3, Reals4
from dalembert.vibration.laws.friction_law import FRICTION, SEPARATED, SLIPPING, STUCK, TANGENTIAL
from dalembert.vibration.laws.friction_period import NEUTRAL, SWEEPS
from dalembert.vibration.laws.friction_period import SETTLED as PERIODIC
from dalembert.vibration.laws.march_in_plane import PlanarMarchWorkspace, Sums, march
from dalembert.vibration.laws.signal_zeros import LEAST, PRESSED, at, signals_of
from dalembert.vibration.laws.slip_in_plane import MOVE, OPENED, PLACE, StageMemory, direction, sample


@inner
def rest(numbers, normal, wanted, signals, table, values, y, grads):
    """State of a slider that was at zero before the period begins; sets y and its gradient."""
    count = table.shape[1]
    at(0.0, signals, table, values)
    y[0], y[1] = 0.0 * y[0], 0.0 * y[1]
    grads[PLACE : PLACE + 2] = 0.0
    if normal and values[0, PRESSED].real <= 0.0:
        return SEPARATED
    size = np.hypot(values[0, 0].real, values[0, 1].real)
    if size <= (numbers[FRICTION] * values[0, PRESSED]).real:
        return STUCK
    y[0] = direction(values[0, 0], values[0, 1])
    if wanted:
        c, s = np.cos(y[0]), np.sin(y[0])
        for q in range(count):
            grads[PLACE, q] = -s * numbers[TANGENTIAL] * table[0, q] / size
            grads[PLACE, count + q] = c * numbers[TANGENTIAL] * table[0, q] / size
    return SLIPPING


@inner
def begin_with(unknowns, state, grads):
    """Set the gradient of a slider's two numbers at the start of a period."""
    grads[PLACE : PLACE + 2] = 0.0
    if state != SEPARATED:
        grads[PLACE, unknowns] = 1.0
    if state == STUCK:
        grads[PLACE + 1, unknowns + 1] = 1.0


@inner
def solved(grads, unknowns, first, second):
    """(1 - K)^-1 times (first, second), and the determinant; K is the derivative of y by itself a period before."""
    a, b = 1.0 - grads[PLACE, unknowns], -grads[PLACE, unknowns + 1]
    c, d = -grads[PLACE + 1, unknowns], 1.0 - grads[PLACE + 1, unknowns + 1]
    determinant = a * d - b * c
    if determinant.real <= NEUTRAL:
        return first, second, determinant.real
    return (d * first - b * second) / determinant, (a * second - c * first) / determinant, determinant.real


@inner
def settle(direct, numbers, normal, wanted, waving, signals, y, before, sums, scratch, grads):
    """Periods until the slider returns to where it was: its state there, and whether that does not depend on its past.
    By Newton's method on its two numbers if ``direct``, else from one period to the next, with gradients from rest on.
    ``before`` keeps the numbers at the start of the last period.
    """
    unknowns, scale, last, forgets = grads.shape[1] - 3, signals.least / LEAST, np.inf, False
    state = rest(numbers, normal, wanted, signals, scratch.tables[3], scratch.small[1], y, grads)
    first = state
    for sweep in range(SWEEPS):
        first, before[0], before[1] = state, y[0], y[1]
        if direct:
            begin_with(unknowns, state, grads)
        state = march(numbers, normal, wanted, waving, signals, state, y, sums, scratch, grads)
        if state != first:
            continue
        one, two = y[0] - before[0], y[1] - before[1]
        if state == SLIPPING:
            one -= 2.0 * np.pi * np.round(one.real / (2.0 * np.pi))
        change, aside = max(abs(one.real), abs(two.real)), max(abs(one.imag), abs(two.imag))
        step_one, step_two, determinant = solved(grads, unknowns, one, two)
        forgets = direct and determinant > NEUTRAL
        size = 1.0 if state == SLIPPING else scale
        if change <= PERIODIC * size and aside <= 1e-10 * max(abs(y[0].imag), abs(y[1].imag)):
            break
        if forgets and sweep > 0 and change < last:
            y[0], y[1] = before[0] + step_one, before[1] + step_two
        last = change
    return first, forgets


def _sums(
    displacements: Numbers3, numbers: Numbers2, normal: bool, orders: Integers, mean: int, waving: Reals3,
    rows: Numbers2, tables: Numbers3, small: Numbers3, radau: Numbers2, stage_tables: Numbers3, stage_values: Numbers3,
    grid: Numbers3, known: Integers2, grads: Numbers2, vectors: Numbers2, seeds: Complexes, forces: Numbers3,
    states: Bytes2, result: Numbers3,
) -> None:  # fmt: skip
    memory, y, before = StageMemory(stage_tables, stage_values, grid, known), vectors[2], vectors[3]
    scratch = PlanarMarchWorkspace(tables, small, radau, vectors[0], vectors[1], seeds, memory)
    known[0] = 0
    for c in range(len(displacements)):
        known[1] = 0
        signals = signals_of(displacements[c], numbers[c], 2, normal, orders, mean, rows, small[0, 0])
        sample(signals, waving, grid)
        sums = Sums(forces[c], states[c], result[c], tables, tables)
        y[0], y[1] = 0.0, 0.0
        for direct in (True, False):
            _, forgets = settle(direct, numbers[c], normal, False, waving, signals, y, before, sums, scratch, grads)
            if forgets:
                break


sums_real, sums_complex = kernels(_sums)


@kernel
def sums_and_slopes(
    numbers: Reals2, normal: bool, orders: Integers, mean: int, waving: Reals3, analysis: Reals2, gemm: Address,
    displacements: Reals3, rows: Reals2, tables: Reals3, small: Reals3, radau: Reals2, stage_tables: Reals3,
    stage_values: Reals3, grid: Reals3, known: Integers2, grads: Reals2, few: Reals2,
    vectors: Reals2, seeds: Complexes, sampled: Reals3, slopes: Reals3, local: Reals2, forces: Reals3, states: Bytes2,
    result: Reals3, jacobians: Reals4,
) -> None:  # fmt: skip
    memory, y, before = StageMemory(stage_tables, stage_values, grid, known), vectors[2], vectors[3]
    scratch = PlanarMarchWorkspace(tables, small, radau, vectors[0], vectors[1], seeds, memory)
    known[0] = 0
    count, unknowns = analysis.shape[0], jacobians.shape[3]
    for c in range(len(displacements)):
        known[1] = 0
        signals = signals_of(displacements[c], numbers[c], 2, normal, orders, mean, rows, small[0, 0])
        sample(signals, waving, grid)
        sums = Sums(forces[c], states[c], result[c], sampled, slopes)
        y[0], y[1] = 0.0, 0.0
        state, forgets = settle(True, numbers[c], normal, False, waving, signals, y, before, sums, scratch, few)
        if forgets:
            y[0], y[1] = before[0], before[1]
            begin_with(unknowns, state, grads)
            march(numbers[c], normal, True, waving, signals, state, y, sums, scratch, grads)
        else:
            settle(False, numbers[c], normal, True, waving, signals, y, before, sums, scratch, grads)
        if forgets:
            for m in range(unknowns):
                one, two, _ = solved(grads, unknowns, grads[PLACE, m], grads[PLACE + 1, m])
                grads[MOVE, m], grads[OPENED, m] = one, two
        for column in range(len(slopes)):
            product(gemm, analysis, sampled[column], 0.0, local)
            for i in range(count):
                weight = 1.0 / (np.pi if i >= mean else 2.0 * np.pi)
                for m in range(unknowns + 2):
                    local[i, m] += weight * slopes[column, i, m]
                for m in range(unknowns):
                    jacobians[c, column, i, m] = local[i, m]
                    if forgets:
                        jacobians[c, column, i, m] += local[i, unknowns] * grads[MOVE, m]
                        jacobians[c, column, i, m] += local[i, unknowns + 1] * grads[OPENED, m]
