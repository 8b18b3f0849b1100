"""Sections of bounds over intervals."""

from dalembert.report.asked import Asked
from dalembert.report.charts.methods import reference
from dalembert.report.needs import ComparisonLike, PropagationLike
from dalembert.report.registry import register_single, sections_of
from dalembert.report.sections import Bounds, Methods, Section, bound_headlines

register_single(PropagationLike, bound_headlines.of_propagation, Bounds)


@sections_of(ComparisonLike)
def comparison(result: ComparisonLike, asked: Asked) -> list[Section]:
    """Methods, and the bounds of the one that the others are measured by."""
    own = [bound_headlines.of_comparison(result, asked.title, asked.notes), Methods(result)]
    return [*own, Bounds(reference(result))]
