"""Structures in three dimensions: surfaces, deformed shapes and modes."""

from typing import TYPE_CHECKING, Any

import numpy as np
import plotly.graph_objects as go

from dalembert.report.charts.frequency.film_controls import Film
from dalembert.report.look import LIGHT, themed
from dalembert.report.player.playback import slowness
from dalembert.report.scene.structure import edges
from dalembert.structure import ModeShapes
from dalembert.tables import labelled, prefixed, shown

if TYPE_CHECKING:
    from dalembert.vibration import Deformation

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
    """Return triangles (count, 3) of faces of three or four corners.
    >>> triangles(np.array([[0, 1, 2, 3]])).tolist()
    [[0, 1, 2], [0, 2, 3]]
    """
    return np.concatenate([faces[:, [0, second, second + 1]] for second in range(1, faces.shape[1] - 1)])


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


FRAMES, FEW_FRAMES = 24, 12
MANY = 20_000
"""Numbers of a frame above which there are fewer of them."""
SECONDS = 2.0
STILL = 1e-3
"""Part of the largest displacement up to which an axis counts as still."""


def deformation(shape: "Deformation", *, title: str | None = None) -> go.Figure:
    """The structure over a period, magnified, coloured by the largest displacement of each node in the period.

    Parameters
    ----------
    shape : Deformation
    title : str, optional

    Returns
    -------
    plotly.graph_objects.Figure
    """
    moving = np.abs(shape.motion(2 * np.pi * np.arange(FRAMES) / FRAMES))
    along = np.flatnonzero(moving.max(axis=(0, 1), initial=0.0) > STILL * moving.max(initial=0.0))
    count = FEW_FRAMES if len(shape.places) * max(len(along), 1) > MANY else FRAMES
    motion = shape.motion(2 * np.pi * np.arange(count) / count)
    first = int(np.abs(motion).max(axis=(1, 2), initial=0.0).argmax())  # the largest deflection, to be seen in print
    order = np.roll(np.arange(count), -first)
    motion = motion[order]
    sizes = np.linalg.norm(motion, axis=2).max(axis=0)
    factor, unit = prefixed(float(sizes.max(initial=0.0)), "m")
    positions = shape.places + magnification(shape.places, sizes) * motion
    body = surface(positions[0], shape.faces, factor * sizes, labelled("largest displacement", unit))
    figure = go.Figure([outline(shape.places, shape.faces), body])
    figure.frames = [
        go.Frame(
            name=str(number),
            traces=[1],
            data=[{"type": body.type, **{"xyz"[axis]: frame[:, axis].astype(np.float32) for axis in along}}],
        )
        for number, frame in enumerate(positions)
    ]
    labels = [f"{360 * number / count:.0f}" for number in order]
    film = Film(labels, SECONDS, "phase", "°", slowness(SECONDS * shape.frequency), endless=True)
    space(figure, np.concatenate([positions.reshape(-1, 3), shape.places]))
    return themed(figure, title or f"Deformed shape at {shown(shape.frequency)} Hz", 520, **film.controls())


def magnified(shape: "Deformation") -> float:
    """How much larger than they are displacements are drawn."""
    motion = shape.motion(2 * np.pi * np.arange(FRAMES) / FRAMES)
    return magnification(shape.places, np.linalg.norm(motion, axis=2).max(axis=0))


MOST = 12
"""Modes that are drawn."""
SECONDS_A_MODE = 1.5


def mode_shapes(modes: ModeShapes, *, title: str = "Mode shapes") -> go.Figure:
    """Each mode at its largest deflection, coloured by the size of the displacement; a slider takes one after another.

    Parameters
    ----------
    modes : ModeShapes
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    shapes = np.asarray(modes.shapes)[:MOST]
    sizes = np.linalg.norm(shapes, axis=2)
    diagonal = float(np.linalg.norm(np.ptp(modes.places, axis=0)))
    positions = modes.places + MAGNIFIED * diagonal * shapes / sizes.max(axis=1)[:, None, None]
    body = surface(positions[0], modes.faces, sizes[0], "part of the largest displacement")
    figure = go.Figure([outline(modes.places, modes.faces), body])
    figure.frames = [
        go.Frame(name=str(number), traces=[1], data=[_frame(body, frame, size)])
        for number, (frame, size) in enumerate(zip(positions, sizes, strict=True))
    ]
    labels = [f"{number}: {shown(float(value))} Hz" for number, value in enumerate(modes.frequencies[: len(shapes)], 1)]
    film = Film(labels, SECONDS_A_MODE * len(labels), "mode", "")
    space(figure, np.concatenate([positions.reshape(-1, 3), modes.places]))
    return themed(figure, title, 520, **film.controls())


def _frame(body: go.Mesh3d | go.Scatter3d, positions: np.ndarray, sizes: np.ndarray) -> dict:
    """What changes of a surface from one mode to the next."""
    size = sizes.astype(np.float32)
    colour = {"intensity": size} if body.type == "mesh3d" else {"marker": {"color": size}}
    return {"type": body.type, **dict(zip("xyz", positions.T.astype(np.float32), strict=True)), **colour}
