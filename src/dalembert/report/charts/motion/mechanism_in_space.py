"""The mechanism in motion in space: bodies, their axes, joints and paths, to be turned with the mouse."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import plotly.graph_objects as go

from dalembert.multibody import Drawing
from dalembert.multibody.components.spatial.mesh_files import simplified
from dalembert.multibody.components.spatial.shapes import Surface
from dalembert.report.charts.drawing import colour_of
from dalembert.report.charts.frequency.shapes import space
from dalembert.report.charts.motion.outlines import NAMED_BODIES, bodies_of, outlines, path_of, unfolded
from dalembert.report.charts.motion.playback import Playback
from dalembert.report.look import LIGHT, plain, themed

CORNERS_A_FRAME = 2500
"""Corners of surfaces above which surfaces are simplified."""
FEWEST = 20
"""Corners of a surface below which bodies are drawn as lines."""
AXIS = 0.09
"""Length of the axes of a body as part of the drawing's size."""
STILL = 1e-9
"""Motion of a joint, as part of the drawing's size, below which it is fixed to the ground."""
FLAT = 0.3
"""Smallest side of the drawn box as part of its largest one."""
EYE = {"x": 0.85, "y": -1.35, "z": 0.6}
"""Where the drawing is seen from, in its own size."""
AXIS_COLOURS = LIGHT.series[1], LIGHT.series[2], LIGHT.series[0]
Meshes = dict[str, tuple[np.ndarray, np.ndarray]]
"""Corners (frames, corners, 3) and triangles by the names of bodies."""


def mechanism_in_space(
    drawing: Drawing, paths: Mapping[str, np.ndarray], measured: Mapping[str, np.ndarray], title: str
) -> go.Figure:
    """Animation of a mechanism in space; see :func:`~dalembert.report.charts.mechanism`."""
    playback = Playback.of(np.asarray(drawing.times, dtype=float))
    frames = playback.frames
    meshes = _meshes(drawing)
    drawn = {name: unfolded(line) for name, line in drawing.lines.items()}
    bodies = bodies_of({name: line for name, line in drawn.items() if name not in drawing.surfaces or not meshes})
    known = [*drawn.values(), *(mesh[0] for mesh in meshes.values()), *drawing.joints.values()]
    known += [] if drawing.ground is None else [drawing.ground.corners]
    box = _box([*known, *paths.values(), *measured.values()])
    size = float(np.ptp(box, axis=0).max())
    grounded = {name: at for name, at in drawing.joints.items() if np.ptp(at, axis=0).max() < STILL * size}
    moving = {name: at for name, at in drawing.joints.items() if name not in grounded}
    axes = _axes(drawing, AXIS * size)
    still = [
        _line(outlines(drawn, frames), 2, LIGHT.grid, hoverinfo="skip", showlegend=False),
        *(_line(path_of(path), 3, LIGHT.muted, name=f"path of {plain(name)}") for name, path in paths.items()),
        *(_crosses(name, points) for name, points in measured.items()),
        _markers("fixed to ground", grounded, 0, "square", LIGHT.muted),
        *(_mesh("ground", own.corners, own.triangles, LIGHT.muted) for own in [drawing.ground] if own is not None),
    ]
    first = int(frames[0])
    shown = [*bodies, *meshes]
    colours = {name: colour_of(place) for place, name in enumerate(name for name in drawing.lines if name in shown)}
    colours |= {name: colour_of(place) for place, name in enumerate(shown) if name not in colours}
    poses = [
        *(_line(line[first], 7, colours[name], name=plain(name), hoverinfo="name") for name, line in bodies.items()),
        *(_mesh(name, own[0][first], own[1], colours[name]) for name, own in meshes.items()),
        _markers("joints", moving, first, "circle", LIGHT.ink),
        *(
            _line(line[first], 4, colour, name=f"{name} axis", hoverinfo="skip", showlegend=line.shape[1] > 0)
            for (name, line), colour in zip(axes.items(), AXIS_COLOURS, strict=True)
        ),
    ]  # fmt: skip
    figure = go.Figure([*still, *poses])
    number = list(range(len(still), len(still) + len(poses)))
    figure.frames = [
        go.Frame(
            name=str(frame),
            traces=number,
            data=[
                *({"type": "scatter3d", **_coordinates(line[frame])} for line in bodies.values()),
                *({"type": "mesh3d", **_coordinates(own[0][frame])} for own in meshes.values()),
                {"type": "scatter3d", **_positions(moving, int(frame))},
                *({"type": "scatter3d", **_coordinates(line[frame])} for line in axes.values()),
            ],
        )
        for frame in frames
    ]
    space(figure, box)
    figure.update_layout(scene_camera={"eye": EYE, "center": {"x": 0, "y": 0, "z": -0.06}})
    return themed(figure, title, 560, **replace(playback.film, redraw=True, y=0).controls())


