"""What of a study is simulated at values of its parameters: its only data, an experiment, or what the task names."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from dalembert.errors import InputError, require_known
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters

if TYPE_CHECKING:
    from dalembert.data import Measurements
    from dalembert.forward import ForwardModel
    from dalembert.multibody import Trajectory
    from dalembert.study import Study

POINTS = 401
"""Samples of channels that are compared with no data."""
FROM_DATA = ("identify", "identify_set", "regularise", "sample")
"""Tasks whose data the channels are compared with."""
OVER_FREQUENCY = "frequency_response"


@dataclass(frozen=True, eq=False)
class StudyMotion:
    """A motion or response of a study, as the experiment changes it. ``model``: from parameters to channels, None where
    no channel is known; ``data``: what the channels are compared with; ``end``: last time of the motion of a mechanism,
    s; 0 without a motion; ``named`` returns the name of a parameter of the model among those of all experiments.
    """

    study: "Study"
    model: "ForwardModel | None"
    data: "Measurements | None"
    end: float
    named: Callable[[str], str] = str

    @property
    def parameters(self) -> Parameters:
        """Parameters of the model, by their own names."""
        return self.study.parameters if self.model is None else self.model.parameters

    def vector(self, values: Mapping[str, float], parameters: Parameters | None = None) -> np.ndarray:
        """Parameters (parameters,), the model's if not given: values by name, first guesses of those not named."""
        named = self.parameters if parameters is None else parameters
        pairs = zip(named.names, named.start.tolist(), strict=True)
        return np.array([values.get(self.named(name), start) for name, start in pairs])

    def motion(self, values: Mapping[str, float], times: np.ndarray) -> "Trajectory":
        """The motion of the mechanism at some times (s)."""
        return self.study.motion(self.end, self.vector(values, self.study.parameters), times)


class NothingToSimulateError(InputError):
    """A study in order whose task names nothing that a page can simulate."""


def parameters_of(study: "Study") -> dict[str, tuple[Parameter, ...]]:
    """Return the parameters that can be moved, by the names of the parts: one that is empty without experiments."""
    from dalembert.study.tables.posing import fitted_parameters

    return fitted_parameters(study) if study.task in FROM_DATA else {"": tuple(study.parameters)}


def part(study: "Study", name: str) -> StudyMotion:
    """Return the part with a name."""
    if study.task in FROM_DATA:
        return _measured(study, name)
    if study.has_system and study.file.solver is not None:
        return _moving(study)
    if study.file.model.forward is not None:
        model = study.forward(tuple(getattr(study.table, "channels", None) or ()), np.zeros(0))
        return StudyMotion(study, model, None, 0.0)
    if study.task == OVER_FREQUENCY:
        return StudyMotion(study, None, None, 0.0)
    raise NothingToSimulateError(f"There is nothing to simulate for [{study.task}]. Run the study to see its result.")


def _measured(study: "Study", name: str) -> StudyMotion:
    from dalembert.study.tables.posing import posed

    named: Callable[[str], str] = str
    model, data = posed(study)
    if isinstance(model, list):
        experiments = {experiment.name: experiment for experiment in model}
        require_known("experiment", name, experiments)
        table = next(table for table in study.file.experiments if table.name == name)
        named = table.named
        study, model, data = study.variant(table), experiments[name].model, experiments[name].data
    assert data is not None
    return StudyMotion(study, model, data, float(data.coordinate.values[-1]) if study.has_system else 0.0, named)


def _moving(study: "Study") -> StudyMotion:
    """A mechanism without data: until the last time that the task names, with its channels."""
    table, end = study.table, last_time(study)
    if end is None:
        raise NothingToSimulateError(
            f"[{study.task}] names no time until which the motion lasts. Run the study to see its result."
        )
    named = getattr(table, "points", ())
    points = [f"{point}.{axis}" for point in named for axis in study.system().AXES] if named else []
    channels = tuple(getattr(table, "channels", None) or points)
    model = study.forward(channels, np.linspace(0.0, end, POINTS)) if channels else None
    return StudyMotion(study, model, None, end)


def last_time(study: "Study") -> float | None:
    """Return the last time of the motion that the task or the data name, in s; None if neither does."""
    table, data = study.table, study.file.data
    times, at = getattr(table, "times", None), getattr(table, "at", None)
    ends = [getattr(table, "last", None), times and times[-1], getattr(table, "end", None), None if at == {} else at]
    named = next((float(time) for time in ends if time), 0.0)
    if not named and data is not None:
        named = float(study.data().coordinate.values[-1])
    return named if named > 0 else None
