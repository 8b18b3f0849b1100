"""The tables of a study file that name data: measurements, and bounds of them."""

from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from pydantic import (
    AfterValidator,
    Discriminator,
    Field,
    PlainValidator,
    Tag,
    ValidationInfo,
    ValidatorFunctionWrapHandler,
    WithJsonSchema,
    WrapValidator,
)

from dalembert.arguments import is_integer
from dalembert.data.known_formats import known_formats
from dalembert.data.record import FIRST, beginning
from dalembert.errors import repeated, unknown
from dalembert.forward import Sensor
from dalembert.forward.sensors import START
from dalembert.parameter import Parameter
from dalembert.study.tables.sensor_table import SensorTable, reads
from dalembert.study.text.numbers import Number, Samples, Seconds, fixed, pair, read_number
from dalembert.study.text.table import Context, Read, StudyTable, alternative, checked, problem

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


Format = Annotated[str, Read(Literal[tuple(known_formats())])]  # pyright: ignore[reportInvalidTypeForm]


def is_universal(file: Path, form: str | None) -> bool:
    """Whether a file is a universal one, by the format that is given or else its suffix."""
    return form == "uff" or (form is None and file.suffix.lower() in known_formats()["uff"].suffixes)


def _read_column(value: Any) -> str | int:
    if isinstance(value, str) or (is_integer(value) and value >= 1):
        return value
    raise problem(f"{value!r} was given; expected the name of a column in quotes, or its number from 1")


Column = Annotated[
    str | int,
    PlainValidator(_read_column),
    WithJsonSchema({"anyOf": [{"type": "string"}, {"type": "integer", "minimum": 1}]}),
]


Missing = Literal["refuse", "leave-out"] | list[str | float]
MISSING: Any = Field(
    "refuse",
    description="what becomes of values that are not there: 'refuse', 'leave-out', or a list of words and numbers that "
    "stand for such values, besides empty cells, NaN, N/A, - and null, and are left out",
)


class FileTable(StudyTable):
    """A file of columns: text, JSON, MAT, NetCDF, a workbook, or another known format."""

    file: DataFile = Field(description="relative to the study file")
    format: Format | None = Field(None, description="by the suffix of the file if not given")
    time: Column = Field("t", description="column of times, by its name, or its number from 1 in a text file")
    frequency: str | None = Field(
        None, description="name of the column of frequencies, where the samples lie along one"
    )
    sampling: Annotated[float, Read(fixed("Hz"))] | None = Field(
        None, gt=0, description="samples a second of a file without a column of times: '200 Hz'"
    )
    units: dict[str, str] = Field({}, description="unit of each column that is not in SI units: case1_x = 'mm'")
    separator: str = Field(
        "auto", description="of the cells of a text file, a blank for any number; found from its lines if 'auto'"
    )
    decimal: Literal["auto", ".", ","] = Field(
        "auto", description="what stands before the decimals of a text file's numbers; found from its lines if 'auto'"
    )

    def _wrong(self) -> list[str]:
        if self.sampling is not None and {"time", "frequency"} & self.model_fields_set:
            return ["sampling is given, and a column of times or frequencies, too; leave one of them out"]
        return []

    @property
    def how(self) -> dict[str, Any]:
        """Arguments that say how the file is read."""
        arguments = self.picked("format", "units", "separator", "decimal")
        return arguments | {
            key: value for key, value in self.picked("frequency", "sampling").items() if value is not None
        }

    @property
    def universal(self) -> bool:
        """Whether the file is a universal one, which says itself what its samples lie along."""
        return is_universal(self.file, self.format)


class DerivativeTable(StudyTable):
    """A channel that is the derivative of another."""

    of: str = Field(description="the channel that it is the derivative of")
    order: int = Field(1, ge=1)
    window: int | None = Field(None, ge=3, description="samples of each polynomial; of the least error if not given")
    degree: int = Field(3, ge=1, description="of the polynomials")


_Name = Annotated[str, AfterValidator(lambda name: DerivativeTable.model_validate({"of": name}))]
Differentiated = alternative(lambda value: isinstance(value, str), _Name, DerivativeTable)


