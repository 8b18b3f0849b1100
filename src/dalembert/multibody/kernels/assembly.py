"""Residual, tangent, constraint rates and energies of a whole model, from the kernels of its components."""

from dalembert.multibody.kernels import beam, body, cable, friction, joints, load, spring, user
from dalembert.multibody.kernels.compiled import inlined, kernel, template
from dalembert.multibody.kernels.dual import STEP
from dalembert.multibody.kernels.markers import GROUND


@inlined
def gather(index, e, width, x, v, a, work):
    """Copy the unknowns of component ``e`` to the local vectors."""
    for i in range(width):
        g = index[e, i]
        work.x[i], work.v[i], work.a[i] = x[g], v[g], a[g]


@template
def _add_residual(function, width, block, callbacks, x, v, a, work, r):
    index = block.index
    for e in range(len(index)):
        gather(index, e, width, x, v, a, work)
        function(work.x, work.v, work.a, work.signals, callbacks, block.data, block.meta, e, work.r)
        for i in range(width):
            r[index[e, i]] += work.r[i]


@template
def _residual(model, n, x, v, a, work, scale, r):
    for i in range(len(r)):
        r[i] = 0.0
    c = model.callbacks
    _add_residual(beam.residual, beam.WIDTH, model.beams, c, x, v, a, work, r)
    _add_residual(cable.residual, cable.WIDTH, model.cables, c, x, v, a, work, r)
    _add_residual(body.residual, body.WIDTH, model.bodies, c, x, v, a, work, r)
    _add_residual(joints.residual, joints.WIDTH, model.joints, c, x, v, a, work, r)
    _add_residual(friction.residual, friction.WIDTH, model.frictions, c, x, v, a, work, r)
    _add_residual(spring.residual, spring.WIDTH, model.springs, c, x, v, a, work, r)
    _add_residual(load.residual, load.WIDTH, model.loads, c, x, v, a, work, r)
    _add_residual(user.residual, user.WIDTH, model.users, c, x, v, a, work, r)
    last = len(r) - 1
    for i in range(n, last):
        r[i] *= scale
    r[last] = 0.0


@kernel
def residual(model, n, x, v, a, work, scale, r):
    """Fill ``r`` (N + 1,): the equations of motion, then the constraints times ``scale``.

    The signals in ``work`` hold the time.
    """
    _residual(model, n, x, v, a, work, scale, r)


@template
def residual_here(model, n, x, v, a, work, scale, r):
    """The same, written into the caller."""
    _residual(model, n, x, v, a, work, scale, r)


@inlined
def _none(data, meta, e):
    """No component of the kind."""
    return False


@template
def _add_tangent(function, width, block, slots, callbacks, n, x, v, a, by, rows, work, matrix, known=_none):
    """Tangents by the complex step; but for components whose tangent is ``known`` by a formula."""
    index, last = block.index, len(x) - 1
    for e in range(len(index)):
        if known(block.data, block.meta, e):
            continue
        gather(index, e, width, x, v, a, work)
        for j in range(width):
            column = index[e, j]
            if column == last:
                continue
            if column < n:
                work.x[j] += 1j * STEP * by[0]
                work.v[j] += 1j * STEP * by[1]
                work.a[j] += 1j * STEP * by[2]
            else:
                work.x[j] += 1j * STEP
            function(work.x, work.v, work.a, work.signals, callbacks, block.data, block.meta, e, work.r)
            work.x[j], work.v[j], work.a[j] = x[column], v[column], a[column]
            for i in range(width):
                row = index[e, i]
                if row < last:
                    matrix[slots[e, i, j]] += work.r[i].imag / STEP * (rows[0] if row < n else rows[1])


@template
def _add_elements(function, known, width, block, slots, n, x, by, rows, work, matrix):
    """Tangents of undamped beam elements, by their formulas."""
    index = block.index
    for e in range(len(index)):
        if not known(block.data, block.meta, e):
            continue
        for i in range(width):
            work.real[i] = x[index[e, i]]
        function(work.real, block.data, e, by, work.matrix)
        for i in range(width):
            for j in range(width):
                matrix[slots[e, i, j]] += work.matrix[i, j] * rows[0]


