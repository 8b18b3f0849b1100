"""Segments of a motion that must meet: least squares under the conditions of continuity."""

from collections.abc import Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from functools import cached_property, reduce

import numpy as np

from dalembert.errors import SolveError
from dalembert.inverse.least_squares.estimate import UNSEEN
from dalembert.inverse.problem.prior import prior_residual, prior_slopes
from dalembert.inverse.problem.problem import Linearisation, MisfitProblem
from dalembert.inverse.problem.search_coordinates import SearchCoordinates
from dalembert.inverse.problem.simulated import failing_at
from dalembert.inverse.shooting.segments import Response, Segments, Tangent
from dalembert.optimize import LeastSquares, Progress

LADDER = 10.0 ** -np.arange(1, 7)
"""Gaps, in parts of the states' ranges, that weigh as much as one deviation of the data: ever smaller ones."""

MET = 1e-8
"""Gap, in parts of the states' ranges, at which segments are said to meet: less than an integrator that begins anew
makes."""

CLOSED = 1e-9
"""Gap at which the steps under exact conditions end: they converge quadratically."""

NEAR = 0.03
"""Gap from which on the conditions are linear enough for such steps."""

STEPS = 20
"""Of these, at most."""

SHORTEST = 1 / 32
"""Part of a step below which they have failed."""

FALL = 1e-6
"""Part of the misfit by which a step must foresee it to fall; less is the end."""

ROUNDS = 6
"""Of multipliers, at most: each makes the gaps some orders of magnitude smaller."""

LEADING = LeastSquares(trials=15, tolerance=1e-8, gain=1e-8)
"""Of one rung of the ladder."""

FIRST = LeastSquares(trials=100, tolerance=1e-6, gain=1e-3)
"""Of the first rung, which leads from far away: gaps hardly count."""

LEFT = 1e-3
"""Fall of the sum of squares, as a fraction, by a step after which a rung is left."""


class _Led(Exception):
    """A rung of the ladder led as far as it is worth."""


@dataclass(frozen=True, eq=False)
class ChainEnd:
    """Where segments that must meet ended: their search point, the misfit to the data alone, and the largest gap."""

    point: np.ndarray
    misfit: float
    gap: float

    @property
    def closed(self) -> bool:
        return self.gap <= MET


