"""Findings of the model itself at the identified values."""

from collections.abc import Iterator

from dalembert.findings import Finding
from dalembert.forward import findings_at
from dalembert.inverse.identification.assess import Optimum


def model_findings(optimum: Optimum) -> Iterator[Finding]:
    """Yield what the model finds at the identified values, such as elements that lock."""
    yield from findings_at(optimum.posed.whole.model, optimum.vector)
