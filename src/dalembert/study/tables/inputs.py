"""The tables of measured inputs: columns of files that drive the model, wherever a signal may stand."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

import numpy as np
from pydantic import Field, PrivateAttr, ValidationInfo, model_validator

from dalembert.data.stretches import gaps
from dalembert.errors import DataError, unknown
from dalembert.study.tables.data_table import (
    MISSING,
    Column,
    DataFile,
    DataTable,
    FileTable,
    Missing,
    Start,
    StartTable,
)
from dalembert.study.text.expressions import Expression, Kinds, kind_of_number
from dalembert.study.text.numbers import Quantity, Times, fixed, number
from dalembert.study.text.table import Context, Read, StudyTable, alternative, problem
from dalembert.unit_table import Unit, readings
from dalembert.units import difference, expected, si_unit, wrong_kind

if TYPE_CHECKING:
    from dalembert.multibody import Table

_CHANNEL = "input"
_ABSCISSA = "t"  # what units call the times of a universal file
_OF_FILES = {*FileTable.model_fields, "start"} - {"file", "units"}
_OF_TIMES = {*FileTable.model_fields, "start", "split", "trial"}
_OUTSIDE = 0.01  # of a motion: what may lie beyond the ends of an input


class InputReference(StudyTable):
    """A measured input in place of a signal: ``torque = { input = "torque" }``."""

    input: str = Field(description="name of a table [inputs.NAME]")


class InputTable(FileTable):
    """A measured input: a column of the data's file, or of another one."""

    file: DataFile | None = Field(None, description="that of the data, or of the experiment, if not given")
    column: Column | None = Field(None, description="name of the column, or its number from 1 in a text file")
    unit: str = Field("", description="of the column, where it is not in SI units: 'N*mm'")
    interpolation: Literal["linear", "cubic", "held"] = Field(
        "linear", description="what the input does between its samples"
    )
    start: Annotated[Any, Read(Start)] = Field(
        None,
        description="time of its file at which the motion begins: a number, or 'first' for that of the first sample",
    )
    scale: Quantity = Field(1.0, description="factor, such as a torque constant")
    offset: Quantity = Field(0.0, description="added to the scaled input, in SI units")
    delay: Annotated[Any, Read(number("s"))] = Field(0.0, description="positive where the input acts late")
    integrals: Literal[0, 1, 2] = Field(0, description="2 makes the motion of a base of its acceleration")
    lowpass: Annotated[float, Read(fixed("Hz"))] | None = Field(
        None, description="cutoff frequency of a low-pass filter without delay: '40 Hz'"
    )
    resample: Times | None = Field(
        None, description="times at which splines through the samples are taken, before the filter if theirs are uneven"
    )
    missing: Missing = MISSING
    wraps: bool = Field(False, description="whether it is an angle known up to whole turns")
    _kinds: Kinds = PrivateAttr({})

    @model_validator(mode="after")
    def _keep_kinds(self, info: ValidationInfo) -> Self:
        if isinstance(info.context, Context):
            self._kinds = info.context.names
        return self

    def unit_of(self, key: str) -> Unit | None:
        """What a number of the table measures; None if that is not known."""
        return kind_of_number(getattr(self, key), self._kinds)

    def _wrong(self) -> list[str]:
        described = sorted(self.model_fields_set & _OF_FILES)
        if described and self.file is None:
            raise problem(
                f"{', '.join(described)}: an input from the data's file is read as the data are; give a file too"
            )
        if isinstance(self.start, StartTable):
            raise problem("start: bounds were given; expected a number of seconds of the file, or 'first'")
        if self.frequency is not None:
            raise problem("frequency: an input lies along time; name its column by time")
        return super()._wrong()

    def over(self, shared: "InputTable | None") -> "InputTable":
        """This table with the keys that it leaves out from the shared one."""
        if shared is None:
            return self
        return shared.model_copy(update=self.picked(*self.model_fields_set))

    def read(self, name: str, data_table: DataTable | None) -> "MeasuredInput":
        """The samples of the input, from its file or that of the data ``data_table``."""
        assert self.column is not None  # or the study was refused
        table = data_table
        if self.file is not None:
            table = DataTable.model_construct(**self.picked(*FileTable.model_fields, "start"))
        if table is None:
            raise DataError(f"[inputs.{name}]: no file is given, and there are no [data]; give a file")
        column = str(self.column)
        units = {name: unit for name, unit in table.units.items() if name in (str(table.time), column, _ABSCISSA)}
        units |= {column: self.unit} if self.unit else {}
        # the times are read as those of the data; what else becomes of the data is left out
        keys = {
            key: key_field.get_default(call_default_factory=True)
            for key, key_field in DataTable.model_fields.items()
            if key not in _OF_TIMES
        }
        keys |= {"columns": {_CHANNEL: self.column}, "units": units, "lowpass": self.lowpass}
        keys |= {"resample": self.resample}
        keys |= {"missing": self.missing, "wraps": [_CHANNEL] * self.wraps}
        data = table.model_copy(update=keys).read()
        values = data.continuous[:, data.channels.index(_CHANNEL)]
        finite = np.isfinite(values)
        self._refuse_gaps(name, data.coordinate.values[finite], str(table.file))
        unit = data.source_units.get(_CHANNEL, "")
        return MeasuredInput(name, self, data.coordinate.values[finite], values[finite], str(table.file), unit)

    def _refuse_gaps(self, name: str, times: np.ndarray, source: str) -> None:
        gaps_here = gaps(times)
        if self.missing == "refuse" and len(gaps_here):
            begin, end = times[gaps_here[0]], times[gaps_here[0] + 1]
            raise DataError(
                f"[inputs.{name}]: {source} has no values from {begin:.6g} to {end:.6g} s, and what drives the "
                "model there is not known. Keep the samples before or behind it, or join them by missing = 'leave-out'"
            )


