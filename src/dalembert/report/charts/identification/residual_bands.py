"""Bands that were given beside those that identified intervals reproduce, and what is left over."""

from collections.abc import Sequence

import plotly.graph_objects as go

from dalembert.inverse import BandFit
from dalembert.report.charts.bounds.bands import draw_band, draw_line, dressed, selected
from dalembert.report.charts.drawing import colour_of, stacked
from dalembert.report.look import LIGHT, plain

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
    for side, found in reproduced(fit).items():
        values, given = found[:, column], getattr(fit.bands, side)[:, column]
        draw_line(figure, at, values, f"{name} reproduced, {side}", name, LIGHT.ink, row=1, line_dash="dash")
        residual, dash = values - given, DASHES[side]
        draw_line(figure, at, residual, f"{name} residual, {side}", name, colour, row=2, line_dash=dash)


def reproduced(fit: BandFit) -> dict:
    """Lower and upper bounds (samples, channels) as true runs give them, or the surrogate where there were none."""
    lower = fit.lower if fit.checked_lower is None else fit.checked_lower
    upper = fit.upper if fit.checked_upper is None else fit.checked_upper
    return {"lower": lower, "upper": upper}
