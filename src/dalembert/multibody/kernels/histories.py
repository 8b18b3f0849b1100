"""Kernels over the samples of a motion: outputs of a block, energies; of states in real or in complex numbers."""

from dalembert.kernels.kernel import kernel
from dalembert.kernels.views import call
from dalembert.kernels.words import Address, Reals
from dalembert.multibody.kernels.assembly import set_signals
from dalembert.multibody.kernels.records import BLOCK_SIZE, block_at, call_at, model_at


@kernel
def outputs_history(
    model: Address, work: Address, block: Address, x: Address, v: Address, a: Address, stride: int, times: Reals,
    within: Reals, out: Address, out_stride: int, samples: int,
) -> None:  # fmt: skip
    """Outputs of a block at each sample; the next outputs stand ``out_stride`` bytes behind, states ``stride``.

    Without ``times`` there are no signals.
    """
    own = call_at(work)
    for s in range(samples):
        if len(times) > 0:
            set_signals(model, times[s], within[s], work)
        # Addresses move on from sample to sample: no state is copied.
        own.x, own.v, own.a, own.r = x + s * stride, v + s * stride, a + s * stride, out + s * out_stride
        call(block_at(block).outputs, work, block)


@kernel
def energy_history(
    model: Address, work: Address, x: Address, v: Address, stride: int, times: Reals, within: Reals, out: Address,
    out_stride: int,
) -> None:  # fmt: skip
    """Kinetic energy, potential energy and power at each sample; added to ``out``."""
    own, table = call_at(work), model_at(model)
    for s in range(len(times)):
        set_signals(model, times[s], within[s], work)
        own.x, own.v, own.a, own.totals = x + s * stride, v + s * stride, v + s * stride, out + s * out_stride
        for k in range(table.block_count):
            block = table.blocks + k * BLOCK_SIZE
            if block_at(block).energy != 0:
                call(block_at(block).energy, work, block)
