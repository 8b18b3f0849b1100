"""Batches of a model on a Dask cluster."""

import hashlib
import sys
import sysconfig
from collections.abc import Iterator
from contextlib import contextmanager
from copy import copy
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from dalembert.errors import DalembertError, InputError, SolveError
from dalembert.forward.model import Channel, Coordinate, ForwardModel
from dalembert.forward.responses import Responses
from dalembert.parameters import Parameters

if TYPE_CHECKING:
    from distributed import Client

RETRIES = 5
"""Times that a part of a batch is begun again where its worker is lost."""
PARTS = 4
"""Parts of a batch a thread of the cluster: enough that few wait at the end, and each worth its message."""
WAIT = 10.0
"""Seconds until a cluster that does not answer is given up."""

_connected: "dict[str, Client]" = {}


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
        asked = self.client.map(_answered, [self._sent()] * len(parts), parts, pure=False, retries=RETRIES)
        try:
            answers: Any = self.client.gather(asked)
        except DalembertError:
            raise
        except KeyboardInterrupt:
            self.client.cancel(asked, force=True)
            raise
        except Exception as error:
            raise SolveError(
                f"the cluster lost a part of a batch of {len(vectors)} ({type(error).__name__}: {error}); see its "
                "workers' logs, and resume the run"
            ) from error
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

    def _sent(self) -> Any:
        """The model on the cluster; a worker that comes later, or in place of a lost one, gets it too."""
        import cloudpickle

        try:
            with _own_modules():
                content = cloudpickle.dumps(_bare(self.model))
        except Exception as error:  # what cannot be sent, and why, is the user's to know
            raise InputError(
                f"the model cannot be sent to the cluster: {error}; a function of the model must not hold open files, "
                "locks or other things of this process"
            ) from error
        key = f"dalembert-model-{hashlib.sha256(content).hexdigest()}"
        return self.client.submit(cloudpickle.loads, content, key=key)


Executor: TypeAlias = "str | Client | None"
"""Where batches are computed: at the address of a scheduler, by a client of Dask's, or in this process."""


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
    return Distributed(model, connected(executor) if isinstance(executor, str) else executor)


def connected(address: str) -> "Client":
    """A client of the scheduler at an address: the same one as long as it is connected."""
    known = _connected.get(address)
    if known is not None and known.status == "running":
        return known
    try:
        from distributed import Client
    except ImportError:
        raise InputError(
            "a cluster needs Dask, which is not installed; run: pip install 'dalembert[cluster]'"
        ) from None
    try:
        _connected[address] = Client(address, timeout=WAIT, set_as_default=False)
    except (OSError, ValueError) as error:
        raise InputError(
            f"no scheduler of Dask answers at {address!r} within {WAIT:g} s ({error}); expected an address such as "
            "'tcp://10.0.0.1:8786', as 'dask scheduler' says it when it starts"
        ) from None
    return _connected[address]


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


@contextmanager
def _own_modules() -> Iterator[None]:
    """Send modules of the user's whole: those that no package brought, and that a worker cannot import."""
    import cloudpickle

    installed = tuple(sysconfig.get_paths()[name] for name in ("stdlib", "platstdlib", "purelib", "platlib"))
    known = cloudpickle.list_registry_pickle_by_value()
    own = [
        module
        for name, module in list(sys.modules.items())
        if (file := getattr(module, "__file__", None))
        and not file.startswith(installed)
        and name.partition(".")[0] not in ("dalembert", "__main__")
        and name not in known
    ]
    for module in own:
        cloudpickle.register_pickle_by_value(module)
    try:
        yield
    finally:
        for module in own:
            cloudpickle.unregister_pickle_by_value(module)
