"""Batches of a model on a Dask cluster."""

from collections.abc import Callable, Iterator
from copy import copy
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import chain
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from dalembert.errors import DalembertError, InputError
from dalembert.forward.cluster import RETRIES, Executor, Received, Sender, futures_of, sent
from dalembert.forward.model import ForwardModel
from dalembert.forward.refinement import Refinement, refined
from dalembert.forward.responses import Responses
from dalembert.forward.wrapped import Wrapped

if TYPE_CHECKING:
    from distributed import Client

PARTS = 4  # parts of a batch a thread of the cluster: enough that few wait at the end, and each worth its message
# What was asked of a model: the name of its method, how many samples it has, and the parameter vector.
Key: TypeAlias = tuple[str, int, bytes]
# Values and failure, or response and jacobian, or why there is none, by what was asked.
Answers: TypeAlias = "dict[Key, tuple[Any, ...] | DalembertError]"


@dataclass(frozen=True)
class Distributed(Wrapped):
    """A forward model whose batches are computed by a Dask cluster; a single vector is computed in this process.

    Parameters
    ----------
    model : ForwardModel
        It is sent to the workers, with the modules that no package brought; they need the same versions of the
        packages. Its answer to a vector must not depend on the others of a batch.
    client : distributed.Client
    prefetched : dict
        Answers that the cluster computed before they are asked for (see :func:`dalembert.forward.prefetched`).

    Notes
    -----
    A worker computes one vector after another, on one thread, by the code that this process would run: between machines
    of one kind the answers are the same, bit for bit, wherever they are computed. A part whose worker is lost is
    computed by another one.
    """

    client: "Client" = field(repr=False)
    prefetched: Answers = field(default_factory=dict, repr=False, compare=False)

    def evaluate(self, vectors: np.ndarray) -> Responses:
        """Responses of a batch; ``vectors`` (batch, parameters), values (batch, samples, channels).

        Raises
        ------
        ClusterError
            Where the cluster lost the batch, and why.
        """
        from distributed import as_completed

        vectors = np.atleast_2d(np.asarray(vectors, dtype=float))
        known = [self.prefetched.get(key_of("evaluate", self, vector)) for vector in vectors]
        if known and all(isinstance(answer, tuple) for answer in known):
            values, failures = zip(*known, strict=True)
            return Responses(np.array(values), failures)
        if len(vectors) < 2:
            return self.model.evaluate(vectors)
        with futures_of(self.client, f"a part of a batch of {len(vectors)}") as futures:
            workers: Any = self.client.nthreads()
            parts = np.array_split(vectors, min(len(vectors), PARTS * max(1, sum(workers.values()))))
            model = sent(self.client, bare(self.model))
            futures += self.client.map(
                _answered, [model] * len(parts), parts, sender=Sender(), pure=False, retries=RETRIES
            )
            for part in as_completed(futures, loop=self.client.loop):  # gather would complain of each that is cancelled
                if part.status != "finished":
                    part.result()  # raises what became of it
            answers: Any = self.client.gather(futures)
        values, failures = zip(*answers, strict=True)
        return Responses(np.concatenate(values), tuple(chain.from_iterable(failures)))

    def linearise(self, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Response (samples, channels) and its jacobian (samples, channels, parameters)."""
        known = self.prefetched.get(key_of("linearise", self, vector))
        if isinstance(known, DalembertError):
            raise known
        return self.model.linearise(vector) if known is None else (known[0], known[1])

    def refined(self) -> Refinement | None:
        """Return the same around a more exact model, without the answers of this one, or None."""
        finer = refined(self.model)
        return None if finer is None else replace(finer, model=replace(self, model=finer.model, prefetched={}))


def on_cluster(model: ForwardModel, client: Executor) -> ForwardModel:
    """A model whose batches go to a Dask cluster.

    Of a model with a checkpoint, only samples without a stored result go there.

    Parameters
    ----------
    model : ForwardModel
    client : distributed.Client, optional
        Of any of Dask's clusters; without one the model stays as it is.

    Raises
    ------
    InputError
        If ``client`` is the address of a scheduler. Make the client yourself, ``Client(address)``, and close it after.
    """
    if client is None:
        return model
    if isinstance(client, str):
        raise InputError(
            f"on_cluster: {client!r} is an address; expected a client, as of: with distributed.Client({client!r}) as "
            "client; methods such as identify take an address, too, and disconnect when they end"
        )
    if isinstance(model, Distributed):
        return replace(model, client=client)
    if isinstance(model, Wrapped):
        return replace(model, model=on_cluster(model.model, client))
    return Distributed(model, client)


def key_of(method: str, model: ForwardModel, vector: np.ndarray) -> Key:
    """What is asked of a model, or of its first samples."""
    return method, len(model.coordinate.values), np.asarray(vector, dtype=float).tobytes()


def models_in(model: ForwardModel) -> Iterator[ForwardModel]:
    """Yield a model and those that it holds."""
    yield model
    for value in getattr(model, "__dict__", {}).values():
        for inner in value if isinstance(value, tuple) else (value,):
            if isinstance(inner, ForwardModel):
                yield from models_in(inner)


def rebuilt(model: ForwardModel, change: Callable[[ForwardModel], ForwardModel | None]) -> ForwardModel:
    """What a change makes of a model; else a copy with what it makes of the models that it holds.

    Without what it has computed of itself, addresses of compiled functions among it.
    """
    changed = change(model)
    if changed is not None:
        return changed
    copied = copy(model)
    for name, value in list(vars(copied).items()):
        if isinstance(getattr(type(copied), name, None), cached_property):
            del vars(copied)[name]
        elif isinstance(value, ForwardModel):
            object.__setattr__(copied, name, rebuilt(value, change))
        elif isinstance(value, tuple) and any(isinstance(inner, ForwardModel) for inner in value):
            several = tuple(rebuilt(inner, change) if isinstance(inner, ForwardModel) else inner for inner in value)
            object.__setattr__(copied, name, several)
    return copied


def bare(model: ForwardModel) -> ForwardModel:
    """A copy for one thread, of the models that it holds too, without what they have computed of themselves."""
    copied = rebuilt(model, lambda inner: None if inner is model else bare(inner))
    if hasattr(copied, "workers"):
        object.__setattr__(copied, "workers", 1)
    return copied


def _answered(model: Received, vectors: np.ndarray, sender: Sender) -> tuple[np.ndarray, tuple[str | None, ...]]:
    """Values and failures of a part of a batch, on a worker."""
    with sender.alike():
        responses = model.content.evaluate(vectors)
    return responses.values, responses.failures
