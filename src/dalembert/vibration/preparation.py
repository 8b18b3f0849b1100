"""Compile the kernels of a computation before it starts: in parallel, and with progress."""

from collections.abc import Sequence
from threading import Lock

from dalembert.kernels.kernel import Compiled
from dalembert.kernels.preparation import prepare
from dalembert.vibration.laws import event_sums_in_plane as in_plane
from dalembert.vibration.laws.contact_sums import Shape, has_events
from dalembert.vibration.laws.event_sums import sums_and_slopes, sums_complex, sums_real
from dalembert.vibration.laws.friction_period import forces_complex, forces_real
from dalembert.vibration.laws.friction_tangent import forces_and_slopes
from dalembert.vibration.laws.law_sums import law_forces, law_samples, law_slopes
from dalembert.vibration.laws.linearised_law import linearise
from dalembert.vibration.system.lowering import ELASTIC, FrictionBlock, Lowered
from dalembert.vibration.time.elements import react, settle
from dalembert.vibration.time.steps import go_through

_TURN = Lock()
"""Threads of an ensemble start together: one of them compiles, and the others wait."""


_PLAIN = (forces_and_slopes, forces_real, forces_complex)
_CORRECTED = (sums_and_slopes, sums_real, sums_complex)
_IN_PLANE = (in_plane.sums_and_slopes, in_plane.sums_real, in_plane.sums_complex)
"""Kernels of sums with their Jacobians, of sums alone, and of their derivatives with respect to parameters."""


def prepare_balance(lowered: Lowered, events: bool, *, residuals: bool, stability: bool, derivatives: bool) -> None:
    """Prepare the kernels of harmonic balance, for the same arguments as ``equations`` takes."""
    kernels = _kernels(lowered, events, residuals, derivatives)
    if stability and any(block.remembers for block in lowered.laws):
        kernels += [law_samples]
    if stability and lowered.blocks:  # the map of stability goes from sample to sample
        kernels += [kernel for kernel in (forces_and_slopes,) if kernel not in kernels]
        kernels += [linearise] if any(block.kind == ELASTIC for block in lowered.blocks) else []
    if kernels:
        _prepare(kernels)


def _kernels(lowered: Lowered, events: bool, residuals: bool, derivatives: bool) -> list[Compiled]:
    """Kernels of the sums of contacts and stops."""
    sums = {_sums(block, events) for block in lowered.blocks}
    corrected = [events and block.kind.switches for block in lowered.laws]
    sums |= {_CORRECTED} if any(corrected) else set()
    kernels: list[Compiled] = [
        kernel
        for own in (_PLAIN, _CORRECTED, _IN_PLANE)
        for kernel, needed in zip(own, (True, residuals, derivatives), strict=True)
        if own in sums and needed
    ]
    if not all(corrected):
        kernels += [law_forces, law_slopes]
    return kernels + [kernel for block in lowered.laws for kernel in block.law.all_kernels()]


def _sums(block: FrictionBlock, events: bool) -> tuple[Compiled, ...]:
    """Kernels of the sums that a block takes."""
    if not (events and has_events(block.numbers, Shape(block.tangents, block.normal, block.memory))):
        return _PLAIN
    return _IN_PLANE if block.tangents == 2 else _CORRECTED


def prepare_time(lowered: Lowered, events: bool | None) -> None:
    """Compile or load the kernels of integration in time.

    With ``events`` it begins at a point of a curve, and they are as the method of the curve has them.
    """
    balance = [] if events is None else [settle, *_kernels(lowered, events, residuals=True, derivatives=False)]
    _prepare([react, go_through, *balance])


def _prepare(kernels: Sequence[Compiled]) -> None:
    with _TURN:
        prepare(kernels)
