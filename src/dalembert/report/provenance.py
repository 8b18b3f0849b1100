"""Where a result comes from, so that it can be made again."""

from collections.abc import Iterator, Mapping
from typing import Any

from dalembert.report.section import Block, Section, Source
from dalembert.report.table import Cell, Table

LONGEST = 200
"""Characters of a value that a page shows."""


def provenance(facts: Mapping[str, Any], study: str | None) -> list[Section]:
    """Version, seed, fingerprint of the model and settings of the method; the study as it was run, if there is one."""
    blocks: list[Block] = []
    if facts:
        flat = dict(_flat(facts))
        columns = {"what": flat, "value": [_shortened(_worded(value)) for value in flat.values()]}
        blocks.append(Table.of("provenance", "What made this result", columns))
    if study:
        blocks.append(Source("The study as it was run", study))
    return [Section("Provenance", blocks)] if blocks else []


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
