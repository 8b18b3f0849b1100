"""Compile the kernels of a computation before it starts: in parallel, and with progress."""

from collections.abc import Sequence
from threading import Lock

from dalembert.kernels.kernel import Compiled
from dalembert.kernels.preparation import prepare
from dalembert.vibration.friction_period import forces_complex, forces_real
from dalembert.vibration.friction_tangent import forces_and_slopes
from dalembert.vibration.linearised_law import linearise
from dalembert.vibration.lowering import ELASTIC, Lowered
from dalembert.vibration.time_elements import react, settle
from dalembert.vibration.time_steps import go_through

_TURN = Lock()
"""Threads of an ensemble start together: one of them compiles, and the others wait."""


def prepare_balance(lowered: Lowered, *, residuals: bool, stability: bool, derivatives: bool) -> None:
    """Prepare the kernels of harmonic balance, for the same arguments as ``equations`` takes."""
    if lowered.blocks:
        elastic = any(block.kind == ELASTIC for block in lowered.blocks)
        own = {forces_real: residuals, linearise: stability and elastic, forces_complex: derivatives}
        _prepare([forces_and_slopes, *(kernel for kernel, needed in own.items() if needed)])


def prepare_time(lowered: Lowered, *, on_curve: bool) -> None:
    """Compile or load the kernels of integration in time, from rest or from a point of a curve."""
    balance = [forces_and_slopes, forces_real] if lowered.blocks else []
    _prepare([react, go_through, *([settle, *balance] if on_curve else [])])


def _prepare(kernels: Sequence[Compiled]) -> None:
    with _TURN:
        prepare(kernels)
