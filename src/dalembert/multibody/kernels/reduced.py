"""Kernels of the reduced system: residuals and tangents in increments, and nodes, whose increments change coordinates.

A node is a component of a kind that has a chart: coordinates, and the internal constraints that hold them.
"""

from collections.abc import Callable
from typing import Any

from dalembert.kernels.kernel import BlockKernel
from dalembert.kernels.views import complexes, complexes2, integers, integers2, local, reals, reals2, records
from dalembert.multibody.kernels.charts import projecting, spreading
from dalembert.multibody.kernels.declaration import Declaration
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.loops import arithmetic, made
from dalembert.multibody.kernels.records import TANGENT, Inputs, block_at, call_at


def reduced(kind: Declaration, dtype: type) -> BlockKernel:
    """Add the residuals N^T r, without internal constraints; in complex numbers, by the call's mode, the tangent."""
    return _complex(kind) if dtype is complex else _real(kind)


def _real(kind: Declaration) -> BlockKernel:
    function, width, narrow = kind.residual_function, kind.width, kind.reduced_width
    coordinates, increments = kind.coordinates, kind.increments
    project, others = projecting(kind.parts), width - coordinates
    numbers, whole = records(kind.number_record(float)), records(kind.integer_record)
    local_x, local_v, local_a, local_r = (local(float, width) for _ in range(4))
    local_s = local(float, narrow)

    def loop(call_address, block_address):
        call, block = call_at(call_address), block_at(block_address)
        count, size = block.count, call.last + 1
        index, rows = integers2(block.index, count, width), integers2(block.rows, count, narrow)
        p, m = numbers(block.numbers, count), whole(block.integers, count)
        x, v, a, r = reals(call.x, size), reals(call.v, size), reals(call.a, size), reals(call.r, call.last_row + 1)
        inputs = Inputs(reals2(call.signals, call.signal_count, 3), integers(call.callbacks, call.callback_count))
        own_x, own_v, own_a, own_r, own_s = local_x(), local_v(), local_a(), local_r(), local_s()
        for e in range(count):
            for i in range(width):
                g = index[e, i]
                own_x[i], own_v[i], own_a[i] = x[g], v[g], a[g]
                own_r[i] = 0.0
            function(own_x, own_v, own_a, p[e], m[e], inputs, own_r)
            project(own_x, own_r, own_s)
            for i in range(others):
                own_s[increments + i] = own_r[coordinates + i]
            for i in range(narrow):
                r[rows[e, i]] += own_s[i]

    return made(loop, kind, "reduced", float)


def _complex(kind: Declaration) -> BlockKernel:
    function, width, narrow = kind.residual_function, kind.width, kind.reduced_width
    coordinates, increments = kind.coordinates, kind.increments
    project, spread, others = projecting(kind.parts), spreading(kind.parts), width - coordinates
    numbers, whole = records(kind.number_record(complex)), records(kind.integer_record)
    local_x, local_v, local_a, local_r, local_dx = (local(complex, width) for _ in range(5))
    local_s, local_d = (local(complex, narrow) for _ in range(2))

    def loop(call_address, block_address):
        call, block = call_at(call_address), block_at(block_address)
        count, size = block.count, call.last + 1
        index, rows = integers2(block.index, count, width), integers2(block.rows, count, narrow)
        p, m = numbers(block.numbers, count), whole(block.integers, count)
        inputs = Inputs(complexes2(call.signals, call.signal_count, 3), integers(call.callbacks, call.callback_count))
        own_x, own_v, own_a, own_r, dx = local_x(), local_v(), local_a(), local_r(), local_dx()
        own_s, d = local_s(), local_d()
        x, v, a = complexes(call.x, size), complexes(call.v, size), complexes(call.a, size)
        real_position, real_velocity, real_acceleration = reals(call.x, size), reals(call.v, size), reals(call.a, size)
        r, matrix = complexes(call.r, call.last_row + 1), reals(call.matrix, call.entries)
        slots = integers2(call.slots, count, narrow * narrow)
        tangent = call.mode == TANGENT
        for e in range(count):
            for i in range(width):
                dx[i] = 0.0
            for j in range(narrow):
                d[j] = 0.0
            for j in range(narrow if tangent else 1):
                if tangent and rows[e, j] == call.last_row:
                    continue
                for i in range(width):
                    g = index[e, i]
                    if tangent:
                        own_x[i], own_v[i], own_a[i] = real_position[g], real_velocity[g], real_acceleration[g]
                    else:
                        own_x[i], own_v[i], own_a[i] = x[g], v[g], a[g]
                    own_r[i] = 0.0
                if tangent and j < increments:
                    d[j] = 1.0
                    spread(own_x, d, dx)
                    d[j] = 0.0
                    for i in range(coordinates):
                        own_x[i] += 1j * STEP * call.by_x * dx[i].real
                        own_v[i] += 1j * STEP * call.by_v * dx[i].real
                        own_a[i] += 1j * STEP * call.by_a * dx[i].real
                elif tangent:
                    own_x[coordinates + j - increments] += 1j * STEP
                function(own_x, own_v, own_a, p[e], m[e], inputs, own_r)
                project(own_x, own_r, own_s)
                for i in range(others):
                    own_s[increments + i] = own_r[coordinates + i]
                for i in range(narrow):
                    row = rows[e, i]
                    if not tangent:
                        r[row] += own_s[i]
                    elif row < call.last_row:
                        factor = call.motion if row < call.increments else call.constraint
                        matrix[slots[e, i * narrow + j]] += own_s[i].imag / STEP * factor

    return made(loop, kind, "reduced", complex)


