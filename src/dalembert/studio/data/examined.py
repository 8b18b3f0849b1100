"""Content of the panel of measured data, computed in a separate process, since files may be large."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from dalembert.data.guesses import Unit
from dalembert.data.preview import Preview, PreviewColumn, preview, without
from dalembert.data.problems import outliers, problems
from dalembert.data.text_layout import AUTO, is_number
from dalembert.errors import DalembertError, InputError
from dalembert.findings import Finding
from dalembert.report.thinning import thinned
from dalembert.studio.data.choices import Choices, Key, guessed, table_of
from dalembert.studio.editor.reading import study_of
from dalembert.studio.worker import Kept

POINTS = 1000
"""Most points of a curve."""
MOST_SAMPLES = 20_000
"""Samples up to which data are compared with the response at the first guesses."""


@dataclass(frozen=True, eq=False)
class Curve:
    """A column over the times, with its chosen or guessed unit. ``along``, ``values`` (points,), thinned so that peaks
    stay: time from the beginning of the motion, s, or number of the row if neither a column nor a sampling rate gives
    times; and values as in the file. ``far`` (2, points): the same of outliers; ``missing``: cells without a value.
    """

    key: Key
    unit: Unit
    along: np.ndarray
    values: np.ndarray
    far: np.ndarray
    missing: int


@dataclass(frozen=True, eq=False)
class Examined:
    """A file as it is read with some choices, which may be guessed. ``channels``: of the model, with SI units;
    ``layout``: of a text file, in words; ``separator``, ``decimal``: ``""`` where the file is no text; ``first``: cells
    of the first rows; ``begins``: first time, s; ``table``: the `[data]` table, empty if it lacks what ``lacks`` says.
    """

    choices: Choices
    channels: Mapping[str, str]
    layout: str
    separator: str
    decimal: str
    first: tuple[tuple[str, ...], ...]
    samples: int
    curves: tuple[Curve, ...]
    begins: float
    findings: tuple[Finding, ...]
    table: Mapping[str, Any]
    lacks: str = ""


def examine(kept: Kept, study: Path, text: str, file: str, choices: Choices | None, before: Choices | None) -> Examined:
    """Return how a file is read with some choices, or with guessed ones. ``kept`` keeps the file and the study that
    were read last. ``text`` is that of the study, ``file`` a name beside the study. ``before`` are choices of another
    file, which are kept if this one has the same columns.
    """
    channels = kept.newest("channels", text, lambda: _channels(kept, study, text))
    marks = (AUTO, AUTO, ()) if choices is None else (choices.separator, choices.decimal, tuple(choices.absent))
    path = study.parent / file
    stamp = (path.stat().st_mtime_ns, path.stat().st_size) if path.is_file() else None
    file_preview = kept.newest("data file", (path, *marks, stamp), lambda: preview(path, *marks))
    choices = guessed(file_preview, channels, before) if choices is None else choices
    if choices.time == "t" and file_preview.column("t") is None and file_preview.column(1) is not None:
        choices = replace(choices, time=1)  # the first column of a file without names
    file_preview = without(file_preview, [float(word) for word in choices.absent if is_number(word)], choices.time)
    use = choices.use(file_preview, channels)
    times = None if choices.time is None else file_preview.column(choices.time)
    along = _along(choices, file_preview.samples) if times is None else times.values * use.factor(choices.time)
    begins = float(along[0]) if len(along) else 0.0
    start = use.start if isinstance(use.start, (int, float)) else begins if use.start == "first" else 0.0
    table, lacks = _table(choices, file_preview)
    return Examined(
        choices,
        channels,
        file_preview.layout,
        file_preview.separator,
        file_preview.decimal,
        file_preview.first,
        file_preview.samples,
        tuple(_curve(column, choices, file_preview, along - start) for column in file_preview.columns),
        begins,
        tuple(problems(file_preview, use)),
        table,
        lacks,
    )


def _along(choices: Choices, samples: int) -> np.ndarray:
    """Times of samples at the sampling rate; their numbers where there is none."""
    rate = choices.rate
    return np.arange(1.0, samples + 1) if rate is None else np.arange(samples) / rate


def compare(kept: Kept, study: Path, text: str) -> tuple[Finding, ...]:
    """Return what the response at the first guesses makes suspect in the data of a study: units and zeros.

    Parameters
    ----------
    kept : Kept
    study : Path
    text : str
        Of the study.
    """
    return kept.newest("comparison", (study, text), lambda: tuple(_suspect(study, text)))


def _channels(kept: Kept, study: Path, text: str) -> dict[str, str]:
    """Channels of the study's model with their units; none while the study has mistakes."""
    from dalembert.study.channels import channel_units

    try:
        return channel_units(study_of(kept, study, text))
    except DalembertError:
        return {}


def _suspect(study: Path, text: str) -> Iterator[Finding]:
    """Findings on suspicious readings, except offsets that the study identifies."""
    from dalembert.inverse.plausibility.suspect_offsets import first_findings
    from dalembert.study.tables.sensor_table import reads

    try:
        candidate = study_of(Kept(), study, text)  # not that of the page, since the data differ
        data = candidate.data()
        if candidate.task != "identify" or len(data.coordinate.values) > MOST_SAMPLES:
            return
        suspects = first_findings(candidate.forward(data.channels, data.coordinate.values), data)
    except DalembertError:  # the page says what is wrong with the study
        return
    offsets = [name for name, sensor in candidate.file.sensors.items() if sensor.offset is not None]
    for finding in suspects:
        known = any(reads(name, [finding.values["channel"]]) for name in offsets)
        if finding.code != "suspect-offset" or not known:
            yield finding


def _table(choices: Choices, file_preview: Preview) -> tuple[dict[str, Any], str]:
    """The `[data]` table, or what it lacks."""
    try:
        return table_of(choices, file_preview), ""
    except InputError as error:
        return {}, str(error)


def _curve(column: PreviewColumn, choices: Choices, file_preview: Preview, along: np.ndarray) -> Curve:
    far = np.zeros((2, 0))
    if column.key in choices.channels.values():
        finite = np.flatnonzero(np.isfinite(column.values))
        rows = finite[outliers(column.values[finite])][:POINTS]
        far = np.stack([along[rows], column.values[rows]])
    points = thinned(along, column.values, POINTS)
    return Curve(column.key, choices.unit(file_preview, column.key), *points, far, column.missing)
