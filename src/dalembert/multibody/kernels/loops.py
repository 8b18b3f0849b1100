"""Kernels of a kind: loops over the components of a block, around the functions of the kind.

Residuals are those of the full system, or of the reduced one, in increments and without internal
constraints: forces N^T r.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

from dalembert.kernels.arithmetic import VIEWS
from dalembert.kernels.digest import digest
from dalembert.kernels.kernel import BlockKernel, inlined
from dalembert.kernels.named_rows import named_rows
from dalembert.kernels.views import integers, integers2, local, records
from dalembert.multibody.kernels.charts import projecting
from dalembert.multibody.kernels.declaration import Declaration
from dalembert.multibody.kernels.records import Inputs, block_at, call_at


def number_rows(kind: Declaration, dtype: type) -> Any:
    """An intrinsic: the numbers of the components of a block, by the names of their columns."""
    return records(kind.number_record(dtype)) if dtype in (float, complex) else named_rows(dtype, kind.number_names)


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


# -- residuals -------------------------------------------------------------------------------------------------------


class _System(NamedTuple):
    """The equations that a kind adds to: by the block those of the full system, or of the reduced one. ``count(block)``
    returns the number of local rows. ``project(count, x, r, s)`` returns the local residual in these rows, for which it
    may fill ``s``.
    """

    count: Any
    project: Any


def system_of(kind: Declaration) -> _System:
    """The equations that a kind adds to."""
    return _full(kind) if kind.is_flat or kind.chart is not None else _either(kind)


def _full(kind: Declaration) -> _System:
    width = kind.width

    @inlined
    def count(block):
        return width

    @inlined
    def unprojected(count, x, r, s):
        return r

    return _System(count, unprojected)


def _either(kind: Declaration) -> _System:
    """The full system, or the reduced one, which has fewer rows."""
    width, coordinates, increments = kind.width, kind.coordinates, kind.increments
    others, project = width - coordinates, projecting(kind.parts)

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

    return _System(count, projected)


def residual(kind: Declaration, dtype: type) -> BlockKernel:
    """Add the residuals, in the reduced system N^T r."""
    function, width, (row_count, project) = kind.residual_function, kind.width, system_of(kind)
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


def mean(kind: Declaration, dtype: type) -> BlockKernel:
    """Add the residuals of the middle of a step, by the forces whose work is the change of the energy."""
    function: Any = kind.mean
    width, (view, _) = kind.width, VIEWS[dtype]
    local_r = local(dtype, width)

    @inlined
    def step(x, v, a, p, m, inputs, call, block, e):
        index, r, own_r = integers2(block.index, block.count, width), view(call.r, call.last + 1), local_r()
        for i in range(width):
            own_r[i] = 0.0
        # The midpoint rule solves the full system, so that these forces are not projected.
        function(x, v, a, p, m, inputs, call.step, own_r)
        for i in range(width):
            r[index[e, i]] += own_r[i]

    return _each(kind, "mean", dtype, step)


# -- other roles -----------------------------------------------------------------------------------------------------


def rates(kind: Declaration, dtype: type) -> BlockKernel:
    """Add the first and second time derivatives of the constraints."""
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
            # A constraint may be the sum of several components: modes of a body at its interface nodes.
            rate[row] += own_rate[i]
            second[row] += own_second[i]

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


def mean_power(kind: Declaration, dtype: type) -> BlockKernel:
    """Add the power of the mean forces of a step that have no potential."""
    function: Any = kind.mean_power
    view, _ = VIEWS[dtype]

    @inlined
    def step(x, v, a, p, m, inputs, call, block, e):
        totals = view(call.totals, 3)
        # Energies of the middle of a step are not asked for, but the power that is lost in it.
        totals[2] += function(x, v, p, m, inputs, call.step)

    return _each(kind, "mean_power", dtype, step)


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
    "residual": residual, "mean": mean, "mean_power": mean_power, "rates": rates, "energy": energy, "outputs": outputs,
    "turn": turn,
}  # fmt: skip
