"""The weighted misfit between a model and measurements."""

import json
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from hashlib import sha256
from typing import Any, TypeAlias, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike

from dalembert import forward
from dalembert.data import Measurements
from dalembert.errors import DalembertError, SolveError, StorageError
from dalembert.forward import ForwardModel, Pull, prefers_adjoint, pullback
from dalembert.forward.adjoint import ADJOINT, AUTO
from dalembert.forward.folds import recorded_in, summarised
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.loss import Loss
from dalembert.inverse.problem.matching import (
    check_finite,
    check_samples,
    check_sizes,
    check_weighted,
    columns_of,
    weights_of,
)
from dalembert.inverse.problem.prior import check_priors, prior_residual, prior_slopes
from dalembert.inverse.problem.search_coordinates import SearchCoordinates
from dalembert.inverse.problem.simulated import failing_at, simulated

ADJOINT_COST = 4
"""Simulations that a gradient by the adjoint counts as."""


@dataclass(frozen=True, eq=False)
class Linearisation:
    """Response (samples, channels) and jacobian (samples, channels, parameters) at a vector (parameters,)."""

    vector: np.ndarray
    response: np.ndarray
    jacobian: np.ndarray


Item = TypeVar("Item")
Work: TypeAlias = Callable[["MisfitProblem", Item], object]


