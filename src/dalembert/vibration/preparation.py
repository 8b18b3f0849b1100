"""Compile the kernels of a computation before it starts: in parallel, and with progress."""

from collections.abc import Sequence
from threading import Lock

from dalembert.kernels.kernel import Compiled
from dalembert.kernels.preparation import prepare
from dalembert.vibration.event_sums import sums_and_slopes, sums_complex, sums_real
from dalembert.vibration.friction_period import forces_complex, forces_real
from dalembert.vibration.friction_tangent import forces_and_slopes
from dalembert.vibration.linearised_law import linearise
from dalembert.vibration.lowering import ELASTIC, Lowered
from dalembert.vibration.springs import BilinearStop, Gap
from dalembert.vibration.time_elements import react, settle
from dalembert.vibration.time_steps import go_through

_TURN = Lock()
"""Threads of an ensemble start together: one of them compiles, and the others wait."""


_PLAIN = (forces_and_slopes, forces_real, forces_complex)
_CORRECTED = (sums_and_slopes, sums_real, sums_complex)
"""Kernels of sums with their Jacobians, of sums alone, and of their derivatives with respect to parameters."""


def prepare_balance(lowered: Lowered, events: bool, *, residuals: bool, stability: bool, derivatives: bool) -> None:
    """Prepare the kernels of harmonic balance, for the same arguments as ``equations`` takes."""
    kernels = _kernels(lowered, events, residuals, derivatives)
    if stability and lowered.blocks:  # the map of stability goes from sample to sample
        kernels += [kernel for kernel in (forces_and_slopes,) if kernel not in kernels]
        kernels += [linearise] if any(block.kind == ELASTIC for block in lowered.blocks) else []
    if kernels:
        _prepare(kernels)


def _kernels(lowered: Lowered, events: bool, residuals: bool, derivatives: bool) -> list[Compiled]:
    """Kernels of the sums of contacts and stops."""
    return [
        kernel
        for law, used in ((_PLAIN, _plain(lowered, events)), (_CORRECTED, _corrected(lowered, events)))
        for kernel, needed in zip(law, (True, residuals, derivatives), strict=True)
        if used and needed
    ]


def _plain(lowered: Lowered, events: bool) -> bool:
    """Whether sums of samples are needed."""
    return any(block.tangents == 2 or not events for block in lowered.blocks)


def _corrected(lowered: Lowered, events: bool) -> bool:
    """Whether sums that are corrected at events are needed."""
    stops = any(isinstance(element, Gap | BilinearStop) for _, element in lowered.springs)
    return events and (stops or any(block.tangents < 2 for block in lowered.blocks))


def prepare_time(lowered: Lowered, events: bool | None) -> None:
    """Compile or load the kernels of integration in time.

    With ``events`` it begins at a point of a curve, and they are as the method of the curve has them.
    """
    balance = [] if events is None else [settle, *_kernels(lowered, events, residuals=True, derivatives=False)]
    _prepare([react, go_through, *balance])


def _prepare(kernels: Sequence[Compiled]) -> None:
    with _TURN:
        prepare(kernels)
