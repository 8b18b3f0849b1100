"""Runs compared: responses over each other, values with deviations, and the differences of their studies."""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import plotly.graph_objects as go

from dalembert.errors import DalembertError, InputError
from dalembert.quantities import unit
from dalembert.report import sections_of
from dalembert.report.headline import Headline
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.options import ReportOptions
from dalembert.report.section import Block, Plot, Section, Source
from dalembert.report.thinning import thinned
from dalembert.studio.runs.differences import as_text, differences
from dalembert.studio.runs.run_list import row
from dalembert.studio.runs.run_units import PLAIN, Unit, in_unit, run_units
from dalembert.study.run.compare_runs import fit_or_posterior
from dalembert.study.run.folder import RunFolder
from dalembert.tables import Cell, Table, cell, labelled

MOST_FIGURES = 24
"""Channels that are drawn, the first ones."""
_UNITS = {"duration": " (s)", "date": " (UTC)"}
_FACTS = ("study", "task", "state", "misfit", "duration", "date", "findings", "tags", "note")


@dataclass(frozen=True, eq=False)
class Curve:
    """A response of a run: ``at`` and ``values`` (samples,). ``channel`` and ``along`` name the channel and the
    coordinate, with units.
    """

    channel: str
    along: str
    at: np.ndarray
    values: np.ndarray
    measured: bool = False


@dataclass(frozen=True, eq=False)
class RunComparison:
    """Runs of which the first is the reference for the differences of studies."""

    folders: Sequence[RunFolder]

    @property
    def names(self) -> list[str]:
        return [folder.path.name for folder in self.folders]

    @property
    def table(self) -> Table:
        """A column for each run: what it is, and its values with standard deviations."""
        rows = [row(folder) for folder in self.folders]
        states = [(folder.state().get("best") or {}) for folder in self.folders]
        values, deviations = ([one.get(key) or {} for one in states] for key in ("values", "deviations"))
        found: list[list[Any]] = [[fact + _UNITS.get(fact, ""), *(_cell(one[fact]) for one in rows)] for fact in _FACTS]
        units: dict[str, Unit] = {}
        for folder, one in zip(self.folders, values, strict=True):
            units = run_units(folder, one) | units  # one unit for all runs, that of the first
        for name in dict.fromkeys(name for one in values for name in one):
            unit = units.get(name, PLAIN)
            known = [[in_unit(own.get(name), unit) for own in both] for both in zip(values, deviations, strict=True)]
            found.append([labelled(name, unit[0]), *(_cell(value, own) for value, own in known)])
            if any(own is not None for _, own in known):
                found.append([labelled(f"{name}, standard deviation", unit[0]), *(_cell(own) for _, own in known)])
        return Table.of_rows("runs", "Values with standard deviations", ["", *self.names], found)


@sections_of(RunComparison)
def _sections(comparison: RunComparison, options: ReportOptions) -> list[Section]:
    title = f"{len(comparison.folders)} runs compared"
    headline = Headline(title=title, verdict="compared", status=", ".join(comparison.names))
    return [
        headline,
        Section("Values", (comparison.table,)),
        *_models(comparison),
        Section("Responses", list(_responses(comparison))),
        Section("Studies", list(_studies(comparison))),
    ]


def _models(comparison: RunComparison) -> list[Section]:
    """The ranking of identified models; none where fewer than two runs identified one."""
    from dalembert.inverse import compare_models
    from dalembert.report.sections.alternative_sections import compared_models

    fits = {}
    for folder in comparison.folders:
        with suppress(DalembertError, OSError):  # another task, no result, or a damaged one
            fits[folder.path.name] = fit_or_posterior(folder)
    if len(fits) < 2:
        return []
    try:
        return [compared_models(compare_models(fits), findings=True)]
    except InputError as error:
        return [Section("Model comparison", (f"These models are not ranked. {error}.",))]


