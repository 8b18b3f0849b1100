"""A batch in groups of eight samples side by side, and what has to run alone one after the other."""

from collections.abc import Callable

import numpy as np

from dalembert.kernels.lanes import WIDTH
from dalembert.multibody.integrators.shared.batch import Batch
from dalembert.multibody.integrators.shared.run import Run
from dalembert.multibody.kernels.states import MotionState
from dalembert.multibody.model.lane_models import FEWEST, share_lanes

RunGroup = Callable[[Batch], tuple[MotionState, np.ndarray]]
"""Runs up to eight samples: their states (samples, times, N + 1), and which of them have to run alone (samples,)."""


def run_groups(batch: Batch, run_group: RunGroup, one_by_one: Callable[[Batch], list[Run]]) -> list[Run]:
    """Return the runs of a batch, in groups where its samples may run side by side: with the bits of each alone."""
    if batch.perturbed or batch.logged or not share_lanes(batch.samples):
        return one_by_one(batch)
    runs: dict[int, Run] = {}
    for first in range(0, len(batch.samples) - FEWEST + 1, WIDTH):
        part = batch.part(range(first, min(first + WIDTH, len(batch.samples))))
        out, alone = run_group(part)
        dout, log = part.derivatives(), part.log(None)
        for number in np.flatnonzero(~alone):
            states = MotionState(*(values[number] for values in out))
            runs[first + int(number)] = part.result(None, states, dout, log)
    left = [number for number in range(len(batch.samples)) if number not in runs]
    runs |= dict(zip(left, one_by_one(batch.part(left)) if left else [], strict=True))
    return [runs[number] for number in range(len(batch.samples))]
