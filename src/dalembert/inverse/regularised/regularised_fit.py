"""The result of a regularised identification."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.fit.stored_data import StoredData
from dalembert.results import Result, fact_lines
from dalembert.stored_fields import Labels, Over, Table


@dataclass(frozen=True, eq=False)
class RegularisedFit(Result):
    """Many parameters that explain data and are smooth, as :func:`regularise` returns them.

    Parameters
    ----------
    names, units : tuple of str, length parameters
    smooth : tuple of str
        Names of the parameters whose differences are penalised, in their order.
    values, deviations : array, shape (parameters,)
        Identified values, and their standard deviations if the penalty is taken as a prior: the root of the diagonal of
        s² (JᵀWJ + μ² DᵀD)⁻¹.
    weight : float
        μ, the weight of the penalty.
    rule : str
        How it was chosen: "l-curve", "discrepancy", or "given".
    corner, discrepancy : float
        Weights by the corner of the L-curve, and by the discrepancy principle; NaN where the noise is not known.
    weights, residual_norms, penalty_norms : array, shape (weights,)
        The L-curve of the linearised problem: ‖W^½ (R − data)‖ and ‖D p/scale‖ at each weight.
    residual_norm, penalty_norm : float
        Of the values.
    effective : float
        Number of parameters that the data determine at this weight.
    data : Measurements
    response : array, shape (samples, channels)
        Of the values.
    simulations : int
        Simulations that the identification took, gradients by the adjoint counted as four.
    provenance : mapping
    findings : tuple of Finding
    """

    FORMAT: ClassVar[str] = "dalembert regularised fit 1"

    names: Annotated[tuple[str, ...], Labels("parameter")]
    units: tuple[str, ...]
    smooth: tuple[str, ...]
    values: Annotated[np.ndarray, Over("parameter")]
    deviations: Annotated[np.ndarray, Over("parameter")]
    weight: float
    rule: str
    corner: float
    discrepancy: float
    weights: Annotated[np.ndarray, Over("weight")]
    residual_norms: Annotated[np.ndarray, Over("weight")]
    penalty_norms: Annotated[np.ndarray, Over("weight")]
    residual_norm: float
    penalty_norm: float
    effective: float
    data: StoredData
    response: Table
    simulations: int
    provenance: Mapping[str, Any]
    findings: tuple[Finding, ...] = ()

    @property
    def residuals(self) -> np.ndarray:
        """Computed minus measured values, (samples, channels)."""
        return self.data.difference(self.response)

    @property
    def success(self) -> bool:
        """Whether weight and values no longer changed in the last round."""
        return not {"weight-not-settled", "values-not-settled"} & {finding.code for finding in self.findings}

    @property
    def status(self) -> str:
        """How many parameters were identified, and how many of them the data determine."""
        return f"{len(self.names)} parameters are identified; the data determine {self.effective:.3g} of them."

    @property
    def vector(self) -> dict[str, float]:
        """Values by name."""
        return dict(zip(self.names, self.values.tolist(), strict=True))

    def summary(self) -> str:
        """The result in a few lines."""
        known = f"{self.discrepancy:.3g}" if np.isfinite(self.discrepancy) else "none (the noise is not known)"
        facts = fact_lines(
            22,
            parameters=f"{len(self.names)}, {len(self.smooth)} of them smooth",
            weight=f"{self.weight:.3g} ({self.rule})",
            corner=f"{self.corner:.3g} (of the L-curve)",
            discrepancy=known,
            residual=f"{self.residual_norm:.4g}",
            effective=f"{self.effective:.3g} parameters",
            simulations=self.simulations,
        )
        return "\n".join([*facts, *map(str, self.findings)])
