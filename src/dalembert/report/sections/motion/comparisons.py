"""Responses along one parameter at a time, and integrators compared on one motion."""

from typing import Any

from dalembert.multibody import WorkPrecision
from dalembert.report import charts
from dalembert.report.headline import headline_of
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Plot, Row, Section


@sections_of("dalembert.study.tasks.sweep.Sweep")
def sweep(result: Any, options: ReportOptions) -> list[Section]:
    """A figure and a table for each parameter."""
    how = ["" if curve.sensitivities is None else "Below, its slope." for curve in result.curves]
    plots = [
        Plot(f"sweep-{place}", charts.sweep(curve, result.at), how[place - 1])
        for place, curve in enumerate(result.curves, start=1)
    ]
    return [headline_of(result), Section("Sweep", (Row(plots), *result.tables()))]


@sections_of(WorkPrecision)
def work_precision(result: WorkPrecision, options: ReportOptions) -> list[Section]:
    """Error, run time and constraint violations of each integrator with each of its settings."""
    how = "Further down is more exact, further left is faster. Below the dotted line nothing is known."
    plot = Plot("work-precision", charts.work_precision(result), how)
    return [headline_of(result), Section("Integrators", (plot, *result.tables()))]
