"""A set of parameters as the boxes that pave it, in the plane of two of them."""

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Any

import numpy as np
import plotly.graph_objects as go

from dalembert.errors import InputError, unknown
from dalembert.inverse import ParameterSet
from dalembert.report.charts.drawing import draw
from dalembert.report.look import LIGHT, faint, plain, themed
from dalembert.tables import labelled

MARGIN = 0.08
MOST_PLANES = 6


def paving(
    result: ParameterSet,
    plane: Sequence[str] | None = None,
    *,
    truth: Mapping[str, float] | None = None,
    title: str | None = None,
) -> go.Figure:
    """Boxes inside the set and boxes that its boundary passes, seen along all parameters but those of a plane.

    Of more than two parameters this is the projection: a point counts as inside where any box above it is, as boundary
    where only boundary boxes are. One parameter is drawn as a strip.

    Parameters
    ----------
    found : ParameterSet
    plane : sequence of one or two str, optional
        Parameters of the axes; the first two if not given.
    truth : mapping of str to float, optional
        A point to mark, such as the parameters that data were made with.
    title : str, optional

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    InputError
        For a parameter that the set does not have.
    """
    names = result.parameters.names
    chosen = tuple(names[:2] if plane is None else plane)
    for name in chosen:
        if name not in names:
            raise InputError(unknown("parameter", name, names, where="paving"))
    axes = [names.index(name) for name in chosen]
    edge = 0.5 if len(names) <= 2 else 0
    figure = go.Figure()
    for word, boxes, colour, opacity in (
        ("undecided", result.boundary, LIGHT.series[1], 0.22),
        ("consistent", result.inside, LIGHT.series[0], 0.6),
    ):
        name = f"{word} boxes" if len(names) <= 2 else f"{word}, projected"
        style: dict[str, Any] = {"fill": "toself", "fillcolor": faint(colour, opacity), "hoverinfo": "skip"}
        draw(figure, *rectangles(boxes[:, :, axes]), name, colour, edge, **style, showlegend=len(boxes) > 0)
    for word, box, dash in (("outer box", result.outer, "dash"), ("inner box", result.inner, "solid")):
        if box is not None:
            x, y = rectangles(np.stack([box.lower, box.upper])[None, :, axes])
            draw(figure, x, y, word, LIGHT.ink, line_dash=dash)
    _mark(figure, chosen, truth or {})
    seen = [result.parameters.items[axis] for axis in axes]
    settings = [
        {"title": labelled(plain(item.name), plain(item.unit)), "range": ends}
        for item, ends in zip(seen, _ranges(result, axes), strict=True)
    ]
    x, y = [*settings, {"visible": False, "range": [-0.2, 1.2]}][:2]
    title = f"Set of {' and '.join(map(plain, chosen))}" if title is None else title
    return themed(figure, title, 520 if axes[1:] else 220, x=x, y=y)


def planes(names: Sequence[str]) -> list[tuple[str, ...]]:
    """Return the planes in which to look at a set of parameters: each pair of them, the first few if there are many; of
    one parameter its axis.
    """
    return [*combinations(names, 2)][:MOST_PLANES] if len(names) > 1 else [tuple(names)]


def rectangles(boxes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return closed outlines, apart by NaN, of boxes (boxes, 2, 1 or 2) given by lower and upper ends; equal boxes
    once.
    """
    if boxes.shape[2] == 1:  # a strip of unit height
        boxes = np.concatenate([boxes, np.broadcast_to([[0.0], [1.0]], boxes.shape)], axis=2)
    boxes = np.unique(boxes, axis=0)
    (left, low), (right, high) = boxes[:, 0].T, boxes[:, 1].T
    gap = np.full(len(boxes), np.nan)
    x = np.stack([left, right, right, left, left, gap], axis=1)
    y = np.stack([low, low, high, high, low, gap], axis=1)
    return x.ravel(), y.ravel()


def _mark(figure: go.Figure, chosen: Sequence[str], truth: Mapping[str, float]) -> None:
    if set(chosen) <= set(truth):
        at = [*(truth[name] for name in chosen), 0.5][:2]
        marker = {"symbol": "x-thin", "size": 12, "line": {"width": 2.5, "color": LIGHT.ink}}
        figure.add_scatter(x=at[:1], y=at[1:], name="true", mode="markers", marker=marker)


def _ranges(result: ParameterSet, axes: Sequence[int]) -> list[list[float]]:
    """Range of each axis: the outer box with a margin, or all that was searched where there is no set."""
    box: Any = result.parameters if result.outer is None else result.outer
    width = np.where(box.upper > box.lower, box.upper - box.lower, 1e-9 * result.parameters.scale)
    return [[float(box.lower[k] - MARGIN * width[k]), float(box.upper[k] + MARGIN * width[k])] for k in axes]
