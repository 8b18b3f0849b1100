"""The tables of a study file that name data: measurements, and bounds of them."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field, PlainValidator, ValidationInfo, WithJsonSchema

from dalembert.study.context import Context
from dalembert.study.numbers import fixed
from dalembert.study.table import Read, StudyTable, problem

if TYPE_CHECKING:
    from dalembert.data import Bands, Measurements


def _read_file(value: Any, info: ValidationInfo) -> Path:
    if not isinstance(value, str):
        raise problem(f"{value!r} was given; expected the name of a file, such as 'motion.csv'")
    context = info.context if isinstance(info.context, Context) else Context()
    path = context.file(value)
    if not path.is_file():
        raise problem(f"{value!r} was given, but there is no file {path}")
    return path


DataFile = Annotated[Path, PlainValidator(_read_file), WithJsonSchema({"type": "string"})]


class CsvTable(StudyTable):
    """A CSV file and its column of times."""

    file: DataFile = Field(description="relative to the study file")
    time: str = Field("t", description="name of the column of times, in s")
    separator: str = Field(",", min_length=1, max_length=1)


class DataTable(CsvTable):
    """Measured data: a CSV file, its column of times, and the column of each channel."""

    columns: dict[str, str] = Field(min_length=1, description="column of each channel: 'AB.end.x' = 'case1_x'")
    deviations: dict[str, Annotated[float, Read(fixed(None))]] | None = Field(
        None, description="standard deviation of each channel's noise"
    )

    def read(self) -> "Measurements":
        """The data."""
        from dalembert.data import read_csv

        return read_csv(self.file, self.time, self.columns, self.deviations, separator=self.separator)


class BandsTable(CsvTable):
    """Bounds of channels: a CSV file, its column of times, and two columns of each channel."""

    columns: dict[str, Annotated[list[str], Field(min_length=2, max_length=2)]] = Field(
        min_length=1, description="columns of each channel, the lower bounds first: 'AB.end.x' = ['x_lower', 'x_upper']"
    )

    def read(self) -> "Bands":
        """The bands."""
        from dalembert.data import read_bands

        columns = {name: (lower, upper) for name, (lower, upper) in self.columns.items()}
        return read_bands(self.file, self.time, columns, separator=self.separator)