def _meshes(drawing: Drawing) -> Meshes:
    """Surfaces of bodies; many bodies become one, and none is drawn where there are too many bodies."""
    drawing = _light(drawing)
    own = drawing.surfaces
    meshes = {name: (drawing.corners(name).astype(np.float32), own[name].triangles) for name in own}
    if len(meshes) <= NAMED_BODIES:
        return meshes
    first = np.cumsum([0, *(len(surface.corners) for surface in own.values())])
    triangles = [mesh[1] + number for mesh, number in zip(meshes.values(), first, strict=False)]
    corners = np.concatenate([mesh[0] for mesh in meshes.values()], axis=1)
    return {f"{len(meshes)} bodies with shapes": (corners, np.concatenate(triangles))}


def _light(drawing: Drawing) -> Drawing:
    """The drawing with as many corners as the frames of a report can hold."""
    own = drawing.surfaces
    if sum(len(surface.corners) for surface in own.values()) <= CORNERS_A_FRAME:
        return drawing
    most = CORNERS_A_FRAME // len(own)
    if most < FEWEST:
        return replace(drawing, surfaces={})
    few = {
        name: surface
        if len(surface.corners) <= most
        else Surface(*simplified(surface.corners, surface.triangles, most))
        for name, surface in own.items()
    }
    return replace(drawing, surfaces=few)


def _axes(drawing: Drawing, length: float) -> dict[str, np.ndarray]:
    """The axes x, y and z of all bodies, each as one line with gaps, (frames, 3 a body, 3); of few bodies only."""
    own = list(drawing.axes.values())
    if not own or len(own) > NAMED_BODIES:
        return {name: np.zeros((len(drawing.times), 0, 3), dtype=np.float32) for name in "xyz"}
    gap = np.full((len(drawing.times), 3), np.nan)
    return {
        name: np.stack(
            [point for pose in own for point in (pose[:, 0], pose[:, 0] + length * pose[:, k], gap)], axis=1
        ).astype(np.float32)
        for k, name in enumerate("xyz", start=1)
    }


def _line(points: np.ndarray, width: float, colour: Any, **style: Any) -> go.Scatter3d:
    """A line through points (points, 3)."""
    return go.Scatter3d(**_coordinates(points), mode="lines", line={"width": width, "color": colour}, **style)


def _mesh(name: str, corners: np.ndarray, triangles: np.ndarray, colour: str) -> go.Mesh3d:
    i, j, k = triangles.T
    light = {"ambient": 0.65, "diffuse": 0.6, "specular": 0.1}
    return go.Mesh3d(
        **_coordinates(corners), i=i, j=j, k=k, color=colour, flatshading=True, lighting=light, name=plain(name),
        showlegend=True, hoverinfo="name",
    )  # fmt: skip


def _crosses(name: str, points: np.ndarray) -> go.Scatter3d:
    points = np.asarray(points)[:: max(1, len(points) // 150)]
    marker = {"symbol": "x", "size": 2.5, "color": LIGHT.ink}
    return go.Scatter3d(**_coordinates(points), name=f"{plain(name)} measured", mode="markers", marker=marker)


def _markers(name: str, joints: Mapping[str, np.ndarray], frame: int, symbol: str, colour: str) -> go.Scatter3d:
    return go.Scatter3d(
        **_positions(joints, frame), name=name, mode="markers",
        marker={"symbol": symbol, "size": 5, "color": colour},
        text=[plain(joint) for joint in joints], hoverinfo="text", showlegend=bool(joints),
    )  # fmt: skip


def _positions(joints: Mapping[str, np.ndarray], frame: int) -> dict[str, np.ndarray]:
    return _coordinates(np.array([motion[frame] for motion in joints.values()], dtype=np.float32).reshape(-1, 3))


def _coordinates(points: np.ndarray) -> dict[str, np.ndarray]:
    return dict(zip("xyz", np.asarray(points, dtype=np.float32).T, strict=True))


def _box(motions: list[np.ndarray]) -> np.ndarray:
    """Two corners (2, 3) of a box that holds the whole motion, no side much shorter than the others."""
    low = np.min([np.nanmin(motion.reshape(-1, 3), axis=0) for motion in motions], axis=0)
    high = np.max([np.nanmax(motion.reshape(-1, 3), axis=0) for motion in motions], axis=0)
    size = max(float((high - low).max()), 1e-9)
    more = np.maximum(FLAT * size - (high - low), 0.0) / 2 + 0.06 * size
    return np.stack([low - more, high + more])
