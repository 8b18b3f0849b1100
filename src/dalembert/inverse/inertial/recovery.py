"""How well a planned experiment recovers known parameters: repeated identifications of simulated torques."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np

from dalembert.errors import InputError
from dalembert.inverse.fit.fit import check_level
from dalembert.inverse.inertial.base_parameters import base_parameters
from dalembert.inverse.inertial.consistent import identify_inertias
from dalembert.inverse.inertial.stacked import checked_regressor
from dalembert.results import Result
from dalembert.stored_fields import Labels, Over
from dalembert.tables import Table, cells, counted, shown


@dataclass(frozen=True, eq=False)
class Recovery(Result):
    """Repeated identifications of simulated torques with noise.

    Parameters
    ----------
    base : tuple of str
        Base parameters.
    level : float
    covered : array, shape (runs, base)
        Whether the interval of a base parameter contains the true value.
    plain_covered : array, shape (runs, base)
        The same for weighted least squares without prior.
    prediction : array, shape (runs,)
        Rms difference of predicted and noisy torques along the unseen motion, relative to the standard deviation of the
        noise. It varies with the noise of this record, too.
    unseen_noise : array, shape (runs,)
        Rms of this noise itself, relative to the same standard deviation.
    consistent : array of bool, shape (runs, links)
    decrements : array, shape (runs,)
        Half the squared Newton decrements.
    gradients : array, shape (runs,)
        Largest entry of the gradient by the log-Cholesky parameters.
    """

    FORMAT: ClassVar[str] = "dalembert recovery 1"
    TITLE: ClassVar[str] = "Simulated recovery"

    base: Annotated[tuple[str, ...], Labels("base")]
    level: float
    covered: Annotated[np.ndarray, Over("run", "base")]
    plain_covered: Annotated[np.ndarray, Over("run", "base")]
    prediction: Annotated[np.ndarray, Over("run")]
    unseen_noise: Annotated[np.ndarray, Over("run")]
    consistent: Annotated[np.ndarray, Over("run", "link")]
    decrements: Annotated[np.ndarray, Over("run")]
    gradients: Annotated[np.ndarray, Over("run")]

    @property
    def coverage(self) -> np.ndarray:
        """Share of runs (base,) whose interval contains the true value."""
        return self.covered.mean(axis=0)

    def facts(self) -> dict[str, str]:
        worst = float(np.max(self.prediction / self.unseen_noise))
        coverage = f"{shown(100 * float(self.covered.mean()), digits=4)} %, nominal {shown(100 * self.level)} %"
        return {
            "runs": counted(len(self.prediction)),
            "coverage": coverage,
            "prediction, worst run": f"{shown(worst, digits=4)} times the noise",
            "consistent links": f"{shown(100 * float(self.consistent.mean()), digits=4)} %",
        }

    def tables(self) -> tuple[Table, ...]:
        """Return the coverage of the interval of each base parameter."""
        shares = {
            "base parameter": self.base,
            "coverage": cells(self.coverage, 3),
            "without prior": cells(self.plain_covered.mean(axis=0), 3),
        }
        return (Table.of("coverage", "Share of intervals that contain the true value", shares),)


def simulated_recovery(
    regressor: np.ndarray,
    unseen: np.ndarray,
    names: Sequence[str],
    truth: np.ndarray,
    prior: np.ndarray,
    *,
    links: Sequence[str],
    positive: Sequence[str] = (),
    noise: float = 0.02,
    regularisation: float = 1.0,
    level: float = 0.95,
    runs: int = 100,
    seed: int = 0,
) -> Recovery:
    """Identify simulated torques with noise again and again, and compare with the true parameters.

    Parameters
    ----------
    regressor, unseen : array, shape (samples, joints, parameters)
        Along the motion that is fitted, and along one that is predicted.
    names : sequence of str, length parameters
    truth, prior : array, shape (parameters,)
    links, positive, regularisation
        As in :func:`identify_inertias`.
    noise : float
        Standard deviation of the torques of each joint, relative to their rms along the motion.
    level : float
        Of the intervals.
    runs : int
    seed : int
        Run k draws from the generator of (seed, k).

    Raises
    ------
    InputError
        For arguments that :func:`identify_inertias` refuses, no runs, or a noise that is not positive.

    Examples
    --------
    >>> motion = np.random.default_rng(0).standard_normal((2, 60, 1, 10))
    >>> sphere = [5.0, 0, 0, 0, 0.02, 0.02, 0.02, 0, 0, 0]
    >>> from dalembert.inverse.inertial import parameter_names
    >>> found = simulated_recovery(*motion, parameter_names(["ball"]), sphere, sphere, links=["ball"], runs=3)
    >>> found.covered.shape, bool(found.consistent.all())
    ((3, 10), True)
    """

    def rms(values: np.ndarray) -> float:
        return float(np.sqrt(np.mean(values**2)))

    table = checked_regressor(regressor, names, "simulated_recovery")
    check_level(level, "simulated_recovery")
    if runs < 1 or not 0 < noise < np.inf:
        raise InputError(f"simulated_recovery: runs {runs}, noise {noise}; expected positive numbers")
    exact, other = table @ np.asarray(truth), np.asarray(unseen) @ np.asarray(truth)
    size = noise * np.sqrt(np.mean(exact**2, axis=0))
    base = base_parameters(table, names)
    true = base.values(np.asarray(truth))
    recovered = []
    for run in range(runs):
        rng = np.random.default_rng((seed, run))
        torques = exact + size * rng.standard_normal(exact.shape)
        estimate = identify_inertias(
            table, torques, names, prior, links=links, positive=positive, regularisation=regularisation, base=base
        )
        inside = np.array(
            [low <= value <= high for value, (low, high) in zip(true, estimate.intervals(level).values(), strict=True)]
        )
        quantile = (estimate.intervals(level)[base.base[0]][1] - estimate.base_values[0]) / estimate.base_deviations[0]
        plain = np.abs(estimate.plain_values - true) <= quantile * np.sqrt(np.diagonal(estimate.plain_covariance))
        added = rng.standard_normal(other.shape)
        ratio = (estimate.torques(unseen) - other) / size - added
        largest = float(np.max(np.abs(np.concatenate([estimate.gradient.ravel(), estimate.other_gradient]))))
        recovered.append((inside, plain, rms(ratio), rms(added), estimate.consistent, estimate.decrement, largest))
    return Recovery(base.base, level, *(np.array(column) for column in zip(*recovered, strict=True)))
