"""The best fit so far beside the data, computed in a process of its own while the run goes on in another."""

from pathlib import Path
from typing import Any

import numpy as np

from dalembert.study.folder import RunFolder


def fit_so_far(run: Path, values: list[float]) -> dict[str, Any] | None:
    """The figure as Plotly's JSON holds it; None for a run without data, or of several experiments."""
    from dalembert.inverse import ExperimentFit
    from dalembert.report.charts import responses
    from dalembert.study.posing import posed

    study = RunFolder(run).kept()
    if study.task != "identify" or study.file.data is None:
        return None
    model, data = posed(study)
    if isinstance(model, list) or data is None or len(values) != len(model.parameters):
        return None
    names = [channel.name for channel in model.channels]
    found = model.evaluate(np.array(values)[None]).only()[0][:, [names.index(channel) for channel in data.channels]]
    return responses(ExperimentFit("", data, found, np.ones_like(found)), title="").to_plotly_json()