@dataclass(frozen=True, eq=False)
class MeasuredInput:
    """Samples of an input, and how they drive the model.

    Parameters
    ----------
    name : str
    table : InputTable
    times, values : array, shape (samples,)
    source : str
        The file.
    unit : str
        That of its column in the file; ``""`` where the file names none.
    """

    name: str
    table: InputTable
    times: np.ndarray
    values: np.ndarray
    source: str
    unit: str = ""

    def signal(self, values: Mapping[str, Any]) -> "Table":
        """The signal at values of parameters and constants."""
        from dalembert.multibody import Table

        numbers: dict[str, Any] = {}
        for key in ("scale", "offset", "delay"):
            entry = getattr(self.table, key)
            numbers[key] = entry(values) if isinstance(entry, Expression) else entry
        table_class: Any = Table
        return table_class(self.times, self.values, self.table.interpolation, integrals=self.table.integrals, **numbers)

    def check_interpolation(self, model: Any) -> None:
        """Refuse an input in a unit of another kind than that of what it drives, unless a scale turns it into that.

        A scale that has a unit must turn the unit of the column into that of what is driven; a plain number may stand
        for any. The offset must have the unit of what is driven.
        """
        scaled, scale = "scale" in self.table.model_fields_set, self.table.unit_of("scale")
        offset = self.table.unit_of("offset")
        for name, where, driven in _used(model):
            if name != self.name or not driven:
                continue
            wanted = driven + f"/s^{self.table.integrals}" * bool(self.table.integrals)
            expected_kind = readings(wanted)[0]
            if not scaled and (sentence := wrong_kind(self.unit, wanted)):
                raise DataError(
                    f"[inputs.{name}], column {str(self.table.column)!r}, for {where}: {sentence}; correct "
                    "unit, or give the scale that turns the column into it"
                )
            units = readings(self.unit) if self.unit.strip("-1 ") else ()
            products = [] if scale is None else [unit * scale for unit in units]
            if products and all(difference(product, expected_kind) is not None for product in products):
                raise DataError(
                    f"[inputs.{name}], scale, for {where}: the column in {self.unit!r} times a scale in "
                    f"{si_unit(scale) if scale else ''} is in {si_unit(products[0])}; expected {expected(wanted)}; "
                    "correct the unit of the column, or that of the scale"
                )
            if offset is not None and difference(offset, expected_kind) is not None:
                raise DataError(
                    f"[inputs.{name}], offset, for {where}: its unit is {si_unit(offset)}; expected {expected(wanted)}"
                )

    def require(self, end: float) -> None:
        """Refuse an input that does not last as long as a motion until ``end`` (s)."""
        first, last = self.times[[0, -1]]
        slack = _OUTSIDE * end + 2 * float(np.median(np.diff(self.times)))
        if first > slack or last < end - slack:
            raise DataError(
                f"[inputs.{self.name}]: {self.source} has values from {first:g} to {last:g} s, and the motion lasts "
                f"from 0 to {end:g} s; expected an input that lasts as long. Choose samples of the data by between, or "
                "another start of the times"
            )


