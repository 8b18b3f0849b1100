"""How the search went."""

from dalembert.inverse import BandFit, Fit
from dalembert.report import charts
from dalembert.report.charts.identification.identifiability import unknowns
from dalembert.report.charts.identification.regularisation import accounts
from dalembert.report.charts.identification.search import ranked
from dalembert.report.section import Fold, Plot, Row, Section
from dalembert.report.table import Table, cells, unless

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
        "misfit": cells((start.fitness for start in starts), 4),
        "simulations": [int(start.simulations) for start in starts],
        "ended": [end if end.text else "converged" for end in ended],
        "message": [start.message for start in starts],
        **{f"{name} at end": [start.end[k] for start in starts] for k, name in enumerate(unknowns(fit))},
    }
    return Table.of("starts", "Where each start ended, best first", columns)


def grew(fit: Fit | BandFit) -> bool:
    """Whether the horizon of the first start grew: more was simulated than the one linearised run of a first step."""
    facts = fit.provenance
    asked = facts.get("horizon") == "growing" and facts.get("method", {}).get("name") in LEAST_SQUARES
    first = next((step.simulations for step in fit.history if step.start == 0), 0)
    return asked and getattr(fit, "nodes", None) is None and first > 1 + len(fit.parameters)
