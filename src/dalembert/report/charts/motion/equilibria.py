"""Equilibria along a load: channels over the load, and the mechanism along the path."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import plotly.graph_objects as go

from dalembert.argument_readers import names_of
from dalembert.errors import require_known
from dalembert.multibody import EquilibriumPath
from dalembert.quantities import common, quantity
from dalembert.report.charts.drawing import colour_of, draw
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.player.animation import Animation
from dalembert.report.scene.path import path_scene
from dalembert.tables import labelled

SYMBOLS = {"limit": "circle-open", "branch": "diamond-open", "symmetric part": "square-open"}


def equilibrium_path(
    path: EquilibriumPath, channels: Sequence[str] | None = None, *, title: str = "Equilibria over the load"
) -> go.Figure:
    """Channels over the load: stable equilibria as solid lines, unstable ones dashed, and the critical points.

    Parameters
    ----------
    path : EquilibriumPath
    channels : sequence of str, optional
        Some of those that the path keeps; all if not given. They share an axis.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    figure, line = go.Figure(), path.line
    chosen = path.names if channels is None else names_of(channels, "equilibrium_path", "channels")
    for name in chosen:
        require_known("channel", name, path.names)
    columns = [path.names.index(name) for name in chosen]
    for place, (name, column) in enumerate(zip(chosen, columns, strict=True)):
        for number, (first, last) in enumerate(runs(line.stable)):
            x, y = line.loads[first : last + 1], line.values[first : last + 1, column]
            dash, label = "solid" if line.stable[first] else "dash", plain(name)
            draw(
                figure, x, y, label, colour_of(place), showlegend=number == 0, line_dash=dash, legendgroup=label
            )  # fmt: skip
    for kind in dict.fromkeys(point.kind for point in path.critical):
        at = [number for number, point in enumerate(path.critical) if point.kind == kind]
        loads = np.array([path.critical[number].load for number in at])
        marker = {"color": LIGHT.ink, "size": 11, "symbol": SYMBOLS[kind], "line": {"width": 2}}
        figure.add_scatter(
            x=np.tile(loads, len(columns)),
            y=path.critical_values[at][:, columns].T.ravel(),
            name=path.critical[at[0]].name,
            mode="markers",
            marker=marker,
        )
    units = [path.units[column] for column in columns]
    y = common([quantity(name, plain(unit)) for name, unit in zip(chosen, units, strict=True)], "response")
    return themed(figure, title, 420, x=labelled(plain(path.parameter), plain(path.unit)), y=y, showlegend=True)


def equilibria(path: EquilibriumPath, *, title: str = "Mechanism along the path") -> Animation:
    """The mechanism at equilibria along the path, and at each critical point; a slider takes one after another.

    Parameters
    ----------
    path : EquilibriumPath
        With its function ``build``.
    title : str

    Returns
    -------
    Animation
    """
    return Animation(path_scene(path), title)


def runs(stable: np.ndarray) -> list[tuple[int, int]]:
    """First and last nodes of parts of a line whose segments (nodes - 1,) are all stable, or all unstable.

    >>> runs(np.array([True, True, False, True]))
    [(0, 2), (2, 3), (3, 4)]
    """
    cuts = [0, *(np.flatnonzero(np.diff(stable)) + 1).tolist(), len(stable)]
    return list(pairwise(cuts))
