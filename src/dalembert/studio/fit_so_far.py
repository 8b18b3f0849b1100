"""The best fit so far beside the data, computed in a process of its own while the run goes on in another."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dalembert.study.experiments import posed
from dalembert.study.folder import RunFolder

if TYPE_CHECKING:
    from dalembert.data import Measurements


@dataclass(frozen=True)
class Current:
    """A response at the best values so far, and the data.

    Parameters
    ----------
    data : Measurements
    response : array, shape (samples, channels)
    """

    data: "Measurements"
    response: np.ndarray

    @property
    def residuals(self) -> np.ndarray:
        return self.response - self.data.values


def fit_so_far(run: Path, values: list[float]) -> dict[str, Any] | None:
    """The figure as Plotly's JSON holds it; None for a run without data, or of several experiments."""
    from dalembert.report.charts import responses

    study = RunFolder(run).kept()
    if study.task != "identify" or study.file.data is None:
        return None
    model, data = posed(study)
    if isinstance(model, list) or data is None or len(values) != len(model.parameters):
        return None
    names = [channel.name for channel in model.channels]
    found = model.evaluate(np.array(values)[None]).only()[0][:, [names.index(channel) for channel in data.channels]]
    return responses(Current(data, found), title="").to_plotly_json()
