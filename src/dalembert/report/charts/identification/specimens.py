"""Values of a parameter in all specimens, beside their mean and what a new specimen may have."""

import numpy as np
import plotly.graph_objects as go

from dalembert.inverse import Population
from dalembert.report.look import LIGHT, plain, themed
from dalembert.tables import labelled


def specimens(population: Population, name: str, *, title: str = "") -> go.Figure:
    """Each specimen's value with two standard deviations, as it was identified and adjusted by the others.

    The line is the mean; the band contains the value of a new specimen with the probability ``told.level``.

    Parameters
    ----------
    told : Population
    name : str
        Of the parameter.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    place, (lower, upper) = population.names.index(name), population.prediction[name]
    rows, places = np.arange(len(population.specimens)), {"tickvals": list(range(len(population.specimens)))}
    figure = go.Figure()
    figure.add_vrect(lower, upper, fillcolor=LIGHT.series[0], opacity=0.12, line_width=0)
    figure.add_vline(float(population.mean[place]), line={"color": LIGHT.series[0], "width": 1.5})
    shown = (
        ("identified", population.values, population.deviations),
        ("adjusted", population.adjusted, population.adjusted_deviations),
    )
    for number, (words, values, deviations) in enumerate(shown):
        figure.add_scatter(
            x=values[:, place],
            y=rows + 0.25 * number,
            error_x={"array": 2 * deviations[:, place], "width": 4},
            mode="markers",
            name=words,
            marker={"color": LIGHT.series[1 - number], "size": 8, "symbol": ("circle-open", "circle")[number]},
        )
    axis = {
        **places,
        "ticktext": [plain(specimen) for specimen in population.specimens],
        "autorange": "reversed",
        "showgrid": False,
    }
    height = 170 + 38 * len(rows)
    return themed(
        figure,
        title or f"{plain(name)} in {len(rows)} specimens",
        height,
        x=labelled(name, population.units[place]),
        y=axis,
    )
