"""Batches of a model on a Dask cluster."""

from copy import copy
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from dalembert.forward.cluster import RETRIES, Executor, asked_of, connected, sent
from dalembert.forward.model import Channel, Coordinate, ForwardModel
from dalembert.forward.responses import Responses
from dalembert.parameters import Parameters

if TYPE_CHECKING:
    from distributed import Client

PARTS = 4
"""Parts of a batch a thread of the cluster: enough that few wait at the end, and each worth its message."""


@dataclass(frozen=True)
class Distributed:
    """A forward model whose batches are computed by a Dask cluster; single linearisations stay in this process.

    Parameters
    ----------
    model : ForwardModel
        It is sent to the workers, with the modules that no package brought; they need the same versions of the
        packages. Its answer to a vector must not depend on the others of a batch.
    client : distributed.Client

    Notes
    -----
    A worker computes one vector after another, on one thread, by the code that this process would run: between machines
    of one kind the answers are the same, bit for bit, wherever they are computed. A part whose worker is lost is
    computed by another one.
    """

    model: ForwardModel
    client: "Client" = field(repr=False)

    @property
    def parameters(self) -> Parameters:
        return self.model.parameters

    @property
    def channels(self) -> tuple[Channel, ...]:
        return self.model.channels

    @property
    def coordinate(self) -> Coordinate:
        return self.model.coordinate

    @property
    def fingerprint(self) -> str:
        return self.model.fingerprint

    def evaluate(self, vectors: np.ndarray) -> Responses:
        """Responses of a batch; ``vectors`` (batch, parameters), values (batch, samples, channels).

        Raises
        ------
        SolveError
            Where the cluster lost the batch, and why.
        """
        vectors = np.atleast_2d(np.asarray(vectors, dtype=float))
        if len(vectors) < 2:
            return self.model.evaluate(vectors)
        workers: Any = self.client.nthreads()
        threads = max(1, sum(workers.values()))
        parts = np.array_split(vectors, min(len(vectors), PARTS * threads))
        model = sent(self.client, _bare(self.model))
        asked = self.client.map(_answered, [model] * len(parts), parts, pure=False, retries=RETRIES)
        with asked_of(self.client, asked, f"a part of a batch of {len(vectors)}"):
            answers: Any = self.client.gather(asked)
        values = np.concatenate([own for own, _ in answers])
        return Responses(values, tuple(failure for _, own in answers for failure in own))

    def jacobian(self, vector: np.ndarray) -> np.ndarray:
        """Derivative of the response, (samples, channels, parameters)."""
        return self.model.jacobian(vector)

    def linearise(self, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Response (samples, channels) and its jacobian (samples, channels, parameters)."""
        return self.model.linearise(vector)

    def first(self, samples: int) -> "Distributed":
        """The same model, cut to its first ``samples`` samples."""
        return Distributed(self.model.first(samples), self.client)


def on_cluster(model: ForwardModel, executor: Executor) -> ForwardModel:
    """A model whose batches go to a Dask cluster.

    Parameters
    ----------
    model : ForwardModel
    executor : str or distributed.Client, optional
        Such as ``"tcp://10.0.0.1:8786"``, or a client of any of Dask's clusters; the model itself without one.

    Raises
    ------
    InputError
        Where Dask is not installed, or no scheduler answers.
    """
    if executor is None:
        return model
    return Distributed(model, connected(executor))


def _answered(model: ForwardModel, vectors: np.ndarray) -> tuple[np.ndarray, tuple[str | None, ...]]:
    """Values and failures of a part of a batch, on a worker."""
    found = model.evaluate(vectors)
    return found.values, found.failures


def _bare(model: ForwardModel) -> ForwardModel:
    """A copy for one thread, without what it has computed of itself, addresses of compiled functions among it."""
    own = copy(model)
    for name in [name for name in vars(own) if isinstance(getattr(type(own), name, None), cached_property)]:
        del vars(own)[name]
    if hasattr(own, "workers"):
        object.__setattr__(own, "workers", 1)
    return own
