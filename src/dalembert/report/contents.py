"""Sections of a report in reading order."""

from dataclasses import replace

from dalembert.report.asked import Asked
from dalembert.report.headline import Headline, fixed_facts
from dalembert.report.provenance import provenance
from dalembert.report.registry import registered_sections
from dalembert.report.section import Section


def contents(result: object, asked: Asked) -> tuple[Headline, *tuple[Section, ...]]:
    """Sections of a report in reading order.

    Raises
    ------
    InputError
        For a result that no sections are registered for, and for what no section shows.
    """
    first, *others = registered_sections(result, asked)
    asked.refuse_others()
    if not isinstance(first, Headline):
        first, others = Headline(title=type(result).__name__), [first, *others]
    headline = replace(
        first,
        title=asked.title or first.title,
        notes=asked.notes,
        facts={**first.facts, **fixed_facts(result)},
        findings=getattr(result, "findings", ()),
    )
    return headline, *others, *asked.sections, *provenance(getattr(result, "provenance", {}), asked.study)
