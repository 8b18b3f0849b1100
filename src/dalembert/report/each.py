"""What a report is given once, or once for each experiment."""

from collections.abc import Iterator, Mapping
from typing import TypeVar

Given = TypeVar("Given")


def each(given: "Given | Mapping[str, Given] | None") -> dict[str, Given]:
    """By the name of the experiment; by no name where there is but one, and nothing where nothing is given.

    >>> each(None), each(3), each({"warm": 3, "cold": 4})
    ({}, {'': 3}, {'warm': 3, 'cold': 4})
    """
    if given is None:
        return {}
    return dict(given) if isinstance(given, Mapping) else {"": given}


def numbered(name: str, given: Mapping[str, Given]) -> Iterator[tuple[str, str, Given]]:
    """Name of a figure's place, name of the experiment, and what was given for it.

    >>> list(numbered("mechanism", {"": 3})), list(numbered("mechanism", {"warm": 3}))
    ([('mechanism', '', 3)], [('mechanism-1', 'warm', 3)])
    """
    for number, (experiment, one) in enumerate(given.items(), start=1):
        yield f"{name}-{number}" if experiment else name, experiment, one
