"""Correlated residuals: tests of whiteness, fitted noise processes, and the covariance that follows from them."""

from dalembert.inverse.correlation.correlated import CorrelatedResiduals, NoiseProcess
from dalembert.inverse.correlation.correlation import correlation
from dalembert.inverse.correlation.findings import correlation_findings

__all__ = ["CorrelatedResiduals", "NoiseProcess", "correlation", "correlation_findings"]
