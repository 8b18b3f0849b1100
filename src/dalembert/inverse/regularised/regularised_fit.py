"""The result of a regularised identification."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.experiments.residual_table import residual_table
from dalembert.inverse.fit.stored_data import StoredData
from dalembert.results import Result
from dalembert.stored_fields import Labels, Over, Table
from dalembert.tables import Table as ResultTable
from dalembert.tables import cells, counted, shown


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
    TITLE: ClassVar[str] = "Smooth parameters"
    VERDICTS: ClassVar[tuple[str, str]] = ("estimated", "not settled")

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

    def facts(self) -> dict[str, str]:
        return {
            "parameters": f"{counted(len(self.names))}, {counted(len(self.smooth))} of them smooth",
            "effective parameters": shown(self.effective),
            "weight of the penalty": f"{shown(self.weight)} ({self.rule})",
            "by the corner of the L-curve": shown(self.corner),
            "by the discrepancy principle": shown(self.discrepancy)
            if np.isfinite(self.discrepancy)
            else "noise not known",
            "residual norm": shown(self.residual_norm),
            "simulations": counted(self.simulations),
        }

    def tables(self) -> tuple[ResultTable, ...]:
        """Return the parameters without a penalty, all values, and the residuals."""
        places = [place for place, name in enumerate(self.names) if name not in self.smooth]
        plain = {
            "parameter": [self.names[place] for place in places],
            "value": cells(self.values[places]),
            "standard deviation": cells(self.deviations[places], 2),
            "unit": [self.units[place] for place in places],
        }
        each = {"parameter": self.names, "value": self.values, "standard deviation": self.deviations}
        return (
            *([ResultTable.of("other-values", "Parameters without a penalty", plain)] if places else []),
            ResultTable.of("values", "Values", {**each, "unit": self.units}, detail=True),
            residual_table(self),
        )
