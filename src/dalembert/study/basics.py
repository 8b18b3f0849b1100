"""What lists of studies need to know of study files, without an import of any task or kind."""

from functools import cache

from dalembert.study import schema_file

LARGEST = 10_000_000
"""Bytes of a study file; one of this size is some other file."""
SHARED = (
    "study", "constants", "parameters", "model", "solver", "harmonic_balance", "data", "bands", "experiments", "inputs",
    "sensors",
)  # fmt: skip
"""Tables that are no tasks."""
MODEL_FILE = ("model", "constants")
"""Tables of a file that ``[model] file = "..."`` names."""


@cache
def task_names() -> tuple[str, ...]:
    """Return the names of the tasks that there are, as the schema has them.

    >>> "identify" in task_names(), "model" in task_names()
    (True, False)
    """
    return tuple(name for name in schema_file.schema()["properties"] if name not in SHARED)
