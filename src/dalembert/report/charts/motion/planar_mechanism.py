"""The mechanism in motion: drawn to scale, with play button, slider and the paths of chosen points."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import plotly.graph_objects as go

from dalembert.multibody import Drawing
from dalembert.report.charts.motion.mechanism_in_space import mechanism_in_space
from dalembert.report.charts.motion.outlines import bodies_of, outlines, path_of
from dalembert.report.charts.motion.playback import Playback
from dalembert.report.look import LIGHT, plain, themed


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
    places = next(iter([*drawing.lines.values(), *drawing.joints.values()]))
    if places.shape[-1] == 3:
        return mechanism_in_space(drawing, paths or {}, measured or {}, title)
    playback = Playback.of(np.asarray(drawing.times, dtype=float))
    bodies = bodies_of(drawing.lines)
    grounded = {name: at for name, at in drawing.joints.items() if np.ptp(at, axis=0).max() == 0.0}
    moving = {name: at for name, at in drawing.joints.items() if name not in grounded}
    still = [
        _line(outlines(drawing.lines, playback.frames), 3, LIGHT.grid, hoverinfo="skip", showlegend=False),
        *(
            _line(path_of(path), 1.5, LIGHT.muted, name=f"path of {plain(name)}", line_dash="dot")
            for name, path in (paths or {}).items()
        ),
        *(_crosses(name, points) for name, points in (measured or {}).items()),
        _markers("fixed to ground", grounded, 0, "triangle-up", LIGHT.muted),
    ]
    first = int(playback.frames[0])
    figure = go.Figure([*still, *_pose(bodies, first), _markers("joints", moving, first, "circle", LIGHT.ink)])
    number = list(range(len(still), len(still) + len(bodies) + 1))
    figure.frames = [
        go.Frame(
            name=str(frame),
            traces=number,
            data=[
                *({"x": motion[frame, :, 0], "y": motion[frame, :, 1]} for motion in bodies.values()),
                _positions(moving, int(frame)),
            ],
        )
        for frame in playback.frames
    ]
    box = _box([*drawing.lines.values(), *drawing.joints.values(), *(paths or {}).values(), *(measured or {}).values()])
    across = {"title": "x (m)", "range": box[0].tolist()}
    up = {"title": "y (m)", "range": box[1].tolist(), "scaleanchor": "x", "scaleratio": 1}
    return themed(figure, title, 520, x=across, y=up, **playback.film.controls())


def _pose(bodies: dict[str, np.ndarray], frame: int) -> list[go.Scatter]:
    return [
        _line(motion[frame], 5, colour, name=plain(name), hoverinfo="name")
        for (name, motion), colour in zip(bodies.items(), LIGHT.series, strict=False)
    ]


def _line(points: np.ndarray, width: float, colour: str, **style: Any) -> go.Scatter:
    """A line through points (points, 2)."""
    return go.Scatter(x=points[:, 0], y=points[:, 1], mode="lines", line_width=width, line_color=colour, **style)


def _crosses(name: str, points: np.ndarray) -> go.Scatter:
    points = np.asarray(points)[:: max(1, len(points) // 150)]
    marker = {"symbol": "x-thin", "size": 6, "line": {"width": 1.25, "color": LIGHT.ink}}
    return go.Scatter(x=points[:, 0], y=points[:, 1], name=f"{plain(name)} measured", mode="markers", marker=marker)


def _markers(name: str, joints: Mapping[str, np.ndarray], frame: int, symbol: str, colour: str) -> go.Scatter:
    marker = {"symbol": symbol, "size": 10, "color": LIGHT.surface, "line": {"width": 2, "color": colour}}
    return go.Scatter(
        **_positions(joints, frame),
        name=name,
        mode="markers",
        marker=marker,
        text=[plain(joint) for joint in joints],
        hoverinfo="text",
        showlegend=bool(joints),
    )


def _positions(joints: Mapping[str, np.ndarray], frame: int) -> dict[str, np.ndarray]:
    at = np.array([motion[frame] for motion in joints.values()], dtype=np.float32).reshape(-1, 2)
    return {"x": at[:, 0], "y": at[:, 1]}


def _box(motions: list[np.ndarray]) -> np.ndarray:
    """Range (2, 2) of x and y over the whole motion, with a margin."""
    low = np.min([np.nanmin(motion.reshape(-1, 2), axis=0) for motion in motions], axis=0)
    high = np.max([np.nanmax(motion.reshape(-1, 2), axis=0) for motion in motions], axis=0)
    size = max(float((high - low).max()), 1e-9)
    margin = 0.06 * size
    flat = np.maximum(0.15 * size - (high - low) / 2, 0.0)
    return np.stack([low - flat - margin, high + flat + margin], axis=1)
