"""How processes that compute for the studio begin.

On Linux they are forked from one process that has imported the package already, so that they answer at once and share
its memory. It computes nothing and ends with the studio.
"""

import multiprocessing
import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from multiprocessing.context import ForkServerContext, SpawnContext

READY = "dalembert.studio.preloaded"
"""What is imported ahead."""


def context() -> "ForkServerContext | SpawnContext":
    """Return how processes begin here."""
    if sys.platform != "linux":  # macOS: forked processes must not use its libraries for linear algebra
        return multiprocessing.get_context("spawn")
    result = multiprocessing.get_context("forkserver")
    result.set_forkserver_preload([READY])
    return result


def prepare() -> None:
    """Start the process that the others are forked from; its imports take a second or two, in the background."""
    if sys.platform == "linux":
        from multiprocessing import forkserver

        context()
        forkserver.ensure_running()
