"""Computed channels over the data, with what a page needs to move their lines without drawing the figure again."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import plotly.graph_objects as go

from dalembert.quantities import by_quantity, common, quantity
from dalembert.report.charts.drawing import colour_of, draw
from dalembert.report.look import plain, themed
from dalembert.report.thinning import thinned
from dalembert.studio.simulation.simulated_parts import StudyMotion
from dalembert.tables import labelled

HEIGHT = 320


@dataclass(frozen=True)
class Curves:
    """A figure, or the lines of it that changed. ``lines`` has abscissae and ordinates by the number of the trace.
    ``figure`` is Plotly's JSON; it is empty where only lines changed.
    """

    lines: dict[int, tuple[list[float], list[float]]] = field(default_factory=dict)
    figure: dict[str, Any] = field(default_factory=dict)


def curves(part: StudyMotion, response: np.ndarray, *, figures: bool) -> tuple[Curves, ...]:
    """Return the channels (samples, channels) of a part in figures by their quantity."""
    names = _channels(part)
    return tuple(_group(part, group, response, figures) for group in by_quantity(names))


def _channels(part: StudyMotion) -> tuple[str, ...]:
    if part.data is not None:
        return part.data.channels
    return () if part.model is None else tuple(channel.name for channel in part.model.channels)


def _group(part: StudyMotion, group: Sequence[str], response: np.ndarray, figures: bool) -> Curves:
    columns = [_channels(part).index(name) for name in group]
    if part.data is None:
        assert part.model is not None
        lines = [thinned(part.model.coordinate.values, response[:, column]) for column in columns]
        return Curves(_numbered(lines, 1), _plain(part, group, lines) if figures else {})
    from dalembert.inverse import ExperimentFit
    from dalembert.report.charts.identification.responses import computed_line, residual_line, responses

    fit = ExperimentFit("", part.data, response, np.ones_like(response))
    lines = [line for column in columns for line in (computed_line(fit, column), residual_line(fit, column))]
    figure = responses(fit, group, title="").update_layout(height=HEIGHT) if figures else None
    numbered = {3 * (place // 2) + place % 2 + 1: _listed(line) for place, line in enumerate(lines)}
    return Curves(numbered, on_page(figure) if figure else {})


def _plain(part: StudyMotion, group: Sequence[str], lines: Sequence[tuple[np.ndarray, np.ndarray]]) -> dict[str, Any]:
    """The figure of channels that are compared with no data."""
    assert part.model is not None
    figure, along = go.Figure(), part.model.coordinate
    units = {channel.name: channel.unit for channel in part.model.channels}
    for place, (name, line) in enumerate(zip(group, lines, strict=True)):
        draw(figure, *line, plain(name), colour_of(place))
    label = common((quantity(name, plain(units[name])) for name in group), "response")
    themed(figure, "", HEIGHT, x=labelled(along.name, along.unit), y=label, hovermode="x unified", showlegend=True)
    return on_page(figure)


def on_page(figure: go.Figure) -> dict[str, Any]:
    """The figure as a page of the studio takes it."""
    from dalembert.studio.runs.figures import bare, on_any_page

    return bare(on_any_page(figure))


def _numbered(lines: Sequence[tuple[np.ndarray, np.ndarray]], apart: int) -> dict[int, tuple[list[float], list[float]]]:
    return {apart * place: _listed(line) for place, line in enumerate(lines)}


def _listed(line: tuple[np.ndarray, np.ndarray]) -> tuple[list[float], list[float]]:
    x, y = line
    return x.tolist(), y.tolist()
