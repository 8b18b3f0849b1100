"""Where a result comes from, so that it can be made again."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from dalembert.report.sections.section import Section
from dalembert.report.table import Cell, Table, cell

LONGEST = 200
"""Characters of a value that a page shows."""


@dataclass(frozen=True)
class Provenance(Section):
    """Version, seed, fingerprint of the model and settings of the method; the study as it was run, if there is one."""

    name: ClassVar[str] = "provenance"
    heading: ClassVar[str] = "Provenance"
    facts: Mapping[str, Any]
    study: str | None = None

    @property
    def table(self) -> Table:
        rows = [(cell(key), _shortened(_worded(value))) for key, value in _flat(self.facts)]
        return Table("provenance", "What made this result", ("what", "value"), rows)


def _worded(value: Any) -> str:
    """A setting as people write it.

    >>> _worded(True), _worded(None), _worded(["low", "high"]), _worded([0.08, 0.32]), _worded(1e-10)
    ('yes', 'none', 'low, high', '0.08, 0.32', '1e-10')
    """
    if isinstance(value, list | tuple):
        return ", ".join(map(_worded, value))
    return {True: "yes", False: "no", None: "none"}[value] if value is None or isinstance(value, bool) else str(value)


def _shortened(text: str) -> Cell:
    """Cell of a text, its end left out of the page where it is long, but not of the CSV."""
    return Cell(text, text if len(text) <= LONGEST else f"{text[:LONGEST]} …")


def _flat(facts: Mapping[str, Any], above: str = "") -> Iterator[tuple[str, Any]]:
    """Entries of nested mappings, named by their path."""
    for key, value in facts.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{above}{key}.")
        else:
            yield f"{above}{key}", value
