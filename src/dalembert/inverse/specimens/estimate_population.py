"""Mean and spread of parameters that vary from one specimen to the next (mixed effects), from the specimens' fits."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from scipy.optimize import root_scalar
from scipy.special import chdtrc, chdtri

import dalembert
from dalembert.argument_readers import names_of
from dalembert.errors import InputError, listed, require_known, shown
from dalembert.findings import Finding
from dalembert.inverse.fit.fit import Fit, check_level
from dalembert.inverse.specimens.new_specimen import new_specimen
from dalembert.inverse.specimens.population import Population
from dalembert.inverse.specimens.restricted_likelihood import Likelihood, SpreadForm, most_likely, profiled

FEW = 6  # specimens from which a spread is known to about a third of itself, 1/√(2 (m − 1))
NOTHING = 1e-6  # a spread that is rounding, over the deviation of the specimens' values
WIDEST = 100.0  # largest upper end of a spread that is looked for, over the deviation of the specimens' values


@dataclass(frozen=True, eq=False)
class Estimates:
    """Estimates of several specimens."""

    # names, units: length parameters.
    names: tuple[str, ...]
    units: tuple[str, ...]
    specimens: tuple[str, ...]
    values: np.ndarray  # (specimens, parameters)
    covariance: np.ndarray  # (specimens · parameters, specimens · parameters)


def population(
    fits: Mapping[str, Fit] | Fit,
    parameters: Sequence[str] | None = None,
    *,
    correlated: bool = False,
    level: float = 0.95,
) -> Population:
    """Estimate the mean of parameters over specimens, and how much they vary between them.

    The values θ_i of specimen i are normal about the mean with the covariance Ω + C_i: Ω between the specimens, C_i of
    the specimen's fit. Ω has the largest restricted likelihood; the mean follows by generalised least squares.

    Parameters
    ----------
    fits : mapping of str to Fit, or Fit
        The fit of each specimen, by its name. Or one fit of several experiments, one for each specimen, in which the
        parameters that vary are local; others are shared.
    parameters : sequence of str, optional
        The parameters that vary; all that the specimens have if not given.
    correlated : bool
        Whether to estimate the correlations between the parameters, too. It needs more specimens than parameters + 1.
    level : float
        Probability of the intervals.

    Returns
    -------
    Population

    Raises
    ------
    InputError
        For fewer than three specimens, parameters that a specimen lacks, and values without standard deviations.

    Notes
    -----
    It assumes fits whose responses are nearly linear within the deviations, so that C_i is right. With two specimens
    the likelihood decreases as 1/spread, so that nothing bounds the spread; three are the least.

    Examples
    --------
    >>> import numpy as np, dalembert as da
    >>> t = np.linspace(0.0, 2.0, 21)
    >>> model = da.PythonModel(lambda rate: np.exp(-rate * t), {"rate": (0.1, 3.0)}, ["x"], t)
    >>> noise = np.random.default_rng(1).standard_normal((5, len(t)))
    >>> data = [np.exp(-rate * t) + 0.002 * e for rate, e in zip((0.9, 1.0, 1.05, 1.1, 0.95), noise)]
    >>> fits = {f"part {i}": da.identify(model, da.Measurements.of(t, {"x": x})) for i, x in enumerate(data)}
    >>> found = da.population(fits)
    >>> print(f"{found.mean[0]:.2f}, spread {found.spread[0]:.2f}")
    1.00, spread 0.08
    """
    check_level(level, "population")
    chosen = None if parameters is None else names_of(parameters, "population", "parameters")
    estimates = _of_experiments(fits, chosen) if isinstance(fits, Fit) else _of_fits(fits, chosen)
    k, m = len(estimates.names), len(estimates.specimens)
    if m < 3:
        raise InputError(f"population: there are {m} specimens, and a spread needs at least 3. Add more fits.")
    if correlated and m <= k + 1:
        raise InputError(
            f"population: the correlations of {k} parameters need at least {k + 2} specimens, and there are {m}. "
            "Use correlated=False, or name fewer parameters."
        )
    return estimated(estimates, correlated=correlated, level=level)


def estimated(estimates: Estimates, *, correlated: bool = False, level: float = 0.95) -> Population:
    """Return the population of estimates, see :func:`population`."""
    values, k = estimates.values, len(estimates.names)
    variances = np.diag(estimates.covariance).reshape(values.shape)
    scale = np.sqrt(values.var(axis=0, ddof=1) + variances.mean(axis=0))
    every = np.tile(scale, len(values))
    likelihood = Likelihood(values / scale, estimates.covariance / np.outer(every, every))
    form = SpreadForm(k, correlated)
    unknowns, best = most_likely(likelihood, form)
    between = form.matrix(unknowns)
    mean, known = likelihood.mean(between)
    adjusted, deviations = likelihood.adjusted(between)
    spread = np.sqrt(np.diag(between))
    spread[spread < NOTHING] = 0.0
    ends = [_interval(likelihood, form, unknowns, number, best, level) for number in range(k)]
    lower, upper = np.array(ends).T * scale
    new = [new_specimen(values[:, number], variances[:, number], level) for number in range(k)]
    # Cochran's Q: the squares of the differences from the mean, in deviations, without a spread.
    tests = [
        Likelihood(values[:, [number]], np.diag(variances[:, number])).residual_product(np.zeros((1, 1)))
        for number in range(k)
    ]
    p_value = np.array([chdtrc(len(values) - 1, size) for size in tests])
    units = np.where(spread > 0, spread, 1.0)
    correlation = between / np.outer(units, units)
    np.fill_diagonal(correlation, 1.0)
    new_lower, new_upper = np.array(new).T
    return Population(
        names=estimates.names,
        units=estimates.units,
        specimens=estimates.specimens,
        values=values,
        deviations=np.sqrt(variances),
        mean=mean * scale,
        mean_deviations=np.sqrt(np.diag(known)) * scale,
        spread=spread * scale,
        spread_lower=lower,
        spread_upper=upper,
        new_lower=new_lower,
        new_upper=new_upper,
        correlation=correlation,
        adjusted=adjusted * scale,
        adjusted_deviations=deviations * scale,
        heterogeneity=np.array(tests),
        p_value=p_value,
        level=level,
        provenance={
            "version": dalembert.__version__,
            "numpy": np.__version__,
            "scipy": scipy.__version__,
            "correlated": correlated,
            "level": level,
        },
        findings=tuple(_findings(estimates, lower, upper, level)),
    )


def _interval(
    likelihood: Likelihood, form: SpreadForm, unknowns: np.ndarray, number: int, best: float, level: float
) -> tuple[float, float]:
    """Where the profile of the restricted likelihood of a σ is lower than the best one by half a χ² quantile."""
    spread, allowed = unknowns[number], best - 0.5 * float(chdtri(1, 1 - level))

    def above(size: float) -> float:
        return profiled(likelihood, form, unknowns, number, size) - allowed

    lower = 0.0 if above(0.0) >= 0 else _root(above, 0.0, spread)
    further = 2 * max(spread, 0.1)
    while above(further) > 0 and further < WIDEST:
        further *= 2
    return lower, _root(above, spread, further) if further < WIDEST else np.inf


def _root(function: Callable[[float], float], first: float, second: float) -> float:
    return float(root_scalar(function, bracket=(first, second), method="brentq", xtol=1e-5).root)


def _findings(estimates: Estimates, lower: np.ndarray, upper: np.ndarray, level: float) -> Iterator[Finding]:
    count = len(estimates.specimens)
    if count < FEW:
        message = f"There are {count} specimens. Their spread is uncertain."
        advice = f"Measure at least {FEW} specimens, or use the upper ends of the spreads."
        yield Finding("few-specimens", "warning", {"specimens": count, "expected": FEW}, message, advice)
    ends = zip(estimates.names, estimates.units, lower.tolist(), upper.tolist(), strict=True)
    yield from (_equal(name, unit, above, level) for name, unit, below, above in ends if below == 0)


def _equal(name: str, unit: str, upper: float, level: float) -> Finding:
    message = (
        f"The specimens do not differ in {name} by more than the deviations of their fits explain. Its spread is at "
        f"most {f'{upper:.3g} {unit}'.strip()} ({100 * level:g} %)."
    )
    return Finding("no-spread-seen", "note", {"parameter": name, "upper": upper, "level": level}, message)


def _of_fits(fits: Mapping[str, Fit], chosen: tuple[str, ...] | None) -> Estimates:
    """Estimates of fits that share nothing."""
    if not isinstance(fits, Mapping) or not all(isinstance(fit, Fit) for fit in fits.values()):
        raise InputError(f"population: fits is {shown(fits)}; expected a mapping of names to fits, or one fit")
    if not fits:
        raise InputError("population: there are no fits. Add at least 3, by the names of the specimens.")
    first = next(iter(fits.values()))
    names = chosen or first.parameters.names
    for specimen, fit in fits.items():
        for name in names:
            require_known("parameter", name, fit.parameters.names, f"population, specimen {specimen!r}")
    covariance = np.zeros((len(fits) * len(names),) * 2)
    for number, (specimen, fit) in enumerate(fits.items()):
        at = slice(number * len(names), (number + 1) * len(names))
        covariance[at, at] = _covariance(fit, [fit.parameters.names.index(name) for name in names], specimen)
    values = np.array([[fit.estimates[name] for name in names] for fit in fits.values()])
    units = {item.name: item.unit for item in first.parameters}
    return Estimates(tuple(names), tuple(units[name] for name in names), tuple(fits), values, covariance)


def _of_experiments(fit: Fit, chosen: tuple[str, ...] | None) -> Estimates:
    """Estimates of the local parameters of one fit, with their covariance through shared ones."""
    specimens = [part.name for part in fit.parts]
    known = fit.parameters.names
    local = [
        {name.removeprefix(f"{specimen}.") for name in known if name.startswith(f"{specimen}.")}
        for specimen in specimens
    ]
    common = set.intersection(*local) if local else set()
    names = chosen or tuple(dict.fromkeys(name.partition(".")[2] for name in known if name.partition(".")[2] in common))
    if not names:
        raise InputError(
            "population: the experiments of the fit have no local parameter in common. Declare those that vary as "
            "local, with local of each experiment."
        )
    for name in names:
        require_known("local parameter", name, common, "population")
    places = [known.index(f"{specimen}.{name}") for specimen in specimens for name in names]
    values = fit.values[places].reshape(len(specimens), len(names))
    items = {item.name: item for item in fit.parameters}
    units = tuple(items[f"{specimens[0]}.{name}"].unit for name in names)
    return Estimates(tuple(names), units, tuple(specimens), values, _covariance(fit, places, "the fit"))


def _covariance(fit: Fit, places: list[int], specimen: str) -> np.ndarray:
    deviations = fit.deviations[places]
    unknown = [fit.parameters.names[place] for place in places if not 0 < fit.deviations[place] < np.inf]
    if unknown:
        raise InputError(
            f"population, specimen {specimen!r}: {listed(unknown)} has no standard deviation, because the data do not "
            "determine it. Leave it out of parameters, or fix it in the fits."
        )
    return fit.correlation[np.ix_(places, places)] * np.outer(deviations, deviations)
