"""Kernels of all nodes of a model: what increments change of its unknowns."""

from dalembert.kernels.kernel import BlockKernel, inlined
from dalembert.kernels.views import call, complexes, integers, reals
from dalembert.multibody.kernels.records import BLOCK_SIZE, block_at, call_at, model_at


@inlined
def _deal(own, table):
    """Increments of coordinates that belong to no node, and of multipliers; 0 for the others."""
    size = own.last + 1
    rows, delta, change = integers(table.rows, size), reals(own.delta, own.last_row + 1), reals(own.change, size)
    for i in range(size):
        change[i] = delta[rows[i]]


def _spread(work, model):
    table = model_at(model)
    _deal(call_at(work), table)
    for k in range(table.node_count):
        node = table.nodes + k * BLOCK_SIZE
        call(block_at(node).spread, work, node)


def _change(work, model):
    table = model_at(model)
    _deal(call_at(work), table)
    for k in range(table.node_count):
        node = table.nodes + k * BLOCK_SIZE
        call(block_at(node).change, work, node)


def _restore(dtype: type) -> BlockKernel:
    view = complexes if dtype is complex else reals

    def restore(work, model):
        own, table = call_at(work), model_at(model)
        change = view(own.change, own.last + 1)
        for i in range(len(change)):
            change[i] = 0.0
        for k in range(table.node_count):
            node = table.nodes + k * BLOCK_SIZE
            call(block_at(node).restore, work, node)

    return BlockKernel(restore, f"dal_nodes_restore_{dtype.__name__}")


SPREAD, CHANGE = BlockKernel(_spread, "dal_nodes_spread"), BlockKernel(_change, "dal_nodes_change")
RESTORE_REAL, RESTORE_COMPLEX = _restore(float), _restore(complex)
RESTORE = {float: RESTORE_REAL, complex: RESTORE_COMPLEX}
