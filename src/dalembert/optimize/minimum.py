"""What every minimiser takes and returns: a batch objective, progress, a minimum."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from dalembert.arguments import limited
from dalembert.errors import InputError

Objective = Callable[[np.ndarray], np.ndarray]
"""Misfit of a batch, (batch, parameters) to (batch,); NaN or an infinity marks a sample that failed."""


def reachable(default: float) -> Any:
    """Field of a tolerance that is not lost in rounding."""
    return limited(default, above=3e-16, below=1)


@dataclass(frozen=True, eq=False)
class RegularisedStep:
    """Account of one regularised step, ‖A d − b‖² + μ² ‖d‖² least, that led to a point.

    Parameters
    ----------
    mu : float
        Weight that the step was taken with.
    chosen : float
        Weight before it was raised for agreement: the corner of the L-curve, say.
    agreement : float
        Fall of the sum of squares over the fall that the linear model foresaw.
    trials : int
        Points tried until one agreed.
    residual, length : float
        ‖b‖ before the step, and ‖d‖.
    weights, residual_norms, step_norms : array, shape (points,)
        The L-curve: ‖A d − b‖ and ‖d‖ of many weights, increasing.
    """

    mu: float
    chosen: float
    agreement: float
    trials: int
    residual: float
    length: float
    weights: np.ndarray
    residual_norms: np.ndarray
    step_norms: np.ndarray


@dataclass(frozen=True)
class Progress:
    """How far a minimiser has come.

    Parameters
    ----------
    iteration, evaluations : int
    best : float
        Lowest misfit so far; infinite while every sample has failed.
    x : array, shape (parameters,)
        Where it was found.
    regularised : RegularisedStep, optional
        The step that led there, from methods that take such steps.
    """

    iteration: int
    evaluations: int
    best: float
    x: np.ndarray
    regularised: RegularisedStep | None = None


OnIteration = Callable[[Progress], None]


@dataclass(frozen=True)
class Minimum:
    """Where a minimiser ended.

    Parameters
    ----------
    x : array, shape (parameters,)
    misfit : float
        Infinite if every sample failed.
    success : bool
    message : str
        Why it stopped, in a sentence.
    iterations, evaluations : int
    stationary : bool
        Whether it stopped because x no longer moves; finer settings would change nothing.
    rough : bool
        Whether it stopped because the misfit is rough: it does not fall where its derivatives foresee a fall.
    left_out : array, shape (directions, parameters), optional
        Directions along which x was left because the residuals do not identify them.
    """

    x: np.ndarray
    misfit: float
    success: bool
    message: str
    iterations: int
    evaluations: int
    stationary: bool = False
    rough: bool = False
    left_out: np.ndarray | None = None


def misfits(objective: Objective, points: np.ndarray) -> np.ndarray:
    """Return the misfit of a batch, shape (batch,), with every failed sample infinitely bad.
    >>> misfits(lambda x: np.array([1.0, np.nan, -np.inf]), np.zeros((3, 2)))
    array([ 1., inf, inf])
    """
    values = np.asarray(objective(points), dtype=float)
    if values.shape != (len(points),):
        raise InputError(
            f"the objective returned an array of shape {values.shape}; expected ({len(points)},), one number a point"
        )
    return np.where(np.isfinite(values), values, np.inf)
