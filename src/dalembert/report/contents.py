"""Sections of a report in reading order, and their figures."""

from dataclasses import replace
from typing import Any

import plotly.graph_objects as go

from dalembert.report.asked import Asked, asked
from dalembert.report.headline import Headline, fixed_facts
from dalembert.report.provenance import provenance
from dalembert.report.registry import registered_sections
from dalembert.report.section import Section


def contents(result: object, wanted: Asked) -> tuple[Headline, *tuple[Section, ...]]:
    """Sections of a report in reading order.

    Raises
    ------
    InputError
        For a result that no sections are registered for, and for what no section shows.
    """
    first, *others = registered_sections(result, wanted)
    wanted.refuse_others()
    if not isinstance(first, Headline):
        first, others = Headline(title=type(result).__name__), [first, *others]
    headline = replace(
        first,
        title=wanted.title or first.title,
        notes=wanted.notes,
        facts={**first.facts, **fixed_facts(result)},
        findings=(*wanted.findings, *getattr(result, "findings", ())),
    )
    return headline, *others, *wanted.sections, *provenance(getattr(result, "provenance", {}), wanted.study)


def figures(result: object, *beside: object, **options: Any) -> dict[str, go.Figure]:
    """Every figure that a report of the result would show, by name.

    Parameters
    ----------
    result : Fit, Trajectory, FrequencyCurve, Propagation, Comparison, BandFit, ParameterSet, Profiles …
    *beside, **options
        As in :func:`dalembert.report.report`.

    Returns
    -------
    dict of str to plotly.graph_objects.Figure
        For a fit ``"parameters"``, ``"responses-1"``, ``"convergence"``, ``"correlation"`` …, from response
        sensitivity ``"l-curve"`` and ``"steps"``, from multiple shooting ``"gaps"`` too, for a trajectory
        ``"mechanism"``, ``"energies"``, ``"violations"``, ``"newton"``, for bounds ``"bands-1"`` …, for methods
        compared ``"methods"`` and ``"differences"`` too, for intervals from bands ``"intervals"``,
        ``"residual-bands-1"`` …, for a set ``"paving-1"`` …, for a sweep ``"sweep-1"`` …, for profiles
        ``"profile-1"`` …, for a prediction ``"prediction-1"`` …, for designs ``"ranking"`` and ``"horizons"``, for a
        response over frequency ``"frequency-curve"``, ``"hysteresis"``, ``"contact-states"``, ``"harmonic-content"`` ….

    Raises
    ------
    InputError
        For a result that is none of these.
    """
    return {plot.name: plot.figure for section in contents(result, asked(beside, **options)) for plot in section.plots}
