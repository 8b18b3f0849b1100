"""Energy that contacts take from the motion, over frequency."""

import numpy as np
import plotly.graph_objects as go

from dalembert.report.focus import dissipation_of, foremost
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.prefixes import prefixed
from dalembert.report.quantities import labelled
from dalembert.vibration import FrequencyCurve


def dissipation(curve: FrequencyCurve, *, title: str = "Friction energy of a period") -> go.Figure:
    """Energy dissipated in a period by each contact, of many those that take most, and by all together.

    Parameters
    ----------
    curve : FrequencyCurve
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    energies = dissipation_of(curve)
    total = np.sum(list(energies.values()), axis=0)
    factor, unit = prefixed(float(np.nanmax(total, initial=0.0)), "J")
    kept = foremost({name: float(np.nanmax(energy, initial=0.0)) for name, energy in energies.items()})
    lines = {plain(name): (energies[name], LIGHT.series[place]) for place, name in enumerate(kept)}
    if len(energies) > 1:
        lines[f"all {len(energies)} contacts"] = total, LIGHT.ink
    figure = go.Figure()
    for name, (energy, colour) in lines.items():
        figure.add_scatter(
            x=curve.frequencies, y=factor * energy, name=name, mode="lines", line={"color": colour, "width": 2}
        )
    themed(figure, title, height=360)
    figure.update_xaxes(title="frequency (Hz)")
    return figure.update_yaxes(title=labelled("energy of a period", unit), rangemode="tozero").update_layout(
        showlegend=True
    )
