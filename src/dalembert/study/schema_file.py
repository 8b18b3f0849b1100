"""The JSON schema of study files as a file beside them, by which editors complete and check keys.

The package contains the schema of its own kinds, `study.schema.json`. `make schema` writes it in some seconds, as this
imports all kinds.
"""

import json
from functools import cache
from importlib.metadata import entry_points
from importlib.resources import files
from pathlib import Path
from typing import Any

from dalembert.files import write_text
from dalembert.kinds import PLUGINS, TASKS

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
