"""Periodic motions by integration in time, alone and compared with a response over frequency."""

import numpy as np

from dalembert.report import charts
from dalembert.report.charts.frequency.time_domain import compared_dofs
from dalembert.report.headline import Headline
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Fold, Plot, Row, Section
from dalembert.tables import Table, cells, counted, labelled, noted, percent, shown, unless
from dalembert.units import unit_of
from dalembert.vibration import FrequencyCurve, PeriodicMotion, TimeComparison

HEADING = "Comparison with time integration"


@sections_of(TimeComparison)
def time_comparison(compared: TimeComparison, options: ReportOptions) -> list[Section]:
    """The comparison alone."""
    found = np.asarray(compared.converged)
    most = float(np.nanmax(np.abs(compared.differences[found]), initial=0.0))
    status = "All points are periodic in time." if found.all() else "Some points are not periodic in time yet."
    facts = {
        "points": counted(len(found)),
        "largest difference": percent(most, 2),
        "steps a period": counted(int(compared.provenance["method"]["steps_per_period"])),
    }
    return [Headline.of(HEADING, bool(found.all()), ("compared", "incomplete"), status, facts), in_time(compared)]


def in_time(compared: TimeComparison, curve: FrequencyCurve | None = None) -> Section:
    """Points of the curve that were integrated in time, and how far harmonic balance is from them."""
    how = "Crosses: in time; circles: harmonic balance at the same frequencies."
    plot = Plot("time-comparison", charts.time_comparison(compared, curve), how)
    return Section(HEADING, (*_sentences(compared), plot, Fold(_table(compared))))


def _sentences(compared: TimeComparison) -> tuple[str, ...]:
    found = np.asarray(compared.converged)
    settings = compared.provenance
    told = f"{len(found)} points were integrated in time with {settings['method']['steps_per_period']} steps a "
    told += f"period ({settings['way']}), {compared.periods.min()} to {compared.periods.max()} periods each."
    late = [shown(float(frequency)) for frequency in compared.frequencies[~found]]
    lost = f"Not periodic yet in time, so not to be compared: {', '.join(late)} Hz." if late else ""
    if not found.any():
        return (told, lost)
    sizes = np.abs(compared.differences[found])
    row, column = np.unravel_index(int(np.nanargmax(sizes)), sizes.shape)
    worst = f"Harmonic balance differs by at most {percent(sizes[row, column], 2)} of the largest motion, for "
    worst += f"{compared.dofs[column]} at {shown(float(compared.frequencies[found][row]))} Hz."
    return (told, worst, lost)


def _table(compared: TimeComparison) -> Table:
    dofs = compared_dofs(compared)
    places, unit = [compared.dofs.index(dof) for dof in dofs], unit_of(compared.dofs[0])
    columns = {
        "frequency (Hz)": np.tile(compared.frequencies, len(dofs)),
        "degree of freedom": np.repeat(dofs, len(compared.frequencies)),
        labelled("harmonic balance", unit): compared.balance[:, places].T.ravel(),
        labelled("in time", unit): compared.time[:, places].T.ravel(),
        "difference (% of the largest)": cells(100 * compared.differences[:, places].T.ravel(), 3),
        "periods": np.tile(compared.periods, len(dofs)),
        "note": unless(np.tile(compared.converged, len(dofs)), "not periodic yet"),
    }
    return noted(Table.of("in-time", "Harmonic balance and time integration", columns))


@sections_of(PeriodicMotion)
def period(motion: PeriodicMotion, options: ReportOptions) -> list[Section]:
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
