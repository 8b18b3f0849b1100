"""Sweep: responses and their sensitivities at one instant, along one parameter after another."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar, Self

import numpy as np
from pydantic import Field

from dalembert.errors import InputError, StorageError, require_known, told
from dalembert.files import replacing
from dalembert.forward import ForwardModel, prefetched
from dalembert.parameters import Parameters
from dalembert.results import Summarised
from dalembert.study.run.duration import TOGETHER, Effort, evaluated
from dalembert.study.run.events import Emit
from dalembert.study.tables.study import Study
from dalembert.study.tasks.requirements import needs_solver, unnamed
from dalembert.study.tasks.task import ResultTask
from dalembert.study.text.numbers import MOST, Number, samples
from dalembert.study.text.table import Read, StudyTable, alternative, problem
from dalembert.tables import MOST_FACTS, Table, labelled

_BATCH = 64  # points between two events


class BoundsTable(StudyTable):
    """Evenly spaced values between the parameter's bounds."""

    count: int = Field(ge=2, le=MOST)


Along = Annotated[
    BoundsTable | tuple[float, ...],
    Read(alternative(lambda value: isinstance(value, dict) and set(value) <= {"count"}, BoundsTable, samples(None))),
]


class SweepTable(StudyTable):
    """Move one parameter at a time, the others at their first guesses, and look at one instant."""

    at: Number = Field(description="the instant: a time in s, or a frequency in Hz")
    channels: list[str] = Field(min_length=1)
    sensitivities: bool = Field(True, description="whether to compute the derivatives too")
    over: dict[str, Along] = Field(
        min_length=1, description="values of each parameter: { count = 41 } between its bounds, a list, or a range"
    )

    def _wrong(self) -> list[str]:
        if len(set(self.channels)) < len(self.channels):
            raise problem("channels are repeated; give each once")
        return []


@dataclass(frozen=True, eq=False)
class Curve:
    """Responses along one parameter.

    Parameters
    ----------
    parameter, unit : str
    values : array, shape (samples,)
    channels, units : tuple of str
    responses : array, shape (samples, channels)
        NaN where the simulation failed.
    sensitivities : array, shape (samples, channels), or None
        Derivatives of the responses with respect to this parameter.
    """

    parameter: str
    unit: str
    values: np.ndarray
    channels: tuple[str, ...]
    units: tuple[str, ...]
    responses: np.ndarray
    sensitivities: np.ndarray | None = None


@dataclass(frozen=True, eq=False)
class Sweep(Summarised):
    """One curve a parameter, at one instant that ``at`` names."""

    TITLE: ClassVar[str] = "Parameter sweep"
    VERDICTS: ClassVar[tuple[str, str]] = ("swept", "incomplete")

    at: str
    curves: tuple[Curve, ...]

    @property
    def failed(self) -> int:
        """Simulations that failed."""
        return sum(int(np.isnan(curve.responses).any(axis=1).sum()) for curve in self.curves)

    @property
    def success(self) -> bool:
        return self.failed == 0

    @property
    def status(self) -> str:
        """What was varied, and how many simulations failed, in sentences."""
        count, names = sum(len(curve.values) for curve in self.curves), [curve.parameter for curve in self.curves]
        failed = f"; {self.failed} of them failed, see events.jsonl" if self.failed else ""
        varied = f"Responses at {self.at}, one parameter varied at a time: {', '.join(names)}."
        return f"{varied} {count} points{failed}."

    def facts(self) -> dict[str, str]:
        return {f"values of {curve.parameter}": str(len(curve.values)) for curve in self.curves[:MOST_FACTS]}

    def tables(self) -> tuple[Table, ...]:
        """Return the responses, and their derivatives, along each parameter."""
        tables = []
        for place, curve in enumerate(self.curves, start=1):
            columns = {labelled(curve.parameter, curve.unit): curve.values}
            columns |= zip(curve.channels, curve.responses.T, strict=True)
            if curve.sensitivities is not None:
                names = [f"d {channel} / d {curve.parameter}" for channel in curve.channels]
                columns |= zip(names, curve.sensitivities.T, strict=True)
            caption = f"Responses along {curve.parameter}"
            tables.append(Table.of(f"sweep-{place}", caption, columns, detail=True))
        return tuple(tables)

    def save(self, path: Path) -> None:
        import xarray as xr

        tree = xr.DataTree.from_dict({f"/{curve.parameter}": _dataset(curve) for curve in self.curves})
        tree.attrs["at"] = self.at
        with replacing(path) as temporary:
            tree.to_netcdf(temporary, engine="h5netcdf")

    @classmethod
    def load(cls, path: Path) -> Self:
        """The curves that :meth:`save` wrote."""
        import xarray as xr

        with xr.open_datatree(path, engine="h5netcdf") as tree:
            curves = tuple(_curve(name, node.to_dataset().load()) for name, node in tree.children.items())
            return cls(tree.attrs["at"], curves)


