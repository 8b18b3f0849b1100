"""Bounds of the response over a box of parameters, by one method or by several."""

from dalembert.quantities import by_quantity
from dalembert.report import charts
from dalembert.report.headline import headline_of
from dalembert.report.look import plain
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Listed, Plot, Row, Section, samples
from dalembert.uncertainty import Comparison, Propagation

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
