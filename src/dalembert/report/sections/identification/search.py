"""The search of a fit: how it ended, its starts, and what the data determine."""

from collections.abc import Iterable, Mapping

import numpy as np

from dalembert.inverse import BandFit, Fit, Nodes
from dalembert.report import charts
from dalembert.report.charts.identification.identifiability import unknowns
from dalembert.report.charts.identification.regularisation import accounts
from dalembert.report.charts.identification.search import ranked
from dalembert.report.headline import Headline
from dalembert.report.section import Fold, Listed, Plot, Row, Section
from dalembert.tables import Table, cells, labelled, unless


def identified(fit: Fit | BandFit, title: str, facts: Mapping[str, str]) -> Headline:
    """Headline of something identified, with what speaks against it."""
    doubts = tuple(doubt.message for doubt in fit.doubts) if fit.success else ()
    verdict = "not identified" if not fit.success else "identified, with doubts" if doubts else "identified"
    return Headline(title=title, verdict=verdict, success=fit.success, status=fit.status, facts=facts, doubts=doubts)


def shooting(fit: Fit, nodes: Nodes) -> Section:
    """Gaps over the steps, and the states at which the segments meet."""
    come = "The gaps weigh ever more until they are closed; where two segments merge, a gap opens once more."
    grown = f"By the last of these states a small change of the initial state has grown {nodes.growth:.2g} times."
    return Section("Multiple shooting", (f"{nodes} {grown}", Plot("gaps", charts.gaps(fit), come), _table(fit, nodes)))


def _table(fit: Fit, nodes: Nodes) -> Table:
    along = [fit, *fit.experiments][-1].data.coordinate
    columns: dict[str, Iterable[object]] = {"experiment": nodes.experiments} if any(nodes.experiments) else {}
    columns |= {"sample": nodes.samples, labelled(along.name, along.unit): nodes.times}
    for name, unit, values in zip(nodes.states, nodes.units, nodes.begins.T, strict=True):
        columns[labelled(name, unit)] = ["" if np.isnan(value) else value for value in values]
    columns["largest gap"] = cells(np.nanmax(abs(nodes.ends - nodes.begins), axis=1), 2)
    return Table.of("nodes", "States found where segments meet", columns)


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
    row = Row(plots, side_by_side=len(names) <= MOST_BESIDE)
    return Section("Identifiability", (Listed(str(known).splitlines()), row))


GREW = "Fewer samples were fitted first: a line begins where all are compared, its simulations counting those before."
LEAST_SQUARES = ("LeastSquares", "ResponseSensitivity")
"""Methods whose horizon may grow."""
MOST_STARTS = 12
"""Rows of starts up to which their table is open."""


def search(fit: Fit | BandFit) -> list[Section]:
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
    tables = [Fold(_starts(fit), MOST_STARTS, "starts")] if fit.starts else []
    return [Section("Search", (f"Method: {fit.method}.", Row(plots), *tables))]


def _starts(fit: Fit | BandFit) -> Table:
    numbers = ranked(fit)
    starts = [fit.starts[number] for number in numbers]
    ended = unless((start.success for start in starts), "not converged")
    columns = {
        "start": [number + 1 for number in numbers],
        "misfit": cells((start.misfit for start in starts), 4),
        "simulations": [int(start.simulations) for start in starts],
        "ended": [end if end.text else "converged" for end in ended],
        "message": [start.message for start in starts],
        **{f"{name} at end": [start.end[k] for start in starts] for k, name in enumerate(unknowns(fit))},
    }
    return Table.of("starts", "Where each start ended, best first", columns)


def grew(fit: Fit | BandFit) -> bool:
    """Whether the horizon of the first start grew: more was simulated than the one linearised run of a first step."""
    facts = fit.provenance
    grows = facts.get("horizon") == "growing" and facts.get("method", {}).get("name") in LEAST_SQUARES
    first = next((step.simulations for step in fit.history if step.start == 0), 0)
    return grows and getattr(fit, "nodes", None) is None and first > 1 + len(fit.parameters)
