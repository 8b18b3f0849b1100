"""Kernels of a kind: loops over the components of a block, around the functions of the kind.

Residuals and tangents are those of the full system, or of the reduced one, in increments and without internal
constraints: forces N^T r.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

from dalembert.kernels.arithmetic import VIEWS
from dalembert.kernels.digest import digest
from dalembert.kernels.duals import Dual, dual_records
from dalembert.kernels.kernel import BlockKernel, inlined
from dalembert.kernels.views import complexes, complexes2, integers, integers2, local, reals, records
from dalembert.multibody.kernels.charts import projecting, spreading
from dalembert.multibody.kernels.declaration import Declaration
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.records import TANGENT, Inputs, block_at, call_at


def number_rows(kind: Declaration, dtype: type) -> Any:
    """An intrinsic: the numbers of the components of a block, by the names of their columns."""
    return dual_records(kind.number_names) if dtype is Dual else records(kind.number_record(dtype))


def made(loop: Callable[[Any, Any], None], kind: Declaration, role: str, dtype: type) -> BlockKernel:
    """The kernel of a kind in a role. Outside the package two kinds may have the same name: their sources differ."""
    # A symbol must be one kernel alone: names of the package are unique, those of users need the digest of their
    # source.
    known = (kind.module or "").startswith("dalembert.")
    name = kind.name if known else f"{kind.name}_{digest(loop)}"  # type: ignore[arg-type]
    return BlockKernel(loop, f"dal_kind_{name}_{role}_{dtype.__name__.lower()}", (kind, role, dtype))


def _each(kind: Declaration, role: str, dtype: type, step: Callable[..., None]) -> BlockKernel:
    """Call ``step(x, v, a, p, m, inputs, call, block, e)`` for component ``e`` of a block, with its local vectors."""
    view, view2 = VIEWS[dtype]
    own_step, width = step, kind.width
    numbers, whole = number_rows(kind, dtype), records(kind.integer_record)
    local_x, local_v, local_a = (local(dtype, width) for _ in range(3))

    def loop(call_address, block_address):
        call, block = call_at(call_address), block_at(block_address)
        count, size = block.count, call.last + 1
        index = integers2(block.index, count, width)
        p, m = numbers(block.numbers, count), whole(block.integers, count)
        x, v, a = view(call.x, size), view(call.v, size), view(call.a, size)
        inputs = Inputs(view2(call.signals, call.signal_count, 3), integers(call.callbacks, call.callback_count))
        own_x, own_v, own_a = local_x(), local_v(), local_a()
        for e in range(count):
            for i in range(width):
                g = index[e, i]
                own_x[i], own_v[i], own_a[i] = x[g], v[g], a[g]
            # Local copies: functions of a kind index a few numbers on the stack, which the compiler keeps in registers.
            own_step(own_x, own_v, own_a, p[e], m[e], inputs, call, block, e)

    return made(loop, kind, role, dtype)


# -- residuals and tangents ------------------------------------------------------------------------------------------


class _System(NamedTuple):
    """The equations that a kind adds to: by the block those of the full system, or of the reduced one. ``count(block)``
    returns the number of local rows. ``project(count, x, r, s)`` returns the local residual in these rows, for which it
    may fill ``s``. ``perturb(count, j, call, x, v, a)`` adds the imaginary step along local row j, and returns the
    range of the unknowns that it changes.
    """

    count: Any
    project: Any
    perturb: Any


@inlined
def _never(p, m):
    return False


@inlined
def _no_tangent(x, p, m, by_x, by_a, matrix):
    pass


def system_of(kind: Declaration) -> _System:
    """The equations that a kind adds to."""
    full = _full(kind)
    return full if kind.is_flat or kind.chart is not None else _either(kind, full)


def _full(kind: Declaration) -> _System:
    width, coordinates = kind.width, kind.coordinates

    @inlined
    def count(block):
        return width

    @inlined
    def unprojected(count, x, r, s):
        return r

    @inlined
    def perturb(count, j, call, x, v, a):
        # One imaginary step moves position, velocity and acceleration together, by the weights of the matrix that is
        # asked for: its imaginary residual is a finished column of by_x K + by_v C + by_a M.
        if j < coordinates:
            x[j] += 1j * STEP * call.by_x
            v[j] += 1j * STEP * call.by_v
            a[j] += 1j * STEP * call.by_a
        else:
            x[j] += 1j * STEP
        return j, j + 1

    return _System(count, unprojected, perturb)


def _either(kind: Declaration, full: _System) -> _System:
    """The full system, or the reduced one, which has fewer rows."""
    width, coordinates, increments = kind.width, kind.coordinates, kind.increments
    others, perturb_one = width - coordinates, full.perturb
    project, spread = projecting(kind.parts), spreading(kind.parts)
    local_d, local_dx = local(complex, increments), local(complex, coordinates)

    @inlined
    def count(block):
        return block.row_count

    @inlined
    def projected(count, x, r, s):
        if count == width:
            return r
        project(x, r, s)
        for i in range(others):
            s[increments + i] = r[coordinates + i]
        return s

    @inlined
    def perturb(count, j, call, x, v, a):
        if count == width:
            return perturb_one(count, j, call, x, v, a)
        if j < increments:
            # Along the increment j: N e_j for coordinates, velocities and accelerations, with N of the real state. What
            # N itself changes is in the projection below, which is complex.
            d, dx = local_d(), local_dx()
            for i in range(increments):
                d[i] = 0.0
            d[j] = 1.0
            spread(x, d, dx)
            for i in range(coordinates):
                x[i] += 1j * STEP * call.by_x * dx[i].real
                v[i] += 1j * STEP * call.by_v * dx[i].real
                a[i] += 1j * STEP * call.by_a * dx[i].real
        else:
            x[coordinates + j - increments] += 1j * STEP
        return 0, width

    return _System(count, projected, perturb)


def residual(kind: Declaration, dtype: type) -> BlockKernel:
    """Add the residuals, in the reduced system N^T r; in complex numbers, by the call's mode, the tangent instead."""
    plain = dtype is not complex or kind.quadratic
    return _plain(kind, dtype, system_of(kind)) if plain else _complex(kind, system_of(kind))


