"""Supplements of a response over frequency: its motion at the peak, points of it in time, a nonlinear mode."""

from contextlib import suppress
from pathlib import Path
from typing import Any, Literal

import numpy as np
from pydantic import Field

from dalembert.errors import SolveError
from dalembert.study.tables.dataclass_tables import buildable_table
from dalembert.study.tables.study import Study
from dalembert.study.tasks.task import load_further_results
from dalembert.study.text.numbers import Frequencies
from dalembert.study.text.table import StudyTable, completed

COMPARISON, BACKBONE, DEFORMATION = "time_comparison", "backbone", "deformation"
"""What there may be beside a curve: options of a report, and names of files beside the result, ``NAME.nc``."""


MOST_BRANCHES = 9
"""Branches of each kind that are followed."""
NEXT_TO = 1e-2
"""Relative difference of frequencies up to which a branch ends at a marker."""


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
    return {**further_results, **_branches(study, curve, system)}


def _branches(study: Study, curve: Any, system: Any) -> dict[str, Any]:
    """The branches that leave a curve, and those that it does not pass, by the names of their files."""
    from dalembert.vibration import follow_branch, isolated_branches
    from dalembert.vibration.balance.arc_length import JOINED
    from dalembert.vibration.stability.bifurcations import BRANCH, DOUBLING

    table = study.table
    followed: list[Any] = []
    if table.branches:
        places = [point for kind, point in curve.markers if kind in (BRANCH, DOUBLING)]
        for number, point in enumerate(places[:MOST_BRANCHES]):
            # A branch that joins its curve ends at another marker, from which it need not be followed again.
            frequency = curve.frequencies[point]
            joined = [
                branch for branch in followed if JOINED in {entry.values.get("reason") for entry in branch.findings}
            ]
            if not any(abs(branch.frequencies[-1] / frequency - 1) < NEXT_TO for branch in joined):
                with suppress(SolveError):  # the marker stays in the report
                    followed.append(
                        follow_branch(system, curve, number, stability=True, observe=curve.dofs, check=False)
                    )
    alone: Any = ()
    if table.isolated is not None:
        options = {"stability": table.stability, "checkpoint": study.checkpoint}
        alone = isolated_branches(system, curve, table.isolated, **options)[:MOST_BRANCHES]
    named = ((f"branch_{number}", branch) for number, branch in enumerate(followed, 1))
    return dict(named) | {f"isolated_{number}": branch for number, branch in enumerate(alone, 1)}


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
    from dalembert.vibration import Backbone, Deformation, FrequencyCurve, TimeComparison

    kinds = {DEFORMATION: Deformation, COMPARISON: TimeComparison, BACKBONE: Backbone}
    numbers = range(1, MOST_BRANCHES + 1)
    curves = {f"{kind}_{number}": FrequencyCurve for kind in ("branch", "isolated") for number in numbers}
    return load_further_results(result, kinds | curves)
