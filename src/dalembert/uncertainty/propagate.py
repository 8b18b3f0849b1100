"""Bounds of a response over a box of parameters."""

from collections.abc import Iterator, Mapping

from dalembert.arguments import check_whole, takes_checked
from dalembert.errors import InputError
from dalembert.findings import Finding
from dalembert.forward import Executor, ForwardModel, clock, findings_at, on_cluster, takes_executor
from dalembert.forward.provenance import provenance
from dalembert.intervals import Box, Interval
from dalembert.uncertainty.events import Began, Ended, OnEvent
from dalembert.uncertainty.method import Method, MethodBounds
from dalembert.uncertainty.methods import label, method_of
from dalembert.uncertainty.propagation import Propagation
from dalembert.uncertainty.runs import Runs

Intervals = Box | Mapping[str, Interval | tuple[float, float] | float]


@takes_executor
@takes_checked("seed", "method")
def propagate(
    model: ForwardModel,
    intervals: Intervals,
    method: Method | str = "chebyshev",
    *,
    seed: int = 0,
    on_event: OnEvent | None = None,
    executor: Executor = None,
) -> Propagation:
    """Bounds of every channel at every sample, while each parameter is anywhere in its interval.

    Parameters
    ----------
    model : ForwardModel
    intervals : Box, or mapping of str to Interval, (lower, upper) or number
        One for each parameter of the model, in SI units; the bounds between which the model's parameters are searched
        do not matter here.
    method : str or settings
        ``"vertex"``, ``"scan"``, ``"monte-carlo"``, ``"latin-hypercube"``, ``"taylor"``, ``"optimise"``,
        ``"chebyshev"``, or an object of their settings, such as ``MonteCarlo(runs=500)``.
    seed : int
        All random numbers follow from it.
    on_event : callable, optional
        Called with each event (see :mod:`dalembert.uncertainty.events`) as it happens.
    executor : str or distributed.Client, optional
        Address of a Dask cluster, such as ``"tcp://10.0.0.1:8786"``, or a client of one, to which batches go.

    Returns
    -------
    Propagation

    Raises
    ------
    InputError
        For an unknown method, a parameter without an interval, an interval of no parameter.
    SolveError
        If not one run succeeded, or the bounds could not be trusted.

    Examples
    --------
    >>> import numpy as np
    >>> from dalembert.forward import PythonModel
    >>> times = np.linspace(0, 1, 3)
    >>> decay = PythonModel(lambda rate: np.exp(-rate * times), {"rate": (0.1, 2.0)}, ["x"], times)
    >>> bands = propagate(decay, {"rate": (0.5, 1.0)}, "vertex")
    >>> bands.lower[:, 0].round(4).tolist(), bands.upper[:, 0].round(4).tolist()
    ([1.0, 0.6065, 0.3679], [1.0, 0.7788, 0.6065])
    >>> bands.kind, bands.runs
    ('inner bound', 2)
    """
    check_whole("propagate", "seed", seed, 0)
    model = on_cluster(model, executor)
    chosen, box = method_of(method), box_of(model, intervals)
    runs = Runs(model, box, label(chosen), on_event)
    runs.most = chosen.most(runs)
    runs.tell(Began(runs.method, runs.most))
    began = clock(model)
    found = chosen.bound(runs, seed)
    result = Propagation(
        coordinate=model.coordinate,
        channels=tuple(channel.name for channel in model.channels),
        lower=found.lower,
        upper=found.upper,
        units=tuple(channel.unit for channel in model.channels),
        box=box,
        method=runs.method,
        kind=found.kind,
        runs=runs.count,
        error=found.error,
        at_lower=found.at_lower,
        at_upper=found.at_upper,
        failures=tuple(runs.failures),
        success=found.success,
        outcome=tuple(_outcome(found, runs)),
        seconds=clock(model) - began,
        provenance=provenance(
            model, chosen, seed=seed, intervals={name: [i.lower, i.upper] for name, i in box.items()}
        ),
        findings=(*found.findings, *findings_at(model, (box.lower + box.upper) / 2)),
        fixed=model.parameters.fixed,
    )
    runs.tell(Ended(runs.method, result.success, result.status, result.runs, result.seconds))
    return result


def box_of(model: ForwardModel, intervals: Intervals) -> Box:
    """The box of a model's parameters, in the model's order.

    Raises
    ------
    InputError
        For a parameter without an interval, and for an interval of no parameter.
    """
    model.parameters.check_some("propagate")
    given, names = Box.of(intervals), model.parameters.names
    for name, interval in given.items():
        known = interval.lower if interval.width == 0 else None
        model.parameters.check_name(name, known, "intervals")
    for name in names:
        if name not in given.names:
            raise InputError(
                f"intervals: none is given for parameter {name!r}; expected an interval, or a number if it is known "
                f"exactly, for each of {', '.join(names)}"
            )
    places = [given.names.index(name) for name in names]
    return Box(names, given.lower[places], given.upper[places])


def _outcome(found: MethodBounds, runs: Runs) -> Iterator[Finding]:
    if runs.failures:
        count = f"{len(runs.failures)} run{'s' * (len(runs.failures) > 1)}"
        yield Finding(
            "failed-runs",
            "error",
            {"failures": len(runs.failures), "first": runs.failures[0]},
            f"{count} failed, the first: {runs.failures[0]}. The bounds are valid only where the model can be run.",
            "Make the box smaller, or check the model there.",
        )
    yield found.outcome
