"""Global sensitivity and screening: which parameters matter for the channels."""

from dalembert.report import charts
from dalembert.report.headline import headline_of
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Plot, Row, Section, samples
from dalembert.uncertainty import Screening, SensitivityIndices


@sections_of(SensitivityIndices)
def sensitivity_indices(result: SensitivityIndices, options: ReportOptions) -> list[Section]:
    """Indices of whole channels, then over the samples, then the distributions."""
    indices, box = result.tables()
    series = {"mean": result.mean, "deviation": result.deviations}
    for number, name in enumerate(result.box.names):
        series[f"first-order of {name}"] = result.first[:, :, number]
        series[f"total of {name}"] = result.total[:, :, number]
    download = samples("indices", result.coordinate, result.channels, series, "Download all indices as CSV")
    sobol = Section("Sobol indices", (indices, Row(_plots(result)), download))
    return [headline_of(result), sobol, Section("Parameters", (box,))]


def _plots(result: SensitivityIndices) -> list[Plot]:
    lines = "Solid: first-order index. Dotted: total index, which contains interactions with other parameters."
    areas = (
        "Each area is the part of the variance that a parameter causes alone. What is left up to 1 are interactions."
    )
    plots = []
    for k, name in enumerate(result.channels, 1):
        if len(result.coordinate.values) == 1:
            plots.append(Plot(f"indices-{k}", charts.indices(result, name), "A total index contains interactions."))
        else:
            plots += [
                Plot(f"indices-{k}", charts.indices(result, name), lines),
                Plot(f"shares-{k}", charts.shares(result, name), areas),
            ]
    return plots


@sections_of(Screening)
def screening(result: Screening, options: ReportOptions) -> list[Section]:
    """Effects on whole channels, the largest first, then the distributions."""
    how = "Right: a large effect. Up: the effect depends on the other parameters or is not linear. Bars: two errors."
    plots = [Plot(f"effects-{k}", charts.effects(result, name), how) for k, name in enumerate(result.channels, 1)]
    series = {f"effect of {name}": result.effects[:, :, number] for number, name in enumerate(result.box.names)}
    download = samples("effects", result.coordinate, result.channels, series, "Download all effects as CSV")
    effects, box = result.tables()
    elementary = Section("Elementary effects", (effects, Row(plots, side_by_side=len(plots) > 1), download))
    return [headline_of(result), elementary, Section("Parameters", (box,))]
