"""The best fit so far beside the data, computed in a process of its own while the run goes on in another."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dalembert.studio.worker import Kept
from dalembert.study.folder import RunFolder

if TYPE_CHECKING:
    from dalembert.data import Measurements
    from dalembert.forward import ForwardModel


def fit_so_far(kept: Kept, run: Path, values: list[float]) -> dict[str, Any] | None:
    """The figure as Plotly's JSON holds it; None for a run without data, or of several experiments."""
    from dalembert.inverse import ExperimentFit
    from dalembert.report.charts import responses

    found = kept.newest("fit", run, lambda: _compared(run))
    if found is None or len(values) != len(found[0].parameters):
        return None
    model, data = found
    names = [channel.name for channel in model.channels]
    own = model.evaluate(np.array(values)[None]).only()[0][:, [names.index(channel) for channel in data.channels]]
    return responses(ExperimentFit("", data, own, np.ones_like(own)), title="").to_plotly_json()


def _compared(run: Path) -> "tuple[ForwardModel, Measurements] | None":
    """Model and data of a run; None without one of each."""
    from dalembert.study.posing import posed

    study = RunFolder(run).kept()
    if study.task != "identify" or study.file.data is None:
        return None
    model, data = posed(study)
    return None if isinstance(model, list) or data is None else (model, data)
