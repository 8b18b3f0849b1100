"""Surfaces of structures in three dimensions."""

from typing import Any

import numpy as np
import plotly.graph_objects as go

from dalembert.report.look import LIGHT

SHARP = 0.8
"""Cosine of the angle between the normals of two faces below which their common edge is drawn."""
MAGNIFIED = 0.1
"""Size that the largest displacement is drawn with, as part of the structure's."""


def surface(places: np.ndarray, faces: np.ndarray, sizes: np.ndarray, bar: str) -> go.Mesh3d | go.Scatter3d:
    """The faces, or the nodes where there are none, coloured by a size (nodes,) named on the bar."""
    x, y, z = places.T.astype(np.float32)
    scale = {"colorscale": "Viridis", "cmin": 0.0, "cmax": float(sizes.max(initial=0.0)) or 1.0}
    side = {"title": {"text": bar, "side": "right"}, "thickness": 12, "outlinewidth": 0, "len": 0.7}
    if not len(faces):
        marker = {"size": 4, "color": sizes.astype(np.float32), "colorbar": side, **scale}
        return go.Scatter3d(x=x, y=y, z=z, mode="markers", marker=marker, showlegend=False)
    i, j, k = triangles(faces).T
    look = {
        "lighting": {"ambient": 0.75, "diffuse": 0.5, "specular": 0.05},
        "hovertemplate": "x %{x:.4g}, y %{y:.4g}, z %{z:.4g}: %{intensity:.4g}<extra></extra>",
        "colorbar": side,
    }
    return go.Mesh3d(x=x, y=y, z=z, i=i, j=j, k=k, intensity=sizes.astype(np.float32), **scale, **look)


def outline(places: np.ndarray, faces: np.ndarray) -> go.Scatter3d:
    """The free and the sharp edges of the structure at rest, as one thin line with gaps."""
    ends = edges(places, faces)
    lines = np.full((len(ends), 3, 3), np.nan, dtype=np.float32)
    lines[:, :2] = places[ends]
    x, y, z = lines.reshape(-1, 3).T
    line = {"color": LIGHT.muted, "width": 2}
    return go.Scatter3d(x=x, y=y, z=z, mode="lines", line=line, hoverinfo="skip", showlegend=False, name="at rest")


def triangles(faces: np.ndarray) -> np.ndarray:
    """Triangles (count, 3) of faces of three or four corners.

    >>> triangles(np.array([[0, 1, 2, 3]])).tolist()
    [[0, 1, 2], [0, 2, 3]]
    """
    return np.concatenate([faces[:, [0, second, second + 1]] for second in range(1, faces.shape[1] - 1)])


def edges(places: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Ends (edges, 2) of the edges of one face alone, and of those where two faces meet at an angle.

    >>> corners = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [2, 1, 0]])
    >>> len(edges(corners, np.array([[0, 1, 2, 3], [1, 4, 5, 2]])))  # not the one between them
    6
    """
    if not len(faces):
        return np.zeros((0, 2), dtype=int)
    sides = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
    first, second, third = (places[faces[:, corner]] for corner in (0, 1, 2))
    normals = np.cross(second - first, third - first)
    normals = np.repeat(normals / np.linalg.norm(normals, axis=1, keepdims=True), faces.shape[1], axis=0)
    ends, own, counts = np.unique(np.sort(sides, axis=1), axis=0, return_inverse=True, return_counts=True)
    order = np.argsort(own.ravel(), kind="stable")
    begins = np.cumsum(counts) - counts
    drawn = counts != 2
    pairs = np.flatnonzero(counts == 2)
    one, other = (normals[order[begins[pairs] + place]] for place in (0, 1))
    # Neighbouring faces may be numbered in opposite senses, so only the axes of their normals count.
    drawn[pairs] = np.abs(np.einsum("ij,ij->i", one, other)) < SHARP
    return ends[drawn]


def space(figure: go.Figure, positions: np.ndarray) -> None:
    """Give a figure equal axes that hold positions (points, 3), m."""
    low, high = positions.min(axis=0), positions.max(axis=0)
    longest = float(np.max(high - low)) or 1.0
    low, high = low - 0.02 * longest, high + 0.02 * longest
    axis = {"gridcolor": LIGHT.grid, "color": LIGHT.muted, "showbackground": False, "zeroline": False, "nticks": 4}
    scene: dict[str, Any] = {
        f"{name}axis": {**axis, "title": f"{name} (m)", "range": [float(low[at]), float(high[at])]}
        for at, name in enumerate("xyz")
    }
    scene["aspectmode"] = "manual"
    scene["aspectratio"] = {name: float((high - low)[at]) / longest for at, name in enumerate("xyz")}
    scene["camera"] = {"eye": {"x": 0.8, "y": -1.25, "z": 0.85}, "center": {"x": 0, "y": 0, "z": -0.08}}
    figure.update_layout(scene=scene, margin={"l": 0, "r": 0, "b": 0})


def magnification(places: np.ndarray, sizes: np.ndarray) -> float:
    """Factor with which displacements of the given sizes are drawn."""
    most = float(sizes.max(initial=0.0))
    return MAGNIFIED * float(np.linalg.norm(np.ptp(places, axis=0))) / most if most > 0 else 1.0
