"""The mechanism in motion: drawn to scale, with play button, slider and the paths of chosen points."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import plotly.graph_objects as go

from dalembert.multibody import Drawing
from dalembert.report.charts.drawing import colour_of
from dalembert.report.charts.frequency.shapes import space
from dalembert.report.charts.motion.playback import Playback
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.scene.mechanism import FEW_BODIES
from dalembert.report.scene.motion import motion_scene, unfolded
from dalembert.report.scene.scene import Primitive, Scene

WIDTHS = {"outline": (3, 2), "path": (1.5, 3), "body": (5, 7), "axis": (0, 4)}
"""Widths in pixels of lines in the plane and in space, by their role."""
FLAT = 0.3
"""Smallest side of the drawn box as part of its largest one."""
EYE = {"x": 0.85, "y": -1.35, "z": 0.6}
"""Where the drawing is seen from, in its own size."""


def mechanism(
    drawing: Drawing,
    *,
    paths: Mapping[str, np.ndarray] | None = None,
    measured: Mapping[str, np.ndarray] | None = None,
    title: str = "Mechanism",
) -> go.Figure:
    """Animation of a mechanism in the plane or in space, with equal axes and a range that holds the whole motion.

    Played at 25 frames a second in real time where that takes 2 s to 6 s, else slower or faster, as its caption says;
    at most 150 frames. Faint outlines show the motion where nothing moves: in print and at rest.

    In space, bodies that have shapes are drawn with them, up to seven bodies with their axes, and the mouse turns the
    figure.

    Parameters
    ----------
    drawing : Drawing
        Lines (frames, points, 2 or 3) and joints (frames, 2 or 3), by name, in m, at times (frames,) in s.
    paths : mapping of str to array, shape (samples, 2 or 3), optional
        Paths of points, in m.
    measured : mapping of str to array, shape (samples, 2 or 3), optional
        Measured positions of points, in m, drawn as crosses.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> angle = np.linspace(0, 1, 51)
    >>> rod = np.stack([np.zeros((51, 2)), np.stack([np.sin(angle), -np.cos(angle)], axis=1)], axis=1)
    >>> swing = SimpleNamespace(times=np.linspace(0, 2, 51), lines={"rod": rod}, joints={"O": rod[:, 0]})
    >>> len(mechanism(swing).frames)
    50
    """
    playback = Playback.of(np.asarray(drawing.times, dtype=float))
    scene = motion_scene(drawing, playback.frames, paths=paths or {}, measured=measured or {})
    in_space = scene.dimensions == 3
    by_role: dict[str, list[Primitive]] = {}
    for shape in _few_surfaces(scene.primitives):
        is_folded = in_space and shape.kind == "line"  # which WebGL cannot draw
        by_role.setdefault(shape.role, []).append(replace(shape, points=unfolded(shape.points)) if is_folded else shape)
    joints, bodies, axes = (by_role.pop(role, []) for role in ("joint", "body", "axis"))
    fixed = [shape for shape in joints if shape.kind == "ground"]
    moving = [shape for shape in joints if shape.kind == "joint"]
    still = [shape for shapes in by_role.values() for shape in shapes]
    ground = _joints("fixed to ground", fixed, "square" if in_space else "triangle-up", LIGHT.muted, in_space)
    traces = [
        *(_trace(shape) for shape in still),
        ground,
        *(_trace(shape) for shape in bodies),
        _joints("joints", moving, "circle", LIGHT.ink, in_space),
        *(_trace(shape) for shape in axes),
    ]
    figure = go.Figure(traces)
    first = len(still) + 1
    figure.frames = [
        go.Frame(
            name=str(name),
            traces=list(range(first, len(traces))),
            data=[
                *({"type": _kind(shape), **_coordinates(shape, frame)} for shape in bodies),
                {"type": "scatter3d" if in_space else "scatter", **_positions(moving, frame, scene.dimensions)},
                *({"type": _kind(shape), **_coordinates(shape, frame)} for shape in axes),
            ],
        )
        for frame, name in enumerate(playback.frames)
    ]
    box = _box(scene)
    if in_space:
        space(figure, box.T)
        figure.update_layout(scene_camera={"eye": EYE, "center": {"x": 0, "y": 0, "z": -0.06}})
        return themed(figure, title, 560, **replace(playback.film, redraw=True, y=0).controls())
    across = {"title": "x (m)", "range": box[0].tolist()}
    up = {"title": "y (m)", "range": box[1].tolist(), "scaleanchor": "x", "scaleratio": 1}
    return themed(figure, title, 520, x=across, y=up, **playback.film.controls())


def _few_surfaces(shapes: Sequence[Primitive]) -> list[Primitive]:
    """Shapes with the surfaces of many bodies as one."""
    surfaces = [shape for shape in shapes if shape.kind == "surface" and shape.role == "body"]
    if len(surfaces) <= FEW_BODIES:
        return [replace(shape, points=shape.positions, poses=None) for shape in shapes]
    first = np.cumsum([0, *(shape.points.shape[1] for shape in surfaces)])
    faces = np.concatenate([shape.faces + number for shape, number in zip(surfaces, first, strict=False)])
    points = np.concatenate([shape.positions for shape in surfaces], axis=1)
    lines = sum(shape.role == "body" for shape in shapes) - len(surfaces)
    joined = Primitive("surface", "body", f"{len(surfaces)} bodies with shapes", points, lines, faces)
    place = next(k for k, shape in enumerate(shapes) if shape is surfaces[0])
    remaining = [shape for shape in shapes if not any(shape is surface for surface in surfaces)]
    return [*remaining[:place], joined, *remaining[place:]]


def _trace(shape: Primitive) -> go.Scatter | go.Scatter3d | go.Mesh3d:
    """A line, a surface or crosses in the first frame."""
    in_space, name = shape.points.shape[2] == 3, plain(shape.name)
    kind = go.Scatter3d if in_space else go.Scatter
    at = _coordinates(shape, 0)
    if shape.kind == "surface":
        assert shape.faces is not None
        i, j, k = shape.faces.T
        light = {"ambient": 0.65, "diffuse": 0.6, "specular": 0.1}
        return go.Mesh3d(
            **at, i=i, j=j, k=k, color=LIGHT.muted if shape.role == "ground" else colour_of(shape.colour),
            flatshading=True, lighting=light, name=name or "ground", showlegend=True, hoverinfo="name",
        )  # fmt: skip
    if shape.kind == "crosses":
        thin = {"symbol": "x-thin", "size": 6, "line": {"width": 1.25, "color": LIGHT.ink}}
        marker = {"symbol": "x", "size": 2.5, "color": LIGHT.ink} if in_space else thin
        return kind(**at, name=f"{name} measured", mode="markers", marker=marker)
    line: dict[str, Any] = {"width": WIDTHS[shape.role][in_space]}
    if shape.role == "outline":
        return kind(**at, mode="lines", line={**line, "color": LIGHT.grid}, hoverinfo="skip", showlegend=False)
    if shape.role == "path":
        dots = {} if in_space else {"dash": "dot"}
        return kind(**at, mode="lines", line={**line, **dots, "color": LIGHT.muted}, name=f"path of {name}")
    line["color"] = colour_of(shape.colour)
    if shape.role == "axis":
        return kind(**at, mode="lines", line=line, name=f"{name} axis", hoverinfo="skip")
    return kind(**at, mode="lines", line=line, name=name, hoverinfo="name")


def _joints(name: str, joints: Sequence[Primitive], symbol: str, colour: str, in_space: bool) -> Any:
    """All joints that move, or all that do not, as one trace."""
    ring = {"size": 10, "color": LIGHT.surface, "line": {"width": 2, "color": colour}}
    marker = {"symbol": symbol, **({"size": 5, "color": colour} if in_space else ring)}
    kind = go.Scatter3d if in_space else go.Scatter
    return kind(
        **_positions(joints, 0, 3 if in_space else 2), name=name, mode="markers", marker=marker,
        text=[plain(joint.name) for joint in joints], hoverinfo="text", showlegend=bool(joints),
    )  # fmt: skip


def _kind(shape: Primitive) -> str:
    return "mesh3d" if shape.kind == "surface" else "scatter3d" if shape.points.shape[2] == 3 else "scatter"


def _coordinates(shape: Primitive, frame: int) -> dict[str, np.ndarray]:
    return dict(zip("xyz", shape.points[frame].astype(np.float32).T, strict=False))


def _positions(joints: Sequence[Primitive], frame: int, dimensions: int) -> dict[str, np.ndarray]:
    at = np.array([joint.points[min(frame, len(joint.points) - 1), 0] for joint in joints], dtype=np.float32)
    return dict(zip("xyz", at.reshape(-1, dimensions).T, strict=False))


def _box(scene: Scene) -> np.ndarray:
    """Range (2 or 3, 2) of the coordinates over the motion, no side much shorter than the others, with a margin."""
    positions = scene.positions
    low, high = positions.min(axis=0), positions.max(axis=0)
    size = max(float((high - low).max()), 1e-9)
    more = np.maximum(FLAT * size - (high - low), 0.0) / 2 + 0.06 * size
    return np.stack([low - more, high + more], axis=1)
