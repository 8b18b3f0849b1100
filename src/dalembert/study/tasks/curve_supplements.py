"""Supplements of a response over frequency: its motion at the peak, points of it in time, a nonlinear mode."""

from pathlib import Path
from typing import Any, Literal

import numpy as np
from pydantic import Field

from dalembert.study.tables.dataclass_tables import buildable_table
from dalembert.study.tables.study import Study
from dalembert.study.tasks.task import load_further_results
from dalembert.study.text.numbers import Frequencies
from dalembert.study.text.table import StudyTable, completed

COMPARISON, BACKBONE, DEFORMATION = "time_comparison", "backbone", "deformation"
"""What there may be beside a curve: options of a report, and names of files beside the result, ``NAME.nc``."""


class CompareInTimeTable(StudyTable):
    """Points of a curve beside integration in time."""

    frequencies: Frequencies | None = Field(
        None, description="the nearest points are taken; the largest response and some spread ones if not given"
    )
    way: Literal["long run", "shooting"] = Field("long run", description="how the periodic motion is found")
    method: Any = None


def compare_in_time_table() -> type[CompareInTimeTable]:
    """The table with the settings of the integration."""
    from dalembert.vibration import Newmark

    method = buildable_table(Newmark) | None, Field(None, description="settings of the integration")
    return completed(CompareInTimeTable, method=method)


def single_curve_supplements(study: Study, curve: Any, system: Any) -> dict[str, Any]:
    """What the task's table asks for beside a curve."""
    from dalembert.vibration import compare_in_time

    table, further_results = study.table, _deformed(study, curve, system)
    if table.compare_in_time is not None and curve.converged.any():
        settings = table.compare_in_time
        method = None if settings.method is None else settings.method.settings()
        further_results[COMPARISON] = compare_in_time(
            system,
            curve,
            frequencies=settings.frequencies,
            method=method,
            way=settings.way,
            kind=table.amplitude,
            checkpoint=study.checkpoint,
        )
    if table.backbone is not None:
        further_results[BACKBONE] = table.backbone.follow(study, system)
    return further_results


def family_supplements(study: Study, family: Any) -> dict[str, Any]:
    """The same beside curves over a parameter: the motion at the smallest of their peaks."""
    table, converged = study.table, [curve is not None and curve.converged.any() for curve in family.curves]
    if not any(converged):
        return {}
    best = family.best(table.dof or family.dofs[0], table.amplitude)
    system = study.along(family.parameter)(**{family.parameter: best})
    return _deformed(study, family.curves[family.values.tolist().index(best)], system)


def _deformed(study: Study, curve: Any, system: Any) -> dict[str, Any]:
    from dalembert.vibration import deformation

    table = study.table
    if not table.deformed or system.structure.nodes is None or not curve.converged.any():
        return {}
    sizes = curve.amplitude(table.dof or curve.dofs[0], table.amplitude)
    return {DEFORMATION: deformation(system, curve, int(np.nanargmax(np.where(curve.converged, sizes, np.nan))))}


def load(result: Path) -> dict[str, Any]:
    """What was written beside a result."""
    from dalembert.vibration import Backbone, Deformation, TimeComparison

    return load_further_results(result, {DEFORMATION: Deformation, COMPARISON: TimeComparison, BACKBONE: Backbone})
