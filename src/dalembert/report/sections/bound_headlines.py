"""The first lines of a report on intervals: bounds of a response, methods compared, and what bands or errors tell."""

from collections.abc import Sequence

import numpy as np

from dalembert.inverse import BandFit, ParameterSet
from dalembert.report.charts.methods import reference
from dalembert.report.digits import counted, interval, shown
from dalembert.report.quantities import labelled
from dalembert.report.sections.headline import MOST_VALUES, Fact, Headline, of_identified
from dalembert.uncertainty import Comparison, Propagation


def of_propagation(result: Propagation, title: str | None, notes: Sequence[str]) -> Headline:
    """Headline of bounds of a response."""
    error = result.error
    facts = [
        Fact("method", result.method),
        Fact("the bounds are", result.kind),
        Fact("largest estimated error", "unknown" if error is None else shown(float(error.max()), digits=2)),
        Fact("runs of the model", counted(result.runs)),
        Fact("time", f"{shown(result.seconds, digits=3)} s"),
    ]
    verdict = "bounded" if result.success else "not bounded"
    return Headline(title or "Bounds of the response", verdict, result.success, result.status, facts, notes)


def of_comparison(comparison: Comparison, title: str | None, notes: Sequence[str]) -> Headline:
    """Headline of methods compared on one box."""
    known = reference(comparison)
    facts = [
        Fact("methods", counted(len(comparison.results) + len(comparison.refused))),
        Fact("reference", known.method),
        Fact("its runs", counted(known.runs)),
        Fact("runs altogether", counted(sum(one.runs for one in comparison.results))),
    ]
    success = comparison.success
    verdict = "compared" if success else "incomplete"
    return Headline(title or "Methods compared", verdict, success, comparison.status, facts, notes)


def of_band_fit(fit: BandFit, title: str | None, notes: Sequence[str]) -> Headline:
    """Headline of intervals identified from bands."""
    values = [
        Fact(labelled(item.name, item.unit), interval(low, high))
        for item, low, high in zip(fit.parameters, fit.box.lower, fit.box.upper, strict=True)
    ]
    checked = fit.checked_fitness
    facts = [
        *(values if len(values) <= MOST_VALUES else []),
        Fact("fitness", shown(fit.fitness, digits=3)),
        *([] if checked is None else [Fact("fitness by true runs", shown(checked, digits=3))]),
        Fact("simulations", counted(fit.simulations)),
    ]
    return of_identified(fit, title or "Identified intervals", facts, notes)


def of_set(found: ParameterSet, title: str | None, notes: Sequence[str]) -> Headline:
    """Headline of a consistent set."""
    box = found.outer
    values = (
        []
        if box is None or len(box.names) > MOST_VALUES
        else [
            Fact(labelled(item.name, item.unit), f"in {interval(low, high)}")
            for item, low, high in zip(found.parameters, box.lower, box.upper, strict=True)
        ]
    )
    whole = float(np.prod(found.parameters.upper - found.parameters.lower))
    least, most = (shown(100 * volume / whole, digits=3) for volume in found.volume)
    facts = [
        *values,
        Fact("part of what was searched", f"{least} to {most} %"),
        Fact("boxes", counted(len(found.inside) + len(found.boundary))),
        Fact("runs of the model", counted(found.runs)),
    ]
    verdict = "empty" if box is None else "found" if found.success else "not settled"
    settled = found.success and box is not None
    return Headline(title or "Consistent parameters", verdict, settled, found.status, facts, notes)
