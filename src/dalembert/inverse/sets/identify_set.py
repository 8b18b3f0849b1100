"""All parameters that are consistent with measurements of bounded error."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from dalembert.argument_readers import check_integer, numbers_of
from dalembert.arguments import takes_checked
from dalembert.data import Measurements
from dalembert.errors import InputError, require_known
from dalembert.forward import Executor, ForwardModel, clock, findings_at, on_cluster, takes_executor
from dalembert.forward.provenance import provenance
from dalembert.intervals import Box
from dalembert.inverse.events import Finished, OnEvent
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.matching import check_finite, check_kinds, check_samples, check_sizes, columns_of
from dalembert.inverse.problem.search_coordinates import SearchCoordinates
from dalembert.inverse.problem.simulated import named, simulated
from dalembert.inverse.sets.inner_box import inner_box
from dalembert.inverse.sets.inversion import Inversion
from dalembert.inverse.sets.parameter_set import ParameterSet
from dalembert.inverse.sets.set_findings import conclusions, outcome
from dalembert.surrogate import Adaptive
from dalembert.surrogate.scheme import Scheme

# Resolution by the number of parameters, if none is given; a sixteenth for more.
RESOLUTIONS = {1: 1 / 256, 2: 1 / 64, 3: 1 / 32}
# Order of the usual surrogates: enclosures of higher orders take long, and a smaller box needs a lower order.
MOST_ORDER = 64


@takes_executor
@takes_checked("model", "data", "seed", "most_boxes")
def identify_set(
    model: ForwardModel,
    data: Measurements,
    *,
    error: float | Mapping[str, float] | ArrayLike,
    scheme: Scheme | None = None,
    resolution: float | None = None,
    most_boxes: int = 200_000,
    seed: int = 0,
    on_event: OnEvent | None = None,
    executor: Executor = None,
) -> ParameterSet:
    """The set of all parameters p, within their bounds, with ``|R(p) − data| ≤ error`` at every sample and channel.

    Parameters
    ----------
    model : ForwardModel
        Its samples must be those of the data; it may have more channels. Made for one to three parameters; the boxes of
        a paving grow in number as resolution^−(parameters − 1).
    data : Measurements
    error : number, mapping by channel, or array of shape (channels,) or (samples, channels)
        Largest error that a value may have, in its channel's unit.
    scheme : Adaptive, Tensor or TotalDegree, optional
        Of the surrogates; ``Adaptive(tolerance=1e-2, most_order=64)`` if not given.
    resolution : float, optional
        Sides of the smallest boxes, as a part of the box around the set: 1/256, 1/64, 1/32 for one, two, three
        parameters, else 1/16.
    most_boxes : int
        Boxes to look at; where they do not suffice, the paving is right but coarser.
    seed : int
        All random numbers follow from it.
    on_event : callable, optional
        Called with each event (see :mod:`dalembert.inverse.events`) as it happens.
    executor : str or distributed.Client, optional
        Address of a Dask cluster, such as ``"tcp://10.0.0.1:8786"``, or a client of one, to which batches go.

    Returns
    -------
    ParameterSet

    Raises
    ------
    DataError
        For a NaN in the data, a channel that the model lacks, samples that are not the model's.
    InputError
        For arguments that cannot be meant.
    SolveError
        For a surrogate that cannot be made.

    Notes
    -----
    Set inversion by branch and prune on Chebyshev surrogates, enclosed by their Bernstein coefficients: a box is left
    out, or inside, only if that is so with the surrogate's estimated error taken into account. The first surrogate is
    made on the whole search box, the next ones on the box that the one before leaves. The set is as certain as the
    estimate of the surrogate's error is. What lies between the runs of the first surrogate unseen is the finding
    "unseen-features": a set that is empty, or has one component, may have another one as narrow as that.

    Source: Jaulin & Walter, Set inversion via interval analysis for nonlinear bounded-error estimation, 1993.

    Examples
    --------
    >>> import numpy as np
    >>> from dalembert.forward import PythonModel
    >>> times = np.linspace(0, 2, 21)
    >>> decay = PythonModel(lambda rate: np.exp(-rate * times), {"rate": (0.1, 3.0)}, ["x"], times)
    >>> data = Measurements.of(times, {"x": np.exp(-times)})
    >>> found = identify_set(decay, data, error=0.02)
    >>> print(found.outer)
    rate [0.946996, 1.05604]
    """
    check_kinds("identify_set", model, data)
    check_integer("identify_set", "seed", seed, 0)
    check_integer("identify_set", "most_boxes", most_boxes, 1)
    began = clock(model)
    model = on_cluster(model, executor)
    columns = columns_of(model, data)
    check_finite(data)
    check_samples(model, data)
    check_sizes(data)
    errors = _errors(error, data)
    resolution = _resolution(resolution, len(model.parameters))
    chosen = Adaptive(tolerance=1e-2, most_order=MOST_ORDER) if scheme is None else scheme
    journal, search = Journal(len(data.coordinate.values), on_event), SearchCoordinates(model.parameters)

    def run(points: np.ndarray) -> np.ndarray:
        return simulated(model, columns, journal, search.vectors(points)).reshape(len(points), -1)

    shape = (len(data.values), len(columns))
    wraps = np.tile(data.wrapping, len(data.values))
    inversion = Inversion(run, data.values.ravel(), errors.ravel(), wraps, shape, chosen, most_boxes, seed, journal)
    surrogate, paving = inversion.zoomed(search.lower, search.upper)
    if paving.hull is not None:
        paving = inversion.paved(surrogate, resolution)
    inner = inner_box(paving.inside)
    believed = inner is None or inversion.consistent(inner)
    left_out = inversion.outside(paving)
    findings = tuple(conclusions(inversion, surrogate, paving, left_out, names := model.parameters.names))
    nearest = inversion.nearest
    at = "" if nearest is None else named(model, search.vectors(nearest.point))
    share = float(np.max(surrogate.error / errors.ravel()))
    outer = None if paving.hull is None else Box(names, *(search.vectors(corner) for corner in paving.hull))
    result = ParameterSet(
        parameters=model.parameters,
        data=data,
        error=errors,
        inside=search.vectors(paving.inside),
        boundary=search.vectors(paving.boundary),
        outer=outer,
        inner=None if inner is None else Box(names, *search.vectors(inner)),
        surrogate_error=surrogate.error.reshape(errors.shape),
        resolution=resolution,
        runs=journal.simulations,
        seconds=clock(model) - began,
        success=paving.finished and believed and not len(left_out),
        outcome=tuple(outcome(data, share, paving, nearest, at, believed, journal.failures)),
        provenance=provenance(
            model,
            chosen,
            data=data.fingerprint,
            units=dict(data.source_units),
            seed=seed,
            error=errors.tolist(),
            resolution=resolution,
            most_boxes=most_boxes,
        ),
        findings=(*findings, *(() if outer is None else findings_at(model, outer.middle))),
    )
    middle = np.full(len(names), np.nan) if result.outer is None else result.outer.middle
    journal.tell(Finished(result.success, result.status, np.nan, middle, result.runs))
    return result


def _resolution(resolution: float | None, parameters: int) -> float:
    if resolution is None:
        return RESOLUTIONS.get(parameters, 1 / 16)
    if not 0 < resolution < 1:
        raise InputError(f"resolution is {resolution}; expected a part of the width, a number between 0 and 1")
    return float(resolution)


def _errors(error: float | Mapping[str, float] | ArrayLike, data: Measurements) -> np.ndarray:
    """Largest errors of shape (samples, channels)."""
    if isinstance(error, Mapping):
        for name in error:
            require_known("channel", name, data.channels, "error")
        missing = [name for name in data.channels if name not in error]
        if missing:
            raise InputError(
                f"no error given for channel {missing[0]!r}; give one for each of {', '.join(data.channels)}"
            )
        error = [error[name] for name in data.channels]
    errors = numbers_of(error, "identify_set", "error")
    if errors.shape not in ((), data.values.shape[1:], data.values.shape):
        raise InputError(
            f"an error of shape {errors.shape} was given; expected one number, (channels,) = {data.values.shape[1:]} "
            f"or (samples, channels) = {data.values.shape}"
        )
    wrong = errors[~(np.isfinite(errors) & (errors > 0))]
    if len(wrong):
        raise InputError(f"identify_set: error has the value {wrong[0]:g}; expected finite positive numbers")
    return np.array(np.broadcast_to(errors, data.values.shape))
