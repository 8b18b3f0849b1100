"""SciPy's error-controlled methods for the equations of index 1."""

__all__ = ["OdeSolver"]

from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
from scipy import integrate as scipy_integrate
from scipy.sparse import block_diag

from dalembert.arguments import limited
from dalembert.errors import InputError, SolveError, require_known
from dalembert.kernels.kernel import Compiled
from dalembert.multibody.integrators.index1.completion import kernels
from dalembert.multibody.integrators.index1.field import RateField
from dalembert.multibody.integrators.index1.index1 import PROJECTED
from dalembert.multibody.integrators.index1.stabilisation import Projection, Stabilisation, posed
from dalembert.multibody.integrators.shared.batch import Batch
from dalembert.multibody.integrators.shared.integrator import Integrator
from dalembert.multibody.integrators.shared.problem import DONE, TOO_MANY_STEPS
from dalembert.multibody.integrators.shared.run import Run, explain, users_error
from dalembert.multibody.model.structure import Structure
from dalembert.multibody.start.singular_positions import singular_position

EXPLICIT, IMPLICIT = ("RK45", "DOP853"), ("Radau", "BDF", "LSODA")
_SHORT, _STUCK = 1e-9, 100  # part of a stretch below which a step is short, and how many in turn do not advance
_FINEST = 1e-12  # relative tolerance; SciPy takes none below 100 roundings, which derivatives divide further