def _plain(kind: Declaration, dtype: type, system: _System) -> BlockKernel:
    """Residuals alone."""
    function, width, row_count, project = kind.residual_function, kind.width, system.count, system.project
    local_r, local_s, (view, _) = local(dtype, width), local(dtype, width), VIEWS[dtype]

    @inlined
    def step(x, v, a, p, m, inputs, call, block, e):
        narrow = row_count(block)
        rows, r = integers2(block.rows, block.count, narrow), view(call.r, call.last + 1)
        own_r = local_r()
        for i in range(width):
            own_r[i] = 0.0
        function(x, v, a, p, m, inputs, own_r)
        # N^T r, with the rows of multipliers after those of increments.
        forces = project(narrow, x, own_r, local_s())
        for i in range(narrow):
            r[rows[e, i]] += forces[i]

    return _each(kind, "residual", dtype, step)


def _complex(kind: Declaration, system: _System) -> BlockKernel:
    function, width, row_count = kind.residual_function, kind.width, system.count
    project, perturb = system.project, system.perturb
    known, formula = kind.known or _never, kind.tangent or _no_tangent
    numbers, whole = records(kind.number_record(complex)), records(kind.integer_record)
    local_x, local_v, local_a, local_r, local_s = (local(complex, width) for _ in range(5))
    real_x, real_matrix = local(float, width), local(float, width, width)

    def loop(call_address, block_address):
        call, block = call_at(call_address), block_at(block_address)
        count, size, narrow = block.count, call.last + 1, row_count(block)
        index, rows = integers2(block.index, count, width), integers2(block.rows, count, narrow)
        p, m = numbers(block.numbers, count), whole(block.integers, count)
        inputs = Inputs(complexes2(call.signals, call.signal_count, 3), integers(call.callbacks, call.callback_count))
        own_x, own_v, own_a, own_r = local_x(), local_v(), local_a(), local_r()
        own_s, own_real, own_matrix = local_s(), real_x(), real_matrix()
        x, v, a = complexes(call.x, size), complexes(call.v, size), complexes(call.a, size)
        r, real_position = complexes(call.r, size), reals(call.x, size)
        real_velocity, real_acceleration = reals(call.v, size), reals(call.a, size)
        matrix, slots = reals(call.matrix, call.entries), integers2(call.slots, count, narrow * narrow)
        tangent = call.mode == TANGENT
        for e in range(count):
            # A formula by hand where the kind has one, in real numbers, for the full system alone.
            if tangent and narrow == width and known(p[e], m[e]):
                for i in range(width):
                    own_real[i] = real_position[index[e, i]]
                formula(own_real, p[e], m[e], call.by_x, call.by_a, own_matrix)
                for i in range(width):
                    row = call.motion if index[e, i] < call.increments else call.constraint
                    for j in range(width):
                        if own_matrix[i, j] != 0.0:
                            matrix[slots[e, i * width + j]] += own_matrix[i, j] * row
                continue
            for i in range(width):
                g = index[e, i]
                # For a tangent the call holds the state in real numbers: the imaginary step is the only imaginary part.
                if tangent:
                    own_x[i], own_v[i], own_a[i] = real_position[g], real_velocity[g], real_acceleration[g]
                else:
                    own_x[i], own_v[i], own_a[i] = x[g], v[g], a[g]
            for j in range(narrow if tangent else 1):
                first = last = 0
                if tangent:
                    # An absent unknown, such as a coordinate of the ground, has no column.
                    if rows[e, j] == call.last_row:
                        continue
                    first, last = perturb(narrow, j, call, own_x, own_v, own_a)
                for i in range(width):
                    own_r[i] = 0.0
                function(own_x, own_v, own_a, p[e], m[e], inputs, own_r)
                forces = project(narrow, own_x, own_r, own_s)
                # Only what the step has changed is read again: one unknown of the full system, all of a reduced one.
                for i in range(first, last):
                    g = index[e, i]
                    own_x[i], own_v[i], own_a[i] = real_position[g], real_velocity[g], real_acceleration[g]
                for i in range(narrow):
                    row = rows[e, i]
                    if not tangent:
                        r[row] += forces[i]
                    elif row < call.last_row:
                        # Rows of motion and of constraints have their own factors, so that M, J or both come from the
                        # same kernel.
                        factor = call.motion if row < call.increments else call.constraint
                        matrix[slots[e, i * narrow + j]] += forces[i].imag / STEP * factor

    return made(loop, kind, "residual", complex)


