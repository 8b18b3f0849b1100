"""Which of many parameters matter: Morris's screening by elementary effects."""

import numpy as np

from dalembert.argument_readers import check_integer, check_model
from dalembert.arguments import takes_checked
from dalembert.errors import InputError, SolveError
from dalembert.findings import Finding
from dalembert.forward import Executor, ForwardModel, findings_at, on_cluster, takes_executor
from dalembert.forward.provenance import provenance
from dalembert.surrogate.basis import powers_of_two
from dalembert.uncertainty.events import Began, Ended, OnEvent
from dalembert.uncertainty.inputs import Distributions, Inputs, described, inputs_of
from dalembert.uncertainty.runs import Runs
from dalembert.uncertainty.screening import Screening
from dalembert.uncertainty.sobol import failed_runs

NAME = "screen"
SMALL = 0.05  # part of the largest effect on a channel below which a parameter may be fixed


@takes_executor
@takes_checked("trajectories", "levels", "seed")
def screen(
    model: ForwardModel,
    intervals: Distributions | None = None,
    *,
    trajectories: int = 20,
    levels: int = 4,
    seed: int = 0,
    on_event: OnEvent | None = None,
    executor: Executor = None,
) -> Screening:
    """Return the elementary effects of the parameters on each channel: a ranking of many parameters by few runs.

    A trajectory starts at a random point and changes one parameter after the other, which costs parameters + 1 runs.
    Each change gives an effect: the difference of the response, scaled to the whole interval of the parameter. Needs
    the extra ``sensitivity``: ``pip install 'dalembert[sensitivity]'``.

    Parameters
    ----------
    model : ForwardModel
    intervals : Box, or mapping of str to Interval, (lower, upper), number or prior, optional
        As for :func:`global_sensitivity`. A parameter with a distribution is changed in steps of its probability.
    trajectories : int
        At least 2; usual are 10 to 50.
    levels : int
        Of each parameter: an even number. A step is levels/(2 (levels − 1)) of the interval.
    seed : int
    on_event : callable, optional
        Called with each event (see :mod:`dalembert.uncertainty.events`) as it happens.
    executor : str or distributed.Client, optional
        Address of a Dask cluster, or a client of one, to which batches go.

    Returns
    -------
    Screening

    Raises
    ------
    InputError
        For intervals that do not match the parameters, fewer than 2 trajectories, levels that are odd, and a missing
        extra.
    SolveError
        If fewer than 2 trajectories are without failed runs.

    Notes
    -----
    Trajectories are SALib's. Source: Morris, Factorial sampling plans for preliminary computational experiments (1991);
    the mean of absolute effects: Campolongo, Cariboni and Saltelli, An effective screening design for sensitivity
    analysis of large models (2007).

    Examples
    --------
    >>> import numpy as np, dalembert as da
    >>> times = np.linspace(0.0, 1.0, 11)
    >>> model = da.PythonModel(lambda a, b: a * times + 0.1 * b, {"a": (0, 1), "b": (0, 1)}, ["x"], times)
    >>> found = da.screen(model, trajectories=4)
    >>> found.ranking("x"), found.effects[-1, 0].round(6).tolist()
    (('a', 'b'), [1.0, 0.1])
    """
    check_model(NAME, model)
    check_integer(NAME, "seed", seed, 0)
    check_integer(NAME, "trajectories", trajectories, 2)
    check_integer(NAME, "levels", levels, 2)
    if levels % 2:
        raise InputError(f"{NAME}: levels is {levels}; expected an even number, as 4")
    model = on_cluster(model, executor)
    inputs = inputs_of(model, intervals, NAME)
    runs = Runs(model, inputs.box, "screening", on_event)
    settings = {"seed": seed, "trajectories": trajectories, "levels": levels}
    result = _screening(runs, inputs, _runs_of_effects(runs, inputs, **settings), settings)
    runs.tell(Ended(runs.method, result.success, result.status, runs.count, 0.0))
    return result


def _runs_of_effects(runs: Runs, inputs: Inputs, seed: int, trajectories: int, levels: int) -> np.ndarray:
    """Run the trajectories; effects (trajectories without failed runs, samples, channels, parameters)."""
    free = runs.free
    parts = _trajectories(len(free), trajectories, levels, seed)
    steps = len(free) + 1
    runs.most = trajectories * steps
    # Rows are probabilities of the distributions. Inputs without a width stay at the middle.
    every = np.full((runs.most, len(inputs.box)), 0.5)
    every[:, free] = parts.reshape(runs.most, -1)
    runs.tell(Began(runs.method, runs.most))
    values = runs.values(inputs.points(every)).reshape(trajectories, steps, *runs.shape)
    # A failed run spoils two effects of its trajectory, so that the trajectory is left out.
    known = np.isfinite(values.reshape(trajectories, -1)).all(axis=1)
    if known.sum() < 2:
        raise SolveError(
            f"{NAME}: only {known.sum()} of {trajectories} trajectories are without failed runs, the first: "
            f"{runs.failures[0]}. Narrow the intervals to where the model can be run."
        )
    effects = np.zeros((int(known.sum()), *runs.shape, len(inputs.box)))
    effects[..., free] = _effects(parts[known], values[known])
    return effects