@dataclass(frozen=True)
class OdeSolver(Integrator):
    """One of SciPy's methods, which choose their steps by the estimated local error, for the equations of index 1.

    The constraints are differentiated twice; what keeps positions and velocities to them is the ``stabilisation``.
    Redundant constraints are allowed; their multipliers are those of least norm. The loop over the steps runs in
    Python, so that ensembles gain nothing from threads.

    Parameters
    ----------
    method : {"DOP853", "RK45", "Radau", "BDF", "LSODA"}
        Explicit of order 8 or 5; implicit of order 5, of orders 1 to 5, and of both kinds in turn, for stiff models.
    relative_tolerance : float
        Of the local error of each coordinate and velocity.
    absolute_tolerance : float
        The same in units of each coordinate's scale (m or rad, and per s): the mechanism's extent, or one for angles.
    stabilisation : Stabilisation
        `Augmented`, `Baumgarte` with given numbers, `Projection` (not with LSODA, whose memory cannot be moved) or
        `Partitioning`.
    most_steps : int
        After which a run gives up.

    Notes
    -----
    Between the ends of steps the motion is the method's own dense output, brought to the constraints by `Projection`
    or `Partitioning`; accelerations and multipliers are those that it demands.

    Derivatives are integrated beside the motion, as the linearised equations. The explicit methods control the error of
    the motion alone, so that they take the same steps as without derivatives, and these are those of the discrete
    solution; the implicit ones control the error of both.

    Examples
    --------
    >>> OdeSolver("Radau", relative_tolerance=1e-6).stabilisation
    Projection()
    """

    method: str = "DOP853"
    relative_tolerance: float = limited(1e-8, unit="", least=_FINEST, below=1)
    absolute_tolerance: float = limited(1e-10, unit="", above=0)
    stabilisation: Stabilisation = field(default_factory=Projection)
    most_steps: int = 1_000_000
    takes_redundancy = True

    def __post_init__(self) -> None:
        require_known("method", self.method, EXPLICIT + IMPLICIT, "OdeSolver")
        if self.method == "LSODA" and self.stabilisation.way == PROJECTED:
            raise InputError(
                "OdeSolver: LSODA keeps a memory of past steps that a projection cannot move; give "
                "stabilisation=Partitioning(), or take BDF"
            )
        self.stabilisation.gains(None)

    def refined(self) -> tuple[Integrator, int | None] | None:
        """Return the method at tolerances up to 100 times tighter; None where they are the tightest."""
        tolerance = max(self.relative_tolerance / 100, _FINEST)
        if tolerance >= self.relative_tolerance:
            return None
        return replace(self, relative_tolerance=tolerance, absolute_tolerance=self.absolute_tolerance / 100), None

    def kernels(self, structure: Structure, derivatives: type | None = None) -> list[Compiled]:
        """What completes states, with its linear systems; an implicit method needs derivatives in any case."""
        along = complex if derivatives or self.method in IMPLICIT else None
        return [*structure.full.linear_kernels, *kernels(self.stabilisation.way, along)]

    def run(self, batch: Batch) -> list[Run]:
        """Runs of samples, one after another."""
        problem, terms = posed(self.stabilisation, batch.samples, batch.problem, None)
        implicit = self.method in IMPLICIT
        return [self._run(RateField(problem, terms, sample, batch.dstates, implicit), sample.edges) for sample in batch]

    def _run(self, own: RateField, edges: np.ndarray) -> Run:
        ends: list[float] = []
        due, reason = 0, None
        try:
            for begin, end in pairwise(edges):
                own.within = 0.5 * (begin + end)
                own.choose(begin)
                if (status := own.complete(begin, projected=False)) != DONE:
                    raise explain(own.lowered, status, begin, 0, "the motion begins there")
                own.count_turns(begin)
                while due < len(own.problem.times) and own.problem.times[due] <= begin and not ends:
                    own.record(due)
                    due += 1
                due = self._stretch(own, begin, end, due, ends)
        except SolveError as error:
            reason = error
        counts, iterations = np.array([len(ends), 0, own.evaluations, 0]), np.zeros(len(ends), dtype=np.int64)
        return Run(reason, own.problem.times, own.out, own.dout, counts, iterations, np.array(ends))

    def _stretch(self, own: RateField, begin: float, end: float, due: int, ends: list[float]) -> int:
        """Run one smooth stretch, and return the number of the next output."""
        times, solver, short = own.problem.times, self._solver(own, begin, end), 0
        while solver.status == "running":
            if len(ends) >= self.most_steps:
                raise explain(own.lowered, TOO_MANY_STEPS, solver.t, 0, "", self.most_steps)
            with np.errstate(all="ignore"):  # a step that is too long may overflow before it is cut down
                message = solver.step()
            if solver.status == "failed":
                raise self._explain(own, solver.t, message)
            reached = min(solver.t, end)
            short = short + 1 if solver.step_size < _SHORT * (end - begin) else 0
            if short == _STUCK and (singular := singular_position(own.lowered, own.state.x, reached)):
                raise singular
            last = due
            while last < len(times) and times[last] <= reached * (1 + 1e-14):
                last += 1
            path = solver.dense_output() if last > due else None
            ends.append(reached)
            for number in range(due, last):
                assert path is not None
                own.put(path(min(times[number], reached)))
                if (status := own.complete(times[number], projected=True)) != DONE:
                    raise self._explain(own, times[number], str(status))
                own.record(number)
            due = last
            own.put(solver.y)
            own.count_turns(reached)
            if own.moves or own.choose(reached):
                if own.complete(reached, projected=True) != DONE:
                    raise self._explain(own, reached, "the state does not come back to the constraints")
                solver = self._moved(solver, own, end)
        if not own.moves:
            own.put(solver.y)
            own.complete(end, projected=True)
        return due

    def _solver(self, own: RateField, begin: float, end: float, first_step: float | None = None):
        """SciPy's object for the rest of a stretch."""
        scale = np.tile(own.problem.scale[: own.n], 2)
        rtol, atol = self.relative_tolerance, np.tile(self.absolute_tolerance * scale, 1 + own.count)
        kind, options = getattr(scipy_integrate, self.method), {}
        if self.method in EXPLICIT:
            # The norm of the error is a mean over all entries: those without a tolerance count as exact.
            atol[2 * own.n :] = np.inf
            rtol, atol = rtol / np.sqrt(1 + own.count), atol / np.sqrt(1 + own.count)
        elif self.method == "LSODA":
            options["jac"] = lambda t, y: block_diag([own.jacobian(t, y)] * (1 + own.count)).toarray()
        else:
            options["jac"] = lambda t, y: block_diag([own.jacobian(t, y)] * (1 + own.count), format="csc")
        return kind(own, begin, own.gathered(), end, rtol=rtol, atol=atol, first_step=first_step, **options)

    def _moved(self, solver, own: RateField, end: float):
        """The solver, going on from a state that has been moved."""
        if solver.status != "running":
            return solver
        if self.method == "LSODA":
            return self._solver(own, solver.t, end)
        solver.y = own.gathered()
        if self.method == "BDF":
            solver.D[0] = solver.y
        else:
            solver.f = own.rates()
        return solver

    def _explain(self, own: RateField, time: float, message: str | None) -> SolveError:
        if error := users_error(own.lowered, time) or singular_position(own.lowered, own.state.x, time):
            return error
        why = f"{message[0].lower()}{message[1:].rstrip('.')}" if message else "no reason was given"
        return SolveError(
            f"OdeSolver: {self.method} stopped at t = {time:.6g} s ({why}); if the model is stiff take an "
            "implicit method (Radau, BDF) or GeneralizedAlpha, else loosen relative_tolerance or start from another "
            "position: near a singular one the accelerations grow without bound"
        )