def _along(value: Any, handler: ValidatorFunctionWrapHandler, info: ValidationInfo) -> Any:
    """Numbers along the samples: frequencies if the file has a column of them, else times; a universal file either."""
    data = info.data
    if not ("file" in data and "format" in data and is_universal(data["file"], data["format"])):
        numbers = [entry for key, entry in value.items() if key != "count"] if isinstance(value, dict) else value
        for entry in numbers if isinstance(numbers, list) else ():
            checked(read_number, entry, "s" if data.get("frequency") is None else "Hz")
    return handler(value)


Ends = Annotated[list[float], Read(pair(Number))] | None


class StartTable(StudyTable):
    """A time of the file at which the motion begins that is not known: its bounds, and optionally a first guess."""

    lower: Seconds
    upper: Seconds
    start: Seconds | None = None

    def _wrong(self) -> list[str]:
        checked(lambda: self.parameter)
        return []

    @property
    def parameter(self) -> Parameter:
        """The parameter that is identified."""
        return Parameter(START, self.lower, self.upper, "s", start=self.start)


Start = Annotated[
    Annotated[StartTable, Tag("table")]
    | Annotated[Literal["first"], Tag("word")]
    | Annotated[float, Read(fixed("s")), Tag("number")],
    Discriminator(lambda value: "table" if isinstance(value, dict) else "word" if value == FIRST else "number"),
]


class ChannelFile(FileTable):
    """A file of channels, with their deviations."""

    columns: dict[str, Column] = Field(
        min_length=1,
        description="column of each channel: 'AB.end.x' = 'case1_x', or its number from 1 in a text file",
    )
    deviations: dict[str, Number] | None = Field(None, description="standard deviation of each channel's noise")
    missing: Missing = MISSING
    wraps: list[str] = Field([], description="channels that are angles known up to whole turns")
    lowpass: Annotated[float, Read(fixed("Hz"))] | None = Field(
        None, description="cutoff frequency of a low-pass filter without delay: '40 Hz'"
    )
    decimate: int | None = Field(None, ge=2, description="keep every n-th sample after the low-pass filter")

    def of_file(self, **options: Any) -> "Measurements":
        """The channels of the file, filtered and decimated."""
        from dalembert.data import read
        from dalembert.data.opening import errors_with_file

        deviations = self.deviations
        known = None if deviations is None else {name: deviations[name] for name in self.columns if name in deviations}
        options |= {"missing": self.missing, "wraps": self.wraps, **self.how}
        data = read(self.file, self.time, self.columns, known, **options)
        with errors_with_file(self.file):
            if self.decimate is not None:
                return data.decimated(self.decimate, self.lowpass)
            return data if self.lowpass is None or self._filters_later(data) else data.filtered(self.lowpass)

    def _filters_later(self, data: "Measurements") -> bool:
        return False


