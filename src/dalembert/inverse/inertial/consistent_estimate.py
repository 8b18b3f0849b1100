"""The result of an identification of physically consistent inertias."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.inertial.base_estimate import base_table, intervals, noise_lines
from dalembert.inverse.inertial.base_parameters import BaseParameters
from dalembert.inverse.inertial.pseudo_inertia import pseudo_inertia
from dalembert.results import EndedResult, fact_lines, text_table
from dalembert.stored_fields import Labels, Over


@dataclass(frozen=True, eq=False)
class ConsistentInertias(EndedResult):
    """Inertial parameters that bodies can have, from torques and prior values.

    Parameters
    ----------
    base : BaseParameters
        With the names of the parameters.
    links, joints : tuple of str
    prior, values, deviations : array, shape (parameters,)
        Standard deviations contain what the prior adds.
    base_values : array, shape (base,)
    base_covariance : array, shape (base, base)
    plain_values, plain_covariance : array
        Those of weighted least squares without conditions and prior.
    noise : array, shape (joints,)
        Standard deviation of the torques, given or from the residuals of weighted least squares.
    noise_is_known : bool
    log_cholesky : array, shape (links, 10)
        As Rucker and Wensing define them.
    gradient : array, shape (links, 10)
        Of half the objective, by the log-Cholesky parameters; zero at a minimum.
    other_gradient : array, shape (others,)
        By the logarithms of positive parameters, and by the other ones.
    eigenvalues : array, shape (links,)
        Smallest eigenvalue of each pseudo-inertia relative to the prior one; positive for a body that can exist.
    plain_eigenvalues : array, shape (links,)
        The same for the least-squares solution that is nearest to the prior.
    distances : array, shape (links,)
        Bregman distance of each link from its prior.
    residual : array, shape (joints,)
        Rms residual of the torques.
    regularisation : float
    started : {"prior", "projected"}
    steps : int
    decrement : float
        Half the squared Newton decrement: how much the objective would still fall.
    success : bool
    outcome, findings : tuple of Finding
    """

    FORMAT: ClassVar[str] = "dalembert consistentinertias 1"

    base: BaseParameters
    links: Annotated[tuple[str, ...], Labels("link")]
    joints: Annotated[tuple[str, ...], Labels("joint")]
    prior: Annotated[np.ndarray, Over("parameter")]
    values: Annotated[np.ndarray, Over("parameter")]
    deviations: Annotated[np.ndarray, Over("parameter")]
    base_values: Annotated[np.ndarray, Over("base")]
    base_covariance: Annotated[np.ndarray, Over("base", "base_")]
    plain_values: Annotated[np.ndarray, Over("base")]
    plain_covariance: Annotated[np.ndarray, Over("base", "base_")]
    noise: Annotated[np.ndarray, Over("joint")]
    noise_is_known: bool
    log_cholesky: Annotated[np.ndarray, Over("link", "entry")]
    gradient: Annotated[np.ndarray, Over("link", "entry")]
    other_gradient: Annotated[np.ndarray, Over("other")]
    eigenvalues: Annotated[np.ndarray, Over("link")]
    plain_eigenvalues: Annotated[np.ndarray, Over("link")]
    distances: Annotated[np.ndarray, Over("link")]
    residual: Annotated[np.ndarray, Over("joint")]
    regularisation: float
    started: str
    steps: int
    decrement: float
    success: bool
    outcome: tuple[Finding, ...]
    findings: tuple[Finding, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters."""
        return self.base.names

    @property
    def estimates(self) -> dict[str, float]:
        """Identified values by name."""
        return dict(zip(self.names, self.values.tolist(), strict=True))

    @property
    def base_deviations(self) -> np.ndarray:
        """Standard deviations (base,) of the base parameters."""
        return np.sqrt(np.diagonal(self.base_covariance))

    @property
    def consistent(self) -> np.ndarray:
        """Whether each link is physically consistent (links,)."""
        return self.eigenvalues > 0

    @property
    def pseudo_inertias(self) -> np.ndarray:
        """Pseudo-inertias (links, 4, 4) about the origins of the links."""
        return pseudo_inertia(self.values[: 10 * len(self.links)].reshape(-1, 10))

    def intervals(self, level: float = 0.95) -> dict[str, tuple[float, float]]:
        """Interval of each base parameter that contains its true value with a probability."""
        return intervals(self.base.base, self.base_values, self.base_deviations, level)

    def torques(self, regressor: np.ndarray) -> np.ndarray:
        """Torques (samples, joints) along another motion, from its regressor (samples, joints, parameters)."""
        return np.asarray(regressor) @ self.values

    def summary(self) -> str:
        """Return tables of base parameters, links and other parameters, then the noise and findings."""
        count = 10 * len(self.links)
        masses, before = self.values[:count:10], self.prior[:count:10]
        rows: list[tuple[str, ...]] = [
            ("link", "mass", "prior mass", "distance", "eigenvalue", "without conditions", "consistent")
        ]
        for k, link in enumerate(self.links):
            sizes = (masses[k], before[k], self.distances[k], self.eigenvalues[k], self.plain_eigenvalues[k])
            rows.append((link, *(f"{size:.4g}" for size in sizes), "yes" if self.consistent[k] else "no"))
        rows_of_others = [("other parameter", "value", "± deviation", "prior")]
        for name, *sizes in zip(
            self.names[count:], self.values[count:], self.deviations[count:], self.prior[count:], strict=True
        ):
            rows_of_others.append((name, f"{sizes[0]:.6g}", f"{sizes[1]:.2g}", f"{sizes[2]:.4g}"))
        largest = float(np.max(np.abs(np.concatenate([self.gradient.ravel(), self.other_gradient]))))
        return "\n".join(
            [
                *text_table(rows),
                "",
                *([*text_table(rows_of_others), ""] if len(rows_of_others) > 1 else []),
                *base_table(self.base, self.base_values, self.base_deviations),
                "",
                *noise_lines(self.joints, self.noise, self.noise_is_known),
                *fact_lines(
                    start=self.started,
                    steps=self.steps,
                    gradient=f"{largest:.1g} (largest, by log-Cholesky parameters)",
                    regularised=f"{self.regularisation:.4g}",
                ),
                "",
                self.status,
                *map(str, (*self.base.findings, *self.findings)),
            ]
        )