def signal_or_input(signal: Any) -> Any:
    """Type of a key that takes a signal's table, or the name of an input."""
    return alternative(_refers, InputReference, signal)


def _refers(value: Any) -> bool:
    return isinstance(value, InputReference) or (isinstance(value, dict) and "input" in value and "kind" not in value)


def input_named(value: Any) -> str | None:
    """Name of the input that an argument of a function stands for: ``{ input = "torque" }``."""
    return value["input"] if isinstance(value, dict) and value.keys() == {"input"} else None


def wrong_inputs(file: Any) -> list[str]:
    """Sentences about inputs that do not fit to the rest of the file."""
    if file.inputs and (file.vibrates or file.model.forward is not None):
        return ["[inputs] drive mechanisms, and here is another model; leave them out"]
    wrong, used = [], {name: where for name, where, _ in _used(file.model)}
    wrong += [unknown("input", name, file.inputs, where) for name, where in used.items() if name not in file.inputs]
    for name, table in file.inputs.items():
        if name not in used:
            wrong.append(
                f"[inputs.{name}] is used nowhere in [model]; write {{ input = '{name}' }} where a signal may stand"
            )
        overridden = [entry.inputs[name].over(table) if name in entry.inputs else table for entry in file.experiments]
        wrong += _wrong_input(name, overridden or [table], file)
    if file.inputs and any(table.unknown_start is not None for table in (file.data, *file.experiments) if table):
        wrong.append(
            "start: the time at which the motion begins is to be identified, and [inputs] drive the model at times of "
            "the file; give start as a number or 'first', or bounds of a sensor's delay"
        )
    for entry in file.experiments:
        where = f"[[experiments]] {entry.name!r}, inputs"
        wrong += [unknown("input", name, file.inputs, where) for name in entry.inputs if name not in file.inputs]
    return wrong


def _wrong_input(name: str, tables: Sequence[InputTable], file: Any) -> Iterator[str]:
    """Sentences about an input, whose table may differ in each experiment."""
    if any(table.column is None for table in tables):
        yield f"[inputs.{name}]: the key 'column' is missing; expected the name of a column"
    if any(table.file is None for table in tables) and file.data is None and not file.experiments:
        yield f"[inputs.{name}]: the key 'file' is missing, and there are no [data] with a file"
    if any(table.interpolation == "held" and _varies(table.delay, file) for table in tables):
        yield (
            f"[inputs.{name}], delay: the response to a held input has no derivative by its delay, since each change "
            "of the value moves in time as a jump; take interpolation = 'linear', or a delay that depends on no "
            "parameter"
        )


def _used(model: Any) -> Iterator[tuple[str, str, str]]:
    """Names of the inputs that a model uses, where, and the SI units of what they drive; empty if not known."""
    for table, component in model.components:
        fields = component.target_type.__dataclass_fields__
        for key, value in component.given().items():
            if isinstance(value, InputReference):
                unit = fields[key].metadata.get("unit") or "" if key in fields else ""
                yield value.input, f"[[model.{table}]] {component.name!r}, {key}", unit
    robot = model.robot_table
    for joint, name in (robot.inputs if robot else {}).items():
        yield name, f"[model.robot.torques], {joint}", robot.drive_units[joint]
    for key, value in model.arguments.items():
        if (name := input_named(value)) is not None:
            yield name, f"[model.arguments], {key}", ""


def _varies(entry: Any, file: Any) -> bool:
    if not isinstance(entry, Expression):
        return False
    return any(name in file.parameters or _varies(file.constants.get(name), file) for name in entry.names)
