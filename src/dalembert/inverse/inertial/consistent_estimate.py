"""The result of an identification of physically consistent inertias."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.inertial.base_estimate import base_table, intervals, noise_table
from dalembert.inverse.inertial.base_parameters import BaseParameters
from dalembert.inverse.inertial.pseudo_inertia import pseudo_inertia
from dalembert.results import EndedResult
from dalembert.stored_fields import Labels, Over
from dalembert.tables import Table, cell, cells, counted, shown
from dalembert.units import inertial_unit


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
    TITLE: ClassVar[str] = "Inertial parameters"
    VERDICTS: ClassVar[tuple[str, str]] = ("identified", "not identified")

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

    @property
    def conclusions(self) -> tuple[Finding, ...]:
        return (*self.outcome, *self.base.findings, *self.findings)

    def facts(self) -> dict[str, str]:
        largest = float(np.max(np.abs(np.concatenate([self.gradient.ravel(), self.other_gradient]))))
        return {
            "links": counted(len(self.links)),
            "base parameters": counted(self.base.rank),
            "regularisation": shown(self.regularisation),
            "start": self.started,
            "steps": counted(self.steps),
            "largest gradient by log-Cholesky parameters": shown(largest, digits=1),
        }

    def tables(self) -> tuple[Table, ...]:
        """Return links, parameters, base parameters and noise."""
        count = 10 * len(self.links)
        links = {
            "link": self.links,
            "mass (kg)": cells(self.values[:count:10]),
            "prior mass (kg)": cells(self.prior[:count:10]),
            "distance from the prior": cells(self.distances, 4),
            "smallest eigenvalue": cells(self.eigenvalues, 4),
            "without conditions": [cell(float(x), digits=4, mark=bool(x <= 0)) for x in self.plain_eigenvalues],
        }
        parameters = {
            "parameter": self.names,
            "value": map(cell, self.values, self.deviations),
            "standard deviation": cells(self.deviations, 2),
            "prior": cells(self.prior),
            "unit": map(inertial_unit, self.names),
        }
        others = {
            "other parameter": self.names[count:],
            "value": map(cell, self.values[count:], self.deviations[count:]),
            "standard deviation": cells(self.deviations[count:], 2),
            "prior": cells(self.prior[count:]),
            "unit": map(inertial_unit, self.names[count:]),
        }
        caption = "Smallest eigenvalue of each pseudo-inertia, relative to the prior one: positive for a possible body"
        return (
            Table.of("links", caption, links),
            *([Table.of("others", "Parameters of the joints", others)] if len(self.names) > count else []),
            Table.of("parameters", "All parameters", parameters, detail=True),
            base_table(self.base, self.base_values, self.base_deviations),
            noise_table(self.joints, self.noise, self.noise_is_known, **{"rms residual": self.residual}),
        )
