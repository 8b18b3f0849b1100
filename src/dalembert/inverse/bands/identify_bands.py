"""Intervals of parameters from bands of a response."""

from collections.abc import Iterable
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from dalembert.argument_readers import check_integer
from dalembert.arguments import takes_checked
from dalembert.data import Bands
from dalembert.errors import InputError, require_known, shown
from dalembert.forward import Executor, ForwardModel, clock, findings_at, on_cluster, takes_executor
from dalembert.forward.provenance import provenance
from dalembert.intervals import Box
from dalembert.inverse.bands.band_findings import conclusions, outcome
from dalembert.inverse.bands.band_fit import BandFit
from dalembert.inverse.bands.band_problem import BandProblem, pose
from dalembert.inverse.bands.candidate import slopes
from dalembert.inverse.bands.check import BandSolution
from dalembert.inverse.bands.global_surrogate import GlobalSurrogate
from dalembert.inverse.bands.nested import Nested
from dalembert.inverse.bands.unknowns import unknowns_of
from dalembert.inverse.events import Finished, OnEvent
from dalembert.inverse.least_squares.estimate import Estimate, estimate
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.matching import check_kinds


class Method(Protocol):
    """A way to identify bands, made of settings."""

    @property
    def name(self) -> str: ...

    def search(self, problem: BandProblem, seed: int) -> BandSolution: ...


METHODS = {"global": GlobalSurrogate, "nested": Nested}


@takes_executor
@takes_checked("model", "bands", "seed", "method", "intervals")
def identify_bands(
    model: ForwardModel,
    bands: Bands,
    *,
    intervals: Iterable[str] | None = None,
    method: Method | str | None = None,
    weights: ArrayLike | None = None,
    seed: int = 0,
    on_event: OnEvent | None = None,
    executor: Executor = None,
) -> BandFit:
    """Intervals of a model's parameters over which its response has given bounds.

    x holds the middles and radii of the intervals; Yˡ(x) and Yᵘ(x) are the smallest and the largest response over that
    box. The x is searched that minimises F = Σ W ((Yˡ − given lower)² + (Yᵘ − given upper)²) over samples and channels.

    Parameters
    ----------
    model : ForwardModel
        Its samples must be those of the bands; it may have more channels. The bounds of its parameters are the search
        box, inside which the identified intervals stay.
    bands : Bands
    intervals : names, optional
        Parameters that are intervals, all if not given. The others are numbers: unknown too, but with radius zero.
    method : GlobalSurrogate, Nested, "global" or "nested", optional
        One surrogate over the search box if not given; ``Nested`` is the published way.
    weights : array, shape (channels,) or (samples, channels), optional
        W; 1 if not given.
    seed : int
        All random numbers follow from it.
    on_event : callable, optional
        Called with each event (see :mod:`dalembert.inverse.events`) as it happens.
    executor : str or distributed.Client, optional
        Address of a Dask cluster, such as ``"tcp://10.0.0.1:8786"``, or a client of one, to which batches go.

    Returns
    -------
    BandFit

    Raises
    ------
    DataError
        For a channel that the model lacks, samples that are not the model's.
    InputError
        For arguments that cannot be meant.
    SolveError
        For a surrogate that cannot be built or is not accurate enough; the message says which order suffices.

    Notes
    -----
    Parameters whose bounds are positive and more than a decade apart are searched, and their surrogate made, by their
    logarithm (``Parameter.log`` overrules).

    Source: Guo & Jin, Inverse dynamical problem of flexible multibody systems with interval uncertainty, 2025, for the
    formulation and the nested way.

    Examples
    --------
    >>> import numpy as np
    >>> from dalembert.forward import PythonModel
    >>> times = np.linspace(0, 2, 21)
    >>> decay = PythonModel(lambda rate: np.exp(-rate * times), {"rate": (0.1, 3.0)}, ["x"], times)
    >>> bands = Bands.of(times, {"x": (np.exp(-1.2 * times), np.exp(-0.8 * times))})
    >>> box = identify_bands(decay, bands).box
    >>> box.lower.round(6).tolist(), box.upper.round(6).tolist()
    ([0.8], [1.2])
    """
    check_kinds("identify_bands", model, bands, Bands)
    check_integer("identify_bands", "seed", seed, 0)
    began = clock(model)
    model, chosen = on_cluster(model, executor), _method(method)
    unknowns = unknowns_of(model.parameters, intervals)
    journal = Journal(len(bands.coordinate.values), on_event)
    problem = pose(model, bands, weights, unknowns, journal)
    solution = chosen.search(problem, seed)
    at, checked = solution.candidate, solution.check
    concluded = tuple(conclusions(problem, solution))
    ends = tuple(unknowns.search.vectors(end) for end in (at.lower, at.upper))
    estimated = _estimated(problem, solution)
    d = len(model.parameters)
    radius_deviations = np.zeros(d)
    radius_deviations[unknowns.chosen] = estimated.deviations[d:]
    fit = BandFit(
        parameters=model.parameters,
        intervals=unknowns.intervals,
        box=Box(model.parameters.names, *ends),
        unknowns=unknowns.names,
        middle_deviations=estimated.deviations[:d],
        radius_deviations=radius_deviations,
        correlation=estimated.correlation,
        singular_values=estimated.singular_values,
        directions=estimated.directions,
        misfit=float(problem.misfit(at.bounds.lower, at.bounds.upper)),
        bands=Bands(bands.coordinate, bands.channels, bands.lower, bands.upper),
        weights=np.array(problem.weights),
        lower=at.bounds.lower.reshape(problem.shape),
        upper=at.bounds.upper.reshape(problem.shape),
        error=solution.error.reshape(problem.shape),
        checked_lower=None if checked is None else checked.lower.reshape(problem.shape),
        checked_upper=None if checked is None else checked.upper.reshape(problem.shape),
        checked_misfit=None if checked is None else float(problem.misfit(checked.lower, checked.upper)),
        history=tuple(journal.history),
        starts=tuple(journal.starts),
        success=solution.success and not any(finding.severity == "error" for finding in concluded),
        outcome=tuple(outcome(problem, solution)),
        method=chosen.name,
        simulations=journal.simulations,
        seconds=clock(model) - began,
        provenance=provenance(
            model,
            chosen,
            data=bands.fingerprint,
            units=dict(bands.source_units),
            seed=seed,
            intervals=unknowns.intervals,
            weights="given" if weights is not None else "one",
        ),
        findings=(*concluded, *findings_at(model, (ends[0] + ends[1]) / 2)),
    )
    values = np.concatenate([fit.middle, fit.radius[unknowns.chosen]])
    journal.tell(Finished(fit.success, fit.status, fit.misfit, values, fit.simulations))
    return fit