def _screening(runs: Runs, inputs: Inputs, effects: np.ndarray, settings: dict[str, int]) -> Screening:
    """Return the statistics of effects (trajectories, samples, channels, parameters)."""
    model = runs.model
    # Squares of large effects would overflow. Powers of two for each channel scale them without rounding.
    powers = powers_of_two(np.moveaxis(effects, -2, -1).reshape(-1, effects.shape[-2]))[:, None]
    effects = np.ldexp(effects, -powers)
    # Effect on a whole channel along one trajectory: the root mean square over its samples.
    size = np.sqrt((effects**2).mean(axis=1))
    # Morris's sigma. Together with the mean of absolute effects (mu* of Campolongo et al. 2007) it is the result.
    spread = effects.std(axis=0, ddof=1)
    # Trajectories are independent, so the standard error of a mean follows from their spread.
    mean_size, errors = size.mean(axis=0), size.std(axis=0, ddof=1) / np.sqrt(len(size))
    return Screening(
        coordinate=model.coordinate,
        channels=tuple(channel.name for channel in model.channels),
        units=tuple(channel.unit for channel in model.channels),
        box=inputs.box,
        distributions=inputs.texts,
        parameter_units=model.parameters.units(inputs.box.names),
        mean=np.ldexp(effects.mean(axis=0), powers),
        effects=np.ldexp(np.abs(effects).mean(axis=0), powers),
        spread=np.ldexp(spread, powers),
        aggregated_effects=np.ldexp(mean_size, powers),
        aggregated_spread=np.ldexp(np.sqrt((spread**2).mean(axis=0)), powers),
        errors=np.ldexp(errors, powers),
        trajectories=len(effects),
        runs=runs.count,
        failures=tuple(runs.failures),
        provenance=provenance(model, **settings, intervals=dict(described(inputs))),
        findings=(
            *failed_runs(runs),
            *_small(inputs.box.names, mean_size + 2 * errors, mean_size, runs.free),
            *findings_at(model, inputs.box.middle),
        ),
    )


def _trajectories(parameters: int, count: int, levels: int, seed: int) -> np.ndarray:
    """Probabilities of the parameters along trajectories, shape (count, parameters + 1, parameters)."""
    if parameters == 0:
        raise InputError(f"{NAME}: all intervals have the width 0. Give at least one parameter an interval.")
    try:
        from SALib.sample.morris import sample
    except ImportError:
        raise InputError(
            "screen: SALib is needed and not installed; run: pip install 'dalembert[sensitivity]'"
        ) from None
    names = [f"x{k}" for k in range(parameters)]
    problem = {"num_vars": parameters, "names": names, "bounds": [[0.0, 1.0]] * parameters}
    # SALib draws points of a grid of levels; one step is levels/(2 (levels - 1)), as Morris proposes for even levels.
    points = sample(problem, count, num_levels=levels, seed=seed)
    return np.clip(points.reshape(count, parameters + 1, parameters), 0.0, 1.0)


def _effects(parts: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Effects (trajectories, samples, channels, parameters) from values (trajectories, points, samples, channels)."""
    # Elementary effect of Morris (1991): d_i(x) = (y(x + step e_i) - y(x))/step, where the step has a sign.
    # Each step of a trajectory changes one parameter: the one with the largest difference.
    steps = np.diff(parts, axis=1)
    changed = np.abs(steps).argmax(axis=2)
    sizes = np.take_along_axis(steps, changed[..., None], axis=2)[..., 0]
    slopes = np.diff(values, axis=1) / sizes[:, :, None, None]
    # Trajectories change the parameters in random order. Sorting puts effects in the order of the parameters.
    order = np.argsort(changed, axis=1)
    return np.moveaxis(np.take_along_axis(slopes, order[:, :, None, None], axis=1), 1, -1)


def _small(names: tuple[str, ...], most: np.ndarray, mean_size: np.ndarray, free: np.ndarray) -> list[Finding]:
    """Finding on parameters whose effects are small in all channels, shape (channels, parameters)."""
    # A parameter counts as small by the upper end of its effect, two standard errors above the mean.
    largest = mean_size.max(axis=1, keepdims=True)
    shares = np.divide(most, largest, out=np.zeros_like(most), where=largest > 0).max(axis=0)
    values = {names[k]: float(shares[k]) for k in free if shares[k] < SMALL}
    if not values:
        return []
    message = (
        f"The effects of these parameters are below {100 * SMALL:g} % of the largest one in all channels: "
        f"{', '.join(values)}."
    )
    return [Finding("small-effects", "note", values, message, "They may be fixed within their intervals.")]
