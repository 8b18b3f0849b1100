"""Residual, tangent, constraint rates, energies and signals of a whole model, by the kernels of its blocks.

``model`` is the address of a model in real or in complex numbers, ``work`` that of a call (:mod:`records`), whose
signals hold the time.
"""

from dalembert.kernels.kernel import inlined, inner
from dalembert.kernels.views import address_of, call
from dalembert.multibody.kernels.records import BLOCK_SIZE, block_at, call_at, model_at


@inlined
def _place(work, x, v, a):
    own = call_at(work)
    own.x, own.v, own.a = address_of(x), address_of(v), address_of(a)
    return own


@inner
def set_signals(model, t, within, work):
    """Evaluate the signals at time ``t``, in the smooth stretch of motion that holds ``within``."""
    own = call_at(work)
    # Signals are evaluated once for a time, and all kernels read the results: ``within`` decides on which side of a
    # jump the time lies.
    own.t, own.within = t, within
    own.callbacks, own.callback_count = model_at(model).callbacks, model_at(model).callback_count
    call(model_at(model).evaluate, work, model)


@inlined
def _add_residuals(blocks, count, increments, work, scale, r):
    own, last = call_at(work), len(r) - 1
    # Absent unknowns have the number of the last entry: kernels read zero there and add what nobody reads, so that they
    # need no branch.
    own.r, own.increments, own.last_row = address_of(r), increments, last
    for i in range(last):
        r[i] = 0.0
    for k in range(count):
        block = blocks + k * BLOCK_SIZE
        call(block_at(block).residual, work, block)
    # Rows of constraints get the unit of the rows of motion, once for all of them.
    for i in range(increments, last):
        r[i] *= scale
    r[last] = 0.0


@inner
def residual(model, n, x, v, a, work, scale, r):
    """Fill ``r`` (N + 1,): the equations of motion, then the constraints times ``scale``."""
    _place(work, x, v, a)
    _add_residuals(model_at(model).blocks, model_at(model).block_count, n, work, scale, r)


@inner
def reduced_residual(model, increments, x, v, a, work, scale, r):
    """The residual of the reduced system, of fewer rows: projected on increments, without internal constraints."""
    _place(work, x, v, a)
    _add_residuals(model_at(model).reduced, model_at(model).reduced_count, increments, work, scale, r)


@inlined
def _add_tangents(blocks, count, increments, last_row, slots, by, rows, work, matrix):
    for i in range(len(matrix)):
        matrix[i] = 0.0
    own = call_at(work)
    own.matrix, own.entries = address_of(matrix), len(matrix)
    own.increments, own.last_row = increments, last_row
    # Of one step by_x, by_v and by_a are dq/da, dv/da and 1; of a static solution 1, 0 and 0. So one kernel gives every
    # matrix that an integrator needs.
    own.by_x, own.by_v, own.by_a = by
    own.motion, own.constraint = rows
    for k in range(count):
        block = blocks + k * BLOCK_SIZE
        own.slots = slots[k]
        call(block_at(block).tangent, work, block)


@inner
def tangent(tangent_model, slots, n, x, v, a, by, rows, work, matrix):
    """Fill the flat ``matrix`` with the residual's derivative along ``by[0] dq + by[1] dv + by[2] da``, and dlambda.
    Rows of the equations of motion are multiplied by ``rows[0]``, those of the constraints by ``rows[1]``.
    ``tangent_model`` is the model with tangents, ``slots`` where each block finds the positions of its entries.
    """
    _place(work, x, v, a)
    table = model_at(tangent_model)
    _add_tangents(table.blocks, table.block_count, n, len(x) - 1, slots, by, rows, work, matrix)


@inner
def reduced_tangent(tangent_model, slots, increments, last_row, x, v, a, by, rows, work, matrix):
    """The tangent of the reduced system, along increments of dq, dv and da, and of multipliers."""
    _place(work, x, v, a)
    table = model_at(tangent_model)
    _add_tangents(table.reduced, table.reduced_count, increments, last_row, slots, by, rows, work, matrix)


@inner
def constraint_rates(model, n, x, v, a, work, rate, second):
    """Fill ``rate`` and ``second`` (N + 1,) with the first and second time derivatives of the constraints."""
    own, table = _place(work, x, v, a), model_at(model)
    own.rate, own.second = address_of(rate), address_of(second)
    for i in range(n, len(rate)):
        rate[i], second[i] = 0.0, 0.0
    for k in range(table.block_count):
        block = table.blocks + k * BLOCK_SIZE
        if block_at(block).rates != 0:
            call(block_at(block).rates, work, block)


@inner
def constraint_forces(model, x, v, a, work, f):
    """Add the residuals of joints alone to ``f`` (N + 1,): constraint forces, and constraints."""
    own, table = _place(work, x, v, a), model_at(model)
    own.r = address_of(f)
    for k in range(table.block_count):
        block = table.blocks + k * BLOCK_SIZE
        # Multipliers enter the residuals of joints alone, so that their sum is J^T lambda.
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


@inlined
def _of_nodes(kernel, model, x, change, work):
    own = call_at(work)
    own.x, own.change = address_of(x), address_of(change)
    call(kernel, work, model)


@inlined
def has_nodes(model):
    """Whether a model has nodes, so that the reduced system differs from the full one."""
    return model_at(model).node_count > 0


@inlined
def spread(model, x, delta, work, change):
    """Fill ``change`` with the corrections of coordinates and multipliers, N(x) ``delta``, of the reduced ``delta``.

    In a model without nodes both are the same array, here and in `displace`.
    """
    if has_nodes(model):
        own = call_at(work)
        own.delta, own.last_row = address_of(delta), len(delta) - 1
        _of_nodes(model_at(model).spread, model, x, change, work)


@inlined
def displace(model, scale, x, delta, work, change):
    """Fill ``change`` so that x - ``scale`` change has the increments -``scale`` delta, which may be large."""
    if has_nodes(model):
        own = call_at(work)
        # The finite increment of a node is -scale delta: a rotation by it, not its linear part.
        own.delta, own.last_row, own.by_x = address_of(delta), len(delta) - 1, scale
        _of_nodes(model_at(model).change, model, x, change, work)


@inlined
def restore(model, scale, x, work, change):
    """Whether there are nodes; if so, fill ``change`` so that x - ``scale`` change satisfies internal constraints."""
    if not has_nodes(model):
        return False
    # What moves a node onto its internal constraints is divided by the scale, as corrections of accelerations are.
    call_at(work).by_x = scale
    _of_nodes(model_at(model).restore, model, x, change, work)
    return True
