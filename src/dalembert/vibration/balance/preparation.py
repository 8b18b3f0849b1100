"""Compile the kernels of a computation before it starts: in parallel, and with progress."""

from collections.abc import Sequence
from threading import Lock

from dalembert.kernels.kernel import Compiled
from dalembert.kernels.preparation import prepare
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.interface.lowering import ELASTIC, Lowered
from dalembert.vibration.laws.contact_sums import EventSums, Shape, sums_for
from dalembert.vibration.laws.friction_law import sliding
from dalembert.vibration.laws.friction_tangent import forces_and_slopes
from dalembert.vibration.laws.law_march import marches
from dalembert.vibration.laws.marched_sums import MarchedSums
from dalembert.vibration.laws.sampled_sums import law_derivatives, sampled_forces

_TURN = Lock()
"""Threads of an ensemble start together: one of them compiles, and the others wait."""


def prepare_balance(lowered: Lowered, events: bool, *, residuals: bool, stability: bool, derivatives: bool) -> None:
    """Prepare the kernels of harmonic balance, for the same arguments as ``equations`` takes."""
    kernels = balance_kernels(lowered, events, residuals, derivatives)
    if stability and lowered.blocks:  # the map of stability goes from sample to sample
        kernels.append(forces_and_slopes)
        if any(block.kind == ELASTIC for block in lowered.blocks):
            kernels += [marches, law_derivatives, *sliding.all_kernels()]
    if kernels:
        prepare_together(list(dict.fromkeys(kernels)))


def balance_kernels(lowered: Lowered, events: bool, residuals: bool, derivatives: bool) -> list[Compiled]:
    """Kernels of the sums of contacts and stops."""
    shapes = [(block.numbers, Shape(block.tangents, block.normal, block.memory)) for block in lowered.blocks]
    corrected = [events and block.element.switches for block in lowered.laws]
    used = [sums_for(*entry, events).kernels for entry in shapes] + [EventSums.kernels] * any(corrected)
    needed = (True, residuals, derivatives)
    kernels: list[Compiled] = [
        kernel for entry in dict.fromkeys(used) for kernel, use in zip(entry, needed, strict=True) if use
    ]
    sums = [block.sums(Fourier((0, 1), 4), events) for block in lowered.laws]
    kernels += [marches] * any(isinstance(entry, MarchedSums) for entry in sums)
    if lowered.laws:
        kernels += [sampled_forces, law_derivatives]
    laws = [entry for block in lowered.laws for entry in (block.law, block.element.events) if entry is not None]
    return kernels + [kernel for law in laws for kernel in law.all_kernels()]


def prepare_together(kernels: Sequence[Compiled]) -> None:
    """Compile or load kernels, once for all threads."""
    with _TURN:
        prepare(kernels)
