"""One of several experiments with the same mechanism, its part of the joint response, and its fit."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from dalembert.argument_readers import check_model, names_of
from dalembert.data import Measurements
from dalembert.errors import InputError, require_known, shown
from dalembert.forward import Coordinate, ForwardModel
from dalembert.parameter import Parameter


@dataclass(frozen=True, eq=False)
class Experiment:
    """One of several experiments with the same mechanism.

    Parameters
    ----------
    name : str
    model : ForwardModel
        Its samples must be those of the data; it may have more channels.
    data : Measurements
    local : tuple of str
        Parameters that this experiment has for itself, such as its initial state; in the fit they are named
        ``"NAME.parameter"``. Others are shared with the experiments that name them, too.

    Raises
    ------
    InputError
        For a local parameter that the model lacks.
    """

    name: str
    model: ForwardModel
    data: Measurements
    local: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if not isinstance(self.name, str):
            raise InputError(f"Experiment: name is {shown(self.name)}; expected a text")
        check_model(f"Experiment {self.name!r}", self.model)
        if not isinstance(self.data, Measurements):
            raise InputError(f"Experiment {self.name!r}: data is {shown(self.data)}; expected Measurements")
        object.__setattr__(self, "local", names_of(self.local, f"Experiment {self.name!r}", "local"))
        names = [item.name for item in self.model.parameters.declared]
        for name in self.local:
            require_known("parameter", name, names, f"experiment {self.name!r}, local")

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Parameters as the fit names them."""
        return tuple(map(self._named, self.model.parameters))

    @property
    def fixed(self) -> tuple[Parameter, ...]:
        """Fixed parameters as the fit names them."""
        return tuple(map(self._named, self.model.parameters.fixed))

    def values(self, joint: Mapping[str, float]) -> dict[str, float]:
        """Values of the model's parameters, out of those of the fit by name."""
        return {item.name: joint[self._named(item).name] for item in self.model.parameters.declared}

    def _named(self, item: Parameter) -> Parameter:
        return replace(item, name=f"{self.name}.{item.name}") if item.name in self.local else item


@dataclass(frozen=True, eq=False)
class ExperimentPart:
    """Where an experiment stands in the joint response: its samples' rows, its channels' columns."""

    name: str
    coordinate: Coordinate  # its own, shape (samples,)
    channels: tuple[str, ...]  # by their own names
    # rows, columns: (samples,) and (channels,)
    rows: np.ndarray
    columns: np.ndarray

    @property
    def block(self) -> tuple[np.ndarray, ...]:
        """Index of its values in an array of shape (samples, channels) of the joint response."""
        return np.ix_(self.rows, self.columns)

    def first(self, rows: int) -> "ExperimentPart":
        """The same in the first rows of the joint response."""
        samples = int(np.searchsorted(self.rows, rows))
        along = replace(self.coordinate, values=self.coordinate.values[:samples])
        return replace(self, coordinate=along, rows=self.rows[:samples])

    def data(self, joint: Measurements) -> Measurements:
        """Its own measurements among the joint ones."""
        names = [joint.channels[column] for column in self.columns]
        channel_of = dict(zip(names, self.channels, strict=True))
        return replace(
            joint,
            coordinate=self.coordinate,
            channels=self.channels,
            values=joint.values[self.block],
            deviations=None if joint.deviations is None else joint.deviations[self.columns],
            wraps=tuple(channel_of[name] for name in joint.wraps if name in channel_of),
            sampled=None if joint.sampled is None else joint.sampled[self.block],
            source_units={
                channel_of.get(name, name): unit for name, unit in joint.source_units.items() if name in channel_of
            },
        )


@dataclass(frozen=True, eq=False)
class ExperimentFit:
    """An experiment beside the response that is fitted to it, or predicted.

    Parameters
    ----------
    name : str
    data : Measurements
    response, weights : array, shape (samples, channels)
        ``weights`` are 0 where a value was not fitted.
    """

    name: str
    data: Measurements
    response: np.ndarray
    weights: np.ndarray

    @property
    def residuals(self) -> np.ndarray:
        """Response − data, shape (samples, channels)."""
        return self.data.difference(self.response)

    @property
    def fitted(self) -> bool:
        """Whether any of its values was fitted."""
        return bool(np.any(self.weights > 0))


def experiment_fit(
    part: ExperimentPart, data: Measurements, response: np.ndarray, weights: np.ndarray
) -> ExperimentFit:
    """The share of a part in joint data, response and weights (samples, channels)."""
    return ExperimentFit(part.name, part.data(data), response[part.block], weights[part.block])
