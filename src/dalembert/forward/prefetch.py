"""What methods will ask of a model, computed on a Dask cluster before they ask.

Several things that do not depend on each other, whole descents even, are done one after the other in this process, as
without a cluster. But first workers do them too, each its own, and send what the model answered them; then they are
done here, with these answers. So events, counts and checkpoints come in one order, and from one process, and the
results are those of this process alone, bit for bit. What a worker was not asked is computed here, as always.
"""

import pickle
from collections.abc import Callable, Generator, Sequence
from contextlib import closing, suppress
from dataclasses import dataclass
from functools import partial
from typing import Any, NoReturn, TypeVar

import numpy as np

from dalembert.errors import DalembertError, SolveError, told
from dalembert.forward.cluster import packed
from dalembert.forward.distributed import Answers, Distributed, bare, key_of, models_in, rebuilt
from dalembert.forward.ensembles import ensemble
from dalembert.forward.model import ForwardModel
from dalembert.forward.recorded import Recorded
from dalembert.forward.responses import Responses
from dalembert.forward.wrapped import Wrapped

Item = TypeVar("Item")
Work = Callable[[ForwardModel, Item], object]


def prefetched(model: ForwardModel, work: Work[Item], items: Sequence[Item]) -> Generator[Item, None, None]:
    """The items, in their order; work on each can be done when it comes, and asks no more of a cluster.

    Parameters
    ----------
    model : ForwardModel
        Where batches of it, or of models in it, go to a cluster, so do the items; else they come as they are.
    work : callable
        Called on the workers with a copy of the model and an item; what it returns is not needed. It must ask the same
        of any model that gives the same answers.
    items : sequence
        Items that are not asked for are taken from the cluster.

    Raises
    ------
    ClusterError
        Where the cluster lost an item, and why.

    Examples
    --------
    >>> from dalembert.forward import PythonModel
    >>> model = PythonModel(lambda rate: np.exp(-rate * np.linspace(0, 1, 3)), {"rate": (0, 2)}, ["x"], [0, 0.5, 1])
    >>> work = lambda model, rate: model.jacobian(np.array([rate]))
    >>> [float(work(model, rate)[-1, 0, 0].round(3)) for rate in prefetched(model, work, [0.5, 1.0])]
    [-0.607, -0.368]
    """
    if len(items) < 2 or not on_several_machines(model):
        yield from items
        return
    parts: list[Distributed] = []
    kept: list[Answers] = []

    def answering(inner: ForwardModel) -> ForwardModel | None:
        """The models of workers: those whose batches go to a cluster keep their answers."""
        if isinstance(inner, Recorded):
            return rebuilt(inner.model, answering)
        if isinstance(inner, Distributed):
            parts.append(inner)
            kept.append({})
            return _Answering(bare(inner.model), kept[-1])
        return None

    remote = rebuilt(model, answering)
    silent = rebuilt(model, lambda submodel: _Unasked(submodel.model) if isinstance(submodel, Distributed) else None)
    missing = [not _known(silent, work, item) for item in items]
    answer = partial(_answers, packed((work, remote, kept)))
    wanted = [item for item, lacks in zip(items, missing, strict=True) if lacks]
    with closing(ensemble(answer, wanted, executor=parts[0].client)) as answered:
        for item, lacks in zip(items, missing, strict=True):
            if lacks:
                for part, answers in zip(parts, next(answered), strict=True):
                    part.prefetched.update(answers)
            try:
                yield item
            finally:
                for part in parts:
                    part.prefetched.clear()


def on_several_machines(model: ForwardModel) -> bool:
    """Return whether batches of the model, or of models in it, go to a cluster."""
    return any(isinstance(inner, Distributed) for inner in models_in(model))


@dataclass(frozen=True)
class _Answering(Wrapped):
    """A model on a worker that keeps its answers."""

    answers: Answers

    def evaluate(self, vectors: np.ndarray) -> Responses:
        vectors = np.atleast_2d(np.asarray(vectors, dtype=float))
        responses = self.model.evaluate(vectors)
        for vector, values, failure in zip(vectors, responses.values, responses.failures, strict=True):
            self.answers[key_of("evaluate", self, vector)] = (values, failure)
        return responses

    def linearise(self, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        key = key_of("linearise", self, vector)
        try:
            linearisation = self.model.linearise(vector)
        except Exception as error:
            self.answers[key] = error if isinstance(error, DalembertError) else SolveError(told(error))
            raise
        self.answers[key] = linearisation
        return linearisation


class _Unknown(BaseException):
    """A result is needed that no checkpoint has. It is no failure of a simulation, after which methods continue."""


@dataclass(frozen=True)
class _Unasked(Wrapped):
    """A model that answers nothing."""

    def evaluate(self, vectors: np.ndarray) -> NoReturn:
        raise _Unknown

    def linearise(self, vector: np.ndarray) -> NoReturn:
        raise _Unknown


def _known(silent: ForwardModel, work: Work[Item], item: Item) -> bool:
    """Whether checkpoints have all answers that work on an item asks for, as those of a run that is resumed may."""
    try:
        with suppress(Exception):  # told where the work is done
            work(silent, item)
    except _Unknown:
        return False
    return True


def _answers(content: bytes, item: Any) -> list[Answers]:
    """On a worker: what the parts of a model answered while an item was worked on."""
    work, model, answers = pickle.loads(content)
    with suppress(Exception):  # told where it is asked
        work(model, item)
    return answers
