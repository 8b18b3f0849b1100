"""One function of several things that do not depend on each other: over this machine's cores, or on a Dask cluster."""

from collections.abc import Callable, Generator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

from dalembert.forward.builders import cores
from dalembert.forward.cluster import RETRIES, Executor, Received, Sender, connected, futures_of, sent

Item = TypeVar("Item")
Answer = TypeVar("Answer")


def ensemble(
    work: Callable[[Item], Answer],
    items: Sequence[Item],
    *,
    workers: int | None = None,
    executor: Executor = None,
    on_stop: Callable[[], Any] | None = None,
) -> Generator[Answer, None, None]:
    """``work(item)`` of each item, in their order, each as soon as it and those before it are there.

    Parameters
    ----------
    work : callable
        It is called from several threads, or sent to a cluster.
    items : sequence
    workers : int, optional
        Threads; as many as there are cores if not given.
    executor : str or distributed.Client, optional
        A cluster in place of threads. What a worker computed that is lost is computed by another one.
    on_stop : callable, optional
        Called where the rest is no longer wanted, before threads that are still at work are waited for.

    Examples
    --------
    >>> list(ensemble(abs, [-3, 4], workers=2))
    [3, 4]
    """
    with connected(executor) as client:
        if client is not None:
            with futures_of(client, f"a part of an ensemble of {len(items)}") as futures:
                futures += client.map(
                    _done, [sent(client, work)] * len(items), items, sender=Sender(), pure=False, retries=RETRIES
                )
                for future in futures:
                    yield future.result()
            return
    workers = min(workers or cores(), len(items))
    if workers < 2:
        yield from map(work, items)
        return
    pool = ThreadPoolExecutor(workers)
    try:
        yield from pool.map(work, items)
    except BaseException:
        if on_stop is not None:
            on_stop()
        raise
    finally:
        pool.shutdown(cancel_futures=True)


def _done(work: Received, item: Any, sender: Sender) -> Any:
    with sender.alike():
        return work.content(item)
