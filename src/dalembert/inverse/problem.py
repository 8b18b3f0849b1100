"""The weighted misfit between a model and measurements."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from dalembert.data import Measurements
from dalembert.errors import DataError, InputError, SolveError, unknown
from dalembert.forward import ForwardModel
from dalembert.inverse.journal import Journal
from dalembert.inverse.search import Search


@dataclass(frozen=True, eq=False)
class Linearisation:
    """Response (samples, channels) and jacobian (samples, channels, parameters) at a vector (parameters,)."""

    vector: np.ndarray
    response: np.ndarray
    jacobian: np.ndarray


@dataclass(frozen=True, eq=False)
class Problem:
    """Fitness g(p) = Σ W (R(p) − data)² over samples and channels.

    Parameters
    ----------
    model : ForwardModel
    data : Measurements
    columns : array of int, shape (channels,)
        Where the data's channels stand among the model's.
    weights : array, shape (samples, channels)
        W.
    search : Search
    journal : Journal
    """

    model: ForwardModel
    data: Measurements
    columns: np.ndarray
    weights: np.ndarray
    search: Search
    journal: Journal

    @property
    def samples(self) -> int:
        return len(self.data.coordinate.values)

    @property
    def compared(self) -> int:
        """Number of values that count."""
        return int(np.count_nonzero(self.weights))

    def first(self, samples: int) -> "Problem":
        """The same problem over the first ``samples`` samples."""
        if samples == self.samples:
            return self
        return replace(
            self, model=self.model.first(samples), data=self.data.first(samples), weights=self.weights[:samples]
        )

    def responses(self, vectors: np.ndarray) -> np.ndarray:
        """Responses (batch, samples, channels) at parameter vectors (batch, parameters); NaN where a sample failed."""
        responses = self.model.evaluate(vectors)
        self.journal.simulations += len(vectors)
        self.journal.failures.extend(
            f"{reason} (at {self._named(vector)})"
            for vector, reason in zip(vectors, responses.failures, strict=True)
            if reason is not None
        )
        values = responses.values[:, :, self.columns].astype(float)
        values[~responses.ok] = np.nan
        return values

    def fitness(self, points: np.ndarray) -> np.ndarray:
        """Fitness (batch,) at search points (batch, parameters); NaN where a sample failed."""
        residuals = self.responses(self.search.vectors(points)) - self.data.values
        return np.einsum("sc,bsc->b", self.weights, residuals**2)

    def linearise(self, vector: np.ndarray) -> Linearisation:
        """Response and jacobian at a parameter vector.

        Raises
        ------
        SolveError
            Whatever goes wrong in the simulation at this vector.
        """
        self.journal.simulations += 1 + len(vector)
        try:
            response, jacobian = self.model.linearise(vector)
            if not (np.all(np.isfinite(response)) and np.all(np.isfinite(jacobian))):
                raise SolveError("the response or its jacobian is not finite")
        except InputError:  # a model that cannot be differentiated at all: no other vector will do better
            raise
        except Exception as error:  # whatever a user's function raises is this vector's failure
            self.journal.failures.append(f"{error} (at {self._named(vector)})")
            raise SolveError(str(error)) from error
        return Linearisation(vector, response[:, self.columns], jacobian[:, self.columns])

    def residual(self, response: np.ndarray) -> np.ndarray:
        """W^½ (R − data) as a vector, shape (samples × channels,)."""
        return (np.sqrt(self.weights) * (response - self.data.values)).ravel()

    def slopes(self, at: Linearisation, unit: np.ndarray | None = None) -> np.ndarray:
        """Jacobian of :meth:`residual` with respect to p/unit, (samples × channels, parameters).

        Without ``unit`` (parameters,) with respect to the search coordinates.
        """
        unit = self.search.slope(at.vector) if unit is None else unit
        jacobian = np.sqrt(self.weights)[:, :, None] * at.jacobian * unit
        return jacobian.reshape(-1, len(at.vector))

    def gradient(self, point: np.ndarray) -> np.ndarray:
        """Gradient of the fitness at a search point, both (parameters,); zero where the sample fails."""
        try:
            at = self.linearise(self.search.vectors(point))
        except SolveError:
            return np.zeros_like(point)
        return 2 * self.slopes(at).T @ self.residual(at.response)

    def _named(self, vector: np.ndarray) -> str:
        return ", ".join(f"{name} = {value:.6g}" for name, value in self.model.parameters.mapping(vector).items())


def pose(model: ForwardModel, data: Measurements, weights: ArrayLike | None, journal: Journal) -> Problem:
    """The problem of explaining data by a model, after checking that they fit together.

    Raises
    ------
    DataError
        For a NaN, a channel that the model lacks, samples that lie elsewhere than the model's.
    InputError
        For weights of another shape, or negative.
    """
    names = tuple(channel.name for channel in model.channels)
    for channel in data.channels:
        if channel not in names:
            raise DataError(unknown("channel", channel, names, "the data name a channel that the model does not give"))
    _check_finite(data)
    _check_samples(model, data)
    columns = np.array([names.index(channel) for channel in data.channels])
    return Problem(model, data, columns, _weights(data, weights), Search(model.parameters), journal)


def _check_finite(data: Measurements) -> None:
    missing = np.argwhere(~np.isfinite(data.values))
    if len(missing):
        sample, column = missing[0]
        raise DataError(
            f"channel {data.channels[column]!r}, sample {sample} ({data.coordinate.name} "
            f"{data.coordinate.values[sample]:.10g} {data.coordinate.unit}): {data.values[sample, column]}; "
            f"expected a finite number ({len(missing)} are not); leave out these samples or the channel"
        )


def _check_samples(model: ForwardModel, data: Measurements) -> None:
    ours, theirs = model.coordinate, data.coordinate
    advice = "build the model with the samples of the data"
    if len(ours.values) != len(theirs.values):
        raise DataError(
            f"the data have {len(theirs.values)} samples and the model {len(ours.values)}; expected the same; {advice}"
        )
    apart = np.abs(ours.values - theirs.values)
    if np.max(apart) > 1e-9 * max(1.0, float(np.max(np.abs(ours.values)))):
        sample = int(np.argmax(apart))
        raise DataError(
            f"sample {sample}: the data lie at {theirs.name} {theirs.values[sample]:.10g} {theirs.unit}, "
            f"the model's response at {ours.values[sample]:.10g} {ours.unit}; expected the same; {advice}"
        )


def _weights(data: Measurements, given: ArrayLike | None) -> np.ndarray:
    """W of shape (samples, channels)."""
    shape = data.values.shape
    if given is None:
        return np.broadcast_to(1.0 if data.deviations is None else data.deviations**-2.0, shape)
    weights = np.asarray(given, dtype=float)
    if weights.shape not in (shape, shape[1:]):
        raise InputError(
            f"weights of shape {weights.shape} were given; expected (channels,) = {shape[1:]} or "
            f"(samples, channels) = {shape}"
        )
    if not (np.all(np.isfinite(weights)) and np.all(weights >= 0) and np.any(weights > 0)):
        raise InputError("weights must be finite and not negative, and at least one of them positive")
    return np.broadcast_to(weights, shape)
