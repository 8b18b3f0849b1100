"""The mechanism in motion, alone or with the measurements of a fit."""

from collections.abc import Mapping, Sequence

import numpy as np

from dalembert.data import Measurements
from dalembert.multibody import Drawing, Trajectory
from dalembert.report import charts
from dalembert.report.look import plain
from dalembert.report.section import Plot, Section, numbered

HEADING = "Mechanism"
MOST_PATHS = 3


def mechanisms(
    moving: Mapping[str, Trajectory], points: tuple[str, ...], data: Mapping[str, Measurements] | None = None
) -> list[Section]:
    """The section on the mechanism in motion, with the measurements of each experiment; none without a motion."""
    moving = {name: one for name, one in moving.items() if len(one.system.AXES) == 2}  # the film is planar
    if not moving:
        return []
    data = data or {}
    plots = [_film(place, name, one, points, data.get(name)) for place, name, one in numbered("mechanism", moving)]
    left_out = [] if "" in moving else [name for name in data if name and name not in moving]
    return [Section(HEADING, (*plots, f"Not drawn: {', '.join(left_out)}." if left_out else ""))]


def _film(
    place: str, experiment: str, trajectory: Trajectory, points: tuple[str, ...], data: Measurements | None
) -> Plot:
    """The mechanism with the paths of points, of the measured ones if none are named, and measured positions."""
    drawing = trajectory.drawing()
    crosses = {} if data is None else measured(data.channels, data.values)
    known = set(trajectory.channel_names)
    followed = points or tuple(point for point in crosses if {f"{point}.x", f"{point}.y"} <= known)
    title = plain(experiment) or HEADING
    figure = charts.mechanism(drawing, paths=paths(trajectory, drawing, followed), measured=crosses, title=title)
    return Plot(place, figure, "Drawn to scale; faint outlines are poses along the motion.")


def paths(trajectory: Trajectory, drawing: Drawing, points: tuple[str, ...]) -> dict[str, np.ndarray]:
    """Paths (samples, 2) of the points given by name; of the free ends of bodies, or else of joints, if none is."""
    if points:
        return {point: np.asarray(trajectory.channels([f"{point}.x", f"{point}.y"])) for point in points}
    held = list(drawing.joints.values())
    ends = {
        f"{name}'s end": line[:, -1]
        for name, line in drawing.lines.items()
        if not any(np.allclose(line[:, -1], joint, atol=1e-6 * _size(drawing)) for joint in held)
    }
    moving = {name: joint for name, joint in (ends or drawing.joints).items() if np.ptp(joint, axis=0).max() > 0}
    return dict(list(moving.items())[-MOST_PATHS:])


def measured(channels: Sequence[str], values: np.ndarray) -> dict[str, np.ndarray]:
    """Positions (samples, 2) of the points of which both coordinates are among the channels."""
    channels = list(channels)
    return {
        point: values[:, [channels.index(f"{point}.x"), channels.index(f"{point}.y")]]
        for point in dict.fromkeys(channel.rpartition(".")[0] for channel in channels)
        if f"{point}.x" in channels and f"{point}.y" in channels
    }


def _size(drawing: Drawing) -> float:
    return max((float(np.ptp(line.reshape(-1, 2), axis=0).max()) for line in drawing.lines.values()), default=1.0)
