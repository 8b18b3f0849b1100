"""The section on mechanisms in motion, alone or with the measurements of a fit."""

from collections.abc import Mapping

from dalembert.inverse import Fit
from dalembert.multibody import Trajectory
from dalembert.report.sections import Motion, Section, motion


def motions(moving: Mapping[str, Trajectory], points: tuple[str, ...], fit: Fit | None = None) -> list[Section]:
    """The section on the mechanism in motion, beside the measurements of each experiment."""
    data = {} if fit is None else {"": fit.data, **{item.name: item.data for item in fit.experiments}}
    drawn = {name: motion.motion(trajectory, points, data.get(name)) for name, trajectory in moving.items()}
    left_out = [] if "" in moving else [name for name in data if name and name not in moving]
    return [Motion(drawn, left_out)] if drawn else []
