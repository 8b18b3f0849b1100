"""Kernels of nodes: what increments change of their coordinates, for one kind of nodes, and for all of a model.

A node is a component of a kind that has a chart: coordinates, and the internal constraints that hold them.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

from dalembert.kernels.arithmetic import VIEWS
from dalembert.kernels.duals import Dual
from dalembert.kernels.kernel import BlockKernel, inlined
from dalembert.kernels.lanes import Lanes
from dalembert.kernels.views import call, integers, integers2, local, reals, records
from dalembert.multibody.kernels.declaration import Declaration
from dalembert.multibody.kernels.loops import made, number_rows
from dalembert.multibody.kernels.records import BLOCK_SIZE, block_at, call_at, model_at


def _kernel(role: str, kind: Declaration, dtype: type) -> BlockKernel:
    """Fill the changes of the nodes' coordinates by a function of their chart. Those of increments are N(x) delta
    (``spread``), or what the finite increments -by_x delta change, divided by -by_x (``change``). Those that move the
    coordinates onto the internal constraints (``restore``) are divided by -by_x, too.
    """
    view, _ = VIEWS[dtype]
    given: Any = getattr(kind.chart, role)
    is_finite, used = role != "spread", 0 if role == "restore" else kind.increments
    width, coordinates, increments = kind.width, kind.coordinates, kind.increments
    numbers, whole = number_rows(kind, dtype), records(kind.integer_record)
    local_x, local_dx, local_d = local(dtype, coordinates), local(dtype, coordinates), local(dtype, increments)

    @inlined
    def moved(x, d, p, m, dx):
        given(x, d, dx)

    @inlined
    def restored(x, d, p, m, dx):
        given(x, p, m, dx)

    function = restored if role == "restore" else moved

    def loop(call_address, block_address):
        call, block = call_at(call_address), block_at(block_address)
        count, size, scale = block.count, call.last + 1, 1.0
        if is_finite:
            # Newton takes delta off with the factor by_x = dq/da, so the increment that happens is -by_x delta.
            scale = -call.by_x
        index, rows = integers2(block.index, count, width), integers2(block.rows, count, increments)
        p, m = numbers(block.numbers, count), whole(block.integers, count)
        x, delta, change = view(call.x, size), view(call.delta, call.last_row + 1), view(call.change, size)
        own_x, own_d, own_dx = local_x(), local_d(), local_dx()
        for e in range(count):
            for i in range(coordinates):
                own_x[i] = x[index[e, i]]
            for j in range(used):
                own_d[j] = scale * delta[rows[e, j]]
            function(own_x, own_d, p[e], m[e], own_dx)
            for i in range(coordinates):
                # Back to a change of accelerations: q - by_x change has the increment.
                change[index[e, i]] = own_dx[i] / scale

    return made(loop, kind, role, dtype)


def _balance(kind: Declaration, dtype: type) -> BlockKernel:
    """Add to the multipliers of internal constraints what balances the residual ``r`` on the nodes' coordinates.

    The reduced system knows no such multipliers. They enter derivatives of the full one.
    """
    chart: Any = kind.chart
    balance = chart.balance
    width, coordinates = kind.width, kind.coordinates
    local_x, local_r, local_dx = (local(dtype, coordinates) for _ in range(3))

    def loop(call_address, block_address):
        call, block = call_at(call_address), block_at(block_address)
        count, size = block.count, call.last + 1
        index = integers2(block.index, count, width)
        x, r = reals(call.x, size), reals(call.r, size)
        own_x, own_r, own_dx = local_x(), local_r(), local_dx()
        for e in range(count):
            for i in range(coordinates):
                own_x[i], own_r[i] = x[index[e, i]], r[index[e, i]]
            # The residual is linear in the multipliers: what it still holds belongs to them.
            balance(own_x, own_r, own_dx)
            for j in range(width - coordinates):
                x[index[e, coordinates + j]] += own_dx[j]

    return made(loop, kind, "balance", dtype)


MAKERS = {role: partial(_kernel, role) for role in ("spread", "change", "restore")} | {"balance": _balance}


def _of_all(role: Callable[..., int], begin: Callable[..., None], symbol: str, dtype: type) -> BlockKernel:
    """The kernel that begins with the changes of what belongs to no node, and calls the nodes' kernels of a role."""
    address, first = role, begin

    def nodes(work, model):
        own, table = call_at(work), model_at(model)
        first(own, table)
        for k in range(table.node_count):
            node = table.nodes + k * BLOCK_SIZE
            call(address(block_at(node)), work, node)

    return BlockKernel(nodes, symbol, dtype=dtype)


def _deal(role: Callable[..., int], dtype: type, symbol: str) -> BlockKernel:
    view, _ = VIEWS[dtype]

    @inlined
    def deal(own, table):
        """Increments of coordinates that belong to no node, and of multipliers; 0 for the others."""
        size = own.last + 1
        rows, delta, change = integers(table.rows, size), view(own.delta, own.last_row + 1), view(own.change, size)
        for i in range(size):
            # Coordinates of nodes are filled by the kernels of their kinds after this.
            change[i] = delta[rows[i]]

    return _of_all(role, deal, symbol, dtype)


def _restore(dtype: type) -> BlockKernel:
    view, _ = VIEWS[dtype]

    @inlined
    def clear(own, table):
        change = view(own.change, own.last + 1)
        for i in range(len(change)):
            change[i] = 0.0

    return _of_all(inlined(lambda node: node.restore), clear, f"dal_nodes_restore_{dtype.__name__.lower()}", dtype)


_change = inlined(lambda node: node.change)
SPREAD = _deal(inlined(lambda node: node.spread), float, "dal_nodes_spread")
CHANGE_REAL, CHANGE_LANES = _deal(_change, float, "dal_nodes_change"), _deal(_change, Lanes, "dal_nodes_change_lanes")
CHANGE = {float: CHANGE_REAL, Lanes: CHANGE_LANES}
RESTORE_REAL, RESTORE_COMPLEX, RESTORE_DUAL, RESTORE_LANES = map(_restore, (float, complex, Dual, Lanes))
RESTORE = {float: RESTORE_REAL, complex: RESTORE_COMPLEX, Dual: RESTORE_DUAL, Lanes: RESTORE_LANES}
