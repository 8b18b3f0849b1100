"""Which mistakes in records are tested where a fit is poor."""

from collections.abc import Callable, Iterator
from typing import TypeAlias

from dalembert.inverse.mistakes.confused_channels import swapped_channels, wrong_sign
from dalembert.inverse.mistakes.record import FittedRecord, Mistake
from dalembert.inverse.mistakes.spoiled_samples import clipped, dropouts, repeated_samples
from dalembert.inverse.mistakes.wrong_clocks import clock_rate, late_clock

Hypothesis: TypeAlias = Callable[[FittedRecord], Iterator[Mistake]]
"""The mistakes of one kind that a record may have."""

HYPOTHESES: tuple[Hypothesis, ...] = (
    dropouts,
    clipped,
    repeated_samples,
    wrong_sign,
    swapped_channels,
    late_clock,
    clock_rate,
)
"""The simplest first: of two that explain the same the first is reported."""
