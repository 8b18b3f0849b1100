"""A response over frequency, and what was computed beside it."""

from collections.abc import Sequence

import numpy as np

from dalembert.report.asked import Asked
from dalembert.report.digits import counted, shown
from dalembert.report.focus import Look
from dalembert.report.headline import Headline
from dalembert.report.prefixes import in_words
from dalembert.report.registry import sections_of
from dalembert.report.section import Section
from dalembert.report.sections.frequency.backbone import nonlinear_mode
from dalembert.report.sections.frequency.balance import balance
from dalembert.report.sections.frequency.deformation import deformed
from dalembert.report.sections.frequency.forced_response import forced_response
from dalembert.report.sections.frequency.friction import friction
from dalembert.report.sections.frequency.harmonics import harmonics
from dalembert.report.sections.frequency.in_time import in_time
from dalembert.report.sections.frequency.reduction import reduced
from dalembert.structure import ReductionErrors
from dalembert.units import unit_of
from dalembert.vibration import Backbone, Deformation, FrequencyCurve, TimeComparison


@sections_of(FrequencyCurve)
def frequency_curve(curve: FrequencyCurve, asked: Asked) -> list[Section]:
    """The response, its contacts and harmonics, and what was computed beside it."""
    look = Look.of(curve, asked.dofs, asked.amplitude) if curve.converged.any() else None
    sections: list[Section] = [_headline(curve, look)]
    if look is not None:
        sections.append(forced_response(look, asked.one(Backbone)))
        sections += [friction(look)] if curve.coordinates else []
        sections.append(harmonics(look))
    return [*sections, *beside(asked, curve), balance(curve)]


def beside(asked: Asked, curve: FrequencyCurve | None = None) -> list[Section]:
    """Sections of what was computed beside a response."""
    sections = {
        Deformation: deformed,
        Backbone: nonlinear_mode,
        TimeComparison: lambda compared: in_time(compared, curve),
        ReductionErrors: reduced,
    }
    found = {kind: asked.one(kind) for kind in sections}
    return [section(found[kind]) for kind, section in sections.items() if found[kind] is not None]


def _headline(curve: FrequencyCurve, look: Look | None) -> Headline:
    found, points = int(curve.converged.sum()), len(curve.converged)
    low, high = (shown(float(end)) for end in (curve.frequencies.min(), curve.frequencies.max()))
    facts = {}
    if look is not None:
        peak = curve.peak(look.dof, look.kind)
        size = in_words(peak.amplitude, unit_of(look.dof), 5)
        facts[f"peak of {look.dof}"] = f"{size} at {shown(peak.frequency)} Hz"
    facts |= {
        "harmonics": _orders(curve.orders),
        "Newton iterations a point": shown(float(np.mean(curve.iterations)), digits=3),
        "samples of a period": counted(int(np.max(curve.samples))),
    }
    status = (
        f"All {counted(points)} points between {low} and {high} Hz were found."
        if found == points
        else f"{counted(points - found)} of {counted(points)} points between {low} and {high} Hz were not found; "
        "they are marked, and the curve continues past them."
    )
    return Headline(
        title="Forced response",
        verdict="computed" if found == points else "incomplete" if found else "not found",
        success=found == points,
        status=status,
        facts=facts | ({"contacts": counted(len(curve.contacts))} if curve.contacts else {}),
    )


def _orders(orders: Sequence[int]) -> str:
    """Harmonics in a few words.

    >>> _orders((0, 1, 2, 3)), _orders((1, 3, 5)), _orders((1, 3, 5, 7, 9))
    ('0 to 3', '1, 3, 5', '1, 3 … 9')
    """
    if len(orders) > 2 and list(orders) == list(range(orders[0], orders[-1] + 1)):
        return f"{orders[0]} to {orders[-1]}"
    return ", ".join(map(str, orders)) if len(orders) < 5 else f"{orders[0]}, {orders[1]} … {orders[-1]}"
