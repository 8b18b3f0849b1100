"""Whether a study can run: all that its run checks before its first simulation."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace

import numpy as np

from dalembert.forward import Checkpoint
from dalembert.forward.checkpoint import Arrays
from dalembert.study.tables.study import Study
from dalembert.study.tasks import TASKS
from dalembert.study.text.functions import users_code


class FirstSimulation(BaseException):
    """Ends a run that is only validated, in place of a simulation. It is no error, so no method handles it."""


class Unanswered(Checkpoint):
    """A checkpoint without a file, which ends the run that looks for a result.

    Every task looks for the result of a simulation in its checkpoint before it simulates.

    Parameters
    ----------
    simulations : int
        Number of simulations that are let through before.
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
    with users_code():
        sentence = task.plan(study)
        for part in task.parts(replace(study, checkpoint=Unanswered(simulations), executor=None)):
            with suppress(FirstSimulation):
                part()
    return sentence