@dataclass(frozen=True, eq=False)
class MisfitProblem:
    """Misfit g(p) = Σ W (R(p) − data)² over samples and channels, + the squared residuals of priors.

    Values that are missing have W = 0; differences of wrapping channels count modulo a turn.
    """

    model: ForwardModel
    data: Measurements
    columns: np.ndarray  # (channels,): where the data's channels stand among the model's
    weights: np.ndarray  # (samples, channels): W
    search: SearchCoordinates
    journal: Journal
    # loss: the square if not given; all that is minimised are squares of residuals that it has transformed
    loss: Loss | None = None
    # derivative: {"auto", "direct", "adjoint"}: how gradients are computed, see :func:`dalembert.forward.pullback`
    derivative: str = AUTO

    @property
    def samples(self) -> int:
        return len(self.data.coordinate.values)

    @property
    def compared(self) -> int:
        """Number of values that count, those of priors among them."""
        return int(np.count_nonzero(self.weights)) + self.priors

    @property
    def priors(self) -> int:
        """Number of parameters of which something is known before the data."""
        return len(self.model.parameters.square_priors)

    def prefetched(self, work: Work[Item], items: Sequence[Item]) -> Generator[Item, None, None]:
        """Yield the items in their order; where the model is on a cluster, answers for work on each come first.

        ``work`` is called on the workers with a problem that reports no events.
        """
        alone = replace(self, model=cast(Any, None), journal=Journal(self.samples))
        return forward.prefetched(self.model, partial(_posed, alone, work), items)

    def first(self, samples: int) -> "MisfitProblem":
        """The same problem over the first ``samples`` samples."""
        if samples == self.samples:
            return self
        return replace(
            self, model=self.model.first(samples), data=self.data.first(samples), weights=self.weights[:samples]
        )

    def responses(self, vectors: np.ndarray) -> np.ndarray:
        """Responses (batch, samples, channels) at parameter vectors (batch, parameters); NaN where a sample failed."""
        return simulated(self.model, self.columns, self.journal, vectors)

    def misfit(self, points: np.ndarray) -> np.ndarray:
        """Misfit (batch,) at search points (batch, parameters); NaN where a sample failed. A checkpoint keeps that of
        several points in place of the responses, with the reasons of failures and the journal's first response.
        """
        vectors, known = self.search.vectors(points), self.journal.first
        if len(vectors) < 2 or not self._is_recorded:
            return self._misfit(vectors, self.journal)
        journal = Journal(self.samples, first=known)

        def compute() -> tuple[np.ndarray, ...]:
            misfit, first = self._misfit(vectors, journal), journal.first
            reasons = np.frombuffer(json.dumps(journal.failures).encode(), np.uint8)
            return misfit, reasons, *([] if first is None or first is known else [first.response])

        misfit, reasons, *first = summarised(self.model, self._compared_with, vectors, compute)
        self.journal.simulations += len(vectors)
        self.journal.failures.extend(json.loads(reasons.tobytes()))
        for response in first:
            self.journal.computed(vectors[0], response)
        return misfit

    def _misfit(self, vectors: np.ndarray, journal: Journal) -> np.ndarray:
        responses = simulated(self.model, self.columns, journal, vectors)
        prior = np.sum(prior_residual(self.model.parameters, vectors) ** 2, axis=1)
        if self.loss is not None:
            return np.sum(self.squares(responses), axis=(1, 2)) + prior
        with np.errstate(over="ignore"):
            return np.einsum("sc,bsc->b", self.weights, self.unweighted_residual(responses) ** 2) + prior

    @cached_property
    def _is_recorded(self) -> bool:
        return recorded_in(self.model) is not None

    @cached_property
    def _compared_with(self) -> str:
        """What the misfit depends on beside the vectors: model, priors, data, weights and loss."""
        numbers = sha256(self.weights.tobytes() + self.columns.tobytes()).hexdigest()
        words = self.model.fingerprint, repr(self.model.parameters), self.data.fingerprint, repr(self.loss)
        return "\n".join(("misfit", *words, numbers))

    def squares(self, responses: np.ndarray) -> np.ndarray:
        """What each value adds to the misfit, both (..., samples, channels)."""
        with np.errstate(over="ignore"):  # infinite squares are a failed sample's
            if self.loss is not None:
                return self.loss.residual(np.sqrt(self.weights) * self.unweighted_residual(responses)) ** 2
            return self.weights * self.unweighted_residual(responses) ** 2

    def unweighted_residual(self, response: np.ndarray) -> np.ndarray:
        """R − data, both (..., samples, channels); 0 where a value is missing, NaN elsewhere if a sample failed."""
        return np.where(self.data.present, self.data.difference(response), 0.0)

    def linearise(self, vector: np.ndarray) -> Linearisation:
        """Response and jacobian at a parameter vector."""
        self.journal.simulations += 1 + len(vector)
        with failing_at(self.model, self.journal, vector):
            response, jacobian = self.model.linearise(vector)
            if not (np.all(np.isfinite(response)) and np.all(np.isfinite(jacobian))):
                raise SolveError("the response or its jacobian is not finite")
        if self.journal.first is None:
            self.journal.computed(vector, response[:, self.columns])
        return Linearisation(vector, response[:, self.columns], jacobian[:, self.columns])

    @property
    def by_adjoint(self) -> bool:
        """Whether gradients come from the adjoint."""
        return self.derivative == ADJOINT or (self.derivative == AUTO and prefers_adjoint(self.model))

    def pulled(self, vector: np.ndarray) -> tuple[np.ndarray, Pull]:
        """Response (samples, channels), and the gradients of its weighted sums (parameters,) by the adjoint."""
        self.journal.simulations += ADJOINT_COST
        with failing_at(self.model, self.journal, vector):
            response, pull_model = pullback(self.model, vector, ADJOINT)
            if not np.all(np.isfinite(response)):
                raise SolveError("the response is not finite")
        if self.journal.first is None:
            self.journal.computed(vector, response[:, self.columns])

        def pull(cotangent: np.ndarray) -> np.ndarray:
            whole = np.zeros_like(response)
            np.add.at(whole.T, self.columns, cotangent.T)
            return pull_model(whole)

        return response[:, self.columns], pull

    def linearised(self, vector: np.ndarray) -> Linearisation | None:
        """Response and jacobian at a parameter vector; None where the model gives no jacobian."""
        try:
            return self.linearise(vector)
        except StorageError:
            raise
        except DalembertError:
            return None

    def residual(self, response: np.ndarray) -> np.ndarray:
        """W^½ (R − data), transformed by the loss, as a vector, shape (samples × channels,)."""
        plain = (np.sqrt(self.weights) * self.unweighted_residual(response)).ravel()
        return plain if self.loss is None else self.loss.residual(plain)

    def residuals(self, vector: np.ndarray, response: np.ndarray) -> np.ndarray:
        """:meth:`residual`, and the priors' behind it: what the misfit is the sum of squares of."""
        residual = self.residual(response)
        return np.concatenate([residual, prior_residual(self.model.parameters, vector)]) if self.priors else residual

    def slopes(self, at: Linearisation, unit: np.ndarray | None = None) -> np.ndarray:
        """Jacobian of :meth:`residuals` with respect to p/unit, (samples × channels + priors, parameters).

        Without ``unit`` (parameters,) with respect to the search coordinates.
        """
        unit = self.search.slope(at.vector) if unit is None else unit
        rows = (self.weighted(at.jacobian, at.response) * unit).reshape(-1, len(at.vector))
        return np.concatenate([rows, prior_slopes(self.model.parameters, at.vector, unit)]) if self.priors else rows

    def weighted(self, table: np.ndarray, response: np.ndarray) -> np.ndarray:
        """Changes (samples, channels, ...) of a response (samples, channels) as changes of the residuals."""
        factor = np.sqrt(self.weights)
        if self.loss is not None:
            factor = factor * self.loss.slope(factor * self.unweighted_residual(response))
        return factor.reshape(*factor.shape, *[1] * (table.ndim - 2)) * table

    def gradient(self, point: np.ndarray) -> np.ndarray:
        """Gradient of the misfit at a search point, both (parameters,); zero where the sample fails."""
        vector = self.search.vectors(point)
        try:
            if self.by_adjoint:
                return self._gradient_by_adjoint(vector)
            at = self.linearise(vector)
        except SolveError:
            return np.zeros_like(point)
        return 2 * self.slopes(at).T @ self.residuals(at.vector, at.response)

    def slope(self, vector: np.ndarray) -> np.ndarray:
        """Gradient of the misfit by the parameters, without priors, at a vector, both (parameters,)."""
        if not self.by_adjoint:
            at = self.linearise(vector)
            rows = self.weighted(at.jacobian, at.response).reshape(-1, len(vector))
            return 2 * rows.T @ self.residual(at.response)
        response, pull = self.pulled(vector)
        return 2 * pull(self.weighted(self.residual(response).reshape(response.shape), response))

    def _gradient_by_adjoint(self, vector: np.ndarray) -> np.ndarray:
        parameters, unit = self.model.parameters, self.search.slope(vector)
        priors = prior_slopes(parameters, vector, unit).T @ prior_residual(parameters, vector) if self.priors else 0.0
        return self.slope(vector) * unit + 2 * priors


def _posed(alone: MisfitProblem, work: Work[Item], model: ForwardModel, item: Item) -> None:
    work(replace(alone, model=model), item)


def pose(
    model: ForwardModel, data: Measurements, weights: ArrayLike | None, journal: Journal, *, noise_known: bool = False
) -> MisfitProblem:
    """The problem of explaining data by a model, after checking that they fit together.

    ``noise_known`` means that priors may be given, although the data have neither deviations nor weights.
    """
    check_priors(model.parameters, known=noise_known or weights is not None or data.deviations is not None)
    columns = columns_of(model, data)
    check_finite(data)
    check_samples(model, data)
    check_sizes(data)
    weighted = _weights(data, weights)
    check_weighted(data, weighted)
    return MisfitProblem(model, data, columns, weighted, SearchCoordinates(model.parameters), journal)


def _weights(data: Measurements, given: ArrayLike | None) -> np.ndarray:
    """W of shape (samples, channels), 0 where a value is missing."""
    if given is None and data.deviations is not None:
        weights = np.broadcast_to(data.deviations**-2.0, data.values.shape)
    else:
        weights = weights_of(given, data.values.shape)
    return weights if np.all(data.present) else np.where(data.present, weights, 0.0)
