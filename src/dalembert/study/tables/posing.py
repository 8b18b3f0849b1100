"""The models and data that a study makes of its data, experiments and sensors."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from dalembert.errors import DataError, InputError
from dalembert.forward import ForwardModel, Sensor, Sensors
from dalembert.forward.sensors import QUANTITIES, reading_parameter
from dalembert.parameter import Parameter
from dalembert.study.tables.data_table import DataTable
from dalembert.study.tables.sensor_table import SensorTable
from dalembert.study.tables.study import Study
from dalembert.study.text.numbers import wrong_units
from dalembert.unit_table import readings
from dalembert.units import difference

if TYPE_CHECKING:
    from dalembert.data import Measurements
    from dalembert.inverse import Experiment

TIMES = ("delay", "lag")
"""Of a sensor."""
MOST_SAMPLES = 20_000
"""Samples of a motion between which sensors interpolate, at most; as many as steps if those are fewer."""

LATE = 10
"""Steps of a record before its first sample from which it must say where the motion begins."""


def fitted_parameters(study: Study) -> dict[str, tuple[Parameter, ...]]:
    """Parameters of the model, of sensors, and of single experiments, as a fit names them, by experiment.

    Without experiments there is one entry with an empty name.
    """
    file = study.file
    if not file.experiments:
        return {"": (*study.parameters, *([] if file.data is None else _of_readings(study, file.data)))}
    result = {}
    for table in file.experiments:
        items = (*study.variant(table).parameters, *_of_readings(study, table))
        named = (replace(item, name=table.named(item.name)) for item in items)
        result[table.name] = tuple(named)
    return result


def unknown_names(study: Study) -> tuple[str, ...]:
    """Names of the parameters of the model, of sensors, and of single experiments, in the order of the fit."""
    return tuple(dict.fromkeys(item.name for items in fitted_parameters(study).values() for item in items))


def _of_readings(study: Study, table: DataTable) -> list[Parameter]:
    readings = [
        reading_parameter(f"{channel} {what}", bounds, "s" if what in TIMES and study.has_system else "", usual)
        for channel, sensor in table.sensors(study.file.sensors).items()
        for what, usual in QUANTITIES.items()
        if (bounds := getattr(sensor, what)) is not None
    ]
    readings = [item for item in readings if not item.is_fixed]
    start = table.unknown_start
    return readings if start is None or start.is_fixed else [*readings, start]


def posed(study: Study) -> "tuple[ForwardModel | list[Experiment], Measurements | None]":
    """Model and data of a study, or its experiments and None: the first arguments of ``identify``."""
    from dalembert.inverse import Experiment

    states = getattr(getattr(study.table, "shooting", None), "states", None) or {}
    later = tuple(state.channel for state in states.values())
    if study.file.data is not None:
        data = study.data()
        model = _model(study, data, study.file.data, later)
        _check_units(study.file.data, model, "[data]", study.file.sensors)
        return model, data
    experiments = []
    for table in study.file.experiments:
        data, variant = table.read(), study.variant(table)
        model = _model(variant, data, table, later)
        _check_units(table, model, f"[[experiments]] {table.name!r}", study.file.sensors)
        experiments.append(Experiment(table.name, model, data, table.alone))
    return experiments, None


def channel_units_of(model: "ForwardModel | Sequence[Experiment]") -> dict[str, str | None]:
    """Units of the channels of a model, or of experiments, also by ``"NAME.channel"``; None where there is none."""
    if isinstance(model, ForwardModel):
        scaled = getattr(model, "scaled", frozenset())  # which may have any unit
        return {item.name: None if item.name in scaled else item.unit or None for item in model.channels}
    units: dict[str, str | None] = {}
    for item in model:
        units_here = channel_units_of(item.model)
        units |= units_here | {f"{item.name}.{name}": unit for name, unit in units_here.items()}
    return units


def _check_units(table: DataTable, model: ForwardModel, where: str, sensors: Mapping[str, SensorTable]) -> None:
    """Refuse deviations and offsets whose unit is not that of their channel, and derivatives of another kind."""
    units = channel_units_of(model)
    for file in (table, *table.more):
        for sentence in wrong_units(file.deviations or {}, units, f"{where}, deviations"):
            raise InputError(sentence)
    offsets = {name: sensor.offset for name, sensor in sensors.items() if sensor.offset is not None}
    for sentence in wrong_units(offsets, units, "[sensors], offset of"):
        raise InputError(sentence)
    for name, derivative in table.derivatives.items():
        unit, wanted = (units.get(channel) for channel in (derivative.of, name))
        if not unit or not wanted or not readings(unit) or not readings(wanted):
            continue
        if difference(readings(unit)[0] * readings("s")[0] ** -derivative.order, readings(wanted)[0]) is not None:
            raise InputError(
                f"{where}, derivatives, {name}: a derivative of {derivative.of!r} in {unit} of order "
                f"{derivative.order} was given for a channel in {wanted}; expected one of the channel's kind"
            )


def _model(study: Study, data: "Measurements", table: DataTable, later: Sequence[str] = ()) -> ForwardModel:
    sensors = table.sensors(study.file.sensors)
    stamps, start = data.coordinate.values, table.unknown_start
    if study.has_system and start is None:
        _refuse_late(table, data)
    if not sensors and start is None:
        return study.forward(tuple(dict.fromkeys((*data.channels, *later))), stamps)
    samples = _fine(study, stamps, sensors, start) if study.has_system else stamps
    return Sensors(study.forward(data.channels, samples), sensors, stamps, start)


def _refuse_late(table: DataTable, data: "Measurements") -> None:
    """Refuse a record that begins late, and of which nobody says when the motion began."""
    stamps = data.coordinate.values
    if table.start is not None or table.between is not None or len(stamps) < 2:
        return
    steps = [np.diff(stamps[rows]) for rows in data.taken.T]
    if stamps[0] > LATE * max(np.median(steps_here) if len(steps_here) else 0.0 for steps_here in steps):
        raise DataError(
            f"{table.file}, column {table.time!r}: the times begin at {stamps[0]:.6g} s, and a motion begins at 0. If "
            "it begins with the record, give start = 'first'; if it began at 0 s of the file, give start = 0"
        )


def _fine(study: Study, stamps: np.ndarray, sensors: dict[str, Sensor], start: Parameter | None = None) -> np.ndarray:
    """Times of the solver's steps until the last reading; of very many steps every n-th one."""
    delays = [sensor.delay for sensor in sensors.values() if sensor.delay is not None]
    least = min((item.lower if isinstance(item, Parameter) else item[0] for item in delays), default=0.0)
    end = float(stamps[-1]) - min(0.0, least) - (0.0 if start is None else start.lower)
    step = getattr(study.solver, "step", None) or end / 2000
    apart = step * np.ceil(end / step / MOST_SAMPLES)
    return apart * np.arange(np.ceil(end / apart - 1e-9) + 1)
