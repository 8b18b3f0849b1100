"""The sections of a report: one class each, with its template in ``templates/``."""

from dalembert.report.sections.comparison import Comparison
from dalembert.report.sections.diagnostics import Diagnostics
from dalembert.report.sections.estimates import Estimates
from dalembert.report.sections.headline import Headline
from dalembert.report.sections.motion import Motion
from dalembert.report.sections.provenance import Provenance
from dalembert.report.sections.search import Search
from dalembert.report.sections.section import Section
from dalembert.report.sections.sweeps import Sweeps
from dalembert.report.sections.telling import Telling

__all__ = [
    "Comparison",
    "Diagnostics",
    "Estimates",
    "Headline",
    "Motion",
    "Provenance",
    "Search",
    "Section",
    "Sweeps",
    "Telling",
]
