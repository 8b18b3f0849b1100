"""Many smooth parameters: their values with a band, and the choice of the penalty."""

import numpy as np

from dalembert.inverse import RegularisedFit
from dalembert.report import charts
from dalembert.report.asked import Asked
from dalembert.report.digits import counted, shown
from dalembert.report.headline import Headline
from dalembert.report.registry import sections_of
from dalembert.report.section import Plot, Row, Section


@sections_of(RegularisedFit)
def regularised_fit(fit: RegularisedFit, asked: Asked) -> list[Section]:
    """The parameters and the L-curve."""
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
    return [headline, Section("Values and penalty", (Row(plots, beside=True),))]
