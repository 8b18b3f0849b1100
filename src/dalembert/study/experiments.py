"""The tables of several experiments and of sensors, and the models and data that they make."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from pydantic import Field, ValidationError, model_validator

from dalembert.errors import DataError, unknown
from dalembert.forward import ForwardModel, Sensor, Sensors
from dalembert.forward.sensors import QUANTITIES, START
from dalembert.parameters import Parameter
from dalembert.study.data_table import DataTable
from dalembert.study.inputs import InputTable
from dalembert.study.numbers import fixed
from dalembert.study.parameters import OwnParameterTable, ParameterTable
from dalembert.study.table import Name, Read, StudyTable, problem

if TYPE_CHECKING:
    from dalembert.data import Measurements
    from dalembert.inverse import Experiment
    from dalembert.study.study import Study

MOST_SAMPLES = 20_000
"""Samples of a motion between which sensors interpolate, at most; as many as steps if those are fewer."""

LATE = 10
"""Steps of a record before its first sample from which it must say where the motion begins."""

TimeBounds = Annotated[list[Annotated[float, Read(fixed("s"))]], Field(min_length=2, max_length=2)]
Bounds = Annotated[list[Annotated[float, Read(fixed(None))]], Field(min_length=2, max_length=2)]


class SensorTable(StudyTable):
    """Bounds of what is not known of a channel's sensor."""

    delay: TimeBounds | None = Field(None, description="positive where the reading comes late")
    lag: TimeBounds | None = Field(None, description="time constant of a first-order low-pass")
    gain: Bounds | None = None
    offset: Bounds | None = Field(None, description="in the channel's unit")
    at_rest: bool = Field(False, description="whether the channel rests at its first value before the motion begins")

    @model_validator(mode="after")
    def _check(self) -> "SensorTable":
        given = {what: getattr(self, what) for what in QUANTITIES if getattr(self, what) is not None}
        wrong = [
            f"{what} is between {lower:g} and {upper:g}; expected the lower bound first"
            for what, (lower, upper) in given.items()
            if lower > upper
        ]
        if self.lag is not None and self.lag[0] < 0:
            wrong.append(f"lag may be {self.lag[0]:g} s; expected bounds of zero or more")
        if not given:
            wrong.append("none of delay, lag, gain and offset is given; expected bounds of at least one")
        if wrong:
            raise problem(*wrong)
        return self

    @property
    def sensor(self) -> Sensor:
        """The sensor."""
        pairs = {what: getattr(self, what) for what in QUANTITIES}
        return Sensor(**{what: pair and tuple(pair) for what, pair in pairs.items()}, at_rest=self.at_rest)


class ExperimentTable(DataTable):
    """One of several experiments: its data, and what differs from the others."""

    SEVERAL = True

    name: Name
    own: list[str] | dict[str, OwnParameterTable] = Field(
        [],
        description="parameters that are not shared with the other experiments: names, or a table with the bounds and "
        "first guesses that differ here",
    )
    constants: dict[str, Annotated[float, Read(fixed(None))]] = Field(
        {}, description="constants that have another value in this experiment"
    )
    arguments: dict[str, Any] = Field({}, description="arguments of the model's function in this experiment")
    inputs: dict[str, InputTable] = Field({}, description="keys of [inputs.NAME] that differ in this experiment")

    @property
    def alone(self) -> tuple[str, ...]:
        """Parameters of this experiment alone; the time at which its motion begins is one of them."""
        return (*self.own, *([START] if self.unknown_start else []))

    def variant(self, study: "Study") -> "Study":
        """The study as it is in this experiment."""
        shared = study.file.inputs
        inputs = {**shared, **{name: table.over(shared[name]) for name, table in self.inputs.items()}}
        varied = study.varied(self.constants, self.arguments, self.parameters(study.file.parameters))
        return varied.driven(inputs, self)

    def parameters(self, shared: Mapping[str, ParameterTable]) -> dict[str, ParameterTable]:
        """The parameters' tables as they are in this experiment."""
        given = self.own if isinstance(self.own, dict) else {}
        return {name: given[name].over(table) if name in given else table for name, table in shared.items()}


def expanded(tables: list[ExperimentTable]) -> list[ExperimentTable]:
    """Experiments, those of files with several trials one by one, ``"NAME-3"``."""
    found = []
    for table in tables:
        if table.split is None or table.trial is not None:
            found.append(table)
            continue
        try:
            labels = table.labels()
        except DataError as error:
            raise problem(str(error)) from None
        start = "first" if table.start is None else table.start
        found += [
            table.model_copy(update={"name": f"{table.name}-{label}", "trial": label, "start": start})
            for label in labels
        ]
    return found


