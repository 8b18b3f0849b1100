"""A periodic motion in time: displacements over a period, and the loops of contacts and springs."""

from dalembert.report import charts
from dalembert.report.asked import Asked
from dalembert.report.digits import counted, shown
from dalembert.report.headline import Headline
from dalembert.report.registry import sections_of
from dalembert.report.section import Plot, Row, Section
from dalembert.vibration import PeriodicMotion


@sections_of(PeriodicMotion)
def period(motion: PeriodicMotion, asked: Asked) -> list[Section]:
    """The last period."""
    plots = [Plot("periodic-motion", charts.periodic_motion(motion), "The last period of the integration.")]
    if motion.coordinates:
        how = "The area of a loop is the energy taken in a period."
        plots.append(Plot("loops-in-time", charts.loops_in_time(motion), how))
    return [_headline(motion), Section("Periodic motion", (plots[0], Row(plots[1:])))]


def _headline(motion: PeriodicMotion) -> Headline:
    status = "The motion repeats itself." if motion.converged else "The motion does not repeat itself yet."
    facts = {
        "frequency": f"{shown(motion.frequency)} Hz",
        "periods": counted(motion.periods),
        "change over the last one": shown(motion.residual, digits=2),
        "steps of a period": counted(len(motion.times)),
    }
    return Headline.of("Periodic motion", motion.converged, ("periodic", "not periodic"), status, facts)
