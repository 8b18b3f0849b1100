"""Bounds of a response over a box of parameters."""

from collections.abc import Mapping

from dalembert.argument_readers import check_integer
from dalembert.arguments import takes_checked
from dalembert.errors import InputError
from dalembert.findings import Finding
from dalembert.forward import Executor, ForwardModel, clock, findings_at, on_cluster, takes_executor
from dalembert.forward.provenance import provenance
from dalembert.intervals import Box, Interval
from dalembert.uncertainty.events import Began, Ended, OnEvent
from dalembert.uncertainty.method import Method
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
    check_integer("propagate", "seed", seed, 0)
    model = on_cluster(model, executor)
    chosen, box = method_of(method), box_of(model, intervals)
    runs = Runs(model, box, label(chosen), on_event)
    runs.most = chosen.most(runs)
    runs.tell(Began(runs.method, runs.most))
    began = clock(model)
    bounded = chosen.bound(runs, seed)
    seconds = clock(model) - began
    known = vars(bounded) | {
        "success": bounded.success and not runs.failures,
        "outcome": (*_failures(runs), bounded.outcome),
        "findings": (*bounded.findings, *findings_at(model, box.middle)),
    }
    result = Propagation(
        **known,
        coordinate=model.coordinate,
        channels=tuple(channel.name for channel in model.channels),
        units=tuple(channel.unit for channel in model.channels),
        box=box,
        method=runs.method,
        runs=runs.count,
        failures=tuple(runs.failures),
        seconds=seconds,
        provenance=provenance(model, chosen, seed=seed, intervals={n: [i.lower, i.upper] for n, i in box.items()}),
        fixed=model.parameters.fixed,
        parameter_units=model.parameters.units(box.names),
    )
    runs.tell(Ended(runs.method, result.success, result.status, result.runs, result.seconds))
    return result


def box_of(model: ForwardModel, intervals: Intervals) -> Box:
    """The box of a model's parameters, in the model's order."""
    model.parameters.check_some("propagate")
    box, names = Box.of(intervals), model.parameters.names
    for name, interval in box.items():
        known = interval.lower if interval.width == 0 else None
        model.parameters.check_name(name, known, "intervals")
    for name in names:
        if name not in box.names:
            raise InputError(
                f"intervals: none is given for parameter {name!r}; expected an interval, or a number if it is known "
                f"exactly, for each of {', '.join(names)}"
            )
    places = [box.names.index(name) for name in names]
    return Box(names, box.lower[places], box.upper[places])


def _failures(runs: Runs) -> list[Finding]:
    if not runs.failures:
        return []
    number, first = len(runs.failures), runs.failures[0]
    count = f"{number} run{'s' * (number > 1)}"
    message = f"{count} failed, the first: {first}. The bounds are valid only where the model can be run."
    advice = "Make the box smaller, or check the model there."
    return [Finding("failed-runs", "error", {"failures": number, "first": first}, message, advice)]
