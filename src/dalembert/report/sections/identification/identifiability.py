"""Which parameters the data determine."""

from dalembert.inverse import BandFit, Fit
from dalembert.report import charts
from dalembert.report.charts.identification.identifiability import unknowns
from dalembert.report.section import Listed, Plot, Row, Section

MOST_BESIDE = 3
"""Unknowns up to which the figures have room side by side: combinations of many have long names."""


def identifiability(fit: Fit | BandFit) -> Section:
    """Sentences on identifiability; of several unknowns, singular values and correlation."""
    known, names = fit.identifiability(), unknowns(fit)
    plots = []
    if len(names) > 1:
        pairs = "Near 1 or −1, the data determine a combination of the two parameters, but not each of them."
        small = "A small value belongs to a combination that is hardly identifiable."
        spectrum = charts.singular_values(known.singular_values, known.directions, names)
        plots = [Plot("correlation", charts.correlation(fit), pairs), Plot("singular-values", spectrum, small)]
    row = Row(plots, beside=len(names) <= MOST_BESIDE)
    return Section("Identifiability", (Listed(str(known).splitlines()), row))
