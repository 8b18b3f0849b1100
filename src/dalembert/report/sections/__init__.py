"""The sections of a report: one class each, with its template in ``templates/``."""

from dalembert.report.sections.balance import Balance
from dalembert.report.sections.bounds import Bounds
from dalembert.report.sections.comparison import Comparison
from dalembert.report.sections.consistent import Consistent
from dalembert.report.sections.deformed import Deformed
from dalembert.report.sections.designing import Designing
from dalembert.report.sections.diagnostics import Diagnostics
from dalembert.report.sections.estimates import Estimates
from dalembert.report.sections.experiments import Experiments
from dalembert.report.sections.family import Family
from dalembert.report.sections.findings import Findings
from dalembert.report.sections.forced_response import ForcedResponse
from dalembert.report.sections.friction import Friction
from dalembert.report.sections.given_bands import GivenBands
from dalembert.report.sections.harmonics import Harmonics
from dalembert.report.sections.headline import Headline
from dalembert.report.sections.in_time import InTime
from dalembert.report.sections.integrators import Integrators
from dalembert.report.sections.intervals import Intervals
from dalembert.report.sections.methods import Methods
from dalembert.report.sections.modes import Modes
from dalembert.report.sections.motion import Motion
from dalembert.report.sections.nonlinear_mode import NonlinearMode
from dalembert.report.sections.period import Period
from dalembert.report.sections.predicting import Predicting
from dalembert.report.sections.profiling import Profiling
from dalembert.report.sections.provenance import Provenance
from dalembert.report.sections.reduction import Reduction
from dalembert.report.sections.search import Search
from dalembert.report.sections.section import Section
from dalembert.report.sections.shooting import Shooting
from dalembert.report.sections.sweeps import Sweeps
from dalembert.report.sections.telling import Telling
from dalembert.report.sections.tracks import Tracks

__all__ = [
    "Balance",
    "Bounds",
    "Comparison",
    "Consistent",
    "Deformed",
    "Designing",
    "Diagnostics",
    "Estimates",
    "Experiments",
    "Family",
    "Findings",
    "ForcedResponse",
    "Friction",
    "GivenBands",
    "Harmonics",
    "Headline",
    "InTime",
    "Integrators",
    "Intervals",
    "Methods",
    "Modes",
    "Motion",
    "NonlinearMode",
    "Period",
    "Predicting",
    "Profiling",
    "Provenance",
    "Reduction",
    "Search",
    "Section",
    "Shooting",
    "Sweeps",
    "Telling",
    "Tracks",
]
