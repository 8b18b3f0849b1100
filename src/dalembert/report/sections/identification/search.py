"""The search of a fit: how it ended, its starts, and what the data determine."""

from collections.abc import Iterable

from dalembert.inverse import BandFit, Fit, Identifiability
from dalembert.report import charts
from dalembert.report.charts.identification.identifiability import unknowns
from dalembert.report.charts.identification.regularisation import accounts
from dalembert.report.headline import Headline, headline_of
from dalembert.report.section import Listed, Plot, Row, Section
from dalembert.tables import Table

MOST_BESIDE = 3
"""Unknowns up to which the figures have room side by side: combinations of many have long names."""
GREW = "Fewer samples were fitted first: a line begins where all are compared, its simulations counting those before."
LEAST_SQUARES = ("LeastSquares", "ResponseSensitivity")
"""Methods whose horizon may grow."""


def identified(fit: Fit | BandFit, known: Identifiability) -> Headline:
    """Headline of something identified, with what speaks against it."""
    findings = (*fit.outcome, *known.findings, *fit.findings)
    doubts = [finding.message for finding in findings if finding.doubtful] if fit.success else []
    return headline_of(fit, doubts=doubts, verdict=f"{fit.verdict}, with doubts" if doubts else fit.verdict)


def identifiability(fit: Fit | BandFit, known: Identifiability) -> Section:
    """Sentences on identifiability; of several unknowns, singular values and correlation."""
    plots, names = [], unknowns(fit)
    if len(names) > 1:
        pairs = "Near 1 or −1, the data determine a combination of the two parameters, but not each of them."
        small = "A small value belongs to a combination that is hardly identifiable."
        spectrum = charts.singular_values(known.singular_values, known.directions, names)
        plots = [Plot("correlation", charts.correlation(fit), pairs), Plot("singular-values", spectrum, small)]
    row = Row(plots, side_by_side=len(names) <= MOST_BESIDE)
    return Section("Identifiability", (Listed(str(known).splitlines()), row))


def search(fit: Fit | BandFit, tables: Iterable[Table]) -> list[Section]:
    """Convergence of every start or swarm, and where each start ended; nothing for a fit without a history."""
    if not fit.history:
        return []
    lines = "One line a start; the winning one in colour."
    plots = [Plot("convergence", charts.convergence(fit), f"{lines} {GREW}" if grew(fit) else lines)]
    if len(fit.starts) > 1:
        ends = "Starts in order of their final misfit; a flat step is a minimum that many starts lead to."
        plots.append(Plot("starts", charts.starts(fit), ends))
    if accounts(fit):
        corner = "The weight is chosen at the corner, and raised until the step goes as the linear model foresees."
        went = "Agreement is the fall of the sum of squares over the fall foreseen; 1 is just as foreseen."
        plots += [Plot("l-curve", charts.l_curve(fit), corner), Plot("steps", charts.steps(fit), went)]
    return [Section("Search", (Row(plots), *tables))]


def grew(fit: Fit | BandFit) -> bool:
    """Whether the horizon of the first start grew: more was simulated than the one linearised run of a first step."""
    facts = fit.provenance
    grows = facts.get("horizon") == "growing" and facts.get("method", {}).get("name") in LEAST_SQUARES
    first = next((step.simulations for step in fit.history if step.start == 0), 0)
    return grows and getattr(fit, "nodes", None) is None and first > 1 + len(fit.parameters)
