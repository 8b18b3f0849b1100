"""Segments of a motion that must meet: least squares under the conditions of continuity."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from dalembert.errors import SolveError
from dalembert.inverse.journal import Journal
from dalembert.inverse.problem import Linearisation, Problem
from dalembert.inverse.search import Search
from dalembert.inverse.segments import Segments, State
from dalembert.optimize import LeastSquares, Progress

LADDER = 10.0 ** -np.arange(1, 7)
"""Gaps, in parts of the states' ranges, that weigh as much as one deviation of the data: ever smaller ones."""

MET = 1e-8
"""Gap, in parts of the states' ranges, at which segments are said to meet: less than an integrator that begins anew
makes."""

ROUNDS = 6
"""Of multipliers, at most: each makes the gaps some orders of magnitude smaller."""

LEADING = LeastSquares(trials=15, tolerance=1e-8, gain=1e-8)
"""Of one rung of the ladder."""

LEFT = 1e-3
"""Fall of the sum of squares, as a fraction, by a step after which a rung is left."""


class _Led(Exception):
    """A rung of the ladder led as far as it is worth."""


@dataclass(frozen=True, eq=False)
class Found:
    """Where segments that must meet ended: their search point, the misfit to the data alone, and the largest gap."""

    point: np.ndarray
    misfit: float
    gap: float

    @property
    def met(self) -> bool:
        return self.gap <= MET


@dataclass(frozen=True, eq=False)
class Chain:
    """Parameters and states at the segments' beginnings for which the misfit is least and every gap is zero.

    min F(z)ᵀF(z) subject to c(z) = 0, with the weighted residuals F of all segments and the gaps c between them.

    Parameters
    ----------
    problem : Problem
        Of one run.
    states : mapping of str to State
    cuts : array of int, shape (segments + 1,)
    """

    problem: Problem
    states: Mapping[str, State]
    cuts: np.ndarray
    _kept: list[Linearisation] = field(default_factory=list, init=False, repr=False)

    @cached_property
    def pieces(self) -> Segments:
        return Segments(self.problem.model, self.states, self.problem.data.channels, self.cuts)

    @cached_property
    def inner(self) -> Problem:
        """The segments against their data, gaps left out; its simulations are parts of runs, and counted elsewhere."""
        whole, pieces = self.problem, self.pieces
        own = Journal(len(pieces.coordinate.values), failures=whole.journal.failures)
        columns = np.arange(len(pieces.channels))
        weights = pieces.spread(whole.weights, 0.0)
        return replace(
            whole,
            model=pieces,
            data=pieces.at(whole.data),
            columns=columns,
            weights=weights,
            search=Search(pieces.parameters),
            journal=own,
        )

    def closed(self, point: np.ndarray) -> Found:
        """Gaps closed from a search point on: their weight grows, then multipliers take what is left to zero."""
        found = Found(point, np.inf, self._gap(point))
        for tightness in LADDER[np.searchsorted(-LADDER, -max(10 * found.gap, LADDER[-1])) :]:
            found = self._solved(found.point, tightness, np.zeros(1))
        shift, tightness = np.zeros(1), LADDER[-1]
        for _ in range(ROUNDS):
            if found.met:
                break
            shift = shift + self.pieces.gaps(self._response(found.point))
            found = self._solved(found.point, tightness, shift)
        return found

    def linearised(self, point: np.ndarray) -> Linearisation:
        """Response of the whole motion and its jacobian along the segments that meet, (samples, channels, parameters).

        The states at a segment's beginning follow from those before it, ds' = X ds + P dp.
        """
        at, number = self._linearise(point), len(self.problem.model.parameters)
        slopes = at.jacobian @ self._following(at.jacobian)
        return Linearisation(at.vector[:number], self.pieces.joined(at.response), self.pieces.joined(slopes))

    def met(self, point: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
        """States at the later beginnings, their gaps, both (gaps,), and the growth from the first state to the last."""
        at, number = self._linearise(point), len(self.problem.model.parameters)
        ends, gaps = self.pieces.places_of_gaps
        names, count = self.problem.model.parameters.names, len(self.states)
        ranges = np.array([state.upper - state.lower for state in self.states.values()])
        first = [names.index(name) for name in self.states]
        last = self._following(at.jacobian)[-count:, first] * ranges / ranges[:, None]
        return at.vector[number:], at.response[ends, gaps], float(np.linalg.norm(last, 2))

    def _following(self, jacobian: np.ndarray) -> np.ndarray:
        """Derivative of all unknowns by the model's parameters, gaps staying as they are, (unknowns, parameters)."""
        number = len(self.problem.model.parameters)
        follow = np.concatenate([np.eye(number), np.zeros((jacobian.shape[2] - number, number))])
        ends, gaps = self.pieces.places_of_gaps
        for k, (end, gap) in enumerate(zip(ends, gaps, strict=True)):  # the gap's derivative by its own state is -1
            row = jacobian[end, gap].copy()
            row[number + k] = 0.0
            follow[number + k] = row @ follow
        return follow

    def _solved(self, point: np.ndarray, tightness: float, shift: np.ndarray) -> Found:
        """Least F² + ((c + shift)/tightness)² from a search point on."""
        search, journal, inner = self.inner.search, self.problem.journal, self.inner
        best = Found(point, np.inf, np.inf)
        least, before, hopeful = np.inf, np.inf, True

        def residual(now: np.ndarray) -> np.ndarray:
            nonlocal best, least, hopeful
            vector = search.vectors(now)
            try:
                response = self._linearise(now).response if hopeful else self._response(now)
            except SolveError:
                return np.full(1, np.nan)
            finally:
                hopeful = False
            misfits, gaps = inner.residuals(vector, response), self.pieces.gaps(response)
            total = np.concatenate([misfits, (gaps + shift) / tightness])
            if total @ total < least:
                least = float(total @ total)
                best = Found(now, float(misfits @ misfits), float(np.max(np.abs(gaps), initial=0.0)))
            return total

        def jacobian(now: np.ndarray) -> np.ndarray:
            nonlocal hopeful
            at, hopeful = self._linearise(now), True
            gaps = self.pieces.gaps(at.jacobian) * search.slope(at.vector)
            return np.concatenate([inner.slopes(at), gaps / tightness])

        def progress(_: Progress) -> None:
            nonlocal before
            values = search.vectors(best.point)[: len(self.problem.model.parameters)]
            journal.step(best.misfit, values, self.problem.samples, gap=best.gap)
            if least > (1 - LEFT) * before:
                raise _Led
            before = least

        try:
            LEADING.minimise(residual, jacobian, search.lower, search.upper, point, on_iteration=progress)
        except (SolveError, _Led):
            return best
        return best

    def _gap(self, point: np.ndarray) -> float:
        return float(np.max(np.abs(self.pieces.gaps(self._response(point))), initial=0.0))

    def _response(self, point: np.ndarray) -> np.ndarray:
        """Rows of the segments at a search point; together they are one simulation."""
        self.problem.journal.simulations += 1
        return self.inner.responses(self.inner.search.vectors(point)[None])[0]

    def _linearise(self, point: np.ndarray) -> Linearisation:
        """Linearisation at a search point; the last one is kept, since one rung begins where the other ended."""
        vector = self.inner.search.vectors(point)
        if not (self._kept and np.array_equal(self._kept[0].vector, vector)):
            self.problem.journal.simulations += 1 + len(self.problem.model.parameters)
            self._kept[:] = [self.inner.linearise(vector)]
        return self._kept[0]
