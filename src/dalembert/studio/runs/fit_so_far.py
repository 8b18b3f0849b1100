"""The best fit so far and the data, computed in a separate process during the run."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dalembert.studio.worker import Kept
from dalembert.study.run.folder import RunFolder

if TYPE_CHECKING:
    from dalembert.study import Study


@dataclass(frozen=True)
class FitSoFar:
    """The fit to one experiment, a figure as Plotly's JSON. ``experiments`` has the names of all; an empty one for a
    single record.
    """

    experiments: tuple[str, ...]
    figure: dict[str, Any]


def fit_so_far(kept: Kept, run: Path, values: list[float], experiment: str = "") -> FitSoFar | None:
    """Return the fit to an experiment, the first if that is not known; None for a run that fits no channels of data."""
    from dalembert.inverse import ExperimentFit
    from dalembert.report.charts import responses
    from dalembert.studio.simulation.answers import response_at
    from dalembert.studio.simulation.simulated_parts import parameters_of, part

    study, names = kept.newest("study of run", run, lambda: _fitted(run))
    if not names or len(values) != len(names):
        return None
    experiments = tuple(parameters_of(study))
    name = experiment if experiment in experiments else experiments[0]
    own = kept.newest("part of run", (run, name), lambda: part(study, name))
    assert own.data is not None
    found = response_at(own, dict(zip(names, values, strict=True)))
    fit = ExperimentFit("", own.data, found, np.ones_like(found))
    return FitSoFar(experiments, responses(fit, title="").to_plotly_json())


def _fitted(run: Path) -> "tuple[Study, tuple[str, ...]]":
    """The study of a run, and the names of its unknowns; none if it fits no channels of data."""
    from dalembert.study.tables.posing import unknown_names

    study = RunFolder(run).kept()
    return study, tuple(unknown_names(study)) if study.task == "identify" else ()
