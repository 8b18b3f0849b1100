"""Which parameters cause the variance of a response over a box: Sobol indices from a surrogate."""

import numpy as np

from dalembert.arguments import check_model, check_whole, is_number
from dalembert.errors import InputError, SolveError, shown
from dalembert.forward import ForwardModel
from dalembert.forward.provenance import provenance
from dalembert.surrogate import Adaptive, SobolIndices, Surrogate, fit, sobol_indices
from dalembert.surrogate.scheme import Scheme
from dalembert.uncertainty.propagate import Intervals, box_of
from dalembert.uncertainty.runs import Runs
from dalembert.uncertainty.sensitivity_indices import SensitivityIndices


def global_sensitivity(
    model: ForwardModel,
    intervals: Intervals,
    scheme: Scheme | None = None,
    *,
    tolerance: float = 0.02,
    seed: int = 0,
) -> SensitivityIndices:
    """Return the Sobol indices of every channel, at every sample and of the channel as a whole.

    The parameters are independent and uniform within their intervals. The first-order index of a parameter is the part
    of the variance that it causes alone; its total index contains its interactions with others. Both come from a
    Chebyshev surrogate in closed form.

    Parameters
    ----------
    model : ForwardModel
    intervals : Box, or mapping of str to Interval, (lower, upper) or number
        One for each parameter of the model, in SI units.
    scheme : TotalDegree, Tensor or Adaptive, optional
        Of the surrogate, see :func:`dalembert.surrogate.fit`.
    tolerance : float
        Largest uncertainty of the indices of a whole channel, which follows from the error of the surrogate.
    seed : int
        Of the runs that test the surrogate.

    Returns
    -------
    SensitivityIndices

    Raises
    ------
    InputError
        For a parameter without an interval, and a tolerance that is not between 0 and 1.
    SolveError
        If the indices of a channel are more uncertain than the tolerance.

    Notes
    -----
    The indices of a whole channel are Σ V_u / Σ V, summed over its samples (Lamboni, Monod and Makowski, Multivariate
    sensitivity analysis to measure global contribution of input factors in dynamic models, 2011).

    Examples
    --------
    >>> import numpy as np, dalembert as da
    >>> times = np.linspace(0.0, 1.0, 11)
    >>> model = da.PythonModel(lambda a, b: a * times + 0.1 * b, {"a": (0, 1), "b": (0, 1)}, ["x"], times)
    >>> found = da.global_sensitivity(model, {"a": (0.0, 1.0), "b": (0.0, 1.0)})
    >>> found.first[0, 0].round(3).tolist(), found.first[-1, 0].round(3).tolist()
    ([0.0, 1.0], [0.99, 0.01])
    """
    check_model("global_sensitivity", model)
    check_whole("global_sensitivity", "seed", seed, 0)
    if not is_number(tolerance) or not 0 < tolerance < 1:
        raise InputError(f"global_sensitivity: tolerance is {shown(tolerance)}; expected a number between 0 and 1")
    box = box_of(model, intervals)
    runs, scheme = Runs(model, box, "global sensitivity"), Adaptive() if scheme is None else scheme
    samples, channels = runs.shape
    surrogate = fit(
        lambda points: runs.values(points).reshape(len(points), -1),
        box.lower,
        box.upper,
        scheme,
        seed=seed,
        groups=np.tile(np.arange(channels), samples),
    )
    found = sobol_indices(surrogate)
    whole = found.summed(np.tile(np.arange(channels), samples))
    names = tuple(channel.name for channel in model.channels)
    _demand(whole, names, tolerance, _improvement(surrogate))
    shape = samples, channels, len(box.names)
    return SensitivityIndices(
        coordinate=model.coordinate,
        channels=names,
        units=tuple(channel.unit for channel in model.channels),
        box=box,
        mean=found.mean.reshape(samples, channels),
        deviations=np.sqrt(found.variance).reshape(samples, channels),
        first=found.first.T.reshape(shape),
        total=found.total.T.reshape(shape),
        whole_first=whole.first.T,
        whole_total=whole.total.T,
        uncertainty=whole.uncertainty,
        runs=runs.count,
        provenance=provenance(
            model, scheme, seed=seed, tolerance=tolerance, intervals={n: [i.lower, i.upper] for n, i in box.items()}
        ),
    )


def _improvement(surrogate: Surrogate) -> str:
    """What gives a better surrogate."""
    scheme = surrogate.scheme
    if isinstance(scheme, Adaptive) and not surrogate.ended:  # it ended at its tolerance
        return f"allow less error by Adaptive(tolerance=...), now {scheme.tolerance:g}"
    return surrogate.ended or scheme.more(2 * surrogate.order)


def _demand(whole: SobolIndices, names: tuple[str, ...], tolerance: float, more: str) -> None:
    """Refuse indices that are too uncertain."""
    worst = int(np.argmax(np.nan_to_num(whole.uncertainty)))
    if whole.uncertainty[worst] > tolerance:
        raise SolveError(
            f"global_sensitivity: the error of the surrogate leaves the indices of channel {names[worst]!r} uncertain "
            f"by {whole.uncertainty[worst]:.2g}, more than the tolerance of {tolerance:g}. Improve the surrogate "
            f"({more}), narrow the intervals, or raise the tolerance."
        )
