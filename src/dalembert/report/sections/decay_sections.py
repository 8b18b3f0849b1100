"""Ring-downs: a mode from its free decay."""

from dalembert.inverse import RingDown
from dalembert.report import charts
from dalembert.report.headline import headline_of
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Plot, Section

PERIODIC = (
    "Those of the periodic motion with the same amplitude; bars are two standard deviations. Windows overlap, so that "
    "neighbours are not independent."
)
BOTH = "Frequency and damping of the decay itself. The two methods are independent: where they differ, look again."


@sections_of(RingDown)
def ring_down(result: RingDown, options: ReportOptions) -> list[Section]:
    """Frequency and damping over the amplitude, and the decay by both methods."""
    return [
        headline_of(result),
        Section("Mode", (Plot("ring-down", charts.ring_down(result), PERIODIC), *result.tables())),
        Section("Decay", (Plot("decay", charts.decay(result), BOTH),)),
    ]
