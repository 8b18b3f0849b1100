"""The mechanism in motion."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from dalembert.report import charts
from dalembert.report.needs import DrawingLike, TrajectoryLike
from dalembert.report.plot import Plot
from dalembert.report.sections.section import Section

MOST_PATHS = 3


@dataclass(frozen=True)
class Motion(Section):
    """Animation with the paths of points, and measured positions where there are any."""

    name: ClassVar[str] = "motion"
    heading: ClassVar[str] = "Mechanism"
    drawing: DrawingLike
    paths: Mapping[str, np.ndarray] = field(default_factory=dict)
    measured: Mapping[str, np.ndarray] = field(default_factory=dict)

    @property
    def plots(self) -> tuple[Plot, ...]:
        figure = charts.mechanism(self.drawing, paths=self.paths, measured=self.measured)
        return (Plot("mechanism", figure, "Drawn to scale; faint outlines are poses along the motion."),)


def paths(trajectory: TrajectoryLike, drawing: DrawingLike, points: tuple[str, ...]) -> dict[str, np.ndarray]:
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


def measured(channels: tuple[str, ...], values: np.ndarray) -> dict[str, np.ndarray]:
    """Positions (samples, 2) of the points of which both coordinates are among the channels."""
    return {
        point: values[:, [channels.index(f"{point}.x"), channels.index(f"{point}.y")]]
        for point in dict.fromkeys(channel.rpartition(".")[0] for channel in channels)
        if f"{point}.x" in channels and f"{point}.y" in channels
    }


def _size(drawing: DrawingLike) -> float:
    return max((float(np.ptp(line.reshape(-1, 2), axis=0).max()) for line in drawing.lines.values()), default=1.0)
