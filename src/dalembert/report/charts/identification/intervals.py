"""Intervals identified from bands, and the residuals of the bands."""

from collections.abc import Mapping, Sequence

import numpy as np
import plotly.graph_objects as go

from dalembert.inverse import BandFit
from dalembert.report.charts.bounds.bands import draw_band, draw_line, dressed, selected
from dalembert.report.charts.drawing import colour_of, draw, stacked
from dalembert.report.charts.identification.parameters import BETWEEN, side_of, tracks
from dalembert.report.look import LIGHT, plain, themed
from dalembert.tables import interval, shown


def intervals(
    fit: BandFit,
    truth: Mapping[str, tuple[float, float]] | None = None,
    *,
    title: str = "Intervals within the search bounds",
) -> go.Figure:
    """Each identified interval as a bar between the parameter's search bounds, its middle marked.

    A whisker extends from each end by two standard deviations of that end to both sides, on each side by at most the
    width of the search bounds. Diamonds are the ends of the true intervals if these are known.

    Parameters
    ----------
    fit : BandFit
    truth : mapping of str to (lower, upper), optional
        Intervals to compare with.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    box, low, high = fit.parameters, *(np.asarray(end, dtype=float) for end in (fit.box.lower, fit.box.upper))
    names = [plain(name) for name in box.names]
    figure = tracks(names)
    ends = np.stack([_placed(fit, low), _placed(fit, high)], axis=1)
    for place, (name, item) in enumerate(zip(names, box, strict=True)):
        text = f"{interval(low[place], high[place])} {plain(item.unit)}".strip()
        _bar(figure, name, ends[place], text, legend=place == 0)
    spread = 2 * end_deviations(fit) / (box.upper - box.lower)[:, None]
    style = {
        "marker": {"color": LIGHT.series[0], "size": 9, "symbol": "line-ns-open", "line": {"width": 2}},
        "error_x": {"array": np.minimum(spread, 1.0).ravel(), "color": LIGHT.ink, "width": 5},
    }
    place = {"x": ends.ravel(), "y": np.repeat(names, 2)}
    figure.add_scatter(**place, mode="markers", **style, hoverinfo="skip", showlegend=False)
    _diamonds(figure, fit, truth or {})
    x, y = {**BETWEEN, "range": [-0.05, 1.05]}, {"range": [len(box) - 0.5, -0.7], "showgrid": False}
    return themed(figure, title, 130 + 62 * len(box), x=x, y=y, margin_t=64)


def end_deviations(fit: BandFit) -> np.ndarray:
    """Standard deviations of the two ends, middle − radius and middle + radius, shape (parameters, 2).

    Those of a parameter whose middle or radius is not identifiable are infinite.
    """
    middle, radius = np.asarray(fit.middle_deviations, dtype=float), np.asarray(fit.radius_deviations, dtype=float)
    correlation = np.array([_correlation(fit, name) for name in fit.parameters.names])
    known = np.isfinite(middle) & np.isfinite(radius) & np.isfinite(correlation)
    middle, radius, correlation = (np.where(known, item, 0.0) for item in (middle, radius, correlation))
    variance = (middle**2 + radius**2)[:, None] + (2 * middle * radius * correlation)[:, None] * [-1, 1]
    return np.where(known[:, None], np.sqrt(np.maximum(variance, 0.0)), np.inf)


def _correlation(fit: BandFit, name: str) -> float:
    """Correlation of a parameter's middle and radius; 0 where the radius was not searched."""
    pair = [fit.unknowns.index(word) for word in (f"{name} middle", f"{name} radius") if word in fit.unknowns]
    return float(fit.correlation[pair[0], pair[1]]) if len(pair) == 2 else 0.0


def _bar(figure: go.Figure, name: str, ends: np.ndarray, text: str, *, legend: bool) -> None:
    style = {
        "mode": "lines+markers+text",
        "marker": {"size": [0, 7, 0], "color": LIGHT.surface},
        "text": ["", text, ""],
        "textposition": f"top {side_of(ends.mean())}",
        "cliponaxis": False,
        "hoverinfo": "text",
    }
    x, legend_keys = [ends[0], ends.mean(), ends[1]], {"legendgroup": "identified", "showlegend": legend}
    draw(figure, x, [name] * 3, "identified", LIGHT.series[0], 8, **legend_keys, **style)


def _diamonds(figure: go.Figure, fit: BandFit, truth: Mapping[str, tuple[float, float]]) -> None:
    known = [item for item in fit.parameters if item.name in truth]
    at = [(np.array(truth[item.name]) - item.lower) / (item.upper - item.lower) for item in known]
    names = [plain(item.name) for item in known for _ in range(2)]
    marker = {"symbol": "diamond-open", "size": 11, "color": LIGHT.series[1], "line": {"width": 2}}
    text = [shown(float(end)) for item in known for end in truth[item.name]]
    style = {"mode": "markers", "marker": marker, "text": text, "hoverinfo": "text", "showlegend": bool(known)}
    figure.add_scatter(x=np.ravel(at), y=names, name="true", **style)


def _placed(fit: BandFit, values: np.ndarray) -> np.ndarray:
    """How far on the way from its lower to its upper search bound each value lies, (parameters,)."""
    return (values - fit.parameters.lower) / (fit.parameters.upper - fit.parameters.lower)


DASHES = {"lower": "solid", "upper": "dot"}


def residual_bands(
    fit: BandFit, channels: Sequence[str] | None = None, *, title: str = "Given and reproduced bands"
) -> go.Figure:
    """Given bands filled, reproduced bounds dashed; below, reproduced minus given, lower bounds solid, upper dotted.

    Where the answer was checked by true runs, these are what is compared.

    Parameters
    ----------
    fit : BandFit
    channels : sequence of str, optional
        Channels to draw, all if not given; they share an axis.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    InputError
        For a channel that the bands do not have.
    """
    chosen = selected(fit.bands, channels, "residual_bands")
    figure = stacked(0.68, 0.32, spacing=0.05)
    for place, name in enumerate(chosen):
        _channel(figure, fit, fit.bands.channels.index(name), colour_of(place))
    return dressed(figure, fit.bands, chosen, title, below="residual")


def _channel(figure: go.Figure, fit: BandFit, column: int, colour: str) -> None:
    at, name = fit.bands.coordinate.values, plain(fit.bands.channels[column])
    draw_band(figure, fit.bands, column, colour, legend=", given")
    for side, reproduced in fit.reproduced.items():
        values, bands = reproduced[:, column], getattr(fit.bands, side)[:, column]
        draw_line(figure, at, values, f"{name} reproduced, {side}", name, LIGHT.ink, row=1, line_dash="dash")
        residual, dash = values - bands, DASHES[side]
        draw_line(figure, at, residual, f"{name} residual, {side}", name, colour, row=2, line_dash=dash)
