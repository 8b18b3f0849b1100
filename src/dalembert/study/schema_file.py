"""The JSON schema of study files as a file, which needs no import of tasks and kinds.

The package contains the schema of the built-in kinds, `study.schema.json`. `make schema` writes it in some seconds, as
this imports all kinds.
"""

import json
from functools import cache
from importlib.metadata import entry_points
from importlib.resources import files
from pathlib import Path
from typing import Any

from dalembert.files import write_text
from dalembert.kinds import PLUGINS, TASKS

LARGEST = 10_000_000
"""Bytes of a study file; one of this size is some other file."""
SHARED = (
    "study", "constants", "parameters", "model", "solver", "harmonic_balance", "data", "bands", "experiments", "inputs",
    "sensors",
)  # fmt: skip
"""Tables that are no tasks."""
MODEL_FILE = ("model", "constants")
"""Tables of a file that ``[model] file = "..."`` names."""
NAME = "study.schema.json"
LINE = f"#:schema ./{NAME}"
"""First line of a study with its schema beside it; the TOML extensions of VS Code and other editors read it."""


@cache
def text() -> str:
    """Return the JSON schema of study files; one with the kinds and tasks of other packages, if these have any."""
    if any(entry_points(group=group) for group in (PLUGINS, TASKS)):
        from dalembert.study.schema import schema_text

        return schema_text()
    return (files("dalembert.study") / NAME).read_text(encoding="utf-8")


@cache
def schema() -> dict[str, Any]:
    """Return what :func:`text` holds."""
    return json.loads(text())


def write(folder: Path) -> Path:
    """Write the schema into the folder of a study, and return its path."""
    path = folder / NAME
    write_text(path, text())
    return path


@cache
def task_names() -> tuple[str, ...]:
    """Return the names of the tasks that there are, as the schema has them.
    >>> "identify" in task_names(), "model" in task_names()
    (True, False)
    """
    return tuple(name for name in schema()["properties"] if name not in SHARED)
