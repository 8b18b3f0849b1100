"""Predictions of groups of the data by fits without them."""

from collections.abc import Iterator

import numpy as np

from dalembert.inverse import CrossValidation
from dalembert.report.asked import Asked
from dalembert.report.digits import counted, shown
from dalembert.report.headline import Headline
from dalembert.report.registry import sections_of
from dalembert.report.section import Section
from dalembert.report.sections.identification.response import compared_simply
from dalembert.report.table import Table, cells

HOW = "Lines are predicted by the fits without each group, circles are data; below, predicted minus measured."


@sections_of(CrossValidation)
def cross_validation(found: CrossValidation, asked: Asked) -> list[Section]:
    """The errors and values of each group, and the predictions of a single record."""
    facts = {
        "groups": counted(len(found.log_densities)),
        "left out": found.left_out,
        "rms of the prediction errors": shown(found.rms),
        "elpd": shown(float(found.log_densities.sum())),
    }
    headline = Headline(title="Cross-validation", verdict="computed", facts=facts, doubts=list(_doubts(found)))
    columns = {
        "group": range(1, 1 + len(found.log_densities)),
        "rms error": cells(found.rms_of_groups, 4),
        "log density": cells(found.log_densities, 4),
        **{name: cells(column, 6) for name, column in zip(found.fit.parameters.names, found.values.T, strict=True)},
        "converged": ["yes" if one else "no" for one in found.converged],
    }
    table = Table.of("cross-validation", "Groups in the order of the data", columns)
    sections = [headline, Section("Groups that were left out", (table,))]
    return sections if found.fit.experiments else [*sections, compared_simply(found, HOW)]


def _doubts(found: CrossValidation) -> Iterator[str]:
    if unfinished := np.count_nonzero(~found.converged):
        yield (
            f"{unfinished} of {len(found.converged)} fits without a group did not converge. Do not compare their "
            "densities; leave out smaller groups."
        )
