"""The base of formats of data files: a subclass is a format that `read` and study files can name."""

from abc import ABC, abstractmethod
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np

from dalembert.data.columns import Columns, Trial
from dalembert.data.text_layout import AUTO


@dataclass(frozen=True)
class Request:
    """What is to be read from a file.

    Parameters
    ----------
    time : str, int or None
        Column of the times; None where there is none, so that samples are numbered.
    names : tuple of str or int, optional
        Columns; all if not given.
    missing : {"refuse", "leave-out"}
        Whether a NaN is an error or a sample that was not measured.
    units : collection of str
        Columns whose unit is known, whatever the file states.
    separator, decimal : str
        Marks of a text file.
    trial : Trial, optional
        The one trial to read.
    absent : tuple of str
        What else stands for a value that was not measured.
    """

    time: str | int | None
    names: tuple[str | int, ...] | None = None
    missing: str = "refuse"
    units: Collection[str] = ()
    separator: str = AUTO
    decimal: str = AUTO
    trial: Trial | None = None
    absent: tuple[str, ...] = ()

    @property
    def along(self) -> str | None:
        """The column of the times by name."""
        return None if self.time is None else str(self.time)

    @property
    def labels(self) -> list[str] | None:
        """The columns by name."""
        return None if self.names is None else [str(name) for name in self.names]


class Format(ABC):
    """A format of data files. A subclass needs no other registration.

    Attributes
    ----------
    name : str
        Name in ``read(format=...)`` and in study files.
    suffixes : tuple of str
        Suffixes of its files, in lower case.
    compressed : bool
        Whether a file may also end in ``.gz``.
    trials : bool
        Whether a file may contain several trials.
    """

    name: ClassVar[str]
    suffixes: ClassVar[tuple[str, ...]]
    compressed: ClassVar[bool] = False
    trials: ClassVar[bool] = False

    @abstractmethod
    def columns(self, path: Path, request: Request) -> Columns:
        """Return times and columns of a file.

        `dalembert.data.columns.chosen` selects and checks them from arrays by name.

        Raises
        ------
        DataError
        """

    def all_columns(self, path: Path) -> dict[str, tuple[np.ndarray, str]]:
        """Return all columns of numbers of a file, with the unit that it names, before one is chosen as the times.

        By default those that lie along a column `t`, and that one.

        Raises
        ------
        DataError
        """
        content = self.columns(path, Request("t", None, "leave-out"))
        columns = {content.time: content.along, **content.table}
        return {name: (array, content.units.get(name, "")) for name, array in columns.items()}

    def trial_labels(self, path: Path, column: str | int, separator: str, decimal: str) -> list[str]:
        """Return the label of the trial of each sample; only formats with several trials in a file need it.

        Raises
        ------
        DataError
        """
        raise NotImplementedError
