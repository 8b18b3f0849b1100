"""The experiments of a problem, each with its model, its place in the joint response and its parameters."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from dalembert.data import Measurements
from dalembert.forward import ForwardModel, begun_later
from dalembert.inverse.experiments.experiments import JointModel
from dalembert.inverse.problem.problem import MisfitProblem


@dataclass(frozen=True, eq=False)
class Track:
    """One experiment of a problem; a problem without experiments is a single one."""

    name: str  # empty for a single one
    model: ForwardModel
    data: Measurements
    picked: np.ndarray  # (channels,): the measured channels among those of the model
    # rows, columns: (samples,) and (channels,): where its samples and measured channels stand in the problem's response
    rows: np.ndarray
    columns: np.ndarray
    wiring: np.ndarray  # (parameters,): where its parameters stand among the problem's

    @property
    def times(self) -> np.ndarray:
        """Values of the coordinate, shape (samples,)."""
        return self.data.coordinate.values

    def between(self, begin: int, end: int) -> ForwardModel:
        """The model from one sample to another one; of one that cannot begin later, as many samples of its beginning.

        Its time is that since the first of them.
        """
        times = self.times[begin : end + 1] - self.times[begin]
        later = begun_later(self.model, float(self.times[begin]), times) if begin else None
        return self.model.first(int(end - begin) + 1) if later is None else later

    @property
    def prefix(self) -> str:
        """What stands before the names of its states."""
        return f"{self.name}." if self.name else ""

    @property
    def where(self) -> str:
        """What stands before a message on it."""
        return f"experiment {self.name!r}: " if self.name else ""


def tracks(problem: MisfitProblem) -> Iterator[Track]:
    """Yield the experiments of a problem."""
    model, data = problem.model, problem.data
    if not isinstance(model, JointModel):
        samples, channels = (np.arange(size) for size in data.values.shape)
        yield Track("", model, data, problem.columns, samples, channels, np.arange(len(model.parameters)))
        return
    for part, submodel, picked, wiring in zip(model.parts, model.models, model.picked, model.wiring, strict=True):
        if part.name in model.active:
            names = [model.channels[column].name for column in part.columns]
            columns = np.array([data.channels.index(name) for name in names])  # without validation data, fewer
            measured = replace(part, columns=columns).data(data)
            yield Track(part.name, submodel, measured, picked, part.rows, columns, wiring)
