"""Many smooth parameters: their values with a band, and the choice of the penalty."""

import numpy as np

from dalembert.inverse import RegularisedFit
from dalembert.report import charts
from dalembert.report.headline import Headline
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Download, Plot, Row, Section
from dalembert.report.sections.identification.response import compared_simply
from dalembert.tables import Table, cells, counted, shown


@sections_of(RegularisedFit)
def regularised_fit(fit: RegularisedFit, options: ReportOptions) -> list[Section]:
    """The parameters, the L-curve, and the response."""
    facts = {
        "parameters": counted(len(fit.names)),
        "effective parameters": shown(fit.effective),
        "weight of the penalty": shown(fit.weight),
        "by the corner of the L-curve": shown(fit.corner),
        "by the discrepancy principle": shown(fit.discrepancy) if np.isfinite(fit.discrepancy) else "noise not known",
        "residual norm": shown(fit.residual_norm),
    }
    headline = Headline(title="Smooth parameters", verdict="estimated", facts=facts, findings=fit.findings)
    how = "The band is two standard deviations, with the penalty as a prior."
    curve = "A larger weight gives smoother parameters and a larger residual. The weight is chosen at the corner."
    plots = [
        Plot("smooth-parameters", charts.smooth_parameters(fit), how),
        Plot("penalty-curve", charts.penalty_curve(fit), curve),
    ]
    columns = {"parameter": fit.names, "value": fit.values, "standard deviation": fit.deviations, "unit": fit.units}
    values = Download(Table.of("values", "", columns), "Download all values as CSV")
    others = [place for place, name in enumerate(fit.names) if name not in fit.smooth]
    table = Table.of("other-values", "Parameters without a penalty", {
        "parameter": [fit.names[place] for place in others], "value": cells(fit.values[others], 6),
        "standard deviation": cells(fit.deviations[others], 2), "unit": [fit.units[place] for place in others],
    })  # fmt: skip
    blocks = (Row(plots, side_by_side=True), *([table] if others else []), values)
    return [headline, Section("Values and penalty", blocks), compared_simply(fit)]
