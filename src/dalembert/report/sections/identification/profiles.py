"""Profile likelihoods: intervals beside those of the standard deviations."""

from dalembert.inverse import Profiles
from dalembert.report import charts
from dalembert.report.asked import Asked
from dalembert.report.digits import counted, interval
from dalembert.report.headline import Headline, few
from dalembert.report.registry import sections_of
from dalembert.report.section import Listed, Plot, Row, Section
from dalembert.report.table import Table, cell, cells, marks


@sections_of(Profiles)
def profiles(told: Profiles, asked: Asked) -> list[Section]:
    """The profiles alone."""
    items = {item.name: item for item in told.parameters}
    ends = [interval(curve.lower, curve.upper) for curve in told.curves]
    facts = {
        **few([items[curve.name] for curve in told.curves], ends),
        "level": f"{100 * told.level:g} %",
        "simulations": counted(told.simulations),
    }
    verdicts = ("profiled", "not settled")
    return [Headline.of("Profile likelihood", told.success, verdicts, told.status, facts), profiled(told)]


def profiled(told: Profiles) -> Section:
    """The section on profiles."""
    sentences = [str(item) for item in told.outcome if item.code != "profile-level"]
    how = "Shaded is where the data do not contradict the value; a parameter with a flat profile is not identifiable."
    plots = [
        Plot(f"profile-{number}", charts.profile(told, curve.name), how) for number, curve in enumerate(told.curves, 1)
    ]
    return Section("Profile likelihood", (Listed(sentences), _table(told), Row(plots, beside=len(plots) > 1)))


def _table(told: Profiles) -> Table:
    curves, places = told.curves, [told.parameters.names.index(curve.name) for curve in told.curves]
    sides = [
        " and ".join(side for side, is_open in zip(("lower", "upper"), curve.open, strict=True) if is_open)
        for curve in curves
    ]
    columns = {
        "parameter": [curve.name for curve in curves],
        "value": told.values[places],
        "lower end": [cell(curve.lower, mark=curve.open[0]) for curve in curves],
        "upper end": [cell(curve.upper, mark=curve.open[1]) for curve in curves],
        "unit": [told.parameters.items[k].unit for k in places],
        "standard deviation": cells(told.deviations[places], 2),
        "note": marks(f"open: {side} bound" if side else "" for side in sides),
    }
    return Table.of("profiles", f"{100 * told.level:g} % intervals from profile likelihoods", columns)