def _method(method: Method | str | None) -> Method:
    if method is None:
        return GlobalSurrogate()
    if isinstance(method, str):
        require_known("method of identifying bands", method, METHODS)
        return METHODS[method]()
    if isinstance(method, type) or not hasattr(method, "search"):
        raise InputError(f"method is {shown(method)}; expected GlobalSurrogate(...), Nested(...), 'global' or 'nested'")
    return method


def _estimated(problem: BandProblem, solution: BandSolution) -> Estimate:
    """Deviations and correlations of middles and radii, the noise estimated from the residuals."""
    unknowns, at = problem.unknowns, solution.candidate
    by_lower, by_upper = slopes(problem, solution.polynomial, at)
    search, parameters = unknowns.search, problem.model.parameters
    # dz/dp at the two ends; in the parameters' units these are middle ∓ radius, with nothing cut.
    lower, upper = (
        side / search.slope(search.vectors(end)) for side, end in ((by_lower, at.lower), (by_upper, at.upper))
    )
    scale = np.concatenate([parameters.scale, parameters.scale[unknowns.chosen]])
    by_unknown = np.hstack([lower + upper, (upper - lower)[:, unknowns.chosen]]) * scale
    freedom = 2 * np.count_nonzero(problem.weights) - len(scale)
    misfit = float(problem.misfit(at.bounds.lower, at.bounds.upper))
    return estimate(by_unknown, scale, misfit / freedom if freedom > 0 else np.nan)
