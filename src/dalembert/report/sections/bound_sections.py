"""Bounds of the response over a box of parameters, by one method or by several."""

from dalembert.quantities import by_quantity
from dalembert.report import charts
from dalembert.report.headline import headline_of
from dalembert.report.look import plain
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Listed, Plot, Row, Section, samples
from dalembert.uncertainty import Comparison, Propagation, Screening, SensitivityIndices

MEANING = {
    "inner bound": "Runs of the model within the box reach both sides of the band; the true one may be wider",
    "estimate": "Whatever the parameters are within their intervals, the response lies about in the band",
    "enclosure of the surrogate": "Whatever the parameters are within their intervals, the surrogate lies in the band, "
    "and the response as far as the estimated error of the surrogate holds",
}


@sections_of(Propagation)
def propagation(result: Propagation, options: ReportOptions) -> list[Section]:
    """Bounds by one method."""
    return [headline_of(result), bounds(result)]


@sections_of(Comparison)
def comparison(result: Comparison, options: ReportOptions) -> list[Section]:
    """Methods, and the bounds of the one that the others are measured by."""
    against = "Further down is closer to the reference, further left is cheaper."
    where = f"Largest distance of any bound from that of {result.reference}, sample by sample; none in a gap."
    plots = [Plot("methods", charts.methods(result), against), Plot("differences", charts.differences(result), where)]
    return [
        headline_of(result),
        Section("Methods", (*result.tables(), Row(plots))),
        bounds(result.reference_result),
    ]


def bounds(result: Propagation) -> Section:
    """The box, a figure of the bounds for each quantity, and how wide they are."""
    how = f"{MEANING[result.kind]}; below, how wide the band is."
    plots = [
        Plot(f"bands-{number}", charts.bands(result, group, title=", ".join(map(plain, group))), how)
        for number, group in enumerate(by_quantity(result.channels), start=1)
    ]
    reasons = [finding.message for finding in result.findings if finding.code == "unknown-error"]
    series = {"lower": result.lower, "upper": result.upper}
    download = samples("bounds", result.coordinate, result.channels, series, "Download all bounds as CSV")
    box, widths = result.tables()
    return Section("Bounds", (box, *plots, widths, Listed(reasons), download))


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
