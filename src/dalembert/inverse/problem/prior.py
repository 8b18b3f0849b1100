"""What is known of parameters before any data, as residuals that least squares can use."""

from collections.abc import Iterator, Sequence

import numpy as np

from dalembert.errors import InputError, counted, listed
from dalembert.findings import Finding
from dalembert.inverse.problem.combinations import moved, separated
from dalembert.parameters import Parameters
from dalembert.priors import CorrelatedNormal, SquarePrior

ALONE = 0.9
"""Part of a prior's variance that is left with the data, from which the prior alone is said to have decided."""

MANY = 4
"""Combinations up to which each has its finding."""


def prior_deviations(parameters: Parameters) -> np.ndarray:
    """Standard deviations of the priors, one for each of ``parameters.square_priors``."""
    known = [item.distribution for item in parameters]
    return np.array([prior.spread for prior in known if isinstance(prior, SquarePrior)], dtype=float)


def prior_residual(parameters: Parameters, vectors: np.ndarray) -> np.ndarray:
    """Residuals of the priors: (..., priors) at parameter vectors (..., parameters).

    Those of correlated parameters are whitened by the Cholesky factor of their covariance.
    """
    known = parameters.square_priors
    residual = np.zeros((*vectors.shape[:-1], len(known)))
    if not len(known):
        return residual
    for row, k in enumerate(known):
        prior = parameters.items[k].distribution
        if isinstance(prior, SquarePrior):
            residual[..., row] = prior.residual(vectors[..., k])
    for joint, columns in joint_priors(parameters):
        residual[..., np.searchsorted(known, columns)] = (vectors[..., columns] - joint.mean) @ joint.whitening().T
    return residual


def prior_slopes(parameters: Parameters, vector: np.ndarray, unit: np.ndarray) -> np.ndarray:
    """Jacobian of :func:`prior_residual` with respect to p/unit at a vector (parameters,), (priors, parameters)."""
    known = parameters.square_priors
    rows = np.zeros((len(known), len(parameters)))
    if not len(known):
        return rows
    for row, k in enumerate(known):
        prior = parameters.items[k].distribution
        if isinstance(prior, SquarePrior):
            rows[row, k] = unit[k] * prior.residual_slope(vector[k])
    for joint, columns in joint_priors(parameters):
        rows[np.ix_(np.searchsorted(known, columns), columns)] = joint.whitening() * unit[columns]
    return rows


def joint_priors(parameters: Parameters) -> Iterator[tuple[CorrelatedNormal, np.ndarray]]:
    """Yield the priors of several parameters, each with the numbers of its parameters."""
    joints = dict.fromkeys(item.prior for item in parameters.items if isinstance(item.prior, CorrelatedNormal))
    for joint in joints:
        yield joint, np.array([parameters.names.index(name) for name in joint.names])


def check_priors(parameters: Parameters, known: bool) -> None:
    """Refuse priors with data of unknown noise: which of the two to trust more would not be known."""
    for k in () if known else parameters.square_priors[:1]:
        what = "its deviation" if parameters.items[k].prior is None else parameters.items[k].distribution.name
        raise InputError(
            f"parameter {parameters.names[k]!r} has a prior ({what}), but the noise level of the data is not "
            "known; give the data's deviations, or weights that are 1/variance"
        )


def prior_findings(parameters: Parameters, deviations: np.ndarray, correlation: np.ndarray) -> Iterator[Finding]:
    """Yield findings on parameters and combinations on which the data add little to the priors.

    They are the directions, in units of the priors' deviations, in which most of the priors' variance is left.
    """
    known = parameters.square_priors
    if not len(known) or not np.all(np.isfinite(deviations[known])):
        return
    before = prior_deviations(parameters)
    after = deviations[known] / before
    left, directions = np.linalg.eigh(after[:, None] * correlation[np.ix_(known, known)] * after)
    names = [parameters.names[k] for k in known]
    weak = directions.T[left > ALONE]
    if len(weak) > MANY:
        yield _many(names, weak)
        return
    for row in separated(weak):
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


def _many(names: Sequence[str], weak: np.ndarray) -> Finding:
    """A finding on more directions than a user can read of, as errors of a measured input have."""
    largest = np.max(np.abs(weak), axis=0)
    among = [name for name, part in zip(names, largest.tolist(), strict=True) if part > 0.3]
    shown = [repr(name) for name in among[:MANY]]
    rest = [] if len(among) <= MANY else [counted(len(among) - MANY, "other")]
    return Finding(
        "prior-dominates",
        "warning",
        {"parameters": ", ".join(among), "combinations": len(weak)},
        f"The data add little to the priors of {len(weak)} combinations of the parameters {listed([*shown, *rest])}.",
        "This is usual for the coefficients of an unknown history. For other parameters, measure a quantity that "
        "depends on them.",
    )