class DataTable(ChannelFile):
    """Measured data: a file, its column of times, the column of each channel, and what becomes of them."""

    SEVERAL: ClassVar[bool] = False  # whether one table may stand for all trials of a file

    start: Annotated[Any, Read(Start)] = Field(
        None,
        description="time of the file at which the motion begins: a number, 'first' for that of the first sample, or "
        "bounds if it is not known",
    )
    split: Column | None = Field(None, description="column that numbers the trials in the file")
    trial: str | float | None = Field(None, description="the trial that is read, of those that split numbers")
    more: list[ChannelFile] = Field([], description="further files of the same experiment, with other time stamps")
    derivatives: dict[str, Annotated[DerivativeTable, Read(Differentiated)]] = Field(
        {}, description="channels that are derivatives of others: 'crank.rate' = 'crank.angle'"
    )
    between: Annotated[Ends, WrapValidator(_along)] = Field(
        None, description="times, or frequencies, between which samples are kept"
    )
    gap: Number | None = Field(
        None,
        gt=0,
        description="longest step of the times, or frequencies, that is no gap to derivatives and resample; 1.5 times "
        "the usual one if not given",
    )
    every: int | None = Field(None, ge=1, description="keep every n-th sample, without a filter")
    resample: Annotated[Samples | None, WrapValidator(_along)] = Field(
        None, description="times, or frequencies, at which splines through the samples are taken"
    )

    def _wrong(self) -> list[str]:
        wrong = super()._wrong() + [
            unknown("channel", name, file.columns, "wraps")
            for file in (self, *self.more)
            for name in file.wraps
            if name not in file.columns
        ]
        if self.trial is not None and self.split is None:
            wrong.append("trial is given, but not split, the column that numbers the trials; give both")
        if self.split is not None and self.trial is None and not self.SEVERAL:
            wrong.append("split is given without trial; give the trial that is read, or use [[experiments]] for all")
        for file in (self, *self.more):
            wrong += [
                f"columns: {column!r} is given for {count} channels; expected one channel for a column"
                for column, count in repeated(map(str, file.columns.values())).items()
            ]
        names = [name for file in (self, *self.more) for name in file.columns]
        if several := repeated(names):
            wrong.append(f"more: {', '.join(several)} has a column in several files; expected one for each channel")
        for name, derivative in self.derivatives.items():
            if name in names:
                wrong.append(f"derivatives: the channel {name!r} has a column already; expected another name")
            if derivative.of not in names:
                wrong.append(unknown("channel", derivative.of, names, f"derivatives, {name!r}"))
        if self.more and self.every is not None:
            wrong.append("every is given with more; give decimate for each file, whose time stamps differ")
        thinned = [name for name in ("decimate", "every", "resample") if getattr(self, name) is not None]
        wrong += [f"{key} and {other} are both given; expected one of them" for key, other in pairwise(thinned)]
        return wrong

    @property
    def channels(self) -> tuple[str, ...]:
        """Channels that the data have."""
        return (*(name for file in (self, *self.more) for name in file.columns), *self.derivatives)

    def sensors(self, shared: Mapping[str, SensorTable]) -> dict[str, Sensor]:
        """The sensors of its channels."""
        return {name: table.sensor for name, table in shared.items() if reads(name, self.channels)}

    def read(self) -> "Measurements":
        """The data."""
        from dalembert.data import merged
        from dalembert.data.opening import errors_with_file

        deviations, trial = self.deviations, None if self.split is None else (self.split, self.trial)
        data = self.of_file(trial=trial)
        begin = 0.0 if self.begins is None else beginning(data.coordinate.values, self.begins)
        parts = [data.since(begin), *(file.of_file(start=begin) for file in self.more)]
        with errors_with_file(self.file):
            data = merged(parts)
            for name, table in self.derivatives.items():
                how = {"order": table.order, "window": table.window, "degree": table.degree, "gap": self.gap}
                data = data.with_derivative(table.of, name, **how, deviation=(deviations or {}).get(name))
            if self.between is not None:
                data = data.between(*self.between)
            if self.every is not None:
                data = data.every(self.every)
            if self.resample is None:
                return data
            later = self.lowpass is not None and self._filters_later(data)
            data = data.resampled(self.resample, gap=self.gap)
            return data.filtered(self.lowpass) if later and self.lowpass is not None else data

    def _filters_later(self, data: "Measurements") -> bool:
        from dalembert.data.filtering import is_even

        return self.resample is not None and not self.more and not is_even(data)

    @property
    def begins(self) -> float | str | None:
        """Time of the file at which the motion begins, where it is known."""
        return None if isinstance(self.start, StartTable) else self.start

    @property
    def unknown_start(self) -> Parameter | None:
        """Time of the file at which the motion begins, where it is to be identified."""
        return self.start.parameter if isinstance(self.start, StartTable) else None

    def labels(self) -> list[str]:
        """Labels of the trials in the file."""
        from dalembert.data.known_formats import trial_labels

        assert self.split is not None
        return trial_labels(self.file, self.split, separator=self.separator, decimal=self.decimal, format=self.format)


class BandsTable(FileTable):
    """Bounds of channels: a file, its column of times, and two columns of each channel."""

    columns: dict[str, Annotated[list[str], Read(pair(str))]] = Field(
        min_length=1, description="columns of each channel, the lower bounds first: 'AB.end.x' = ['x_lower', 'x_upper']"
    )

    def read(self) -> "Bands":
        """The bands."""
        from dalembert.data import read_bands

        columns = {name: (lower, upper) for name, (lower, upper) in self.columns.items()}
        return read_bands(self.file, self.time, columns, **self.how)
