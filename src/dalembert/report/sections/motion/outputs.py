"""The asked channels of a motion over time."""

from collections.abc import Sequence

import numpy as np

from dalembert.forward import Coordinate
from dalembert.multibody import Trajectory
from dalembert.report import charts
from dalembert.report.look import plain
from dalembert.report.quantities import by_quantity
from dalembert.report.section import Plot, Section
from dalembert.report.sections.samples import samples

HEADING = "Outputs over time"


def outputs(trajectory: Trajectory, channels: Sequence[str]) -> list[Section]:
    """A figure for each quantity, and all samples for download; nothing where no channel is asked for."""
    if not channels:
        return []
    plots = [
        Plot(f"outputs-{place}", charts.outputs(trajectory, group, title=", ".join(map(plain, group))))
        for place, group in enumerate(by_quantity(channels), start=1)
    ]
    along = Coordinate("time", "s", np.asarray(trajectory.times))
    download = samples("outputs", along, channels, {"": trajectory.channels(channels)}, "Download all samples as CSV")
    return [Section(HEADING, (*plots, download))]


def asked_channels(trajectory: Trajectory, channels: Sequence[str], points: Sequence[str]) -> tuple[str, ...]:
    """The channels that are asked for, then the coordinates of the points, each once."""
    coordinates = [f"{point}.{axis}" for point in points for axis in trajectory.system.AXES]
    return tuple(dict.fromkeys((*channels, *coordinates)))
