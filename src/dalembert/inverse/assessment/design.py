"""Sensors and durations of the experiment that determines the parameters best."""

from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike

from dalembert.arguments import takes_checked
from dalembert.errors import InputError, require_known
from dalembert.forward import ForwardModel
from dalembert.forward.provenance import provenance
from dalembert.inverse.assessment.designs import CRITERIA, Designs
from dalembert.inverse.assessment.planned_noise import Planned, planned_channels
from dalembert.inverse.assessment.sensitivity import at_of, linearised
from dalembert.inverse.least_squares.estimate import UNSEEN, estimate
from dalembert.inverse.problem.prior import prior_slopes

SETS = ("singles", "pairs", "all")


@takes_checked()
def design(
    model: ForwardModel,
    at: Mapping[str, float] | ArrayLike | None = None,
    *,
    deviations: Mapping[str, float] | ArrayLike | None = None,
    noise: Planned | None = None,
    sensors: str | Iterable[str | Sequence[str]] = "singles",
    horizons: Sequence[float] | None = None,
    criterion: str = "D",
) -> Designs:
    """Experiments ranked by how well they determine the parameters, from one run with its sensitivities.

    Parameters
    ----------
    model : ForwardModel
        With all channels that could be measured, over the longest horizon.
    at : mapping by name, or array of shape (parameters,), optional
        Where to look; the first guesses if not given. The ranking may be another one elsewhere.
    deviations : number, mapping by channel, or array of shape (channels,), optional
        Standard deviations of the noise; a mapping names the channels that can be measured.
    noise : NoiseModel, its name, mapping of channel to NoiseModel, or EstimatedNoise, optional
        Noise that is correlated from sample to sample, or depends on the response: with a value for each of its
        parameters, or as a fit has estimated it (``fit.noise``). Independent noise if not given.
    sensors : {"singles", "pairs", "all"}, or channels and tuples of channels
        The sets of channels to compare: each alone, each two, all at once, or those given.
    horizons : sequence of float, optional
        Ends of the measurement, along the model's coordinate; its own end if not given.
    criterion : {"D", "E"}
        With the derivative S of the weighted response by p/scale, its singular values σ, and d parameters: ``"D"`` is
        the geometric mean of 1/σ, (det SᵀS)^(−1/2d); other scales do not change the ranking. ``"E"`` is the largest,
        1/σ_min. Small is good.

    Returns
    -------
    Designs
        The best one first.

    Raises
    ------
    InputError
        For an unknown channel, parameter, set or criterion, a horizon without samples, noise that is not known.
    SolveError
        If the simulation fails.

    Examples
    --------
    >>> from dalembert.forward import PythonModel
    >>> times = np.linspace(0, 5, 51)
    >>> def response(rate, height):
    ...     decay = height * np.exp(-rate * times)
    ...     return np.stack([decay, -rate * decay], axis=1)
    >>> model = PythonModel(response, {"rate": (0.5, 2.0), "height": (0.5, 2.0)}, ["x", "vx"], times)
    >>> designs = design(model, {"rate": 1.0, "height": 1.0}, deviations=0.01, horizons=(1.0, 5.0))
    >>> designs.sensors[0], designs.horizons[0]
    (('vx',), np.float64(5.0))
    """
    require_known("criterion", criterion, CRITERIA, "design")
    vector, parameters = at_of(model, at, "design"), model.parameters
    channels = planned_channels(model, deviations, noise)
    names = channels.names
    sets = _sets(sensors, names)
    along = model.coordinate
    ends = [float(along.values[-1])] if horizons is None else [float(end) for end in horizons]
    counts = [_samples(along.values, end, along.unit) for end in ends]
    sizes, weighted = channels.whitened(*linearised(model, vector))
    slopes = weighted * parameters.scale
    prior = prior_slopes(parameters, vector, parameters.scale)
    rows = []
    for chosen in sets:
        places = [names.index(name) for name in chosen]
        for end, count in zip(ends, counts, strict=True):
            planned = slopes[:count, places].reshape(-1, len(vector))
            estimated = estimate(np.concatenate([planned, prior]), parameters.scale, 1.0)
            seen = estimated.singular_values > UNSEEN * (estimated.singular_values[0] or 1.0)
            with np.errstate(divide="ignore"):
                lengths = np.where(seen, 1 / estimated.singular_values, np.inf)
            score = np.exp(np.mean(np.log(lengths))) if criterion == "D" else np.max(lengths)
            rows.append((int(np.sum(~seen)), float(score), chosen, end, count, estimated))
    rows.sort(key=lambda row: row[:2])
    return Designs(
        parameters=parameters,
        at=vector,
        criterion=criterion,
        noise=dict(zip(names, sizes.tolist(), strict=True)),
        along=along.name,
        unit=along.unit,
        sensors=tuple(row[2] for row in rows),
        horizons=np.array([row[3] for row in rows]),
        samples=np.array([row[4] for row in rows]),
        scores=np.array([row[1] for row in rows]),
        unseen=np.array([row[0] for row in rows]),
        deviations=np.array([row[5].deviations for row in rows]),
        singular_values=np.array([row[5].singular_values for row in rows]),
        simulations=1 + len(vector),
        provenance=provenance(model, at=vector.tolist(), criterion=criterion),
    )


def _sets(sensors: str | Iterable[str | Sequence[str]], names: tuple[str, ...]) -> list[tuple[str, ...]]:
    if isinstance(sensors, str):
        require_known("set of sensors", sensors, SETS, "design")
        if sensors == "all":
            return [names]
        sets = list(combinations(names, 1 if sensors == "singles" else 2))
        if not sets:
            raise InputError(f"design: pairs of sensors were asked for, but {names[0]!r} is the only channel")
        return sets
    sets = [(entry,) if isinstance(entry, str) else tuple(entry) for entry in sensors]
    for name in (name for chosen in sets for name in chosen):
        require_known("channel", name, names, "design: sensors")
    if not sets or not all(sets):
        raise InputError("design: a set of sensors is empty; expected at least one channel in each")
    return sets


def _samples(values: np.ndarray, end: float, unit: str) -> int:
    """How many samples lie up to an end."""
    count = int(np.sum(values <= end + 1e-9 * max(1.0, abs(end))))
    if count == 0:
        raise InputError(
            f"design: horizon {end:g} {unit} was given, but the model's first sample lies at {values[0]:g} {unit}; "
            "expected a later end".replace("  ", " ")
        )
    return count
