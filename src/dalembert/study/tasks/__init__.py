"""The tasks that a study file can ask for, by the names of their tables."""

from typing import cast

from dalembert import kinds
from dalembert.study.tasks.task import Outcome, Task

_KINDS = cast("dict[str, type[Task]]", kinds.named(__name__, Task, plugins=kinds.TASKS))
TASKS: dict[str, Task] = {name: _KINDS[name]() for name in sorted(_KINDS, key=lambda name: (_KINDS[name].rank, name))}

__all__ = ["TASKS", "Outcome", "Task"]
