"""Kernels of a kind: loops over the components of a block, around the functions of the kind."""

from collections.abc import Callable
from typing import Any

from dalembert.kernels.kernel import BlockKernel, inlined
from dalembert.kernels.views import complexes, complexes2, integers, integers2, local, reals, reals2, records
from dalembert.multibody.kernels.declaration import Declaration
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.records import TANGENT, Inputs, block_at, call_at


def arithmetic(dtype: type) -> tuple[Any, Any]:
    return (complexes, complexes2) if dtype is complex else (reals, reals2)


def made(loop: Callable[[Any, Any], None], kind: Declaration, role: str, dtype: type) -> BlockKernel:
    return BlockKernel(loop, f"dal_kind_{kind.name}_{role}_{dtype.__name__}", (kind, role, dtype))


def residual(kind: Declaration, dtype: type) -> BlockKernel:
    """Add the residuals; in complex numbers, by the call's mode, the tangent instead."""
    return _complex(kind) if dtype is complex else _real(kind)


def _real(kind: Declaration) -> BlockKernel:
    function, width = kind.residual_function, kind.width
    numbers, whole = records(kind.number_record(float)), records(kind.integer_record)
    local_x, local_v, local_a, local_r = (local(float, width) for _ in range(4))

    def loop(call_address, block_address):
        call, block = call_at(call_address), block_at(block_address)
        count, size = block.count, call.last + 1
        index = integers2(block.index, count, width)
        p, m = numbers(block.numbers, count), whole(block.integers, count)
        x, v, a, r = reals(call.x, size), reals(call.v, size), reals(call.a, size), reals(call.r, size)
        inputs = Inputs(reals2(call.signals, call.signal_count, 3), integers(call.callbacks, call.callback_count))
        own_x, own_v, own_a, own_r = local_x(), local_v(), local_a(), local_r()
        for e in range(count):
            for i in range(width):
                g = index[e, i]
                own_x[i], own_v[i], own_a[i] = x[g], v[g], a[g]
                own_r[i] = 0.0
            function(own_x, own_v, own_a, p[e], m[e], inputs, own_r)
            for i in range(width):
                r[index[e, i]] += own_r[i]

    return made(loop, kind, "residual", float)


@inlined
def _never(p, m):
    return False


@inlined
def _no_tangent(x, p, m, by_x, by_a, matrix):
    pass


def _complex(kind: Declaration) -> BlockKernel:
    function, width = kind.residual_function, kind.width
    known, formula = kind.known or _never, kind.tangent or _no_tangent
    numbers, whole = records(kind.number_record(complex)), records(kind.integer_record)
    local_x, local_v, local_a, local_r = (local(complex, width) for _ in range(4))
    real_x, real_matrix = local(float, width), local(float, width, width)

    def loop(call_address, block_address):
        call, block = call_at(call_address), block_at(block_address)
        count, size, n = block.count, call.last + 1, call.coordinates
        index = integers2(block.index, count, width)
        p, m = numbers(block.numbers, count), whole(block.integers, count)
        inputs = Inputs(complexes2(call.signals, call.signal_count, 3), integers(call.callbacks, call.callback_count))
        own_x, own_v, own_a, own_r = local_x(), local_v(), local_a(), local_r()
        own_real, own_matrix = real_x(), real_matrix()
        x, v, a = complexes(call.x, size), complexes(call.v, size), complexes(call.a, size)
        r, real_position = complexes(call.r, size), reals(call.x, size)
        real_velocity, real_acceleration = reals(call.v, size), reals(call.a, size)
        matrix, slots = reals(call.matrix, call.entries), integers2(call.slots, count, width * width)
        tangent = call.mode == TANGENT
        for e in range(count):
            if tangent and known(p[e], m[e]):
                for i in range(width):
                    own_real[i] = real_position[index[e, i]]
                formula(own_real, p[e], m[e], call.by_x, call.by_a, own_matrix)
                for i in range(width):
                    row = call.motion if index[e, i] < n else call.constraint
                    for j in range(width):
                        if own_matrix[i, j] != 0.0:
                            matrix[slots[e, i * width + j]] += own_matrix[i, j] * row
                continue
            for i in range(width):
                g = index[e, i]
                if tangent:
                    own_x[i], own_v[i], own_a[i] = real_position[g], real_velocity[g], real_acceleration[g]
                else:
                    own_x[i], own_v[i], own_a[i] = x[g], v[g], a[g]
            for j in range(width if tangent else 1):
                column = index[e, j]
                if tangent:
                    if column == call.last:
                        continue
                    if column < n:
                        own_x[j] += 1j * STEP * call.by_x
                        own_v[j] += 1j * STEP * call.by_v
                        own_a[j] += 1j * STEP * call.by_a
                    else:
                        own_x[j] += 1j * STEP
                for i in range(width):
                    own_r[i] = 0.0
                function(own_x, own_v, own_a, p[e], m[e], inputs, own_r)
                if tangent:
                    own_x[j], own_v[j] = real_position[column], real_velocity[column]
                    own_a[j] = real_acceleration[column]
                    for i in range(width):
                        row = index[e, i]
                        if row < call.last:
                            factor = call.motion if row < n else call.constraint
                            matrix[slots[e, i * width + j]] += own_r[i].imag / STEP * factor
                else:
                    for i in range(width):
                        r[index[e, i]] += own_r[i]

    return made(loop, kind, "residual", complex)


