"""Records that kernels of components share: the call, a block of components of one kind, and the table of a model."""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.views import record


class Inputs(NamedTuple):
    """What a component sees beside its own state: values and two rates of the signals (signals, 3), callbacks."""

    signals: np.ndarray
    callbacks: np.ndarray


def _record(integers: str, reals: str = "") -> np.dtype:
    return np.dtype([(name, "i8") for name in integers.split()] + [(name, "f8") for name in reals.split()])


#: What changes from call to call. Vectors have N + 1 entries, of which the last one stays zero: absent unknowns of a
#: component point to it. ``x v a``: coordinates with multipliers, velocities, accelerations; ``coordinates``: how many
#: of the unknowns are no multipliers; ``last``: N. Rows of residual and tangent are those of ``increments``, then of
#: multipliers, ``last_row`` in all: as many as the unknowns in the full system, fewer in the reduced one. ``r rate
#: second totals matrix``: what kernels add to; ``entries`` of the matrix. ``delta``: increments, and the ``change``
#: that they make of the coordinates. ``signals`` (signals, 3) at the time ``t``, ``within`` its smooth stretch; the
#: length of the ``step`` whose middle is at that time, for methods that take forces of both its ends; else zero.
#: ``slots``: where the entries of the block's local
#: matrices stand in ``matrix``. The tangent is the derivative along ``by_x dq + by_v dv + by_a da``; its rows are
#: multiplied by ``motion`` and ``constraint``.
CALL = _record(
    "coordinates last increments last_row x v a r rate second totals matrix entries delta change "
    "signals signal_count callbacks callback_count slots",
    "t within step by_x by_v by_a motion constraint",
)
#: Components of one kind: how many, their unknowns (count, width), the rows of their residual (count, row_count), which
#: in the full system are the unknowns, integers, numbers, the real parts of these, and the kind's kernels in the
#: arithmetic of the model (``spread`` and ``change`` in real numbers, ``tangent`` in complex ones); 0 if there is none.
#: ``joins``: whether the kind has constraints.
BLOCK = _record(
    "count index rows row_count integers numbers residual tangent rates energy outputs joins spread change restore"
)
#: A model: its blocks; those of the reduced system; the nodes as blocks, the row of each unknown, and kernels of all
#: nodes; its ``middle``, see :meth:`BlockModel.averaged`; its signals, see :mod:`signals`. Without nodes a model has
#: one system: ``reduced`` are its blocks.
MODEL = _record(
    "blocks block_count reduced reduced_count nodes node_count rows spread change restore middle "
    "signal_count signal_index knots knot_count signal_data number_count callbacks callback_count evaluate"
)

call_at, block_at, model_at = record(CALL), record(BLOCK), record(MODEL)
BLOCK_SIZE = BLOCK.itemsize