class SweepTask(ResultTask):
    """The task ``[sweep]``."""

    name = "sweep"
    rank = 3
    schema = SweepTable
    keeps_responses = True
    needs = (needs_solver,)
    kind = f"{__name__}:Sweep"

    def wrong(self, file: Any) -> list[str]:
        return [*unnamed(file.sweep.over, file.parameters, "[sweep.over]"), *super().wrong(file)]

    def plan(self, study: Study) -> str:
        model = _model(study)
        _sample(model, study.table.at)
        _columns(model, study.table.channels)
        counts = {name: len(values) for name, values in _values(study).items()}
        each = f", each with {len(study.parameters)} sensitivities" if study.table.sensitivities else ""
        along = ", ".join(f"{name} ({count})" for name, count in counts.items())
        return f"sweeps {along} at {_instant(model, study.table.at)}: {sum(counts.values())} simulations{each}"

    def effort(self, study: Study) -> Effort:
        count = sum(map(len, _values(study).values()))
        count *= 1 + len(study.parameters) if study.table.sensitivities else 1
        return evaluated(_model(study), study.parameters.start, count, count, TOGETHER)

    def result(self, study: Study, emit: Emit) -> Sweep:
        model, along = _model(study), _values(study)
        total = sum(map(len, along.values()))
        curves, done = [], 0
        for name, values in along.items():
            channels = [model.channels[column] for column in _columns(model, study.table.channels)]
            shape = (len(values), len(channels))
            unit = next(item.unit for item in study.parameters if item.name == name)
            slopes = np.full(shape, np.nan) if study.table.sensitivities else None
            names, units = tuple(c.name for c in channels), tuple(c.unit for c in channels)
            curve = Curve(name, unit, values, names, units, np.full(shape, np.nan), slopes)
            for row, failure in _fill(study, model, curve):
                done += 1
                details = {"parameter": name, "value": float(curve.values[row]), "done": done, "total": total}
                emit("swept", **details, failure=failure)
            curves.append(curve)
        return Sweep(_instant(model, study.table.at), tuple(curves))


def _model(study: Study) -> ForwardModel:
    return study.forward(study.table.channels, np.array([study.table.at]))


def _instant(model: ForwardModel, at: float) -> str:
    return f"{model.coordinate.name} {at:g} {model.coordinate.unit}".strip()


def _sample(model: ForwardModel, at: float) -> int:
    values = model.coordinate.values
    nearest = int(np.argmin(np.abs(values - at)))
    if abs(values[nearest] - at) > 1e-9 * max(1.0, abs(at)):
        raise InputError(
            f"[sweep], at: {at:g} was given, but the model has no sample there; the nearest is {values[nearest]:g}"
        )
    return nearest


def _columns(model: ForwardModel, channels: list[str]) -> list[int]:
    names = [channel.name for channel in model.channels]
    for channel in channels:
        require_known("channel", channel, names, "[sweep], channels")
    return [names.index(channel) for channel in channels]


def values_along(parameters: Parameters, name: str, along: BoundsTable | tuple[float, ...]) -> np.ndarray:
    """Values of a parameter, shape (samples,)."""
    if not isinstance(along, BoundsTable):
        return np.array(along)
    parameter = next(item for item in parameters if item.name == name)
    return np.linspace(parameter.lower, parameter.upper, along.count)


def _values(study: Study) -> dict[str, np.ndarray]:
    """Values of each parameter, shape (samples,)."""
    return {name: values_along(study.parameters, name, along) for name, along in study.table.over.items()}


def _fill(study: Study, model: ForwardModel, curve: Curve) -> Iterator[tuple[int, str | None]]:
    """Simulate each point of a curve; yields its number and why it failed, if it did."""
    sample, columns = _sample(model, study.table.at), _columns(model, list(curve.channels))
    place = study.parameters.names.index(curve.parameter)
    vectors = np.tile(study.parameters.start, (len(curve.values), 1))
    vectors[:, place] = curve.values
    if curve.sensitivities is None:
        for first in range(0, len(vectors), _BATCH):
            responses = model.evaluate(vectors[first : first + _BATCH])
            for row, failure in enumerate(responses.failures, start=first):
                curve.responses[row] = responses.values[row - first, sample, columns]
                yield row, failure
        return
    for row, vector in enumerate(prefetched(model, lambda model, vector: model.linearise(vector), list(vectors))):
        failure = None
        try:
            response, jacobian = model.linearise(vector)
            curve.responses[row] = response[sample, columns]
            curve.sensitivities[row] = jacobian[sample, columns, place]
        except (InputError, StorageError):  # no other point will do better
            raise
        except Exception as error:  # whatever a user's function raises is this point's failure
            failure = told(error)
        yield row, failure


def _dataset(curve: Curve) -> Any:
    import xarray as xr

    arrays = [("{}", curve.responses, "{}", "response")]
    if curve.sensitivities is not None:
        arrays.append(("d({})", curve.sensitivities, f"{{}}/({curve.unit or '1'})", "sensitivity"))
    variables = {
        label.format(name): (curve.parameter, values[:, column], {"units": form.format(unit), "role": role})
        for label, values, form, role in arrays
        for column, (name, unit) in enumerate(zip(curve.channels, curve.units, strict=True))
    }
    return xr.Dataset(variables, {curve.parameter: (curve.parameter, curve.values, {"units": curve.unit})})


def _curve(name: str, dataset: Any) -> Curve:
    channels = tuple(key for key, column in dataset.data_vars.items() if column.attrs["role"] == "response")
    responses = np.stack([dataset[channel].values for channel in channels], axis=1)
    slopes = [dataset[f"d({channel})"].values for channel in channels if f"d({channel})" in dataset]
    return Curve(
        name,
        dataset[name].attrs["units"],
        dataset[name].values,
        channels,
        tuple(dataset[channel].attrs["units"] for channel in channels),
        responses,
        np.stack(slopes, axis=1) if slopes else None,
    )
