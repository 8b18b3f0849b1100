"""What the validators of a study file know beside the value before them."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from dalembert.unit_table import Unit


@dataclass
class Context:
    """Surroundings of a study file while it is read.

    Parameters
    ----------
    folder : Path
        Files named in the study are relative to it.
    names : mapping of str to Unit or None
        Parameters and constants, which an expression may use, with the units that they have.
    series : mapping of str to tuple of str
        Names of the parameters of each series, which a list of numbers may name as a whole.
    files : mapping of str to Path
        Where a file named in the study lies if not relative to the folder: a run folder keeps copies.
    used : dict of str to Path
        Files that were asked for.
    """

    folder: Path = field(default_factory=Path)
    names: Mapping[str, Unit | None] = field(default_factory=dict)
    series: dict[str, tuple[str, ...]] = field(default_factory=dict)
    files: dict[str, Path] = field(default_factory=dict)
    used: dict[str, Path] = field(default_factory=dict)
    _keys: dict[int, tuple[str, ...]] = field(default_factory=dict)

    def file(self, given: str) -> Path:
        """Path of a file named in the study."""
        path = self.files.get(given, self.folder / given)
        self.used[given] = path
        return path

    def remember(self, table: Any, keys: Iterable[str]) -> None:
        """Keep the keys that a table of the document may have, for the error about one that it may not."""
        self._keys[id(table)] = tuple(keys)

    def known_keys(self, table: Any) -> tuple[str, ...]:
        """Keys that a table of the document may have; none if it was never read as a table."""
        return self._keys.get(id(table), ())
