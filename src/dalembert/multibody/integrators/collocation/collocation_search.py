"""A collocation step by any minimiser of the package."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from dalembert.errors import DalembertError
from dalembert.multibody.integrators.collocation.collocation_gap import measure
from dalembert.multibody.integrators.collocation.collocation_rule import Rule
from dalembert.multibody.integrators.collocation.collocation_step import CollocationRun, Schedule, ScheduleStep, step_of
from dalembert.multibody.integrators.collocation.collocation_swarm import Kept, keep, kept_workspace, squares
from dalembert.multibody.integrators.shared.problem import DONE, NEWTON_FAILED, IntegrationProblem, SampleModels
from dalembert.optimize import Firefly, Minimiser, Squares, Swarm

_WIDE = 2.0  # half the box, against what remains at its middle: where that falls evenly the minimum lies at one half
_THIN = 1e-3  # least width of a coordinate's box, against the widest
_STILL = 1e-9  # the same, where next to nothing remains


@dataclass(frozen=True, eq=False)
class CollocationSearch:
    """Minimises what remains in the steps of one run. The box lies around the prediction: twice what remains there of
    each independent coordinate's acceleration. The directions of the ``models`` are those of the unknown accelerations,
    then those of the parameters.
    """

    minimiser: Squares | Firefly | Swarm | Minimiser
    seed: int
    problem: IntegrationProblem
    rule: Rule
    models: SampleModels
    schedule: Schedule
    walk: CollocationRun

    def __call__(self, number: int) -> tuple[int, int, int]:
        """Find the accelerations of a step, into ``walk.c``: status, iterations, the coordinate to blame."""
        walk, step = self.walk, step_of(self.schedule, number)
        rank = int(walk.partition.rank[0])
        if not len(walk.c):
            return DONE, 0, 0
        kept = self.kept(step)
        own = walk.partition.columns[rank : self.problem.n]
        worst = int(own[0])
        if kept is None:
            return NEWTON_FAILED, 0, worst
        middle = kept.middle
        half = _WIDE * np.abs(walk.gaps[:, own]).max(axis=0)
        half = np.maximum(half, max(_THIN * half.max(), _STILL * (1.0 + np.abs(middle).max())))
        half = np.tile(half, len(self.rule.powers))
        corner = np.ones(len(middle))
        try:
            if isinstance(self.minimiser, Squares):
                residual, jacobian = self._squares(step, middle, half)
                found = self.minimiser.minimise(residual, jacobian, -corner, corner, 0.0 * corner)
            else:
                fill = squares.given(self.problem, self.rule, self.models.real, step, walk, kept)

                def objective(places: np.ndarray) -> np.ndarray:
                    misfit = np.zeros(len(places))
                    fill(middle + half * places, misfit)
                    return misfit

                seed = int(np.random.SeedSequence((self.seed, number)).generate_state(1)[0])
                found = self.minimiser.minimise(objective, -corner, corner, seed, start=0.0 * corner)
        except DalembertError:
            return NEWTON_FAILED, 0, worst
        walk.c[:] = middle + half * found.x
        return (DONE if np.isfinite(found.misfit) else NEWTON_FAILED), found.iterations, worst

    def kept(self, step: ScheduleStep) -> Kept | None:
        """States of the Gauss points at the prediction."""
        walk, measured = self.walk, self._measured(step)
        kept = kept_workspace(walk)
        for s in range(len(self.rule.nodes)):
            if not measured(s):
                return None
            keep(walk, kept, s)
        return kept

    def _measured(self, step: ScheduleStep) -> Callable[[int], bool]:
        """A function that measures what remains at a Gauss point, and its derivatives by the unknown accelerations."""
        return measure.given(self.problem, self.rule, self.models, step, self.walk, False)

    def _squares(self, step: ScheduleStep, middle: np.ndarray, half: np.ndarray) -> tuple:
        """What remains and its derivatives, in the coordinates of the box."""
        walk, n, measured = self.walk, self.problem.n, self._measured(step)
        roots = np.sqrt(self.rule.weights)

        def residual(place: np.ndarray) -> np.ndarray:
            walk.c[:] = middle + half * place
            solved = [measured(s) for s in range(len(roots))]
            return (roots[:, None] * walk.gaps[:, :n]).ravel() if all(solved) else np.full(len(roots) * n, np.nan)

        def jacobian(place: np.ndarray) -> np.ndarray:
            slopes = walk.slopes[:, : len(middle), :n] * roots[:, None, None]
            return slopes.transpose(0, 2, 1).reshape(-1, len(middle)) * half

        return residual, jacobian
