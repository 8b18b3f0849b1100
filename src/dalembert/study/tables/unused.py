"""Parameters of a study that nothing in its file names."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from dalembert.errors import listed
from dalembert.study.text.expressions import Expression
from dalembert.study.text.table import StudyTable

TABLES = ("constants", "model", "inputs", "sensors", "data", "bands", "experiments", "solver")
"""Tables whose numbers may name parameters."""

MOST = 4
"""Names in a sentence."""


def unused_parameters(file: Any) -> list[str]:
    """Return the parameters that no number of a study names; none where a Python function takes them."""
    if file.model.function is not None or file.model.forward is not None:
        return []
    known = {name for table in TABLES for name in _names(getattr(file, table, None))}
    return [name for name in file.parameters if name not in known]


def few(names: Sequence[str]) -> str:
    """Return names for a sentence; of many the first ones.

    >>> few(["a", "b"]), few([f"push_{k}" for k in range(1, 101)])
    ("'a' and 'b'", "'push_1', 'push_2', 'push_3', 'push_4' and 96 others")
    """
    if len(names) <= MOST + 1:
        return listed(list(map(repr, names)))
    return f"{', '.join(map(repr, names[:MOST]))} and {len(names) - MOST} others"


def _names(value: Any) -> Iterator[str]:
    if isinstance(value, Expression):
        yield from value.names
    elif isinstance(value, StudyTable):
        for name in type(value).model_fields:
            yield from _names(getattr(value, name))
    elif isinstance(value, Mapping):
        for entry in value.values():
            yield from _names(entry)
    elif isinstance(value, list | tuple):
        for entry in value:
            yield from _names(entry)
    elif hasattr(value, "__dataclass_fields__"):
        for name in value.__dataclass_fields__:
            yield from _names(getattr(value, name))
