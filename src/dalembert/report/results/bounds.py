"""Sections of bounds over intervals."""

from dalembert.report.asked import Asked
from dalembert.report.charts.methods import reference
from dalembert.report.registry import register_single, sections_of
from dalembert.report.sections import Bounds, Methods, Section, bound_headlines
from dalembert.uncertainty import Comparison, Propagation

register_single(Propagation, bound_headlines.of_propagation, Bounds)


@sections_of(Comparison)
def comparison(result: Comparison, asked: Asked) -> list[Section]:
    """Methods, and the bounds of the one that the others are measured by."""
    own = [bound_headlines.of_comparison(result, asked.title, asked.notes), Methods(result)]
    return [*own, Bounds(reference(result))]