@dataclass(frozen=True, eq=False)
class Chain:
    """Parameters and states at the segments' beginnings for which the misfit is least and every gap is zero.

    min F(z)ᵀF(z) subject to c(z) = 0, with the weighted residuals F of all segments and the gaps c between them.
    """

    problem: MisfitProblem  # of the whole motions
    segments: Segments
    _kept: list[Tangent] = field(default_factory=list, init=False, repr=False)

    @cached_property
    def search(self) -> SearchCoordinates:
        """Coordinates in which all unknowns are searched."""
        return SearchCoordinates(self.segments.parameters)

    def closed(self, point: np.ndarray, *, merged: bool = False) -> ChainEnd:
        """Gaps closed from a search point on: their weight grows, then the conditions of continuity hold exactly. Where
        the steps to the exact conditions fail, the weight grows further, and multipliers close the gaps. Segments that
        were ``merged`` from others which met have no such gaps: where the steps fail, they are too long.
        """
        found = ChainEnd(point, np.inf, float(np.max(np.abs(self._linearise(point).response.gaps), initial=0.0)))
        if merged:
            return self._met(found.point)
        for tightness in LADDER[np.searchsorted(-LADDER, -max(10 * found.gap, LADDER[-1])) :]:
            if found.gap <= NEAR:
                close = self._met(found.point)
                if close.closed:
                    return close
            found = self._solved(found.point, tightness, np.zeros(1), far=tightness == LADDER[0])
        shift, tightness = np.zeros(1), LADDER[-1]
        for _ in range(ROUNDS):
            if found.closed:
                break
            shift = shift + self._response(found.point).gaps
            found = self._solved(found.point, tightness, shift)
        return found

    def _met(self, point: np.ndarray) -> ChainEnd:
        """Steps of Gauss and Newton under the linearised conditions, each accepted by a filter. A step must not be
        worse in both, the misfit and the gaps, than any point before it. Source: H. G. Bock, 1983 (generalised
        Gauss-Newton); R. Fletcher and S. Leyffer, Nonlinear programming without a penalty function, Mathematical
        Programming 91 (2002).
        """
        search = self.search
        best = now = self._found(point, self._linearise(point).response)
        known = [(now.gap, now.misfit)]
        for _ in range(STEPS):
            at = self._linearise(now.point)
            step, foreseen = self._step(at)
            trial, length = None, 1.0
            while length >= SHORTEST:
                moved = np.clip(now.point + length * step, search.lower, search.upper)
                try:
                    response = self._linearise(moved).response if length == 1.0 else self._response(moved)
                except SolveError:
                    length /= 2
                    continue
                trial = self._found(moved, response)
                if all(trial.gap <= (1 - 1e-3) * gap or trial.misfit <= left - 1e-6 * left for gap, left in known):
                    break
                if trial.closed and trial.misfit <= now.misfit * (1 + 1e-9):
                    break
                trial, length = None, length / 2
            if trial is None:
                return best
            now = trial
            known.append((now.gap, now.misfit))
            if now.closed and (not best.closed or now.misfit <= best.misfit):
                best = now
            self._tell(now, now.misfit)
            if now.gap <= CLOSED and foreseen <= FALL * now.misfit and length == 1.0:
                return best
        return best

    def _found(self, point: np.ndarray, response: Response) -> ChainEnd:
        values = self.search.vectors(point)[: len(self.problem.model.parameters)]
        left = self.problem.residuals(values, response.values)
        return ChainEnd(point, float(left @ left), float(np.max(np.abs(response.gaps), initial=0.0)))

    def _step(self, at: Tangent) -> tuple[np.ndarray, float]:
        """Search step dz of least (F + J dz)² under c + C dz = 0, and the fall of the misfit that it foresees. It is
        the sum of the shortest one that closes the gaps and of one along the null space of C. Parameters at bounds that
        it would pass stay there.
        """
        search, point = self.search, self.search.points(at.vector)
        rows, slopes = self._misfits(at), self.segments.slopes_of_gaps(at) * self.search.slope(at.vector)
        free = np.ones(len(point), dtype=bool)
        step, foreseen = np.zeros(len(point)), 0.0
        for _ in range(3):
            q, r = np.linalg.qr(slopes[:, free].T, mode="complete")
            number = len(slopes)
            closing = q[:, :number] @ np.linalg.solve(r[:number].T, -at.response.gaps)
            within = rows[:, :-1][:, free] @ q[:, number:]
            left = rows[:, -1] + rows[:, :-1][:, free] @ closing
            along = np.linalg.lstsq(within, -left, rcond=1e-13)[0]
            step = np.zeros(len(point))
            step[free] = closing + q[:, number:] @ along
            foreseen = float(np.sum((within @ along) ** 2))
            over = ((point >= search.upper) & (step > 0)) | ((point <= search.lower) & (step < 0))
            over[len(self.problem.model.parameters) :] = False
            if not np.any(over & free):
                break
            free &= ~over
        return step, foreseen

    def _tell(self, found: ChainEnd, minimised: float) -> None:
        values = self.search.vectors(found.point)[: len(self.problem.model.parameters)]
        self.problem.journal.step(found.misfit, values, self.problem.samples, gap=found.gap, minimised=minimised)

    def led(self, point: np.ndarray) -> ChainEnd:
        """Least misfit near a search point, where gaps hardly count."""
        return self._solved(point, LADDER[0], np.zeros(1), far=True)

    def passed(self, point: np.ndarray) -> list[list[np.ndarray]]:
        """Derivatives of each beginning's state by that of the one before, in parts of the ranges; a list a motion."""
        at, number = self._linearise(point), len(self.problem.model.parameters)
        motions: list[list[np.ndarray]] = [[]]
        before = np.zeros(0, dtype=int)
        for piece, ends in zip(self.segments.pieces, at.ends, strict=True):
            if not len(piece.begins):
                motions.append([])
            elif len(before):
                ranges, was = (self.segments.ranges[places - number] for places in (piece.begins, before))
                motions[-1].append(ends[:, np.searchsorted(piece.places, before)] * was / ranges[:, None])
            before = piece.begins
        return motions[:-1]

    def linearised(self, point: np.ndarray) -> Linearisation:
        """Response of the whole motions and its jacobian along segments that meet, (samples, channels, parameters).

        The states at a segment's beginning follow from those before it, ds' = X ds + P dp.
        """
        at, number = self._linearise(point), len(self.problem.model.parameters)
        slopes = self.segments.jacobian(at) @ self._following(at)
        return Linearisation(at.vector[:number], at.response.values, slopes)

    def spread(self, point: np.ndarray) -> np.ndarray:
        """Return S (parameters, parameters) with the covariance S Sᵀ of the model's parameters, at unit variance. With
        an orthonormal basis Z of the null space of the conditions it is Z (Zᵀ JᵀWJ Z)⁻¹ Zᵀ. The derivatives of whole
        motions, which errors make grow without bound, are not formed.
        """
        at = self._linearise(point)
        unit, number = self.search.slope(at.vector), len(self.problem.model.parameters)
        rows, slopes = self._misfits(at)[:, :-1], self.segments.slopes_of_gaps(at) * unit
        basis = np.linalg.qr(slopes.T, mode="complete")[0][:, len(slopes) :]
        _, singular, directions = np.linalg.svd(rows @ basis, full_matrices=False)
        least = UNSEEN * (singular[0] or 1.0)
        return unit[:number, None] * (basis @ directions.T / np.maximum(singular, least))[:number]

    def met(self, point: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """States at the later beginnings, and their gaps, both (gaps,)."""
        at = self._linearise(point)
        return at.vector[len(self.problem.model.parameters) :], at.response.gaps * self.segments.ranges

    def growth(self, point: np.ndarray, first: Sequence[np.ndarray]) -> float:
        """Growth of a small change by the last beginning of a segment of each motion, the largest of all. Both are in
        parts of the ranges. The change is one of the parameters ``first`` of each motion, those of its initial state in
        the order of the states; or, without them, of the state at the first later beginning.
        """
        if not len(first):
            return max(
                float(np.linalg.norm(reduce(lambda all_, one: one @ all_, own), 2)) if own else 1.0
                for own in self.passed(point)
            )
        follow, number = self._following(self._linearise(point)), len(self.problem.model.parameters)
        largest, motion, begins = 0.0, 0, np.zeros(0, dtype=int)
        for piece in self.segments.pieces:
            if len(piece.begins):
                begins = piece.begins
                continue
            ranges = self.segments.ranges[begins - number]
            passed = follow[np.ix_(begins, first[motion])] * ranges / ranges[:, None]
            largest, motion = max(largest, float(np.linalg.norm(passed, 2))), motion + 1
        return largest

    def _following(self, at: Tangent) -> np.ndarray:
        """Derivative of all unknowns by the problem's parameters, gaps staying as they are, (unknowns, parameters)."""
        number = len(self.problem.model.parameters)
        follow = np.concatenate([np.eye(number), np.zeros((len(at.vector) - number, number))])
        for piece, ends in zip(self.segments.pieces, at.ends, strict=True):
            follow[piece.begins] = ends @ follow[piece.places]
        return follow

    def _solved(self, point: np.ndarray, tightness: float, shift: np.ndarray, *, far: bool = False) -> ChainEnd:
        """Least F² + ((c + shift)/tightness)² from a search point on. Least squares get the sum's root as the first
        residual and zeros behind it, as many as there are unknowns, with the slopes turned accordingly: sums of
        squares, gradients and normal matrices are those of all residuals.
        """
        search, problem = self.search, self.problem
        best = ChainEnd(point, np.inf, np.inf)
        least, before, hopeful = np.inf, np.inf, True

        def residual(now: np.ndarray) -> np.ndarray:
            nonlocal best, least, hopeful
            vector = search.vectors(now)
            total = np.zeros(len(vector) + 1)
            try:
                response = self._linearise(now).response if hopeful else self._response(now)
            except SolveError:
                total[0] = np.nan
                return total
            finally:
                hopeful = False
            misfits = problem.residuals(vector[: len(problem.model.parameters)], response.values)
            gaps = (response.gaps + shift) / tightness
            misfit = float(misfits @ misfits)
            total[0] = np.sqrt(misfit + gaps @ gaps)
            if total[0] ** 2 < least:
                least = total[0] ** 2
                best = ChainEnd(now, misfit, float(np.max(np.abs(response.gaps), initial=0.0)))
            return total

        def jacobian(now: np.ndarray) -> np.ndarray:
            nonlocal hopeful
            at, hopeful = self._linearise(now), True
            return self._compressed(at, tightness, shift)

        def progress(_: Progress) -> None:
            nonlocal before
            self._tell(best, least)
            if least > (1 - LEFT) * before and not far:
                raise _Led
            before = least

        try:
            method = FIRST if far else LEADING
            method.minimise(residual, jacobian, search.lower, search.upper, point, on_iteration=progress)
        except (SolveError, _Led):
            return best
        return best

    def _compressed(self, at: Tangent, tightness: float, shift: np.ndarray) -> np.ndarray:
        """Slopes (1 + unknowns, unknowns) of the compressed residuals by the search coordinates."""
        gaps = self.segments.slopes_of_gaps(at) * self.search.slope(at.vector) / tightness
        weighed = np.column_stack([gaps, (at.response.gaps + shift) / tightness])
        return _turned(np.concatenate([self._misfits(at), weighed]))

    def _misfits(self, at: Tangent) -> np.ndarray:
        """Slopes by the search coordinates, and residuals, (any, unknowns + 1): rows with the same products as all.

        A triangular factor of each segment's has them.
        """
        problem, unit, number = self.problem, self.search.slope(at.vector), len(at.vector)
        values = at.response.values
        factor = problem.weighted(np.ones_like(values), values)
        left = problem.residual(values).reshape(values.shape)
        parts = []
        for piece, block in zip(self.segments.pieces, at.blocks, strict=True):
            slopes = (factor[piece.block][..., None] * block * unit[piece.places]).reshape(-1, len(piece.places))
            known = np.linalg.qr(np.column_stack([slopes, left[piece.block].ravel()]), mode="r")
            rows = np.zeros((len(known), number + 1))
            rows[:, [*piece.places, number]] = known
            parts.append(rows)
        if problem.priors:
            own = len(problem.model.parameters)
            rows = np.zeros((problem.priors, number + 1))
            rows[:, :own] = prior_slopes(problem.model.parameters, at.vector[:own], unit[:own])
            rows[:, number] = prior_residual(problem.model.parameters, at.vector[:own])
            parts.append(rows)
        return np.concatenate(parts)

    def _response(self, point: np.ndarray) -> Response:
        """Response of the segments at a search point; together they are one simulation."""
        vector = self.search.vectors(point)
        if self._kept and np.array_equal(self._kept[0].vector, vector):
            return self._kept[0].response
        self.problem.journal.simulations += 1
        with self._failures(vector):
            return self.segments.evaluate(vector)

    def _linearise(self, point: np.ndarray) -> Tangent:
        """Tangent at a search point; the last one is kept, since one rung begins where the other ended."""
        vector = self.search.vectors(point)
        if not (self._kept and np.array_equal(self._kept[0].vector, vector)):
            self.problem.journal.simulations += 1 + len(self.problem.model.parameters)
            with self._failures(vector):
                self._kept[:] = [self.segments.linearise(vector)]
        return self._kept[0]

    def _failures(self, vector: np.ndarray) -> AbstractContextManager[None]:
        """Failures of a simulation, kept by the journal."""
        model = self.problem.model
        return failing_at(model, self.problem.journal, vector[: len(model.parameters)])


def _turned(rows: np.ndarray) -> np.ndarray:
    """Slopes (1 + unknowns, unknowns) whose residual is the root of the sum of squares, then zeros. ``rows``
    (any, unknowns + 1) are slopes and residuals. A triangular factor of both has the same products; a reflection turns
    its residuals into the first axis.
    """
    factor = np.linalg.qr(rows, mode="r")
    factor = np.concatenate([factor, np.zeros((rows.shape[1] - len(factor), rows.shape[1]))])
    slopes, left = factor[:, :-1], factor[:, -1]
    normal = left.copy()
    normal[0] -= np.linalg.norm(left)
    square = float(normal @ normal)
    return slopes if square == 0 else slopes - np.outer(normal, (2 / square) * (normal @ slopes))
