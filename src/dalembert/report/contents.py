"""Sections of a report in reading order, their figures, and where the result comes from."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

import plotly.graph_objects as go

from dalembert.report.headline import Headline
from dalembert.report.options import ReportOptions, report_options
from dalembert.report.player.animation import Animation
from dalembert.report.registry import registered_sections
from dalembert.report.section import Block, Section, Source
from dalembert.results import fixed_facts
from dalembert.tables import Cell, Table

LONGEST = 200
"""Characters of a value that a page shows; its CSV has all."""


def provenance(facts: Mapping[str, Any], study: str | None) -> list[Section]:
    """Version, seed, fingerprint of the model and settings of the method; the study as it was run, if there is one."""
    blocks: list[Block] = []
    if facts:
        flat = dict(_flat(facts))
        texts = [_worded(value) for value in flat.values()]
        cells = [Cell(text, text if len(text) <= LONGEST else f"{text[:LONGEST]} …") for text in texts]
        columns = {"what": flat, "value": cells}
        blocks.append(Table.of("provenance", "What made this result", columns))
    if study:
        blocks.append(Source("The study as it was run", study))
    return [Section("Provenance", blocks)] if blocks else []


def _worded(value: Any) -> str:
    """Return a setting as people write it.
    >>> _worded(True), _worded(None), _worded(["low", "high"]), _worded([0.08, 0.32]), _worded(1e-10)
    ('yes', 'none', 'low, high', '0.08, 0.32', '1e-10')
    """
    if isinstance(value, list | tuple):
        return ", ".join(map(_worded, value))
    return {True: "yes", False: "no", None: "none"}[value] if value is None or isinstance(value, bool) else str(value)


def _flat(facts: Mapping[str, Any], above: str = "") -> Iterator[tuple[str, Any]]:
    """Entries of nested mappings, named by their path."""
    for key, value in facts.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{above}{key}.")
        else:
            yield f"{above}{key}", value


def contents(result: object, options: ReportOptions) -> tuple[Headline, *tuple[Section, ...]]:
    """Sections of a report in reading order.

    Raises
    ------
    InputError
        For a result that no sections are registered for, and for what no section shows.
    """
    first, *rest = registered_sections(result, options)
    options.refuse_others()
    if not isinstance(first, Headline):
        first, rest = Headline(title=type(result).__name__), [first, *rest]
    headline = replace(
        first,
        title=options.title or first.title,
        notes=options.notes,
        facts={**first.facts, **fixed_facts(result)},
        findings=(*options.findings, *getattr(result, "findings", ())),
    )
    return headline, *rest, *options.sections, *provenance(getattr(result, "provenance", {}), options.study)


def figures(result: object, *supplements: object, **options: Any) -> dict[str, go.Figure | Animation]:
    """Every figure that a report of the result would show, by name.

    Parameters
    ----------
    result : Fit, Trajectory, FrequencyCurve, Propagation, Comparison, BandFit, ParameterSet, Profiles …
    *supplements, **options
        As in :func:`dalembert.report.report`.

    Returns
    -------
    dict of str to plotly.graph_objects.Figure or Animation
        For a fit ``"parameters"``, ``"responses-1"``, ``"convergence"``, ``"correlation"`` …, from response
        sensitivity ``"l-curve"`` and ``"steps"``, from multiple shooting ``"gaps"`` too, for a trajectory
        ``"mechanism"``, ``"energies"``, ``"violations"``, ``"newton"``, for bounds
        ``"bands-1"`` …, for methods compared ``"methods"`` and ``"differences"`` too, for intervals from bands
        ``"intervals"``, ``"residual-bands-1"`` …, for a set ``"paving-1"`` …, for a sweep ``"sweep-1"`` …, for profiles
        ``"profile-1"`` …, for a prediction ``"prediction-1"`` …, for designs ``"ranking"`` and ``"horizons"``, for a
        response over frequency ``"frequency-curve"``, ``"hysteresis"``, ``"contact-states"``, ``"harmonic-content"`` ….
        ``"mechanism"``, ``"deformation"`` and ``"mode-shapes"`` are each an :class:`Animation`.

    Raises
    ------
    InputError
        For a result that is none of these.
    """
    return {
        plot.name: plot.figure
        for section in contents(result, report_options(supplements, **options))
        for plot in section.plots
    }
