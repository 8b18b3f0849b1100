"""What a method makes of batches of responses, kept after each batch in place of the responses."""

import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from time import perf_counter

import numpy as np

from dalembert.forward.checkpoint import Arrays, Checkpoint
from dalembert.forward.distributed import models_in
from dalembert.forward.model import ForwardModel
from dalembert.forward.recorded import Recorded


class Fold:
    """State of a method after the batches of responses that it has used, as the checkpoint of its model keeps it. A
    checkpoint with the responses of 5,000 samples would take gigabytes; the method needs only what it has made of them,
    such as the smallest and the largest. The responses of the batch at work are kept until its end.

    ``model``: without a checkpoint nothing is kept; ``name``: of the method; ``points`` (n, parameters): parameter
    vectors of all batches; ``state``: before the first batch. Attributes: ``done``, number of batches that earlier
    processes used; ``state``, after these; ``notes``, what was noted of each batch.
    """

    def __init__(self, model: ForwardModel, name: str, points: np.ndarray, state: Arrays) -> None:
        self.done, self.state, self.notes = 0, state, list[list[str]]()
        self._checkpoint: Checkpoint | None = None
        self._seconds, self._lines = 0.0, list[bytes]()
        recorded = recorded_in(model)
        if recorded is None or not len(points):
            return
        self._checkpoint = recorded.checkpoint
        numbers = [np.ravel(array).astype(float) for array in (points, *state)]
        self._key = recorded.key(f"fold of {name}", np.concatenate(numbers))
        known = self._checkpoint.recall(self._key)
        if known is not None:
            lines, seconds, *self.state = known
            self._lines, self._seconds = lines.tobytes().splitlines(), float(seconds[0])
            self.notes = [json.loads(line) for line in self._lines]
            self.state, self.done = tuple(self.state), len(self.notes)

    @contextmanager
    def batch(self) -> Iterator[None]:
        """A block that computes and uses a batch; its responses are forgotten at the end, once the state is kept."""
        began = perf_counter()
        if self._checkpoint is None:
            yield
            return
        with self._checkpoint.summarised(self._key, self._summary):
            yield
            self._seconds += perf_counter() - began

    def used(self, state: Arrays, notes: Sequence[str]) -> None:
        """Take the state after a batch."""
        self.state = state
        self.notes.append(list(notes))
        self._lines.append(json.dumps(self.notes[-1]).encode())

    def _summary(self) -> tuple[Arrays, float]:
        """What the checkpoint keeps, made where it is written: lines of notes, seconds and state."""
        lines = np.frombuffer(b"\n".join(self._lines), np.uint8)
        return (lines, np.array([self._seconds]), *self.state), self._seconds


def summarised(model: ForwardModel, name: str, numbers: np.ndarray, compute: Callable[[], Arrays]) -> Arrays:
    """Return arrays that a method makes of a batch of responses; a checkpoint of the ``model`` keeps them in place of
    the responses. ``name``: of the method, with all other words that the arrays depend on. ``numbers``: all numbers
    that they depend on. ``compute``: evaluates the model and makes the arrays.
    """
    recorded = recorded_in(model)
    if recorded is None:
        return compute()
    checkpoint, key = recorded.checkpoint, recorded.key(f"summary of {name}", np.ravel(numbers))
    known = checkpoint.recall(key)
    if known is not None:
        return known
    began, spared = perf_counter(), checkpoint.spared
    with checkpoint.summarised(key, lambda: (arrays, seconds)):
        arrays = compute()
        seconds = perf_counter() - began + checkpoint.spared - spared
    return arrays


def recorded_in(model: ForwardModel) -> Recorded | None:
    """The first model with a checkpoint, of a model and of those that it holds."""
    return next((inner for inner in models_in(model) if isinstance(inner, Recorded)), None)
