"""The mechanism in motion."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.data import Measurements
from dalembert.multibody import Drawing, Trajectory
from dalembert.report import charts
from dalembert.report.each import numbered
from dalembert.report.look import plain
from dalembert.report.plot import Plot
from dalembert.report.sections.section import Section

MOST_PATHS = 3


@dataclass(frozen=True)
class Moving:
    """A drawing with the paths of points, and measured positions where there are any, each (samples, 2)."""

    drawing: Drawing
    paths: Mapping[str, np.ndarray]
    measured: Mapping[str, np.ndarray]


@dataclass(frozen=True)
class Motion(Section):
    """An animation, or one for each experiment, some of which may be ``left_out``."""

    name: ClassVar[str] = "motion"
    heading: ClassVar[str] = "Mechanism"
    moving: Mapping[str, Moving]
    left_out: Sequence[str] = ()

    @property
    def plots(self) -> tuple[Plot, ...]:
        how = "Drawn to scale; faint outlines are poses along the motion."
        return tuple(
            Plot(
                place,
                charts.mechanism(
                    one.drawing, paths=one.paths, measured=one.measured, title=plain(experiment) or self.heading
                ),
                how,
            )
            for place, experiment, one in numbered("mechanism", self.moving)
        )

    @property
    def sentence(self) -> str:
        """Which experiments are not drawn; empty if all are."""
        return f"Not drawn: {', '.join(self.left_out)}." if self.left_out else ""


def motion(trajectory: Trajectory, points: tuple[str, ...], data: Measurements | None) -> Moving:
    """What is drawn of a trajectory: the paths of points, of the measured ones if none are named."""
    drawing = trajectory.drawing()
    crosses = {} if data is None else measured(data.channels, data.values)
    known = set(trajectory.channel_names)
    followed = points or tuple(point for point in crosses if {f"{point}.x", f"{point}.y"} <= known)
    return Moving(drawing, paths(trajectory, drawing, followed), crosses)


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