def spread(kind: Declaration, dtype: type) -> BlockKernel:
    """Fill the changes N(x) delta of the nodes' coordinates."""
    return _nodes(kind, dtype, "spread")


def change(kind: Declaration, dtype: type) -> BlockKernel:
    """Fill what the increments -by_x delta change in the nodes' coordinates, divided by -by_x."""
    return _nodes(kind, dtype, "change")


def _nodes(kind: Declaration, dtype: type, role: str) -> BlockKernel:
    view, _ = arithmetic(dtype)
    function: Any = getattr(kind.chart, role)
    finite = role == "change"
    width, coordinates, increments = kind.width, kind.coordinates, kind.increments
    local_x, local_dx, local_d = local(dtype, coordinates), local(dtype, coordinates), local(dtype, increments)

    def loop(call_address, block_address):
        call, block = call_at(call_address), block_at(block_address)
        count, size, scale = block.count, call.last + 1, 1.0
        if finite:
            scale = -call.by_x
        index, rows = integers2(block.index, count, width), integers2(block.rows, count, increments)
        x, delta, change = view(call.x, size), view(call.delta, call.last_row + 1), view(call.change, size)
        own_x, own_d, own_dx = local_x(), local_d(), local_dx()
        for e in range(count):
            for i in range(coordinates):
                own_x[i] = x[index[e, i]]
            for j in range(increments):
                own_d[j] = scale * delta[rows[e, j]]
            function(own_x, own_d, own_dx)
            for i in range(coordinates):
                change[index[e, i]] = own_dx[i] / scale

    return made(loop, kind, role, dtype)


def restore(kind: Declaration, dtype: type) -> BlockKernel:
    """Fill what moves the nodes' coordinates onto the internal constraints, divided by -by_x."""
    view, _ = arithmetic(dtype)
    function: Any = kind.chart.restore if kind.chart else None
    width, coordinates = kind.width, kind.coordinates
    numbers, whole = records(kind.number_record(dtype)), records(kind.integer_record)
    local_x, local_dx = local(dtype, coordinates), local(dtype, coordinates)

    def loop(call_address, block_address):
        call, block = call_at(call_address), block_at(block_address)
        count, size = block.count, call.last + 1
        index = integers2(block.index, count, width)
        p, m = numbers(block.numbers, count), whole(block.integers, count)
        x, change = view(call.x, size), view(call.change, size)
        own_x, own_dx = local_x(), local_dx()
        for e in range(count):
            for i in range(coordinates):
                own_x[i] = x[index[e, i]]
            function(own_x, p[e], m[e], own_dx)
            for i in range(coordinates):
                change[index[e, i]] = own_dx[i] / -call.by_x

    return made(loop, kind, "restore", dtype)


MAKERS: dict[str, Callable[[Declaration, type], BlockKernel]] = {
    "reduced": reduced, "spread": spread, "change": change, "restore": restore,
}  # fmt: skip
