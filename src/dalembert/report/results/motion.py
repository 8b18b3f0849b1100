"""Sections of motions in time, sweeps of a parameter, and comparisons of integrators."""

from dalembert.multibody import Trajectory, WorkPrecision
from dalembert.report.asked import Asked
from dalembert.report.registry import register_single, sections_of
from dalembert.report.results.moving import motions
from dalembert.report.sections import Diagnostics, Integrators, Section, Sweeps, headline


@sections_of(Trajectory)
def trajectory(result: Trajectory, asked: Asked) -> list[Section]:
    """The mechanism in motion, and its diagnostics."""
    moving = {"": result}
    return [
        headline.of_trajectory(result, asked.title, asked.notes),
        *motions(moving, asked.points),
        Diagnostics(moving),
    ]


register_single("dalembert.study.tasks.sweep.Sweep", headline.of_sweep, Sweeps)


@sections_of(WorkPrecision)
def work_precision(result: WorkPrecision, asked: Asked) -> list[Section]:
    """Errors and run times of integrators."""
    return [headline.of_work_precision(result, asked.title, asked.notes), Integrators(result)]
