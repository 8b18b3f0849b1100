"""Checks of a study before its run, and a forecast of its duration and its result."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from math import inf
from time import monotonic

import numpy as np

from dalembert.forward import Checkpoint
from dalembert.forward.checkpoint import Arrays
from dalembert.study.run.duration import StartFailed, duration, storage, timed, too_long
from dalembert.study.run.model_findings import time_scale_findings
from dalembert.study.run.progress import duration_text
from dalembert.study.tables.study import Study
from dalembert.study.tasks import TASKS
from dalembert.study.text.functions import users_code
from dalembert.study.text.table import naming
from dalembert.threads import single_thread


class FirstSimulation(BaseException):
    """Ends a run that is only validated, in place of a simulation. It is no error, so no method handles it."""


class Unanswered(Checkpoint):
    """A checkpoint without a file, which lets a number of ``simulations`` through and then ends the run. Every task
    looks for the result of a simulation in its checkpoint before it simulates.
    """

    def __init__(self, simulations: int = 0) -> None:
        self.spared = 0.0
        self._left = simulations

    def recall(self, key: bytes) -> Arrays | None:
        """End the run, unless a simulation is left."""
        self._left -= 1
        if self._left < 0:
            raise FirstSimulation
        return None

    def keep(self, key: bytes, arrays: Sequence[np.ndarray], seconds: float = 0.0) -> None:
        """Keep nothing."""

    @contextmanager
    def summarised(self, key: bytes, summary: object) -> Iterator[None]:
        """Keep no summary."""
        yield

    def close(self) -> None:
        """Do nothing: there is no file."""


def plan(study: Study, simulations: int = 0) -> str:
    """Return what a study would run, in a sentence, once all that its run checks before it simulates is right.

    Parameters
    ----------
    study : Study
    simulations : int
        Number of simulations after which the run is ended.

    Raises
    ------
    DalembertError
        What the run would raise before its next simulation.
    """
    task = TASKS[study.task]
    with users_code(), naming(study.task):
        sentence = task.plan(study)
        for part in task.parts(replace(study, checkpoint=Unanswered(simulations), executor=None)):
            with suppress(FirstSimulation):
                part()
    return sentence


def forecast(study: Study, limit: float = inf) -> Iterator[str]:
    """Yield sentences on how long a study takes and what its result will be, from few simulations. What takes longer
    than ``limit``, s, is left out, and a sentence says so.
    """
    task, began = TASKS[study.task], monotonic()
    with users_code(), single_thread():
        yield from (f"Warning: {finding}" for finding in time_scale_findings(study))
        effort = task.effort(study)
        try:
            timing = timed(effort)
        except StartFailed as error:
            yield f"Warning: the simulation at the first guesses fails: {error}. Check the model or change the start."
            return
        yield duration(effort, timing)
        if size := storage(effort):
            yield size
        long = too_long(effort, timing)
        if long is not None:
            yield f"Warning: {long}"
        trials, count = task.trials(study), task.foresight(study)
        needed, left = (trials + count) * timing.each, limit - (monotonic() - began)
        if needed > left:
            yield (
                f"The check ends before its time limit, {duration_text(limit)}: what it would simulate next takes "
                f"{duration_text(needed)}. Raise --limit."
            )
            return
        if trials:
            plan(study, trials)
        if count:
            yield from task.foreseen(study)
