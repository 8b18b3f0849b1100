"""What is known of parameters before any data: a standard deviation around the first guess."""

from collections.abc import Iterator

import numpy as np

from dalembert.errors import InputError, listed
from dalembert.findings import Finding
from dalembert.inverse.problem.combinations import moved, separated
from dalembert.parameters import Parameters

ALONE = 0.9
"""Part of a prior's variance that is left with the data, from which the prior alone is said to have decided."""


def priors(parameters: Parameters) -> np.ndarray:
    """Numbers of the parameters that have a prior."""
    return np.array([k for k, item in enumerate(parameters) if item.deviation is not None], dtype=int)


def prior_deviations(parameters: Parameters) -> np.ndarray:
    """Standard deviations of the priors, one for each of :func:`priors`."""
    return np.array([item.deviation for item in parameters if item.deviation is not None], dtype=float)


def prior_residual(parameters: Parameters, vectors: np.ndarray) -> np.ndarray:
    """(p − start)/deviation of each prior: (..., priors) at parameter vectors (..., parameters)."""
    known = priors(parameters)
    return (vectors[..., known] - parameters.start[known]) / prior_deviations(parameters)


def prior_slopes(parameters: Parameters, unit: np.ndarray) -> np.ndarray:
    """Jacobian of :func:`prior_residual` with respect to p/unit, (priors, parameters)."""
    known = priors(parameters)
    rows = np.zeros((len(known), len(parameters)))
    rows[np.arange(len(known)), known] = unit[known] / prior_deviations(parameters)
    return rows


def check_priors(parameters: Parameters, known: bool) -> None:
    """Refuse priors beside data of unknown noise: which of the two to trust more would not be known.

    Raises
    ------
    InputError
    """
    for k in () if known else priors(parameters)[:1]:
        raise InputError(
            f"parameter {parameters.names[k]!r} has a prior (its deviation), but the noise level of the data is not "
            "known; give the data's deviations, or weights that are 1/variance"
        )


def prior_findings(parameters: Parameters, deviations: np.ndarray, correlation: np.ndarray) -> Iterator[Finding]:
    """Yield findings on parameters and combinations on which the data add little to the priors.

    They are the directions, in units of the priors' deviations, in which most of the priors' variance is left.
    """
    known = priors(parameters)
    if not len(known) or not np.all(np.isfinite(deviations[known])):
        return
    before = prior_deviations(parameters)
    after = deviations[known] / before
    left, directions = np.linalg.eigh(after[:, None] * correlation[np.ix_(known, known)] * after)
    names = [parameters.names[k] for k in known]
    for row in separated(directions.T[left > ALONE]):
        parts = np.flatnonzero(np.abs(row) > 0.3 * np.max(np.abs(row)))
        if len(parts) == 1:
            k = parts[0]
            yield Finding(
                "prior-dominates",
                "warning",
                {"parameters": names[k], "prior": float(before[k]), "deviation": float(deviations[known[k]])},
                f"The data add nothing to the prior of {names[k]!r}: its standard deviation is {before[k]:.3g} in the "
                f"prior and {deviations[known[k]]:.3g} with the data.",
                f"Check that the prior is not too narrow, or measure a quantity that depends on {names[k]!r}.",
            )
        else:
            yield Finding(
                "prior-dominates",
                "warning",
                {"parameters": ", ".join(names[k] for k in parts)},
                f"Only the priors distinguish {listed([repr(names[k]) for k in parts])}: changing "
                f"{moved(names, row * before, before / 0.1)} together changes the response by less than its noise.",
                "Measure a quantity that separates them.",
            )
