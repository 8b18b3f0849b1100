"""A model whose answers are kept, and given again without computing when the same is asked."""

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from time import perf_counter

import numpy as np

from dalembert.errors import SolveError
from dalembert.forward.adjoint import ADJOINT, Pull, pullback
from dalembert.forward.checkpoint import Checkpoint
from dalembert.forward.complex_steps import check_derivatives
from dalembert.forward.responses import Responses
from dalembert.forward.wrapped import Wrapped

TOGETHER = 64  # vectors of a batch that are computed between two records


@dataclass(frozen=True)
class Recorded(Wrapped):
    """A forward model that reads known responses from a checkpoint and adds new ones to it.

    A method that is started again after it was killed gets the same responses, bit for bit. So it repeats its steps in
    little time until it needs a response that was not computed yet.

    Parameters
    ----------
    model : ForwardModel
        Its answer to a vector must not depend on the others of a batch.
    checkpoint : Checkpoint
    label : str
        Distinguishes this model from others in the same checkpoint, with its fingerprint.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from dalembert.forward import PythonModel
    >>> asked = []
    >>> def decay(rate):
    ...     asked.append(rate)
    ...     return np.exp(-rate * np.linspace(0, 1, 3))
    >>> model = PythonModel(decay, {"rate": (0.1, 2.0)}, ["x"], np.linspace(0, 1, 3))
    >>> with Checkpoint(Path(tempfile.mkdtemp()) / "checkpoint") as checkpoint:
    ...     recorded = Recorded(model, checkpoint)
    ...     first, second = (recorded.evaluate(np.array([[1.0], [1.5]])).values for _ in range(2))
    >>> len(asked), bool((first == second).all())
    (2, True)
    """

    checkpoint: Checkpoint
    label: str = ""

    @property
    def spared(self) -> float:
        """Seconds that earlier processes computed what this one recalled."""
        return self.checkpoint.spared

    def evaluate(self, vectors: np.ndarray) -> Responses:
        """Responses of a batch: those that are known, and then the others, kept as they come."""
        vectors = np.atleast_2d(np.asarray(vectors, dtype=float))
        values = np.full((len(vectors), len(self.coordinate.values), len(self.channels)), np.nan)
        failures: list[str | None] = [None] * len(vectors)
        keys, missing = [self.key("evaluate", vector) for vector in vectors], []
        for row, key in enumerate(keys):
            known = self.checkpoint.recall(key)
            if known is None:
                missing.append(row)
            else:
                values[row], failures[row] = known[0], _text(known[1])
        for begin in range(0, len(missing), TOGETHER):
            rows, began = missing[begin : begin + TOGETHER], perf_counter()
            responses = self.model.evaluate(vectors[rows])
            seconds = (perf_counter() - began) / len(rows)
            for row, response, failure in zip(rows, responses.values, responses.failures, strict=True):
                self.checkpoint.keep(keys[row], (response, _bytes(failure)), seconds)
                values[row], failures[row] = response, failure
        return Responses(values, tuple(failures))

    def jacobian(self, vector: np.ndarray) -> np.ndarray:
        """Derivative of the response, (samples, channels, parameters)."""
        return self._once("jacobian", vector, lambda: (self.model.jacobian(vector),))[0]

    def linearise(self, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Response (samples, channels) and its jacobian (samples, channels, parameters)."""
        values, jacobian = self._once("linearise", vector, lambda: self.model.linearise(vector))
        return values, jacobian

    def pullback(self, vector: np.ndarray) -> tuple[np.ndarray, Pull]:
        """Response (samples, channels), and the gradients of its weighted sums by the model's adjoint."""
        opened = cache(lambda: pullback(self.model, vector, ADJOINT))
        (response,) = self._once("pullback", vector, lambda: (opened()[0],))

        def pull(cotangent: np.ndarray) -> np.ndarray:
            key_numbers = np.concatenate([vector, np.ravel(cotangent)])
            return self._once("pull", key_numbers, lambda: (opened()[1](cotangent),))[0]

        return response, pull

    def check_derivatives(self, vector: np.ndarray) -> None:
        """Compare the complex step of the model with differences at a vector (parameters,), once a checkpoint."""

        def compared() -> tuple[np.ndarray]:
            check_derivatives(self.model, vector)
            return (np.ones(1),)

        self._once("check_derivatives", vector, compared)

    def _once(self, what: str, vector: np.ndarray, compute: Callable[[], Sequence[np.ndarray]]) -> Sequence[np.ndarray]:
        """Arrays from the checkpoint, or computed; a stored failure of a solver is raised again."""
        key = self.key(what, np.asarray(vector, dtype=float))
        known = self.checkpoint.recall(key)
        if known is not None and len(known) == 1 and known[0].dtype == np.uint8:
            raise SolveError(_text(known[0]) or "")
        if known is None:
            began = perf_counter()
            try:
                known = compute()
            except SolveError as error:
                self.checkpoint.keep(key, (_bytes(str(error)),), perf_counter() - began)
                raise
            self.checkpoint.keep(key, known, perf_counter() - began)
        return known

    def key(self, what: str, vector: np.ndarray) -> bytes:
        """Hash of all that an answer depends on."""
        return hashlib.sha256(self._question + what.encode() + np.ascontiguousarray(vector).tobytes()).digest()

    @cached_property
    def _question(self) -> bytes:
        text = "\n".join((self.label, self.fingerprint, *(channel.name for channel in self.channels)))
        return hashlib.sha256(text.encode() + self.coordinate.values.tobytes()).digest()


def _bytes(text: str | None) -> np.ndarray:
    """A text as an array; an empty one for none."""
    return np.frombuffer((text or "").encode(), np.uint8)


def _text(array: np.ndarray) -> str | None:
    return array.tobytes().decode() or None
