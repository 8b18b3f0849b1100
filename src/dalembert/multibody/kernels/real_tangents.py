"""Tangents in real numbers, of kinds whose residuals are quadratic: central differences of such residuals are exact.

For r of degree two, r(x + d) - r(x - d) = 2 r'(x) d without a remainder, for steps d of any size. So two residuals in
real numbers take the place of one in complex numbers, and a model without derivatives needs no complex kernels.
"""

from dalembert.kernels.kernel import BlockKernel, inlined
from dalembert.kernels.views import integers, integers2, local, reals, reals2, records
from dalembert.multibody.kernels.charts import projecting, spreading
from dalembert.multibody.kernels.declaration import Declaration
from dalembert.multibody.kernels.loops import made, system_of
from dalembert.multibody.kernels.records import Inputs, block_at, call_at


def tangent(kind: Declaration, dtype: type) -> BlockKernel:
    """Add the tangent of a quadratic kind, from the real numbers of a complex model. The directions are of size one,
    along coordinates and multipliers, or along accelerations where there are no constraints. In the reduced system
    N^T r changes with N, too, which is linear in the coordinates.
    """
    function, width, coordinates, increments = kind.residual_function, kind.width, kind.coordinates, kind.increments
    joins, system, others = kind.constraint is not None, system_of(kind), kind.width - kind.coordinates
    # A quadratic r and an N that is linear in the coordinates: N^T r is of degree three, so its derivative takes both
    # parts apart, N^T r' and (dN)^T r.
    turns = tuple(float(not chart.is_flat) for chart in kind.parts for _ in range(chart.size))  # N depends on them
    row_count, projected = system.count, system.project
    project, spread = projecting(kind.parts), spreading(kind.parts)
    numbers, whole = records(kind.number_record(float)), records(kind.integer_record)
    local_x, local_a, local_d, local_moved, local_none = (local(float, width) for _ in range(5))
    local_r, local_column, local_base, local_s = (local(float, width) for _ in range(4))
    local_turned, local_unit = local(float, increments), local(float, increments)

    @inlined
    def of_joint(x, v, moved, p, m, inputs, r):
        function(moved, v, v, p, m, inputs, r)

    residual = of_joint if joins else function

    def loop(call_address, block_address):
        call, block = call_at(call_address), block_at(block_address)
        count, size, narrow = block.count, call.last + 1, row_count(block)
        index, rows = integers2(block.index, count, width), integers2(block.rows, count, narrow)
        p, m = numbers(block.real_numbers, count), whole(block.integers, count)
        inputs = Inputs(reals2(call.signals, 0, 3), integers(call.callbacks, 0))
        x, a = reals(call.x, size), reals(call.a, size)
        matrix, slots = reals(call.matrix, call.entries), integers2(call.slots, count, narrow * narrow)
        own_x, own_a, d, moved, none = local_x(), local_a(), local_d(), local_moved(), local_none()
        r, column, base, s = local_r(), local_column(), local_base(), local_s()
        turned, unit = local_turned(), local_unit()
        is_reduced, first = narrow < width, narrow - others
        for i in range(width):
            none[i] = 0.0
        for i in range(increments):
            unit[i] = 0.0
        for e in range(count):
            for i in range(width):
                g = index[e, i]
                own_x[i], own_a[i] = x[g], a[g]
            for j in range(0 if not is_reduced else -1, narrow):  # -1: the residual itself
                if j >= 0 and rows[e, j] == call.last_row:
                    continue
                by = call.by_x if joins else call.by_a
                for i in range(width):
                    d[i], column[i] = 0.0, 0.0
                if j >= first:
                    d[coordinates + j - first], by = 1.0, 1.0
                elif j >= 0 and is_reduced:
                    unit[j] = 1.0
                    spread(own_x, unit, d)
                    unit[j] = 0.0
                elif j >= 0:
                    d[j] = 1.0
                for side in range(2 if j >= 0 else 1):
                    sign = 1.0 - 2.0 * side
                    for i in range(width):
                        moved[i], r[i] = sign * d[i], 0.0
                        if j < 0:
                            moved[i] = own_x[i] if joins else own_a[i]
                        elif joins and (j < first or i < coordinates):  # forces are linear in multipliers
                            moved[i] += own_x[i]
                    residual(own_x, none, moved, p[e], m[e], inputs, r)
                    for i in range(width):
                        column[i] += 0.5 * sign * by * r[i]
                if j < 0:
                    for i in range(coordinates):
                        base[i] = r[i] * turns[i]
                    continue
                change = projected(narrow, own_x, column, s)
                if is_reduced and j < first:
                    project(d, base, turned)
                    for i in range(increments):
                        change[i] += call.by_x * turned[i]
                for i in range(narrow):
                    row = rows[e, i]
                    if row < call.last_row:
                        factor = call.motion if row < call.increments else call.constraint
                        matrix[slots[e, i * narrow + j]] += change[i] * factor

    return made(loop, kind, "tangent", dtype)
