"""Several models of the same data: criteria and cross-validation."""

from collections.abc import Iterable, Iterator

import numpy as np

from dalembert.inverse import CrossValidation, ModelComparison
from dalembert.inverse.comparison.comparison_findings import alike
from dalembert.inverse.comparison.left_out import WAYS
from dalembert.report import charts
from dalembert.report.headline import Headline
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Listed, Plot, Row, Section
from dalembert.report.sections.identification.response import compared_simply
from dalembert.tables import Cell, Table, cell, cells, counted, shown

HOW = "Lines are predicted by the fits without each group, circles are data; below, predicted minus measured."


@sections_of(CrossValidation)
def cross_validation(found: CrossValidation, options: ReportOptions) -> list[Section]:
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


DIFFERENCES_HOW = "Differences to the best model, with two standard deviations. A difference below 4 means nothing."
WHERE = "The sum over the groups in the order of the data. A step is a part of the data that a model predicts worse."


@sections_of(ModelComparison)
def model_comparison(found: ModelComparison, options: ReportOptions) -> list[Section]:
    """The ranking, and its section."""
    facts = {"best": found.models[0], "models": counted(len(found.models)), "values": counted(found.values)}
    verdict = "equal models" if alike(found)[1] else "ranked"
    headline = Headline(title="Models compared", verdict=verdict, facts=facts, findings=found.findings)
    return [headline, compared_models(found)]


def compared_models(found: ModelComparison, *, findings: bool = False) -> Section:
    """The section on the models; with their findings where no headline has them."""
    sentences = [str(item) for item in found.findings] if findings else []
    plots = [
        Plot("model-differences", charts.model_differences(found), DIFFERENCES_HOW),
        Plot("difference-by-group", charts.difference_by_group(found), WHERE),
    ]
    how = f"Log predictive densities (elpd): {found.how}. Left out together: {WAYS[found.left_out]}."
    return Section("Model comparison", (Listed(sentences), how, _table(found), Row(plots, side_by_side=False)))


def _table(found: ModelComparison) -> Table:
    known = found.parameters >= 0
    columns: dict[str, Iterable[object]] = {"model": found.models}
    if np.any(known):
        columns["parameters"] = [
            int(count) if one else Cell("", "") for count, one in zip(found.parameters, known, strict=True)
        ]
    criteria = {"rms residual": found.rms, "AIC": found.aic, "AICc": found.aicc, "BIC": found.bic}
    columns |= {name: cells(values) for name, values in criteria.items() if np.any(np.isfinite(values))}
    columns |= {
        "elpd": cells(found.elpd),
        "difference": [cell(float(one), digits=4) for one in found.difference],
        "deviation of the difference": cells(found.difference_deviation, 2),
    }
    if np.any(np.isfinite(found.waic)):
        columns["WAIC (elpd)"] = cells(found.waic)
    return Table.of("model-comparison", "Models, the one that predicts best first", columns)
