"""A motion cut into segments that each begin anew, and must meet: what multiple shooting fits."""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from dalembert.data import Measurements
from dalembert.errors import InputError
from dalembert.forward import Channel, Coordinate, ForwardModel, Responses, check_derivatives
from dalembert.parameters import Parameter, Parameters


@dataclass(frozen=True)
class State:
    """A parameter of the initial state, as it is later in the motion.

    Parameters
    ----------
    channel : str
        Channel of the model whose first value the parameter is.
    lower, upper : float
        Bounds that it keeps throughout the motion, in the channel's unit.
    rate_of : str, optional
        Measured channel whose rate of change it is, to begin with; for a state that is not measured itself.
    """

    channel: str
    lower: float
    upper: float
    rate_of: str | None = None

    def __post_init__(self) -> None:
        if not self.lower < self.upper:
            raise InputError(
                f"State {self.channel!r}: bounds are ({self.lower:g}, {self.upper:g}); expected lower < upper"
            )


@dataclass(frozen=True, eq=False)
class Segments:
    """Segments of a motion as one forward model: their measured channels, and by how much they miss each other.

    Row s holds sample s of every segment; shorter segments are followed by 0. In a segment's last row its end less the
    beginning of the next one stands, one channel a state.

    Parameters
    ----------
    model : ForwardModel
        Autonomous, with even samples from the beginning of the motion on.
    states : mapping of str to State
        By the model's parameters.
    measured : tuple of str
        Channels that are compared.
    cuts : array of int, shape (segments + 1,)
        Samples at which the segments begin and end.
    """

    model: ForwardModel
    states: Mapping[str, State]
    measured: tuple[str, ...]
    cuts: np.ndarray

    @property
    def count(self) -> int:
        return len(self.cuts) - 1

    @property
    def parameters(self) -> Parameters:
        """The model's, and the states at the later beginnings, ``"theta1 at 20"`` for that at sample 20."""
        later = [
            Parameter(f"{name} at {cut}", state.lower, state.upper, self._unit(name))
            for cut in self.cuts[1:-1]
            for name, state in self.states.items()
        ]
        return Parameters((*self.model.parameters.declared, *later))

    @property
    def channels(self) -> tuple[Channel, ...]:
        units = {channel.name: channel.unit for channel in self.model.channels}
        compared = [Channel(f"{name} from {cut}", units[name]) for cut in self.cuts[:-1] for name in self.measured]
        gaps = [
            Channel(f"{name} gap at {cut}", units[state.channel])
            for cut in self.cuts[1:-1]
            for name, state in self.states.items()
        ]
        return (*compared, *gaps)

    @property
    def coordinate(self) -> Coordinate:
        return Coordinate("sample", "", np.arange(np.max(np.diff(self.cuts)) + 1, dtype=float))

    @property
    def fingerprint(self) -> str:
        text = repr((self.model.fingerprint, sorted(self.states), self.measured, self.cuts.tolist()))
        return hashlib.sha256(text.encode()).hexdigest()

    def evaluate(self, vectors: np.ndarray) -> Responses:
        """All segments of all vectors in one batch of the model."""
        vectors = np.atleast_2d(vectors)
        each = np.stack([self._own(vectors, number) for number in range(self.count)], axis=1)
        runs = self._piece.evaluate(each.reshape(-1, each.shape[2]))
        shape = (len(vectors), self.count, *runs.values.shape[1:])
        values = self._arranged(runs.values.reshape(shape))
        values[..., self._gaps] -= self._targets(vectors)
        reasons = np.array(runs.failures, dtype=object).reshape(len(vectors), self.count)
        failures = tuple(next((reason for reason in row if reason is not None), None) for row in reasons)
        values[[reason is not None for reason in failures]] = np.nan
        return Responses(values, failures)

    def jacobian(self, vector: np.ndarray) -> np.ndarray:
        return self.linearise(vector)[1]

    def linearise(self, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Response (rows, channels) and jacobian (rows, channels, parameters)."""
        runs = [self._piece.linearise(self._own(np.asarray(vector), number)) for number in range(self.count)]
        values = self._arranged(np.stack([response for response, _ in runs])[None])[0]
        values[..., self._gaps] -= self._targets(np.asarray(vector)[None])[0]
        jacobian = np.zeros((*values.shape, len(vector)))
        for number, (_, slopes) in enumerate(runs):
            alone = np.zeros((self.count, *slopes.shape))
            alone[number] = slopes
            own = self._arranged(np.moveaxis(alone, 3, 0))  # (parameters, rows, channels)
            jacobian[..., self._places(number)] += np.moveaxis(own, 0, 2)
        for gap, row in zip(self._gaps, self._ends(), strict=True):
            jacobian[row, gap, len(self.model.parameters) + gap - self._gaps[0]] -= 1
        return values, jacobian

    def check_derivatives(self, vector: np.ndarray) -> None:
        """Compare the complex step of the model with differences at a vector (parameters,), in the first segment."""
        check_derivatives(self.model, vector[: len(self.model.parameters)])

    def first(self, samples: int) -> "Segments":
        """The first segments of at most so many samples."""
        return replace(self, cuts=self.cuts[: max(2, int(np.searchsorted(self.cuts, samples)))])

    def spread(self, table: np.ndarray, empty: float) -> np.ndarray:
        """A table of the measured channels (samples, measured) as rows of the segments, ``empty`` where none is.

        The sample at which two segments meet belongs to the earlier one.
        """
        rows = np.full((len(self.coordinate.values), len(self.channels)), empty)
        width = len(self.measured)
        for number, (begin, end) in enumerate(zip(self.cuts[:-1], self.cuts[1:], strict=True)):
            new = 1 if number else 0
            rows[new : end - begin + 1, number * width : (number + 1) * width] = table[begin + new : end + 1]
        return rows

    def joined(self, rows: np.ndarray) -> np.ndarray:
        """Rows of the segments (rows, channels, ...) as samples of the whole motion (samples, measured, ...)."""
        width = len(self.measured)
        parts = [
            rows[(1 if number else 0) : length + 1, number * width : (number + 1) * width]
            for number, length in enumerate(np.diff(self.cuts))
        ]
        return np.concatenate(parts)

    def gaps(self, rows: np.ndarray) -> np.ndarray:
        """Gaps out of rows of the segments (rows, channels, ...), in parts of the states' ranges: (gaps, ...)."""
        ranges = np.tile([state.upper - state.lower for state in self.states.values()], self.count - 1)
        return (rows[self._ends(), self._gaps].T / ranges).T

    @property
    def places_of_gaps(self) -> tuple[np.ndarray, np.ndarray]:
        """Rows and columns of the gaps, both (gaps,)."""
        return self._ends(), self._gaps

    def at(self, data: Measurements) -> Measurements:
        """The measurements as rows of the segments; gaps are not measured."""
        names = tuple(channel.name for channel in self.channels)
        wraps = tuple(f"{name} from {cut}" for cut in self.cuts[:-1] for name in data.wraps)
        return Measurements(self.coordinate, names, self.spread(data.values, np.nan), None, "leave-out", wraps)

    @cached_property
    def _piece(self) -> ForwardModel:
        return self.model.first(len(self.coordinate.values))

    @property
    def _gaps(self) -> np.ndarray:
        """Columns of the gaps."""
        return self.count * len(self.measured) + np.arange((self.count - 1) * len(self.states))

    def _ends(self) -> np.ndarray:
        """Rows in which the gaps stand."""
        return np.repeat(np.diff(self.cuts)[:-1], len(self.states))

    def _unit(self, name: str) -> str:
        return next(item.unit for item in self.model.parameters if item.name == name)

    def _places(self, number: int) -> np.ndarray:
        """Where a segment's parameters stand among all."""
        names = self.model.parameters.names
        places = np.arange(len(names))
        if number:
            later = len(names) + (number - 1) * len(self.states)
            places[[names.index(name) for name in self.states]] = later + np.arange(len(self.states))
        return places

    def _own(self, vectors: np.ndarray, number: int) -> np.ndarray:
        return vectors[..., self._places(number)]

    def _targets(self, vectors: np.ndarray) -> np.ndarray:
        """Beginnings of the later segments where the gaps stand, (batch, rows, gaps)."""
        targets = np.zeros((len(vectors), len(self.coordinate.values), len(self._gaps)))
        columns = np.arange(len(self._gaps))
        targets[:, self._ends(), columns] = vectors[:, len(self.model.parameters) :]
        return targets

    def _arranged(self, runs: np.ndarray) -> np.ndarray:
        """Runs (batch, segments, rows, model's channels) as (batch, rows, channels), ends where the gaps stand."""
        names = [channel.name for channel in self.model.channels]
        picked = [names.index(name) for name in self.measured]
        kept = [names.index(state.channel) for state in self.states.values()]
        values = np.zeros((len(runs), len(self.coordinate.values), len(self.channels)))
        width = len(picked)
        for number, last in enumerate(np.diff(self.cuts)):
            values[:, : last + 1, number * width : (number + 1) * width] = runs[:, number, : last + 1][..., picked]
            if number < self.count - 1:
                begin = self._gaps[0] + number * len(kept)
                values[:, last, begin : begin + len(kept)] = runs[:, number, last][..., kept]
        return values