@template
def _add_points(block, slots, by, rows, matrix):
    """Tangents of the joints that join points: ones, and their signs."""
    for e in range(len(block.index)):
        if not joints.joins_points(block.data, block.meta, e):
            continue
        for side in range(2):
            if block.meta[e, 1 + side] == GROUND:
                continue
            sign = 2.0 * side - 1.0
            for k in range(2):
                place, multiplier = 4 * side + k, joints.MULTIPLIERS + k
                matrix[slots[e, place, multiplier]] += sign * rows[0]
                matrix[slots[e, multiplier, place]] += sign * by[0] * rows[1]


@kernel
def tangent(dual, slots, n, x, v, a, by, rows, work, matrix):
    """Fill the flat ``matrix`` with the residual's derivative along ``by[0] dq + by[1] dv + by[2] da``, and dlambda.

    Rows of the equations of motion are multiplied by ``rows[0]``, those of the constraints by ``rows[1]``. ``dual`` is
    the model in complex numbers; the columns of a component come from the complex step of its residual, but for
    undamped beams and pins between points, where the formula is five times as fast (the sensitivities need a tangent at
    each step).
    """
    for i in range(len(matrix)):
        matrix[i] = 0.0
    c = dual.callbacks
    known, w = beam.undamped, beam.WIDTH
    _add_elements(beam.tangent, known, w, dual.beams, slots.beams, n, x, by, rows, work, matrix)
    _add_tangent(beam.residual, w, dual.beams, slots.beams, c, n, x, v, a, by, rows, work, matrix, known)
    known, w = cable.undamped, cable.WIDTH
    _add_elements(cable.tangent, known, w, dual.cables, slots.cables, n, x, by, rows, work, matrix)
    _add_tangent(cable.residual, w, dual.cables, slots.cables, c, n, x, v, a, by, rows, work, matrix, known)
    _add_tangent(body.residual, body.WIDTH, dual.bodies, slots.bodies, c, n, x, v, a, by, rows, work, matrix)
    known, w = joints.joins_points, joints.WIDTH
    _add_points(dual.joints, slots.joints, by, rows, matrix)
    _add_tangent(joints.residual, w, dual.joints, slots.joints, c, n, x, v, a, by, rows, work, matrix, known)
    _add_tangent(
        friction.residual, friction.WIDTH, dual.frictions, slots.frictions, c, n, x, v, a, by, rows, work, matrix
    )
    _add_tangent(spring.residual, spring.WIDTH, dual.springs, slots.springs, c, n, x, v, a, by, rows, work, matrix)
    _add_tangent(load.residual, load.WIDTH, dual.loads, slots.loads, c, n, x, v, a, by, rows, work, matrix)
    _add_tangent(user.residual, user.WIDTH, dual.users, slots.users, c, n, x, v, a, by, rows, work, matrix)


@kernel
def constraint_rates(model, n, x, v, a, work, rate, second):
    """Fill ``rate`` and ``second`` (N + 1,) with the first and second time derivatives of the constraints."""
    block = model.joints
    for e in range(len(block.index)):
        gather(block.index, e, joints.WIDTH, x, v, a, work)
        joints.rates(work.x, work.v, work.a, work.signals, block.data, block.meta, e, work.r)
        for i in range(3):
            row = block.index[e, joints.MULTIPLIERS + i]
            rate[row], second[row] = work.r[i], work.r[3 + i]


@template
def _sum_energy(function, width, block, callbacks, x, v, work, totals):
    for e in range(len(block.index)):
        gather(block.index, e, width, x, v, v, work)
        kinetic, potential, power = function(work.x, work.v, work.signals, callbacks, block.data, block.meta, e)
        totals[0] += kinetic
        totals[1] += potential
        totals[2] += power


@kernel
def energies(model, x, v, work, totals):
    """Fill ``totals`` (3,): kinetic energy, potential energy, power of all that is not conservative."""
    for i in range(3):
        totals[i] = 0.0
    c = model.callbacks
    _sum_energy(beam.energy, beam.WIDTH, model.beams, c, x, v, work, totals)
    _sum_energy(cable.energy, cable.WIDTH, model.cables, c, x, v, work, totals)
    _sum_energy(body.energy, body.WIDTH, model.bodies, c, x, v, work, totals)
    _sum_energy(joints.energy, joints.WIDTH, model.joints, c, x, v, work, totals)
    _sum_energy(friction.energy, friction.WIDTH, model.frictions, c, x, v, work, totals)
    _sum_energy(spring.energy, spring.WIDTH, model.springs, c, x, v, work, totals)
    _sum_energy(load.energy, load.WIDTH, model.loads, c, x, v, work, totals)
    _sum_energy(user.energy, user.WIDTH, model.users, c, x, v, work, totals)
