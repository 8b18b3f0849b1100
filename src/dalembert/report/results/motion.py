"""Sections of motions in time, sweeps of a parameter, and comparisons of integrators."""

from dalembert.report.asked import Asked
from dalembert.report.needs import SweepLike, TrajectoryLike
from dalembert.report.needs_integrators import WorkPrecisionLike
from dalembert.report.registry import register_single, sections_of
from dalembert.report.results.moving import motions
from dalembert.report.sections import Diagnostics, Integrators, Section, Sweeps, headline


@sections_of(TrajectoryLike)
def trajectory(result: TrajectoryLike, asked: Asked) -> list[Section]:
    """The mechanism in motion, and its diagnostics."""
    moving = {"": result}
    return [
        headline.of_trajectory(result, asked.title, asked.notes),
        *motions(moving, asked.points),
        Diagnostics(moving),
    ]


register_single(SweepLike, headline.of_sweep, Sweeps)


@sections_of(WorkPrecisionLike)
def work_precision(result: WorkPrecisionLike, asked: Asked) -> list[Section]:
    """Errors and run times of integrators."""
    return [headline.of_work_precision(result, asked.title, asked.notes), Integrators(result)]
