"""The functions that the process of a study is asked for: a simulation, and how strongly parameters act."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np

from dalembert.errors import SolveError
from dalembert.report.look import plain
from dalembert.studio.editor.reading import study_of
from dalembert.studio.simulation.curves import Curves, curves, on_page
from dalembert.studio.simulation.simulated_parts import OVER_FREQUENCY, NothingToSimulateError, StudyMotion, part
from dalembert.studio.worker import Kept

if TYPE_CHECKING:
    from dalembert.multibody import Trajectory
    from dalembert.studio.editor.outline import Outline
    from dalembert.study import Study
    from dalembert.vibration import FrequencyCurve

REST = 1e-9
"""Range of a channel, relative to the largest effect of a parameter on it, up to which it is at rest."""

DIFFERENCE = 1e-4
"""Step of differences, as a part of the distance between the bounds of a parameter."""
LONG = 5.0
"""Seconds of curves over frequency above which no effects are computed: the next simulation would wait."""


@dataclass(frozen=True)
class Source:
    """What a study is made of. ``stamps`` are the other files that it names, with the times of their last changes."""

    path: Path
    text: str
    stamps: tuple[tuple[str, int], ...] = ()

    @classmethod
    def of(cls, study: "Outline | Study", path: Path, text: str) -> "Source":
        """The source of a study that was read from a text."""
        files = [file for file in study.files.values() if file.is_file()]
        return cls(path, text, tuple((str(file), file.stat().st_mtime_ns) for file in files))


@dataclass(frozen=True)
class Simulated:
    """A simulation as a page shows it. ``film``: of a mechanism, see :func:`~dalembert.report.player.film.film_of`;
    ``misfit``: weighted sum of squares of the residuals, None without data; ``residuals``: root mean squares by
    channel, in ``units``; ``seconds``: time of the simulation; ``computed``: that with film and curves; ``hint``: why
    nothing is simulated, though the study is valid.
    """

    film: dict[str, Any] | None = None
    curves: tuple[Curves, ...] = ()
    misfit: float | None = None
    residuals: dict[str, float] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    seconds: float = 0.0
    computed: float = 0.0
    hint: str = ""


@dataclass(frozen=True)
class Influences:
    """How strongly parameters act on channels, to first order. ``effects`` maps each parameter to its effect on each
    channel: root mean square of the change from its lower to its upper bound, relative to the range of the channel.
    """

    channels: tuple[str, ...]
    effects: dict[str, list[float]]


def simulated(
    kept: Kept, source: Source, name: str, values: Mapping[str, float], *, figures: bool = False
) -> Simulated:
    """Simulate a part of a study at values of its parameters by name. ``figures`` makes the figures of the curves too,
    not their lines alone.
    """
    try:
        own = _part(kept, source, name)
    except NothingToSimulateError as error:
        return Simulated(hint=str(error))
    began = perf_counter()
    if own.model is None and own.study.task == OVER_FREQUENCY:
        return _followed(own, values, began)
    if not own.end:
        response, moving = response_at(own, values), None
    else:
        response, moving = _motion(own, values)
    seconds = perf_counter() - began
    found = () if response is None else curves(own, response, figures=figures)
    misfit, residuals = (None, {}) if own.data is None or response is None else _misfit(own, response)
    played = None if moving is None else _film(own, *moving)
    channels = () if own.model is None else own.model.channels
    units = {one.name: plain(one.unit) for one in channels if one.name in residuals}
    return Simulated(played, found, misfit, residuals, units, seconds, perf_counter() - began)


def influences(kept: Kept, source: Source, name: str, values: Mapping[str, float]) -> Influences:
    """Return how strongly the parameters act on the channels of a part at values of them by name."""
    own = _part(kept, source, name)
    if own.model is None:
        return _over_frequency(own, values) if own.study.task == OVER_FREQUENCY else Influences((), {})
    vector, parameters = own.vector(values), own.model.parameters
    response, jacobian = own.model.linearise(vector)
    columns, channels = _columns(own), tuple(channel.name for channel in own.model.channels)
    spans = [
        value * np.log(item.upper / item.lower) if item.logarithmic else item.upper - item.lower
        for item, value in zip(parameters, vector.tolist(), strict=True)
    ]
    moves = np.sqrt(np.mean(jacobian[:, columns] ** 2, axis=0)) * np.array(spans)
    largest = np.max(moves, axis=1, initial=0.0)
    ranges = np.ptp(response[:, columns], axis=0)
    if own.data is not None:
        ranges = np.fmax(ranges, np.nanmax(own.data.values, axis=0) - np.nanmin(own.data.values, axis=0))
    sizes = moves / np.where(ranges > REST * largest, ranges, np.maximum(largest, 1e-300))[:, None]
    effects = dict(zip(map(own.named, parameters.names), np.nan_to_num(sizes).T.tolist(), strict=True))
    return Influences(tuple(channels[column] for column in columns), effects)


def _part(kept: Kept, source: Source, name: str) -> StudyMotion:
    study = study_of(kept, source.path, source.text)
    return kept.newest("part", (source, name), lambda: part(study, name))


def _columns(own: StudyMotion) -> list[int]:
    """Columns of the model that are shown: those of the data, or all."""
    assert own.model is not None
    channels = [channel.name for channel in own.model.channels]
    return [channels.index(name) for name in (channels if own.data is None else own.data.channels)]


def response_at(own: StudyMotion, values: Mapping[str, float]) -> np.ndarray:
    """Return the channels that are shown, (samples, channels), at values of parameters by name."""
    assert own.model is not None
    found = own.model.evaluate(own.vector(values)[None])
    if found.failures[0] is not None:
        raise SolveError(found.failures[0])
    return found.values[0][:, _columns(own)]


def _motion(own: StudyMotion, values: Mapping[str, float]) -> "tuple[np.ndarray | None, tuple[Trajectory, np.ndarray]]":
    """Response and motion, by one simulation where the model reads its channels off a motion and does no more.

    The motion has its frames in some of its rows.
    """
    from dalembert.multibody import TimeResponse
    from dalembert.report.player.film import frames

    model, shown = own.model, frames(own.end)
    if not isinstance(model, TimeResponse):
        trajectory = own.motion(values, shown)
        return None if model is None else response_at(own, values), (trajectory, np.arange(len(shown)))
    times = np.union1d(shown, model.times)
    trajectory = own.motion(values, times)
    names = [channel.name for channel in model.channels]
    channels = trajectory.channels([names[column] for column in _columns(own)])
    return channels[np.searchsorted(times, model.times)], (trajectory, np.searchsorted(times, shown))


def _film(own: StudyMotion, trajectory: "Trajectory", rows: np.ndarray) -> dict[str, Any]:
    from dalembert.report.player.film import film_of
    from dalembert.report.sections.motion_sections import measured

    axes = "xyz"[: len(trajectory.system.AXES)]
    positions = {} if own.data is None else measured(own.data.channels, own.data.values, axes)
    return film_of(trajectory.drawing(), positions, rows)


def _misfit(own: StudyMotion, response: np.ndarray) -> tuple[float, dict[str, float]]:
    """Weighted sum of squares, with the weights of an identification, and root mean squares by channel."""
    data: Any = own.data
    given, residual = getattr(own.study.table, "weights", None), data.difference(response)
    if given is not None:
        weights = np.array([given[channel] for channel in data.channels])
    else:
        weights = np.ones(len(data.channels)) if data.deviations is None else data.deviations**-2.0
    squares = np.nansum(residual**2, axis=0)
    means = np.sqrt(squares / np.maximum(np.isfinite(residual).sum(axis=0), 1))
    return float(weights @ squares), dict(zip(data.channels, means.tolist(), strict=True))


def _followed(own: StudyMotion, values: Mapping[str, float], began: float) -> Simulated:
    """The curve of a structure over frequency."""
    from dalembert.report.charts import frequency_curve
    from dalembert.study.tasks.frequency_response import drawn_dofs

    table, curve = own.study.table, _curve_at(own, own.vector(values))
    seconds = perf_counter() - began
    figure = frequency_curve(curve, drawn_dofs(table, curve) or None, kind=table.amplitude, title="")
    return Simulated(curves=(Curves(figure=on_page(figure)),), seconds=seconds)


def _curve_at(own: StudyMotion, vector: np.ndarray, harmonics: int | None = None) -> "FrequencyCurve":
    from dalembert.study.tasks.frequency_response import balance_of, curve_options
    from dalembert.vibration import frequency_response

    study, method = own.study, balance_of(own.study)
    method = method if harmonics is None else replace(method, harmonics=harmonics)
    return frequency_response(study.system(vector), study.table.along, method, **curve_options(study))


def _over_frequency(own: StudyMotion, values: Mapping[str, float]) -> Influences:
    """Effects on amplitudes over given frequencies, by differences; none where the curves would take long.

    A curve that is followed by arc length has other points at other values, and no effects.
    """
    from dalembert.study.tasks.frequency_response import drawn_dofs
    from dalembert.vibration.paths.focus import movers

    vector, table, began = own.vector(values), own.study.table, perf_counter()
    first = _curve_at(own, vector)
    if (perf_counter() - began) * len(vector) > LONG or not first.converged.any():
        return Influences((), {})
    dofs = drawn_dofs(table, first) or movers(first)
    sizes, effects = _sizes(first, dofs, table.amplitude), {}
    ranges = np.nanmax(sizes, axis=0) - np.nanmin(sizes, axis=0)
    for place, item in enumerate(own.parameters):
        span = item.upper - item.lower
        step = DIFFERENCE * span * (-1.0 if vector[place] > (item.lower + item.upper) / 2 else 1.0)
        moved = vector.copy()
        moved[place] += step
        other = _curve_at(own, moved, first.orders[-1])
        if not np.array_equal(other.frequencies, first.frequencies):
            return Influences((), {})
        across = vector[place] * np.log(item.upper / item.lower) if item.logarithmic else span
        slopes = (_sizes(other, dofs, table.amplitude) - sizes) / step
        both = first.converged & other.converged
        moves = across * np.sqrt(np.mean(slopes[both] ** 2, axis=0)) if both.any() else np.zeros(len(dofs))
        effects[own.named(item.name)] = np.nan_to_num(moves / np.maximum(ranges, 1e-300)).tolist()
    return Influences(tuple(dofs), effects)


def _sizes(curve: "FrequencyCurve", dofs: tuple[str, ...], kind: str) -> np.ndarray:
    """Amplitudes (points, dofs); NaN where there are none."""
    columns = [np.where(curve.converged, curve.amplitude(dof, kind), np.nan) for dof in dofs]
    return np.stack(columns, axis=1)
