"""What the results of this package have in common: they can be kept, drawn and reported."""

from abc import ABC, abstractmethod
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Self

from dalembert.files import read_dataset, write_dataset
from dalembert.hooks import hook

if TYPE_CHECKING:
    from xarray import Dataset


class Result(ABC):
    """A result that can be written to a file, drawn, and reported."""

    FORMAT: ClassVar[str]

    @abstractmethod
    def to_xarray(self) -> "Dataset":
        """Everything as an :class:`xarray.Dataset`."""

    @classmethod
    @abstractmethod
    def from_xarray(cls, dataset: "Dataset") -> Self:
        """The result that :meth:`to_xarray` turned into a dataset."""

    def save(self, path: str | Path) -> None:
        """Write everything to a NetCDF-4 file, whole or not at all; :meth:`load` gives back the same bits."""
        write_dataset(path, self.to_xarray())

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """A result that was saved.

        Raises
        ------
        DataError
            For a file that is not there, or holds something else.
        """
        return cls.from_xarray(read_dataset(path, form=cls.FORMAT, expected=f"a result written by {cls.__name__}.save"))

    def figures(self, **options: Any) -> dict[str, Any]:
        """Plotly figures by name; options as those of :func:`dalembert.report.figures`."""
        return hook("figures")(self, **options)

    def report(self, path: str | Path, **options: Any) -> Any:
        """Write an HTML report that opens offline; options as those of :func:`dalembert.report.report`."""
        return hook("report")(self, path, **options)
