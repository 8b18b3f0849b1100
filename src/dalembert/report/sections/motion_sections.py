"""A motion: the mechanism, its outputs, and how well it was computed."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from dalembert.data import Measurements
from dalembert.forward import Coordinate
from dalembert.multibody import Drawing, Trajectory
from dalembert.quantities import by_quantity
from dalembert.report import charts
from dalembert.report.headline import headline_of
from dalembert.report.look import plain
from dalembert.report.options import ReportOptions
from dalembert.report.player.animation import Animation
from dalembert.report.registry import sections_of
from dalembert.report.section import Block, Motion, Plot, Row, Section, numbered, samples
from dalembert.tables import Table

if TYPE_CHECKING:
    from dalembert.multibody import WorkPrecision

HEADING = "Mechanism"
MOST_PATHS = 3


def mechanisms(
    moving: Mapping[str, Trajectory], points: tuple[str, ...], data: Mapping[str, Measurements] | None = None
) -> list[Section]:
    """The section on the mechanism in motion, with the measurements of each experiment; none without a motion."""
    if not moving:
        return []
    data = data or {}
    plots = [_film(place, name, item, points, data.get(name)) for place, name, item in numbered("mechanism", moving)]
    left_out = [] if "" in moving else [name for name in data if name and name not in moving]
    return [Section(HEADING, (*plots, f"Not drawn: {', '.join(left_out)}." if left_out else ""))]


def _film(
    place: str, experiment: str, trajectory: Trajectory, points: tuple[str, ...], data: Measurements | None
) -> Motion:
    """The mechanism with the paths of points, of the measured ones if none are named, and measured positions."""
    drawing = trajectory.drawing()
    axes = _axes(drawing)
    crosses = {} if data is None else measured(data.channels, data.values, axes)
    known = set(trajectory.channel_names)
    followed = points or tuple(point for point in crosses if _channels(point, axes) <= known)
    lines = paths(trajectory, drawing, followed)
    figure = Animation.of(drawing, paths=lines, measured=crosses, title=experiment or HEADING)
    named = {"Path": list(lines), "Measured": list(crosses)}
    which = "".join(f" {kind}: {', '.join(names)}." for kind, names in named.items() if names)
    turned = " Drag to turn, scroll to zoom." if len(axes) == 3 else ""
    how = f"Drawn to scale, {figure.pace}; faint outlines are poses along the motion."
    return Motion(place, figure, f"{how}{which}{turned}")


def paths(trajectory: Trajectory, drawing: Drawing, points: tuple[str, ...]) -> dict[str, np.ndarray]:
    """Paths (samples, 2 or 3) of the points given by name; of the free ends of bodies, or else of joints, if none is.

    In space the end of a body is its last point.
    """
    axes = _axes(drawing)
    if points:
        return {point: np.asarray(trajectory.channels([f"{point}.{axis}" for axis in axes])) for point in points}
    joints = list(drawing.joints.values())
    last = {body.name: body.point_names[-1] for body in trajectory.system.bodies} if len(axes) == 3 else {}
    spans = [float(np.ptp(line.reshape(-1, len(axes)), axis=0).max()) for line in drawing.lines.values()]
    ends = {
        f"{name}.{last[name]}" if name in last else f"{name}'s end": line[:, -1]
        for name, line in drawing.lines.items()
        if not any(np.allclose(line[:, -1], joint, atol=1e-6 * max(spans)) for joint in joints)
    }
    moving = {name: joint for name, joint in (ends or drawing.joints).items() if np.ptp(joint, axis=0).max() > 0}
    return dict(list(moving.items())[-MOST_PATHS:])


def measured(channels: Sequence[str], values: np.ndarray, axes: str = "xy") -> dict[str, np.ndarray]:
    """Positions (samples, 2 or 3) of the points of which all coordinates are among the channels."""
    channels = list(channels)
    return {
        point: values[:, [channels.index(f"{point}.{axis}") for axis in axes]]
        for point in dict.fromkeys(channel.rpartition(".")[0] for channel in channels)
        if _channels(point, axes) <= set(channels)
    }


def _axes(drawing: Drawing) -> str:
    """Axes of the positions: those of the plane or of space."""
    return "xyz"[: next(iter([*drawing.lines.values(), *drawing.joints.values()])).shape[-1]]


def _channels(point: str, axes: str) -> set[str]:
    return {f"{point}.{axis}" for axis in axes}


def diagnostics(trajectories: Mapping[str, Trajectory]) -> Section:
    """Energy balance, constraint violations and Newton iterations, of each experiment's motion."""
    blocks: list[Block] = []
    for place, experiment, item in numbered("", trajectories):
        drawn = (
            ("energies", charts.energies(item), "Below, what the energy balance leaves over."),
            ("violations", charts.violations(item), "Largest violation of any constraint."),
            ("newton", charts.newton(item), "A rise shows where the motion is hard to follow."),
        )
        if experiment:
            for _, figure, _ in drawn:
                figure.update_layout(title_text=f"{plain(experiment)}: {figure.layout.title.text}")  # pyright: ignore[reportAttributeAccessIssue]
        plots = [Plot(f"{name}{place}", figure, how) for name, figure, how in drawn]
        blocks += [plots[0], Row(plots[1:])]
    tables = Table.joined({experiment: item.tables()[0] for experiment, item in trajectories.items()})
    return Section("Diagnostics of the simulation", (*blocks, tables))


