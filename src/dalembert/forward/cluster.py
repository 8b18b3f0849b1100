"""A Dask cluster: connecting to it, sending it work, and what is said where it fails.

A connection belongs to the call that makes it, and ends with it.
"""

import pickle
import sys
import sysconfig
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import wraps
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar, cast

from dalembert.errors import ClusterError, DalembertError, InputError, shown
from dalembert.threads import threads, with_threads
from dalembert.versions import difference, versions

if TYPE_CHECKING:
    from distributed import Client, Future

RETRIES = 5  # times that work is begun again where its worker is lost
# Topic of the scheduler's log by which workers say that they have other versions of packages than their sender.
VERSIONS = "dalembert-versions"
WAIT = 10.0  # seconds until a cluster that does not answer is given up
Executor: TypeAlias = "str | Client | None"
"""Where ensembles are computed: at the address of a scheduler, by a client of Dask's, or in this process."""

M = TypeVar("M", bound=Callable[..., Any])


@contextmanager
def connected(executor: Executor) -> Iterator["Client | None"]:
    """A client of the scheduler at an address, closed at the end; an existing client is not closed.

    Raises
    ------
    InputError
        Where Dask is not installed, or no scheduler answers.
    """
    if not isinstance(executor, str):
        if executor is not None and not hasattr(executor, "submit"):
            raise InputError(f"executor is {shown(executor)}; expected the address of a Dask cluster, or its client")
        yield executor
        return
    try:
        from distributed import Client
    except ImportError:
        raise InputError(
            "a cluster needs Dask, which is not installed; run: pip install 'dalembert[cluster]'"
        ) from None
    try:
        client = Client(executor, timeout=WAIT, set_as_default=False)
    except (OSError, ValueError) as error:
        raise InputError(
            f"no scheduler of Dask answers at {executor!r} within {WAIT:g} s ({error}); expected an address such as "
            "'tcp://10.0.0.1:8786', as 'dask scheduler' says it when it starts"
        ) from None
    with client:
        yield client


def takes_executor(method: M) -> M:
    """A method that is given a client for its ``executor``, connected as long as it runs.

    A worker with another dalembert is refused; one with other packages is a warning.
    """

    @wraps(method)
    def with_client(*args: Any, executor: Executor = None, **settings: Any) -> Any:
        with connected(executor) as client, noted(client, _warn_of):
            return method(*args, executor=client, **settings)

    return cast(M, with_client)


def _warn_of(worker: Mapping[str, str]) -> None:
    local = versions()
    differing = [f"{name} {version}, not {local[name]}" for name, version in worker.items() if version != local[name]]
    warnings.warn(
        f"a worker of the cluster has {' and '.join(differing)} as here: the last digits of the result may differ. "
        "Install one version on all machines",
        RuntimeWarning,
        stacklevel=3,
    )


def packed(thing: Any) -> bytes:
    """A model or a function as it is sent to a cluster; ``pickle.loads`` makes it anew."""
    import cloudpickle

    try:
        with _user_modules():
            return cloudpickle.dumps(thing)
    except Exception as error:  # what cannot be sent, and why, is the user's to know
        raise InputError(
            f"the model cannot be sent to the cluster: {error}; a function of the model must not hold open files, "
            "locks or other things of this process"
        ) from error


def sent(client: "Client", thing: Any) -> "Future":
    """A model or a function on the cluster; a worker that comes later, or in place of a lost one, gets it too."""
    # Each time under a name of its own: one that is asked for again while the scheduler lets go of it may never come.
    return client.submit(_received, packed(thing), Sender(), pure=False)


@dataclass(frozen=True)
class Sender:
    """What a worker must have in common with the process that sends it work, for the same bits."""

    versions: dict[str, str] = field(default_factory=versions)
    threads: int = field(default_factory=threads)

    @contextmanager
    def alike(self) -> Iterator[None]:
        """A block on a worker that computes as the sender does; the scheduler's log says if it has other packages."""
        local = versions()
        _refuse_other(local, self.versions)
        if local != self.versions:
            from distributed import get_worker

            get_worker().log_event(VERSIONS, local)
        with with_threads(self.threads):
            yield


def _refuse_other(worker: dict[str, str], process: dict[str, str]) -> None:
    if differing := difference(worker, process):
        raise ClusterError(
            f"a worker of the cluster has {differing} as here. Install the same version on all machines, and start the "
            "workers again"
        )


class Received:
    """A model or a function on a worker.

    It is sent to another worker as the bytes that were received. A model in use cannot be pickled: its caches change.
    """

    def __init__(self, packed_content: bytes) -> None:
        self._packed, self.content = packed_content, pickle.loads(packed_content)

    def __reduce__(self) -> tuple[type, tuple[bytes]]:
        return Received, (self._packed,)


def _received(content: bytes, sender: Sender) -> Received:
    with sender.alike():
        return Received(content)


def worker_versions(client: "Client") -> list[dict[str, str]]:
    """Return the different versions that the workers of a cluster have."""
    answers: Any = client.run(versions, on_error="return")
    different: list[dict[str, str]] = []
    for answer in answers.values():
        _refuse_other(answer if isinstance(answer, dict) else {"dalembert": "of unknown version"}, versions())
        if answer not in different:
            different.append(answer)
    return different


@contextmanager
def noted(client: "Client | None", note: Callable[[Mapping[str, str]], None]) -> Iterator[None]:
    """A block at whose end the versions of each worker that computed with other packages are noted.

    Also of workers that came later, in place of a lost one, or that are lost themselves.
    """
    if client is None:
        yield
        return
    before = len(_logged(client))
    try:
        yield
    finally:
        notes: list[Mapping[str, str]] = []
        with suppress(Exception):  # the cluster may be gone; what ended the block says so
            for versions_of_worker in _logged(client)[before:]:
                if versions_of_worker not in notes:
                    notes.append(versions_of_worker)
        for versions_of_worker in notes:
            note(versions_of_worker)


def _logged(client: "Client") -> list[Mapping[str, str]]:
    events: Any = client.get_events(VERSIONS)  # with the address of the worker beside the versions
    return [{name: entry[name] for name in versions()} for _, entry in events]


@contextmanager
def futures_of(client: "Client", what: str) -> Iterator["list[Future]"]:
    """A list for futures: those no longer needed are cancelled, and lost ones are reported."""
    futures: list[Future] = []
    try:
        yield futures
    except BaseException as error:  # that the user stops the run, or does not ask for the rest, too
        with suppress(Exception):  # the cluster may be gone
            client.cancel(futures, force=True)
        if isinstance(error, DalembertError) or not isinstance(error, Exception):
            raise
        raise ClusterError(
            f"the cluster lost {what} ({type(error).__name__}: {error}); see its workers' logs, and resume the run"
        ) from error


@contextmanager
def _user_modules() -> Iterator[None]:
    """Send modules of the user's whole: those that no package brought, and that a worker cannot import."""
    import cloudpickle

    installed = tuple(sysconfig.get_paths()[name] for name in ("stdlib", "platstdlib", "purelib", "platlib"))
    known = cloudpickle.list_registry_pickle_by_value()
    modules = [
        module
        for name, module in list(sys.modules.items())
        if (file := getattr(module, "__file__", None))
        and not file.startswith(installed)
        and name.partition(".")[0] not in ("dalembert", "__main__")
        and name not in known
    ]
    for module in modules:
        cloudpickle.register_pickle_by_value(module)
    try:
        yield
    finally:
        for module in modules:
            cloudpickle.unregister_pickle_by_value(module)
