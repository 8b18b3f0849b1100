"""Search the least misfit, from one or several starts."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from dalembert.argument_readers import check_integer
from dalembert.errors import InputError, SolveError, require_known, shown
from dalembert.forward import check_derivatives
from dalembert.inverse.identification.pose import PosedIdentification
from dalembert.inverse.least_squares.descent import End
from dalembert.inverse.noise.likelihood.estimate_noise import NoiseFit
from dalembert.inverse.noise.noise_floor import NoiseFloor
from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.inverse.shooting.restarts import check_restart, check_segments
from dalembert.inverse.shooting.shooting import MultipleShooting, shots
from dalembert.inverse.starts.multistart import HORIZONS, multistart
from dalembert.inverse.starts.runs import Method, polished, runs
from dalembert.inverse.starts.spread import SPREADS
from dalembert.optimize import LeastSquares, Minimiser, Squares


@dataclass(frozen=True, eq=False)
class SearchSettings:
    """Method of a search and where its starts are; each field is an argument of :func:`dalembert.identify`."""

    method: Squares | Method
    starts: int
    seed: int
    start: Mapping[str, float] | ArrayLike | None
    polish: bool
    horizon: str | None
    spread: str
    shooting: MultipleShooting | None


@dataclass(frozen=True, eq=False)
class MisfitMinimum:
    """The least misfit that was reached."""

    problem: MisfitProblem
    end: End  # of the best start
    floor: NoiseFloor
    ends: list[End]  # of all starts, before the best one was polished
    noise: NoiseFit | None = None  # estimated with the parameters; the weights follow from it

    @property
    def explained_by(self) -> str:
        """Source of the noise that explains the misfit; empty if none does."""
        return self.floor.source if self.end.misfit <= self.floor.misfit else ""

    @property
    def is_one_run(self) -> bool:
        """Whether one run follows the motion, not several segments."""
        return self.end.nodes is None or self.end.nodes.segments == 1

    @property
    def shows_model(self) -> bool:
        """Whether the residuals are those of one run and more than rounding, so that they show the model."""
        return self.is_one_run and self.explained_by not in ("arithmetic", "rounded")


def search_settings(
    method: Squares | Method | str | None,
    starts: int | None,
    seed: int,
    start: Mapping[str, float] | ArrayLike | None,
    polish: bool,
    horizon: str | None,
    spread: str,
    shooting: MultipleShooting | None,
) -> SearchSettings:
    """Return checked settings, the usual ones where an argument is None."""
    method = LeastSquares() if method is None else Minimiser(method) if isinstance(method, str) else method
    if isinstance(method, type) or not hasattr(method, "minimise"):
        hint = f"; write {method.__name__}(...)" if isinstance(method, type) else ""
        raise InputError(
            f"method is {shown(method)}; expected LeastSquares(), ResponseSensitivity(), ParticleSwarm(), "
            f"ImprovedParticleSwarm(), Firefly(), or a Minimiser or its name{hint}"
        )
    check_integer("identify", "seed", seed, 0)
    squares = isinstance(method, Squares)
    if shooting is not None and not squares:
        raise InputError(
            f"shooting: method is {type(method).__name__}; multiple shooting is a way of least squares; leave one out"
        )
    starts = starts if starts is not None else 3 if shooting is not None else 8 if squares else 1
    check_integer("identify", "starts", starts, 1)
    if horizon is not None:
        require_known("horizon", str(horizon), HORIZONS)
    require_known("spread", str(spread), SPREADS)
    return SearchSettings(method, starts, seed, start, polish, horizon, spread, shooting)


def find_minimum(posed: PosedIdentification, settings: SearchSettings) -> MisfitMinimum:
    """Return the least misfit of all starts."""
    problem, floor, method, shooting = posed.problem, posed.floor, settings.method, settings.shooting
    options = {"starts": settings.starts, "seed": settings.seed, "spread": settings.spread}
    if shooting is not None:  # before anything is simulated
        check_segments(problem, shooting)
        check_restart(problem, shooting, problem.search.vectors(posed.first_point))
    if isinstance(method, Squares):
        check_derivatives(problem.model, problem.search.vectors(posed.first_point))
        options["start"] = posed.first_point
        if shooting is not None:
            ends = shots(problem, shooting, method, floor, **options)
        else:
            ends = multistart(problem, method, floor, horizon=settings.horizon, **options)
    else:
        ends = runs(problem, method, floor, start=None if settings.start is None else posed.first_point, **options)
    best = min(ends, key=lambda end: end.misfit)
    if not np.isfinite(best.misfit):
        raise SolveError(
            f"none of {len(ends)} starts could be simulated; the first failure: {problem.journal.failures[0]}; "
            "look at the model there, or change the bounds or the start"
        )
    several = isinstance(method, Squares) and settings.starts > 1 and shooting is None
    if not best.stationary and (settings.polish or several):
        best = polished(problem, method if isinstance(method, Squares) else LeastSquares(), best)
    return MisfitMinimum(problem, best, floor, ends)