def _responses(comparison: RunComparison) -> Iterator[Block]:
    """A figure for each channel, with a line for each run that has it."""
    curves = {folder.path.name: list(curves_of(folder)) for folder in comparison.folders}
    channels = list(dict.fromkeys((one.channel, one.along) for own in curves.values() for one in own))
    if not channels:
        yield "These runs have no responses that can be drawn over each other."
    for number, (channel, along) in enumerate(channels[:MOST_FIGURES], start=1):
        figure, shown = go.Figure(), set()
        for place, (name, own) in enumerate(curves.items()):
            for one in own:
                if (one.channel, one.along) == (channel, along):
                    _draw(figure, one, name, LIGHT.series[place % len(LIGHT.series)], shown)
        yield Plot(f"responses-{number}", themed(figure, plain(channel), x=plain(along), y=plain(channel)))
    if len(channels) > MOST_FIGURES:
        yield f"{len(channels) - MOST_FIGURES} more channels are not drawn."


def _draw(figure: go.Figure, one: Curve, name: str, colour: str, shown: set[bytes]) -> None:
    """Draw a line; the same data of several runs are drawn once."""
    x, y = thinned(one.at, one.values)
    if not one.measured:
        figure.add_scatter(x=x, y=y, name=plain(name), mode="lines", line={"color": colour, "width": 2})
    elif one.values.tobytes() not in shown:
        shown.add(one.values.tobytes())
        marker = {"color": LIGHT.muted, "size": 4, "opacity": 0.5}
        figure.add_scatter(x=x, y=y, name=f"{plain(name)}, measured", mode="markers", marker=marker)


def _studies(comparison: RunComparison) -> Iterator[Block]:
    """What differs between the first study and the others."""
    first, *others = comparison.folders
    reference = _text(first.study)
    for folder in others:
        lines = differences(reference, _text(folder.study))
        name = folder.path.name
        if lines:
            yield Source(f"{name}: changes from {first.path.name} (− removed, + added)", as_text(lines))
        else:
            yield f"The study of {name} is that of {first.path.name}."


def curves_of(folder: RunFolder) -> Iterator[Curve]:
    """Yield the responses in the result of a run over time or frequency, with the data that they were fitted to."""
    from dalembert.inverse import Fit

    try:
        with h5py.File(folder.result) as file:
            is_fit = file.attrs.get("format") == Fit.FORMAT
        yield from _of_fit(Fit.load(folder.result)) if is_fit else _of_dataset(folder.result)
    except (DalembertError, OSError, ValueError, KeyError):  # no result, or a damaged one
        return


def _of_fit(fit: Any) -> Iterator[Curve]:
    for name, data, response in _fitted(fit):
        along = labelled(data.coordinate.name, data.coordinate.unit)
        for column, channel in enumerate(data.channels):
            label = labelled(f"{name}{channel}", unit(channel))
            at, taken = data.coordinate.values, data.taken[:, column]
            yield Curve(label, along, at[taken], data.values[taken, column], measured=True)
            yield Curve(label, along, at, response[:, column])


def _of_dataset(path: Path) -> Iterator[Curve]:
    """Variables over one coordinate, without those that say how a simulation went."""
    from xarray import load_dataset

    dataset = load_dataset(path, engine="h5netcdf")
    for name, variable in dataset.data_vars.items():
        own = variable.dims == ("time",) or variable.dims == ("frequency",)
        if own and variable.dims[0] in dataset.coords and not str(name).startswith(("energy.", "violation.")):
            coordinate = dataset.coords[variable.dims[0]]
            along = labelled(str(coordinate.name), str(coordinate.attrs.get("units", "")))
            label = labelled(str(name), str(variable.attrs.get("units", "")))
            yield Curve(label, along, coordinate.values, np.asarray(variable.values, dtype=float))


def _fitted(result: Any) -> Iterator[tuple[str, Any, np.ndarray]]:
    """Data and responses of a fit, with the name of each experiment before its channels."""
    if not result.experiments:
        yield "", result.data, result.response
    for one in result.experiments:
        yield f"{one.name}: ", one.data, one.response


def _cell(value: Any, deviation: float | None = None) -> Cell:
    return Cell("", "") if value is None else cell(value, deviation)


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8") if path.is_file() else ""