def wrong_experiments(file: Any) -> list[str]:
    """Sentences about experiments and sensors that do not fit to the rest of the file."""
    wrong = []
    names = [table.name for table in file.experiments]
    repeated = sorted({name for name in names if names.count(name) > 1})
    if repeated:
        wrong.append(f"[[experiments]]: {', '.join(repeated)} is given more than once; expected different names")
    if file.experiments and file.data is not None:
        wrong.append("[data] and [[experiments]] are both given; expected one of them")
    wrong += [
        f"{table} belongs to [identify], and the task is [{task}]; leave it out"
        for task in file.tasks
        for table, given in (("[[experiments]]", file.experiments), ("[sensors]", file.sensors))
        if given and task != "identify"
    ]
    measured = measured_channels(file)
    wrong += [unknown("channel", name, measured, "[sensors]") for name in file.sensors if name not in measured]
    for table in file.experiments:
        where = f"[[experiments]] {table.name!r}, constants"
        wrong += [
            unknown("constant", name, file.constants, where) for name in table.constants if name not in file.constants
        ]
        where = f"[[experiments]] {table.name!r}, own"
        wrong += [
            unknown("parameter", name, file.parameters, where) for name in table.own if name not in file.parameters
        ]
        wrong += _wrong_own(table, file.parameters, where)
        if table.arguments and not (file.model.function or file.model.forward):
            wrong.append(f"[[experiments]] {table.name!r}: arguments are for a function, and there is none")
    return wrong


def _wrong_own(table: ExperimentTable, shared: Mapping[str, ParameterTable], where: str) -> list[str]:
    """Sentences about bounds and first guesses of a single experiment that do not fit to each other."""
    try:
        table.parameters(shared)
    except ValidationError as error:
        return [f"{where}: {one['msg']}" for one in error.errors()]
    return []


def measured_channels(file: Any) -> tuple[str, ...]:
    """Channels of the data, or of all experiments, each once."""
    tables = file.experiments or ([] if file.data is None else [file.data])
    return tuple(dict.fromkeys(channel for table in tables for channel in table.channels))


def unknown_names(study: "Study") -> tuple[str, ...]:
    """Names of the parameters of the model, of sensors, and of single experiments, in the order of the fit."""
    file = study.file
    if file.data is not None:
        return (*study.parameters.names, *_of_readings(file, file.data))
    names = {}
    for table in file.experiments:
        for name in (*study.parameters.names, *_of_readings(file, table)):
            names[f"{table.name}.{name}" if name in table.alone else name] = None
    return tuple(names)


def _of_readings(file: Any, table: DataTable) -> list[str]:
    """Names of the parameters of the sensors of some data, and of the time at which the motion begins."""
    start = table.unknown_start
    return [
        *(
            f"{channel} {what}"
            for channel, sensor in file.sensors.items()
            if channel in table.channels
            for what in QUANTITIES
            if (bounds := getattr(sensor, what)) is not None and bounds[0] < bounds[1]
        ),
        *([START] if start is not None and not start.is_fixed else []),
    ]


def posed(study: "Study") -> "tuple[ForwardModel | list[Experiment], Measurements | None]":
    """Model and data of a study, or its experiments and None: the first arguments of ``identify``."""
    from dalembert.inverse import Experiment

    states = getattr(getattr(study.table, "shooting", None), "states", None) or {}
    later = tuple(state.channel for state in states.values())
    if study.file.data is not None:
        data = study.data()
        return _model(study, data, study.file.data, later), data
    experiments = []
    for table in study.file.experiments:
        data, variant = table.read(), table.variant(study)
        experiments.append(Experiment(table.name, _model(variant, data, table, later), data, table.alone))
    return experiments, None


def _model(study: "Study", data: "Measurements", table: DataTable, later: Sequence[str] = ()) -> ForwardModel:
    """The model at the samples of data, seen by the sensors that there are; with channels that are states later."""
    sensors = {name: table.sensor for name, table in study.file.sensors.items() if name in data.channels}
    stamps, start = data.coordinate.values, table.unknown_start
    if study.has_system and start is None:
        _refuse_late(table, data)
    if not sensors and start is None:
        return study.forward(tuple(dict.fromkeys((*data.channels, *later))), stamps)
    samples = _fine(study, stamps, sensors, start) if study.has_system else stamps
    return Sensors(study.forward(data.channels, samples), sensors, stamps, start)


def _refuse_late(table: DataTable, data: "Measurements") -> None:
    """Refuse a record that begins late, and of which nobody says when the motion began.

    Raises
    ------
    DataError
    """
    stamps = data.coordinate.values
    if table.start is not None or table.between is not None or len(stamps) < 2:
        return
    steps = [np.diff(stamps[rows]) for rows in data.taken.T]
    if stamps[0] > LATE * max(np.median(own) if len(own) else 0.0 for own in steps):
        raise DataError(
            f"{table.file}, column {table.time!r}: the times begin at {stamps[0]:.6g} s, and a motion begins at 0. If "
            "it begins with the record, give start = 'first'; if it began at 0 s of the file, give start = 0"
        )


def _fine(study: "Study", stamps: np.ndarray, sensors: dict[str, Sensor], start: Parameter | None = None) -> np.ndarray:
    """Times of the solver's steps until the last reading, every so manyth of them where they are very many."""
    least = min((sensor.delay[0] for sensor in sensors.values() if isinstance(sensor.delay, tuple)), default=0.0)
    end = float(stamps[-1]) - min(0.0, least) - (0.0 if start is None else start.lower)
    step = getattr(study.solver, "step", None) or end / 2000
    apart = step * np.ceil(end / step / MOST_SAMPLES)
    return apart * np.arange(np.ceil(end / apart - 1e-9) + 1)
