"""The tables of several experiments and of sensors, and that they fit to the rest of the file."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated, Any

from pydantic import AfterValidator, Field, ValidationError, ValidationInfo

from dalembert.errors import DataError, repeated, unknown
from dalembert.forward import Sensor
from dalembert.forward.sensors import QUANTITIES, START
from dalembert.study.tables.data_table import DataTable
from dalembert.study.tables.inputs import InputTable
from dalembert.study.tables.parameters import LocalParameterTable, ParameterTable
from dalembert.study.tables.sensor_table import SensorTable, reads
from dalembert.study.text.numbers import Number, wrong_units
from dalembert.study.text.table import Context, Name, problem
from dalembert.units import si_unit


def _of_their_kinds(constants: dict[str, float], info: ValidationInfo) -> dict[str, float]:
    known = info.context.names if isinstance(info.context, Context) else {}
    units = {name: si_unit(kind) for name, kind in known.items() if kind is not None}
    if wrong := list(wrong_units(constants, units, "")):
        raise problem(*(sentence.removeprefix(", ") for sentence in wrong))
    return constants


class ExperimentTable(DataTable):
    """One of several experiments: its data, and what differs from the others."""

    SEVERAL = True

    name: Name
    local: list[str] | dict[str, LocalParameterTable] = Field(
        [],
        description="parameters that are not shared with the other experiments: names, also of sensors, such as "
        "'bar.angle offset', or a table with the bounds and first guesses that differ here",
    )
    constants: Annotated[dict[str, Number], AfterValidator(_of_their_kinds)] = Field(
        {}, description="constants that have another value in this experiment"
    )
    arguments: dict[str, Any] = Field({}, description="arguments of the model's function in this experiment")
    inputs: dict[str, InputTable] = Field({}, description="keys of [inputs.NAME] that differ in this experiment")

    @property
    def alone(self) -> tuple[str, ...]:
        """Parameters of this experiment alone; the time at which its motion begins is one of them."""
        return (*self.local, *([START] if self.unknown_start else []))

    def named(self, name: str) -> str:
        """Name of a parameter in a fit of all experiments."""
        return f"{self.name}.{name}" if name in self.alone else name

    def parameters(self, shared: Mapping[str, ParameterTable]) -> dict[str, ParameterTable]:
        """The parameters' tables as they are in this experiment."""
        tables = self.local if isinstance(self.local, dict) else {}
        return {name: tables[name].over(table) if name in tables else table for name, table in shared.items()}

    def sensors(self, shared: Mapping[str, SensorTable]) -> dict[str, Sensor]:
        """The sensors of its channels, with the bounds that are local to this experiment."""
        return {name: self._local(name, sensor) for name, sensor in super().sensors(shared).items()}

    def _local(self, name: str, sensor: Sensor) -> Sensor:
        tables = self.local if isinstance(self.local, dict) else {}
        for what in QUANTITIES:
            bounds, table = getattr(sensor, what), tables.get(f"{name} {what}")
            if bounds is not None and table is not None:
                parameter = table.over(ParameterTable.model_validate({"lower": bounds[0], "upper": bounds[1]}))
                sensor = replace(sensor, **{what: parameter.parameter(f"{name} {what}")})
        return sensor


def expanded(tables: list[ExperimentTable]) -> list[ExperimentTable]:
    """Experiments, those of files with several trials one by one, ``"NAME-3"``."""
    result = []
    for table in tables:
        if table.split is None or table.trial is not None:
            result.append(table)
            continue
        try:
            labels = table.labels()
        except DataError as error:
            raise problem(str(error)) from None
        start = "first" if table.start is None else table.start
        result += [
            table.model_copy(update={"name": f"{table.name}-{label}", "trial": label, "start": start})
            for label in labels
        ]
    return result


def wrong_experiments(file: Any) -> list[str]:
    """Sentences about experiments and sensors that do not fit to the rest of the file."""
    wrong = []
    if several := repeated([table.name for table in file.experiments]):
        wrong.append(f"[[experiments]]: {', '.join(several)} is given more than once; expected different names")
    if file.experiments and file.data is not None:
        wrong.append("[data] and [[experiments]] are both given; expected one of them")
    wrong += [
        f"{table} belongs to [identify] or [sample], and the task is [{task}]; leave it out"
        for task in file.tasks
        for table, content in (("[[experiments]]", file.experiments), ("[sensors]", file.sensors))
        if content and task not in ("identify", "sample")
    ]
    measured = measured_channels(file)
    wrong += [unknown("channel", name, measured, "[sensors]") for name in file.sensors if not reads(name, measured)]
    for table in file.experiments:
        where = f"[[experiments]] {table.name!r}, constants"
        wrong += [
            unknown("constant", name, file.constants, where) for name in table.constants if name not in file.constants
        ]
        where = f"[[experiments]] {table.name!r}, local"
        seen = {name: sensor for name, sensor in file.sensors.items() if reads(name, table.channels)}
        of_sensors = (f"{name} {what}" for name in seen for what in QUANTITIES if getattr(seen[name], what) is not None)
        known = [*file.parameters, *of_sensors]
        wrong += [unknown("parameter", name, known, where) for name in table.local if name not in known]
        wrong += _wrong_local(table, file, where)
        if table.arguments and not (file.model.function or file.model.forward):
            wrong.append(f"[[experiments]] {table.name!r}: arguments are for a function, and there is none")
    return wrong


def _wrong_local(table: ExperimentTable, file: Any, where: str) -> list[str]:
    try:
        table.parameters(file.parameters)
        table.sensors(file.sensors)
    except ValidationError as error:
        return [f"{where}: {error_entry['msg']}" for error_entry in error.errors()]
    return []


def measured_channels(file: Any) -> tuple[str, ...]:
    """Channels of the data, or of all experiments, each once."""
    tables = file.experiments or ([] if file.data is None else [file.data])
    return tuple(dict.fromkeys(channel for table in tables for channel in table.channels))
