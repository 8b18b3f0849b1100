"""Tangents: columns of a local matrix are slopes of the residual, eight at once by duals, or one by a complex step."""

from typing import Any

from dalembert.kernels.arithmetic import VIEWS
from dalembert.kernels.duals import DIRECTIONS, ENTRIES, Dual
from dalembert.kernels.kernel import BlockKernel, inlined
from dalembert.kernels.views import address_of, integers, integers2, local, reals, reals2, records
from dalembert.multibody.kernels.charts import spreading
from dalembert.multibody.kernels.declaration import Declaration
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.loops import made, system_of
from dalembert.multibody.kernels.records import Inputs, block_at, call_at


def mean_tangent(kind: Declaration, dtype: type) -> BlockKernel:
    """As `tangent`, of the residual with the mean forces of a step."""
    return tangent(kind, dtype, "mean_tangent")


def _residual(kind: Declaration) -> Any:
    """The residual, as a function of the step too, which it does not depend on."""
    function = kind.residual_function

    @inlined
    def residual(x, v, a, p, m, inputs, step, r):
        function(x, v, a, p, m, inputs, r)

    return residual


def tangent(kind: Declaration, dtype: type, role: str = "tangent") -> BlockKernel:
    """Add by_x dr/dq + by_v dr/dv + by_a dr/da of a kind, and dr/dlambda; in the reduced system by the increments.

    A model in real numbers takes dual ones for it; one in complex numbers, as functions of users need it, takes complex
    steps. Formulas by hand of beams, cables and pins were measured to gain less than 3 % of a step.
    """
    # Slopes are imaginary parts of a complex step, or the slopes of dual numbers: in memory both follow the value.
    dual = dtype is float
    numeric, entries, at_once, step = (Dual, ENTRIES, DIRECTIONS, 1.0) if dual else (complex, 2, 1, STEP)
    view2 = VIEWS[dtype][1]
    function: Any = _residual(kind) if role == "tangent" else kind.mean
    width, coordinates, increments = kind.width, kind.coordinates, kind.increments
    system, spread = system_of(kind), spreading(kind.parts)
    row_count, project = system.count, system.project
    numbers, whole = records(kind.number_record(dtype)), records(kind.integer_record)
    local_x, local_v, local_a, local_r, local_s = (local(numeric, width) for _ in range(5))
    real_x = local(float, width)
    local_d, local_dx = local(float, increments), local(float, coordinates)

    @inlined
    def seed(narrow, j, k, call, x, d, dx, sx, sv, sa):
        by_x, by_v, by_a = call.by_x * step, call.by_v * step, call.by_a * step
        # One direction moves positions, velocities and accelerations together, by the weights of the matrix that is
        # asked for: the slopes of the residual along it are a finished column of by_x K + by_v C + by_a M.
        if narrow == width:
            sx[j, k] = step
            if j < coordinates:
                sx[j, k], sv[j, k], sa[j, k] = by_x, by_v, by_a
        elif j < increments:
            # Along the increment j: N e_j, with N of the state. What N itself changes is in the projection.
            d[j] = 1.0
            spread(x, d, dx)
            d[j] = 0.0
            for i in range(coordinates):
                sx[i, k], sv[i, k], sa[i, k] = by_x * dx[i], by_v * dx[i], by_a * dx[i]
        else:
            sx[coordinates + j - increments, k] = step

    def loop(call_address, block_address):
        call, block = call_at(call_address), block_at(block_address)
        count, size, narrow = block.count, call.last + 1, row_count(block)
        index, rows = integers2(block.index, count, width), integers2(block.rows, count, narrow)
        p, m = numbers(block.numbers, count), whole(block.integers, count)
        inputs = Inputs(view2(call.signals, call.signal_count, 3), integers(call.callbacks, call.callback_count))
        x, v, a = reals(call.x, size), reals(call.v, size), reals(call.a, size)
        matrix, slots = reals(call.matrix, call.entries), integers2(call.slots, count, narrow * narrow)
        own_x, own_v, own_a, own_r, own_s = local_x(), local_v(), local_a(), local_r(), local_s()
        place, d, dx = real_x(), local_d(), local_dx()
        # The same memory as values and slopes: column k + 1 holds the derivatives along direction k.
        sx, sv = reals2(address_of(own_x), width, entries), reals2(address_of(own_v), width, entries)
        sa = reals2(address_of(own_a), width, entries)
        for j in range(increments):
            d[j] = 0.0
        for e in range(count):
            for i in range(width):
                place[i] = x[index[e, i]]
            # Eight columns from one residual: a body in space has six, a joint between two bodies fifteen or more.
            for first in range(0, narrow, at_once):
                last = min(first + at_once, narrow)
                for i in range(width):
                    # Numbers without slopes; then the slopes along each of the directions.
                    own_x[i], own_v[i], own_a[i], own_r[i] = place[i], v[index[e, i]], a[index[e, i]], 0.0
                for j in range(first, last):
                    seed(narrow, j, 1 + j - first, call, place, d, dx, sx, sv, sa)
                function(own_x, own_v, own_a, p[e], m[e], inputs, call.step, own_r)
                # N^T r in the same arithmetic, so that the change of N with the state is in its slopes.
                forces = project(narrow, own_x, own_r, own_s)
                slopes = reals2(address_of(forces), narrow, entries)
                for j in range(first, last):
                    # An absent unknown, such as a coordinate of the ground, has neither column nor row.
                    if rows[e, j] == call.last_row:
                        continue
                    for i in range(narrow):
                        row = rows[e, i]
                        # Rows of motion and of constraints have factors, so that M, J or both come from one kernel.
                        if row < call.last_row:
                            factor = call.motion if row < call.increments else call.constraint
                            matrix[slots[e, i * narrow + j]] += slopes[i, 1 + j - first] / step * factor

    return made(loop, kind, role, dtype)


MAKERS = {"tangent": tangent, "mean_tangent": mean_tangent}
