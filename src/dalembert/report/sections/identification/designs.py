"""Designs of an experiment: sensors and horizons in order of what they would tell."""

import numpy as np

from dalembert.inverse import Designs
from dalembert.report import charts
from dalembert.report.asked import Asked
from dalembert.report.digits import counted, shown
from dalembert.report.headline import Headline
from dalembert.report.quantities import labelled
from dalembert.report.registry import sections_of
from dalembert.report.section import Fold, Plot, Section
from dalembert.report.table import Table, cell, cells, marks


@sections_of(Designs)
def designs(told: Designs, asked: Asked) -> list[Section]:
    """The designs, the best first."""
    facts = {
        "best sensors": ", ".join(told.sensors[0]),
        f"until {told.along}": f"{shown(float(told.horizons[0]))} {told.unit}".rstrip(),
        "criterion": told.criterion,
        "designs": counted(len(told.scores)),
    }
    headline = Headline.of("Design of the experiment", told.success, ("ranked", "not ranked"), told.status, facts)
    how = "Further left is better: the deviations to be expected, in parts of the parameters' scales."
    plots = [Plot("ranking", charts.ranking(told), how)]
    if len(np.unique(told.horizons)) > 1:
        longer = "Where a line flattens, measuring longer brings little more."
        plots.append(Plot("horizons", charts.horizons(told), longer))
    return [headline, Section("Designs", (*plots, Fold(_table(told), rows="designs")))]


def _table(told: Designs) -> Table:
    unseen = list(map(int, told.unseen))
    columns = {
        "rank": range(1, len(told.scores) + 1),
        "sensors": map(", ".join, told.sensors),
        labelled(told.along, told.unit): told.horizons,
        "score": [cell(score, digits=4, mark=lost > 0) for score, lost in zip(told.scores, unseen, strict=True)],
        **{
            f"± {labelled(item.name, item.unit)}": cells(deviations, 3)
            for item, deviations in zip(told.parameters, told.deviations.T, strict=True)
        },
        "note": marks(f"{lost} unseen" if lost else "" for lost in unseen),
    }
    return Table.of("designs", "Designs, the best first, with the deviations to be expected", columns)
