"""Which mistakes in records are tested where a fit is poor."""

from collections.abc import Callable, Iterator
from typing import TypeAlias

from dalembert.inverse.mistakes.clipped import clipped
from dalembert.inverse.mistakes.clock_rate import clock_rate
from dalembert.inverse.mistakes.dropouts import dropouts
from dalembert.inverse.mistakes.late_clock import late_clock
from dalembert.inverse.mistakes.record import FittedRecord, Mistake
from dalembert.inverse.mistakes.repeated_samples import repeated_samples
from dalembert.inverse.mistakes.swapped_channels import swapped_channels
from dalembert.inverse.mistakes.wrong_sign import wrong_sign

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