def rates(kind: Declaration, dtype: type) -> BlockKernel:
    """Fill the first and second time derivatives of the constraints."""
    view, view2 = arithmetic(dtype)
    function, width, coordinates, multipliers = kind.rates_function, kind.width, kind.coordinates, kind.multipliers
    numbers, whole = records(kind.number_record(dtype)), records(kind.integer_record)
    local_x, local_v, local_a = (local(dtype, width) for _ in range(3))
    local_rate, local_second = (local(dtype, max(multipliers, 1)) for _ in range(2))

    def loop(call_address, block_address):
        call, block = call_at(call_address), block_at(block_address)
        count, size = block.count, call.last + 1
        index = integers2(block.index, count, width)
        p, m = numbers(block.numbers, count), whole(block.integers, count)
        x, v, a = view(call.x, size), view(call.v, size), view(call.a, size)
        rate, second = view(call.rate, size), view(call.second, size)
        inputs = Inputs(view2(call.signals, call.signal_count, 3), integers(call.callbacks, call.callback_count))
        own_x, own_v, own_a = local_x(), local_v(), local_a()
        own_rate, own_second = local_rate(), local_second()
        for e in range(count):
            for i in range(width):
                g = index[e, i]
                own_x[i], own_v[i], own_a[i] = x[g], v[g], a[g]
            function(own_x, own_v, own_a, p[e], m[e], inputs, own_rate, own_second)
            for i in range(multipliers):
                row = index[e, coordinates + i]
                rate[row], second[row] = own_rate[i], own_second[i]

    return made(loop, kind, "rates", dtype)


def energy(kind: Declaration, dtype: type) -> BlockKernel:
    """Add kinetic energy, potential energy and power."""
    view, view2 = arithmetic(dtype)
    function, width = kind.energy_function, kind.width
    numbers, whole = records(kind.number_record(dtype)), records(kind.integer_record)
    local_x, local_v = (local(dtype, width) for _ in range(2))

    def loop(call_address, block_address):
        call, block = call_at(call_address), block_at(block_address)
        count, size = block.count, call.last + 1
        index = integers2(block.index, count, width)
        p, m = numbers(block.numbers, count), whole(block.integers, count)
        x, v, totals = view(call.x, size), view(call.v, size), view(call.totals, 3)
        inputs = Inputs(view2(call.signals, call.signal_count, 3), integers(call.callbacks, call.callback_count))
        own_x, own_v = local_x(), local_v()
        for e in range(count):
            for i in range(width):
                g = index[e, i]
                own_x[i], own_v[i] = x[g], v[g]
            kinetic, potential, power = function(own_x, own_v, p[e], m[e], inputs)
            totals[0] += kinetic
            totals[1] += potential
            totals[2] += power

    return made(loop, kind, "energy", dtype)


def outputs(kind: Declaration, dtype: type) -> BlockKernel:
    """Fill the outputs of the components, (count, outputs), at the call's ``r``."""
    view, view2 = arithmetic(dtype)
    function: Any = kind.observe
    width, wide = kind.width, len(kind.outputs)
    numbers, whole = records(kind.number_record(dtype)), records(kind.integer_record)
    local_x, local_v, local_a = (local(dtype, width) for _ in range(3))

    def loop(call_address, block_address):
        call, block = call_at(call_address), block_at(block_address)
        count, size = block.count, call.last + 1
        index = integers2(block.index, count, width)
        p, m = numbers(block.numbers, count), whole(block.integers, count)
        x, v, a, out = view(call.x, size), view(call.v, size), view(call.a, size), view2(call.r, count, wide)
        inputs = Inputs(view2(call.signals, call.signal_count, 3), integers(call.callbacks, call.callback_count))
        own_x, own_v, own_a = local_x(), local_v(), local_a()
        for e in range(count):
            for i in range(width):
                g = index[e, i]
                own_x[i], own_v[i], own_a[i] = x[g], v[g], a[g]
            function(own_x, own_v, own_a, p[e], m[e], inputs, out[e])

    return made(loop, kind, "outputs", dtype)


MAKERS: dict[str, Callable[[Declaration, type], BlockKernel]] = {
    "residual": residual, "rates": rates, "energy": energy, "outputs": outputs,
}  # fmt: skip
