"""Time steps as minimisations: what a polynomial leaves of the equations of motion is made as small as it can be."""

__all__ = ["Collocation", "GaussNewton"]

from dataclasses import dataclass, field

import numpy as np

from dalembert.arguments import Checked, limited
from dalembert.errors import InputError
from dalembert.kernels.kernel import Compiled
from dalembert.multibody.integrators.collocation.collocation_descent import Descent, descent, march, respond
from dalembert.multibody.integrators.collocation.collocation_gap import measure
from dalembert.multibody.integrators.collocation.collocation_rule import make_rule
from dalembert.multibody.integrators.collocation.collocation_search import CollocationSearch
from dalembert.multibody.integrators.collocation.collocation_step import Schedule, begin, finish, prepare, step_of
from dalembert.multibody.integrators.collocation.collocation_swarm import squares
from dalembert.multibody.integrators.shared.batch import Batch, Sample
from dalembert.multibody.integrators.shared.consistent import accelerate_along
from dalembert.multibody.integrators.shared.integrator import Integrator
from dalembert.multibody.integrators.shared.partitioning import settle_along
from dalembert.multibody.integrators.shared.problem import (
    DONE,
    SINGULAR,
    IntegrationProblem,
    Log,
    SampleModels,
    note_step,
)
from dalembert.multibody.integrators.shared.run import Run, explain
from dalembert.multibody.kernels.linear import DENSE_KERNELS
from dalembert.multibody.kernels.states import Histories, MotionStates, resting
from dalembert.multibody.model.structure import Structure
from dalembert.optimize import Firefly, LeastSquares, Minimiser, ResponseSensitivity, Squares, Swarm


@dataclass(frozen=True)
class GaussNewton(Checked):
    """Gauss and Newton's iterations with exact derivatives, compiled; for :class:`Collocation`.

    Parameters
    ----------
    iterations : int
        Largest number of iterations in each step; fewer where rounding is reached before.
    """

    iterations: int = limited(3, least=1)


