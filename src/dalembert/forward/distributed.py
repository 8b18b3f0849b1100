"""Batches of a model on a Dask cluster."""

from copy import copy
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from dalembert.errors import InputError
from dalembert.forward.cluster import RETRIES, Executor, asked_of, sent
from dalembert.forward.model import ForwardModel
from dalembert.forward.responses import Responses
from dalembert.forward.wrapped import Wrapped

if TYPE_CHECKING:
    from distributed import Client

PARTS = 4
"""Parts of a batch a thread of the cluster: enough that few wait at the end, and each worth its message."""


@dataclass(frozen=True)
class Distributed(Wrapped):
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

    client: "Client" = field(repr=False)

    def evaluate(self, vectors: np.ndarray) -> Responses:
        """Responses of a batch; ``vectors`` (batch, parameters), values (batch, samples, channels).

        Raises
        ------
        SolveError
            Where the cluster lost the batch, and why.
        """
        from distributed import as_completed

        vectors = np.atleast_2d(np.asarray(vectors, dtype=float))
        if len(vectors) < 2:
            return self.model.evaluate(vectors)
        with asked_of(self.client, f"a part of a batch of {len(vectors)}") as asked:
            workers: Any = self.client.nthreads()
            parts = np.array_split(vectors, min(len(vectors), PARTS * max(1, sum(workers.values()))))
            model = sent(self.client, _bare(self.model))
            asked += self.client.map(_answered, [model] * len(parts), parts, pure=False, retries=RETRIES)
            for part in as_completed(asked, loop=self.client.loop):  # gather would complain of each that is cancelled
                if part.status != "finished":
                    part.result()  # raises what became of it
            answers: Any = self.client.gather(asked)
        values, failures = zip(*answers, strict=True)
        return Responses(np.concatenate(values), tuple(chain.from_iterable(failures)))


def on_cluster(model: ForwardModel, client: Executor) -> ForwardModel:
    """A model whose batches go to a Dask cluster; of a recorded one, those that are not known yet.

    Parameters
    ----------
    model : ForwardModel
    client : distributed.Client, optional
        Of any of Dask's clusters; without one the model stays as it is.

    Raises
    ------
    InputError
        For an address: who connects is to disconnect, too.
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


def _answered(model: ForwardModel, vectors: np.ndarray) -> tuple[np.ndarray, tuple[str | None, ...]]:
    """Values and failures of a part of a batch, on a worker."""
    found = model.evaluate(vectors)
    return found.values, found.failures


def _bare(model: ForwardModel) -> ForwardModel:
    """A copy for one thread, without what it has computed of itself, addresses of compiled functions among it.

    The same of a model that it holds.
    """
    own = copy(model)
    for name, held in list(vars(own).items()):
        if isinstance(getattr(type(own), name, None), cached_property):
            del vars(own)[name]
        elif isinstance(held, ForwardModel):
            object.__setattr__(own, name, _bare(held))
    if hasattr(own, "workers"):
        object.__setattr__(own, "workers", 1)
    return own
