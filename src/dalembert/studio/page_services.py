"""What the panels of a study's page share besides the draft."""

from dataclasses import dataclass

from dalembert.studio.jobs import Jobs
from dalembert.studio.worker import Worker
from dalembert.studio.workspace import Workspace


@dataclass(frozen=True)
class PageServices:
    """Where the page of a study lives. ``jobs`` are the runs that this studio started. ``worker`` computes for this
    page, in a process that ends with it.
    """

    workspace: Workspace
    jobs: Jobs
    worker: Worker
