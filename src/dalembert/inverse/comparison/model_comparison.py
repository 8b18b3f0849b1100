"""The result of a comparison of models, its text and its file."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.comparison.left_out import WAYS
from dalembert.results import Result
from dalembert.stored_fields import Labels, Over
from dalembert.tables import Table, cells, counted


@dataclass(frozen=True, eq=False)
class ModelComparison(Result):
    """Models of the same data, the one that predicts best first, as :func:`compare_models` returns them.

    Parameters
    ----------
    models : tuple of str
    parameters : array of int, shape (models,)
        Free parameters, an unknown variance of the noise among them; −1 where only draws are known.
    rms : array, shape (models,)
        Root mean square of the weighted residuals.
    log_likelihood, aic, aicc, bic : array, shape (models,)
        Largest log-likelihood, Akaike's criterion, the same corrected for few values, and Schwarz's criterion.
        NaN where only draws are known.
    elpd, elpd_deviation : array, shape (models,)
        Expected log predictive density: sum of the log densities of groups that were left out, and its standard
        deviation. Larger is better.
    difference, difference_deviation : array, shape (models,)
        Difference to the elpd of the first model, and its standard deviation from the differences of the groups.
    waic : array, shape (models,)
        elpd by the widely applicable information criterion; NaN without draws.
    densities : array, shape (models, groups)
        Log predictive density of each group.
    values : int
        Number of fitted values.
    how : str
        How the predictive densities were computed.
    left_out : {"values", "blocks", "experiments"}
        What was left out together.
    provenance : mapping
    findings : tuple of Finding
    """

    FORMAT: ClassVar[str] = "dalembert model comparison 1"
    TITLE: ClassVar[str] = "Models compared"

    models: Annotated[tuple[str, ...], Labels("model")]
    parameters: Annotated[np.ndarray, Over("model", name="free_parameters")]
    rms: Annotated[np.ndarray, Over("model")]
    log_likelihood: Annotated[np.ndarray, Over("model")]
    aic: Annotated[np.ndarray, Over("model")]
    aicc: Annotated[np.ndarray, Over("model")]
    bic: Annotated[np.ndarray, Over("model")]
    elpd: Annotated[np.ndarray, Over("model")]
    elpd_deviation: Annotated[np.ndarray, Over("model")]
    difference: Annotated[np.ndarray, Over("model")]
    difference_deviation: Annotated[np.ndarray, Over("model")]
    waic: Annotated[np.ndarray, Over("model")]
    densities: Annotated[np.ndarray, Over("model", "group")]
    values: int
    how: str
    left_out: str
    provenance: Mapping[str, Any]
    findings: tuple[Finding, ...] = ()

    @property
    def akaike_weights(self) -> np.ndarray:
        """Share of each model by exp(−ΔAICc/2), (models,).

        Source: K. P. Burnham, D. R. Anderson, Model Selection and Multimodel Inference (2002), section 2.9.
        """
        shares = np.exp(-(self.aicc - np.min(self.aicc)) / 2)
        return shares / np.sum(shares)

    @property
    def verdict(self) -> str:
        return "equal models" if any(finding.code == "equal-models" for finding in self.findings) else "ranked"

    def facts(self) -> dict[str, str]:
        return {
            "best": self.models[0],
            "models": counted(len(self.models)),
            "values": counted(self.values),
            "elpd": self.how,
            "left out together": WAYS[self.left_out],
        }

    def tables(self) -> tuple[Table, ...]:
        """Return the models, the one that predicts best first; draws alone have no criteria."""
        columns: dict[str, Iterable[object]] = {"model": self.models}
        if np.any(self.parameters >= 0):
            columns["parameters"] = [count if count >= 0 else "" for count in self.parameters.tolist()]
        criteria = {"rms residual": self.rms, "AIC": self.aic, "AICc": self.aicc, "BIC": self.bic}
        columns |= {name: cells(values) for name, values in criteria.items() if np.any(np.isfinite(values))}
        columns |= {
            "elpd": cells(self.elpd),
            "difference": cells(self.difference, 4),
            "deviation of the difference": cells(self.difference_deviation, 2),
        }
        if np.any(np.isfinite(self.waic)):
            columns["WAIC (elpd)"] = cells(self.waic)
        return (Table.of("model-comparison", "Models, the one that predicts best first", columns),)