def outputs(trajectory: Trajectory, channels: Sequence[str]) -> list[Section]:
    """A figure for each quantity, and all samples for download; nothing where no channel is chosen."""
    if not channels:
        return []
    plots = [
        Plot(f"outputs-{place}", charts.outputs(trajectory, group, title=", ".join(map(plain, group))))
        for place, group in enumerate(by_quantity(channels), start=1)
    ]
    along = Coordinate("time", "s", np.asarray(trajectory.times))
    download = samples("outputs", along, channels, {"": trajectory.channels(channels)}, "Download all samples as CSV")
    return [Section("Outputs over time", (*plots, download))]


def chosen_channels(trajectory: Trajectory, channels: Sequence[str], points: Sequence[str]) -> tuple[str, ...]:
    """The chosen channels, then the coordinates of the points, each once."""
    coordinates = [f"{point}.{axis}" for point in points for axis in trajectory.system.AXES]
    return tuple(dict.fromkeys((*channels, *coordinates)))


@sections_of(Trajectory)
def trajectory(result: Trajectory, options: ReportOptions) -> list[Section]:
    """The mechanism in motion, the chosen channels over time, and the diagnostics."""
    moving = {"": result}
    channels = chosen_channels(result, options.channels, options.points)
    return [
        headline_of(result),
        *mechanisms(moving, options.points),
        *outputs(result, channels),
        diagnostics(moving),
    ]


@sections_of("dalembert.study.tasks.sweep.Sweep")
def sweep(result: Any, options: ReportOptions) -> list[Section]:
    """A figure and a table for each parameter."""
    how = ["" if curve.sensitivities is None else "Below, its slope." for curve in result.curves]
    plots = [
        Plot(f"sweep-{place}", charts.sweep(curve, result.at), how[place - 1])
        for place, curve in enumerate(result.curves, start=1)
    ]
    return [headline_of(result), Section("Sweep", (Row(plots), *result.tables()))]


@sections_of("dalembert.multibody.motion.compare_integrators.WorkPrecision")  # whose module loads every integrator
def work_precision(result: "WorkPrecision", options: ReportOptions) -> list[Section]:
    """Error, run time and constraint violations of each integrator with each of its settings."""
    how = "Further down is more exact, further left is faster. Below the dotted line nothing is known."
    plot = Plot("work-precision", charts.work_precision(result), how)
    return [headline_of(result), Section("Integrators", (plot, *result.tables()))]