# -- other roles -----------------------------------------------------------------------------------------------------


def rates(kind: Declaration, dtype: type) -> BlockKernel:
    """Fill the first and second time derivatives of the constraints."""
    function, width, coordinates, multipliers = kind.rates_function, kind.width, kind.coordinates, kind.multipliers
    view, _ = VIEWS[dtype]
    local_rate, local_second = (local(dtype, max(multipliers, 1)) for _ in range(2))

    @inlined
    def step(x, v, a, p, m, inputs, call, block, e):
        rate, second = view(call.rate, call.last + 1), view(call.second, call.last + 1)
        index, own_rate, own_second = integers2(block.index, block.count, width), local_rate(), local_second()
        function(x, v, a, p, m, inputs, own_rate, own_second)
        for i in range(multipliers):
            row = index[e, coordinates + i]
            # A constraint belongs to one component, so that its rates are written, not added.
            rate[row], second[row] = own_rate[i], own_second[i]

    return _each(kind, "rates", dtype, step)


def energy(kind: Declaration, dtype: type) -> BlockKernel:
    """Add kinetic energy, potential energy and power."""
    function, (view, _) = kind.energy_function, VIEWS[dtype]

    @inlined
    def step(x, v, a, p, m, inputs, call, block, e):
        kinetic, potential, power = function(x, v, p, m, inputs)
        totals = view(call.totals, 3)
        totals[0] += kinetic
        totals[1] += potential
        totals[2] += power

    return _each(kind, "energy", dtype, step)


def outputs(kind: Declaration, dtype: type) -> BlockKernel:
    """Fill the outputs of the components, (count, outputs), at the call's ``r``."""
    function: Any = kind.observe
    wide, (_, view2) = len(kind.outputs), VIEWS[dtype]

    @inlined
    def step(x, v, a, p, m, inputs, call, block, e):
        function(x, v, a, p, m, inputs, view2(call.r, block.count, wide)[e])

    return _each(kind, "outputs", dtype, step)


def turn(kind: Declaration, dtype: type) -> BlockKernel:
    """Fill angles and rates of the components, (count, 2 angles), at the call's ``r``."""
    function: Any = kind.turn
    wide, (_, view2) = 2 * len(kind.angles), VIEWS[dtype]

    @inlined
    def step(x, v, a, p, m, inputs, call, block, e):
        function(x, v, p, m, view2(call.r, block.count, wide)[e])

    return _each(kind, "turn", dtype, step)


MAKERS: dict[str, Callable[[Declaration, type], BlockKernel]] = {
    "residual": residual, "rates": rates, "energy": energy, "outputs": outputs, "turn": turn,
}  # fmt: skip