@dataclass(frozen=True)
class Collocation(Integrator):
    """Integrator whose steps are minimisations, with all constraints exact.

    On a step the independent coordinates are polynomials with the position and velocity that the last one left; the
    dependent coordinates follow from the constraints and their first two rates, to rounding. The accelerations that
    the polynomials leave free minimise

        sum over Gauss points s of A_s f_s^T f_s,    f = [a; lambda] - [M J^T; J 0]^-1 [Q; -J' v]

    where the multipliers are those of the equations, so that f is the gap of the accelerations, in m/s^2 and rad/s^2.

    Parameters
    ----------
    step : float
        s.
    minimiser : GaussNewton, Firefly, or any minimiser of dalembert.optimize
        What finds the minimum. Swarms and fireflies search a box around the explicit prediction.
    degree : int
        Of the polynomials, at least 2; 2 is the three-point Lagrange polynomial.
    gauss_points : int
        At least degree - 1. With just that many nothing remains, and the method is of order 2 (degree - 1): collocation
        at Gauss points. With more, as published (2 and 2), it is of the order of its polynomial, degree.
    seed : int
        Of the random numbers of swarms and fireflies.

    Notes
    -----
    Zhang & Ding, "Firefly algorithm for solving multibody dynamics differential-algebraic equations" (2021).
    Between steps the motion is the polynomial with the constraints solved again, so output times need no steps.
    Derivatives are those of the minimum, so the minimiser must find it: Gauss and Newton's or least squares do. All
    matrices are dense: meant for up to some dozens of coordinates.

    Examples
    --------
    >>> Collocation(step=0.01).minimiser
    GaussNewton(iterations=3)
    >>> Collocation(step=0.01, degree=3, gauss_points=1)
    Traceback (most recent call last):
    dalembert.errors.InputError: Collocation: gauss_points is 1; expected at least degree - 1 = 2
    """

    step: float = limited(unit="s", above=0)
    minimiser: GaussNewton | Firefly | LeastSquares | ResponseSensitivity | Swarm | Minimiser = field(
        default=GaussNewton(), metadata={"checked": False}
    )
    degree: int = limited(2, least=2)
    gauss_points: int = 2
    seed: int = 0

    def __post_init__(self) -> None:
        if self.gauss_points < self.degree - 1:
            raise InputError(
                f"Collocation: gauss_points is {self.gauss_points}; expected at least degree - 1 = {self.degree - 1}"
            )
        if not isinstance(self.minimiser, GaussNewton | Firefly | Squares | Swarm | Minimiser):
            raise InputError(
                f"Collocation: minimiser is {self.minimiser!r}; expected GaussNewton(), Firefly(), LeastSquares() or "
                "another minimiser of dalembert.optimize"
            )

    @property
    def convergence(self) -> int:
        """Order in the step."""
        return 2 * (self.degree - 1) if self.gauss_points == self.degree - 1 else self.degree

    def kernels(self, structure: Structure, derivatives: type | None = None) -> list[Compiled]:
        """The loop, or the parts that a search calls, with what differentiates a state by the unknown accelerations."""
        own = [march] if isinstance(self.minimiser, GaussNewton) else [begin, measure, squares, finish]
        roles = "residual", "rates"
        rates = [kind.kernel(role, complex) for role in roles for kind in structure.index if role in kind.roles]
        linear = [*structure.full.linear_kernels, *DENSE_KERNELS]
        return [*own, settle_along, *rates, *linear, *[respond, accelerate_along] * (derivatives is not None)]

    def run(self, batch: Batch) -> list[Run]:
        """Runs of samples, one after the other; see `Integrator`.

        Raises
        ------
        InputError
            For derivatives with a minimiser that only comes near the minimum.
        """
        if batch.perturbed and not isinstance(self.minimiser, GaussNewton | Squares):
            raise InputError(
                f"Collocation: a step by {type(self.minimiser).__name__} has no exact derivatives, because the search "
                "ends near the minimum, not at it; take GaussNewton() or LeastSquares()"
            )
        slots, layout = batch.samples[0].structure.full.dense
        problem = batch.problem._replace(exact_slots=slots, exact_layout=layout)
        return [self._run(batch, problem, sample) for sample in batch]

    def schedule(self, edges: np.ndarray, times: np.ndarray) -> Schedule:
        """Steps between the edges of the smooth stretches of a motion."""
        grid = self.step_ends(float(edges[-1]), tuple(edges[1:-1]))
        assert grid is not None
        begins, ends = grid[:-1], grid[1:]
        stretch = np.searchsorted(edges, (begins + ends) / 2) - 1
        reached = np.searchsorted(times, ends + 1e-9 * (ends - begins), side="right")
        opens = np.diff(stretch, prepend=-1) > 0
        within = (edges[stretch] + edges[stretch + 1]) / 2
        return Schedule(begins, ends, within, opens.astype(np.int64), np.append(0, reached))

    def _run(self, batch: Batch, problem: IntegrationProblem, sample: Sample) -> Run:
        lowered, models, schedule = sample.lowered, sample.models, self.schedule(sample.edges, problem.times)
        rule = make_rule(self.degree, self.gauss_points)
        calls = lowered.real.call(), lowered.complex_model.need("rates").call()
        linear = not any(kind.takes_reactions for kind in lowered.data)
        walk = prepare(problem, rule, *calls, len(batch.perturbed), linear)
        for own, given in zip((*walk.old, *walk.dold), (*sample.start, *batch.dstates), strict=True):
            own[:] = given
        moving = models._replace(
            directions=np.append(np.full(len(walk.c), lowered.complex_model.address), models.directions)
        )
        out, dout, log = resting(*batch.shape), batch.derivatives(), batch.log(schedule.begins)
        work = descent(problem, walk)
        if isinstance(self.minimiser, GaussNewton):
            status, time, worst = march(
                problem, rule, self.minimiser.iterations, moving, models, schedule, walk, out, dout, log, work
            )
        else:
            search = CollocationSearch(self.minimiser, self.seed, problem, rule, moving, schedule, walk)
            status, time, worst = _search(search, models, out, dout, log, work)
        given = lowered, int(status), float(time), int(worst), f"the step is {self.step:g} s"
        return batch.result(None if status == DONE else explain(*given), out, dout, log)


def _search(
    search: CollocationSearch, models: SampleModels, out: MotionStates, dout: Histories, log: Log, scratch: Descent
) -> tuple[int, float, int]:
    """All steps by a minimiser of the package: status, time reached, the coordinate to blame."""
    problem, rule, schedule, walk = search.problem, search.rule, search.schedule, search.walk
    for number in range(len(schedule.begins)):
        step, taken, worst = step_of(schedule, number), 0, 0
        status = begin(problem, rule, models, step, walk)
        if status == DONE:
            status, taken, worst = search(number)
        if status == DONE and len(walk.dc):
            regular = respond(problem, rule, search.models, step, walk, scratch)
            status = DONE if regular else SINGULAR
        if status == DONE:
            status = finish(problem, rule, models, step, walk, out, dout)
        if status != DONE:
            return status, step.begin, worst
        log.counts[1] += taken
        note_step(log, taken, step.end)
    return DONE, schedule.ends[-1], 0
