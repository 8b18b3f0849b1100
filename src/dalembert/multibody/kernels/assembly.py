"""Residual, tangent, constraint rates, energies and signals of a whole model, by the kernels of its blocks.

``model`` is the address of a model in real or in complex numbers, ``work`` that of a call (:mod:`records`), whose
signals hold the time.
"""

from dalembert.kernels.kernel import inlined, inner
from dalembert.kernels.views import address_of, call
from dalembert.multibody.kernels.records import BLOCK_SIZE, RESIDUAL, TANGENT, block_at, call_at, model_at


@inlined
def _place(work, x, v, a):
    own = call_at(work)
    own.x, own.v, own.a = address_of(x), address_of(v), address_of(a)
    return own


@inner
def set_signals(model, t, within, work):
    """Evaluate the signals at time ``t``, in the smooth stretch of motion that holds ``within``."""
    own = call_at(work)
    own.t, own.within = t, within
    own.callbacks, own.callback_count = model_at(model).callbacks, model_at(model).callback_count
    call(model_at(model).evaluate, work, model)


@inner
def residual(model, n, x, v, a, work, scale, r):
    """Fill ``r`` (N + 1,): the equations of motion, then the constraints times ``scale``."""
    own, table, last = _place(work, x, v, a), model_at(model), len(r) - 1
    own.r, own.mode = address_of(r), RESIDUAL
    for i in range(last):
        r[i] = 0.0
    for k in range(table.block_count):
        block = table.blocks + k * BLOCK_SIZE
        call(block_at(block).residual, work, block)
    for i in range(n, last):
        r[i] *= scale
    r[last] = 0.0


@inner
def tangent(dual, slots, n, x, v, a, by, rows, work, matrix):
    """Fill the flat ``matrix`` with the residual's derivative along ``by[0] dq + by[1] dv + by[2] da``, and dlambda.

    Rows of the equations of motion are multiplied by ``rows[0]``, those of the constraints by ``rows[1]``. ``dual`` is
    the model in complex numbers, ``slots`` where each block finds the positions of its entries.
    """
    for i in range(len(matrix)):
        matrix[i] = 0.0
    own, table = _place(work, x, v, a), model_at(dual)
    own.matrix, own.entries, own.mode = address_of(matrix), len(matrix), TANGENT
    own.by_x, own.by_v, own.by_a = by
    own.motion, own.constraint = rows
    for k in range(table.block_count):
        block = table.blocks + k * BLOCK_SIZE
        own.slots = slots[k]
        call(block_at(block).residual, work, block)


@inner
def constraint_rates(model, n, x, v, a, work, rate, second):
    """Fill ``rate`` and ``second`` (N + 1,) with the first and second time derivatives of the constraints."""
    own, table = _place(work, x, v, a), model_at(model)
    own.rate, own.second = address_of(rate), address_of(second)
    for k in range(table.block_count):
        block = table.blocks + k * BLOCK_SIZE
        if block_at(block).rates != 0:
            call(block_at(block).rates, work, block)


@inner
def constraint_forces(model, x, v, a, work, f):
    """Add the residuals of joints alone to ``f`` (N + 1,): constraint forces, and constraints."""
    own, table = _place(work, x, v, a), model_at(model)
    own.r, own.mode = address_of(f), RESIDUAL
    for k in range(table.block_count):
        block = table.blocks + k * BLOCK_SIZE
        if block_at(block).joins == 1:
            call(block_at(block).residual, work, block)
    f[len(f) - 1] = 0.0


@inner
def energies(model, x, v, work, totals):
    """Fill ``totals`` (3,): kinetic energy, potential energy, power of all that is not conservative."""
    own, table = _place(work, x, v, v), model_at(model)
    own.totals = address_of(totals)
    for i in range(3):
        totals[i] = 0.0
    for k in range(table.block_count):
        block = table.blocks + k * BLOCK_SIZE
        if block_at(block).energy != 0:
            call(block_at(block).energy, work, block)
