"""What a method makes of batches of responses, kept after each batch in place of the responses."""

import json
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from time import perf_counter

import numpy as np

from dalembert.forward.checkpoint import Arrays, Checkpoint
from dalembert.forward.model import ForwardModel
from dalembert.forward.recorded import Recorded


class Fold:
    """The state of a method after the batches of responses that it has used, as the checkpoint of its model keeps it.

    A checkpoint that kept the responses of 5,000 samples would take gigabytes; the method needs only what it has made
    of them, such as the smallest and the largest. The responses of the batch at work are kept until its end.

    Parameters
    ----------
    model : ForwardModel
        Without a checkpoint nothing is kept.
    name : str
        Of the method.
    points : ndarray
        Parameter vectors of all batches, (n, parameters).
    state : tuple of ndarray
        Before the first batch.

    Attributes
    ----------
    done : int
        Batches that earlier processes used.
    state : tuple of ndarray
        After these.
    notes : list of list of str
        What was noted of each batch.
    """

    def __init__(self, model: ForwardModel, name: str, points: np.ndarray, state: Arrays) -> None:
        self.done, self.state, self.notes = 0, state, list[list[str]]()
        self._checkpoint: Checkpoint | None = None
        self._seconds = 0.0
        recorded = _recorded(model)
        if recorded is None or not len(points):
            return
        self._checkpoint = recorded.checkpoint
        numbers = [np.ravel(array).astype(float) for array in (points, *state)]
        self._key = recorded.key(f"fold of {name}", np.concatenate(numbers))
        known = self._checkpoint.recall(self._key)
        if known is not None:
            notes, seconds, *self.state = known
            self.notes, self._seconds = json.loads(notes.tobytes()), float(seconds[0])
            self.state, self.done = tuple(self.state), len(self.notes)

    @contextmanager
    def batch(self) -> Iterator[None]:
        """A block that computes and uses a batch; its responses are forgotten at the end, once the state is kept."""
        began = perf_counter()
        if self._checkpoint is None:
            yield
            return
        with self._checkpoint.scratch():
            yield
            self._seconds += perf_counter() - began
            notes = np.frombuffer(json.dumps(self.notes).encode(), np.uint8)
            self._checkpoint.keep(self._key, (notes, np.array([self._seconds]), *self.state), self._seconds)

    def used(self, state: Arrays, notes: Sequence[str]) -> None:
        """Take the state after a batch."""
        self.state = state
        self.notes.append(list(notes))


def _recorded(model: object) -> Recorded | None:
    """The model with a checkpoint in a model, if there is one."""
    while model is not None and not isinstance(model, Recorded):
        model = getattr(model, "model", None)
    return model
