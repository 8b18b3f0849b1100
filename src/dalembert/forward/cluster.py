"""A Dask cluster: connecting to it, sending it work, and what is said where it fails."""

import hashlib
import sys
import sysconfig
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeAlias

from dalembert.errors import DalembertError, InputError, SolveError

if TYPE_CHECKING:
    from distributed import Client, Future

RETRIES = 5
"""Times that work is begun again where its worker is lost."""
WAIT = 10.0
"""Seconds until a cluster that does not answer is given up."""

Executor: TypeAlias = "str | Client | None"
"""Where ensembles are computed: at the address of a scheduler, by a client of Dask's, or in this process."""

_connected: "dict[str, Client]" = {}


def connected(executor: "str | Client") -> "Client":
    """A client, or that of the scheduler at an address: the same one as long as it is connected.

    Raises
    ------
    InputError
        Where Dask is not installed, or no scheduler answers.
    """
    if not isinstance(executor, str):
        return executor
    known = _connected.get(executor)
    if known is not None and known.status == "running":
        return known
    try:
        from distributed import Client
    except ImportError:
        raise InputError(
            "a cluster needs Dask, which is not installed; run: pip install 'dalembert[cluster]'"
        ) from None
    try:
        _connected[executor] = Client(executor, timeout=WAIT, set_as_default=False)
    except (OSError, ValueError) as error:
        raise InputError(
            f"no scheduler of Dask answers at {executor!r} within {WAIT:g} s ({error}); expected an address such as "
            "'tcp://10.0.0.1:8786', as 'dask scheduler' says it when it starts"
        ) from None
    return _connected[executor]


def sent(client: "Client", thing: Any) -> "Future":
    """A model or a function on the cluster; a worker that comes later, or in place of a lost one, gets it too.

    Raises
    ------
    InputError
        Where it holds what cannot leave this process.
    """
    import cloudpickle

    try:
        with _own_modules():
            content = cloudpickle.dumps(thing)
    except Exception as error:  # what cannot be sent, and why, is the user's to know
        raise InputError(
            f"the model cannot be sent to the cluster: {error}; a function of the model must not hold open files, "
            "locks or other things of this process"
        ) from error
    return client.submit(cloudpickle.loads, content, key=f"dalembert-{hashlib.sha256(content).hexdigest()}")


@contextmanager
def asked_of(client: "Client", asked: "Sequence[Future]", what: str) -> Iterator[None]:
    """Where answers are awaited: those that are no longer wanted are taken from the cluster, and losses are told."""
    try:
        yield
    except DalembertError:
        client.cancel(asked, force=True)
        raise
    except Exception as error:
        client.cancel(asked, force=True)
        raise SolveError(
            f"the cluster lost {what} ({type(error).__name__}: {error}); see its workers' logs, and resume the run"
        ) from error
    except BaseException:  # the user stops the run, or the rest is not asked for
        client.cancel(asked, force=True)
        raise


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
