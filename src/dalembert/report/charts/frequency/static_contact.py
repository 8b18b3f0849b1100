"""Normal forces and friction over an interface at rest."""

import numpy as np
import plotly.graph_objects as go

from dalembert.report.charts.frequency.interface_map import outline
from dalembert.report.look import LIGHT, plain, themed
from dalembert.tables import prefixed
from dalembert.vibration import StaticContact
from dalembert.vibration.laws.friction_law import SEPARATED, SLIPPING, STATES

SIZE, SMALL, MANY = 18, 9, 60
"""Diameters of contacts: of few, and of more than ``MANY``."""


def normal_forces(joint: StaticContact, *, title: str = "Normal forces over the interface") -> go.Figure:
    """Contacts from above, coloured by their normal forces; those that slip have a ring, open ones are hollow.

    Parameters
    ----------
    joint : StaticContact
        Its structure says where its nodes are.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    here = np.asarray(np.isfinite(joint.contact_places).all(axis=1))
    places, normal, states = joint.contact_places[here], np.asarray(joint.normal)[here], joint.states[here]
    wide = np.sort(np.argsort(-np.ptp(places, axis=0), kind="stable")[:2])
    factor, unit = prefixed(float(normal.max(initial=0.0)), "N")
    names = [name for name, there in zip(joint.contacts, here, strict=True) if there]
    text = [
        f"{plain(name)}: {STATES[state]}, {factor * force:.3g} {unit}, friction {factor * rub:.3g} {unit}"
        for name, state, force, rub in zip(names, states, normal, joint.friction[here], strict=True)
    ]
    figure = go.Figure([outline(joint.places, joint.faces, wide)])
    marker = {
        "size": SIZE if len(normal) <= MANY else SMALL,
        "color": factor * normal,
        "colorscale": "Viridis",
        "cmin": 0.0,
        "colorbar": {"title": unit},
        "symbol": ["circle-open" if state == SEPARATED else "circle" for state in states],
        "line": {"width": [2.5 if state == SLIPPING else 0.5 for state in states], "color": LIGHT.ink},
        "opacity": 1,
    }
    x, y = places[:, wide].T
    figure.add_scatter(
        x=x, y=y, mode="markers", marker=marker, text=text, hovertemplate="%{text}<extra></extra>", showlegend=False
    )
    low, high = places[:, wide].min(axis=0), places[:, wide].max(axis=0)
    margin = 0.08 * float((high - low).max() or 1.0)
    across, up = (
        {"title": f"{'xyz'[axis]} (m)", "range": [low[place] - margin, high[place] + margin]}
        for place, axis in enumerate(wide)
    )
    return themed(figure, title, 420, x=across | {"constrain": "domain"}, y=up | {"scaleanchor": "x", "scaleratio": 1})
