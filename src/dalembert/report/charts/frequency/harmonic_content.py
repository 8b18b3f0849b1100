"""Harmonics of a motion over frequency."""

import numpy as np
import plotly.graph_objects as go

from dalembert.report.charts.drawing import colour_of, draw, logarithmic, positive
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.prefixes import prefixed
from dalembert.report.quantities import labelled
from dalembert.units import unit_of
from dalembert.vibration import FrequencyCurve

NOTHING = 1e-6
"""Size of a harmonic, as part of the largest, below which it is left out."""


def harmonic_content(curve: FrequencyCurve, dof: str, *, title: str | None = None) -> go.Figure:
    """Amplitude of each harmonic of a degree of freedom over frequency, on a logarithmic scale.

    Harmonics that never reach a millionth of the largest are left out.

    Parameters
    ----------
    curve : FrequencyCurve
    dof : str
    title : str, optional

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    InputError
        For a degree of freedom that was not observed.
    """
    sizes = {order: np.where(curve.converged, size, np.nan) for order, size in by_order(curve, dof).items()}
    most = max(float(np.nanmax(size, initial=0.0)) for size in sizes.values())
    factor, unit = prefixed(most, unit_of(dof))
    figure = go.Figure()
    for place, (order, size) in enumerate(sizes.items()):
        if not np.nanmax(size, initial=0.0) > NOTHING * most:
            continue
        y = factor * np.where(size > NOTHING * most, positive(size), np.nan)
        name, width = "mean" if order == 0 else f"harmonic {order}", 2 if order == 1 else 1.5
        dash = ("solid", "dash", "dot")[min(place // len(LIGHT.series), 2)]
        draw(figure, curve.frequencies, y, name, colour_of(place), width, line_dash=dash)
    y = {"title": labelled("amplitude", unit), **logarithmic(figure)}
    return themed(figure, title or f"Harmonics of {plain(dof)}", 400, x="frequency (Hz)", y=y, showlegend=True)


def by_order(curve: FrequencyCurve, dof: str) -> dict[int, np.ndarray]:
    """Amplitude of each harmonic, of the mean its size, (points,)."""
    coefficients, mean = curve.harmonics(dof), int(curve.orders[0] == 0)
    sizes = {0: np.abs(coefficients[:, 0])} if mean else {}
    for number, order in enumerate(curve.orders[mean:]):
        place = mean + 2 * number
        sizes[order] = np.hypot(coefficients[:, place], coefficients[:, place + 1])
    return sizes
