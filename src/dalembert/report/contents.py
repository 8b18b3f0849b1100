"""Sections of a report in reading order."""

from dataclasses import replace

from dalembert.report.asked import Asked
from dalembert.report.registry import registered_sections
from dalembert.report.sections.headline import Headline, fixed_facts
from dalembert.report.sections.provenance import Provenance
from dalembert.report.sections.section import Section


def contents(result: object, asked: Asked) -> list[Section]:
    """Sections of a report in reading order; the first is the headline.

    Raises
    ------
    InputError
        For a result that no sections are registered for, and for what no section shows.
    """
    first, *others = registered_sections(result, asked)
    asked.refuse_others()
    if not isinstance(first, Headline):
        title = asked.title or type(result).__name__
        first, others = Headline(title, "", True, "", (), asked.notes), [first, *others]
    first = replace(first, findings=tuple(getattr(result, "findings", ())), facts=[*first.facts, *fixed_facts(result)])
    facts = getattr(result, "provenance", {})
    after = [Provenance(facts, asked.study)] if facts or asked.study else []
    return [first, *others, *asked.sections, *after]
