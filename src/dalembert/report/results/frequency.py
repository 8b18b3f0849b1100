"""Sections of structures in frequency."""

from dalembert.report.asked import Asked
from dalembert.report.charts.resonance_peaks import value_text
from dalembert.report.focus import Look, family_dofs
from dalembert.report.registry import register_single, sections_of
from dalembert.report.sections import (
    Balance,
    Deformed,
    Family,
    ForcedResponse,
    Friction,
    Harmonics,
    InTime,
    Modes,
    NonlinearMode,
    Period,
    Reduction,
    Section,
    Tracks,
    vibration_headlines,
)
from dalembert.report.sections.family import best_curve
from dalembert.structure import ModeShapes, ReductionErrors
from dalembert.vibration import (
    Backbone,
    CurveFamily,
    Deformation,
    FrequencyCurve,
    PeriodicMotion,
    ResonanceTrack,
    TimeComparison,
)


@sections_of(FrequencyCurve)
def frequency_curve(result: FrequencyCurve, asked: Asked) -> list[Section]:
    """The response, its contacts and harmonics, and what was computed beside it."""
    look = Look.of(result, asked.dofs, asked.amplitude) if result.converged.any() else None
    return [
        vibration_headlines.of_frequency_curve(result, look, asked.title, asked.notes),
        *_vibrating(look, asked.one(Backbone)),
        *_beside(asked, result),
        Balance(result),
    ]


register_single(Deformation, vibration_headlines.of_deformation, Deformed)
register_single(PeriodicMotion, vibration_headlines.of_period, Period)
register_single(ReductionErrors, vibration_headlines.of_reduction, Reduction)
register_single(ModeShapes, vibration_headlines.of_modes, Modes)
register_single(TimeComparison, vibration_headlines.of_time_comparison, InTime)
register_single(Backbone, vibration_headlines.of_backbone, NonlinearMode)
register_single(ResonanceTrack, vibration_headlines.of_track, Tracks)


@sections_of(CurveFamily)
def curve_family(result: CurveFamily, asked: Asked) -> list[Section]:
    """Curves for several values of a parameter, and what was computed beside the best."""
    dofs = asked.dofs or family_dofs(result, asked.amplitude)
    own = vibration_headlines.of_family(result, dofs, asked.amplitude, asked.title, asked.notes)
    return [own, *_family(result, dofs, asked.amplitude), *_beside(asked)]


def _beside(asked: Asked, curve: FrequencyCurve | None = None) -> list[Section]:
    """Sections of what was computed beside a response."""
    sections: list[Section] = []
    if (deformed := asked.one(Deformation)) is not None:
        sections.append(Deformed(deformed))
    if (mode := asked.one(Backbone)) is not None:
        sections.append(NonlinearMode(mode))
    if (compared := asked.one(TimeComparison)) is not None:
        sections.append(InTime(compared, curve) if curve is not None else InTime(compared))
    if (reduced := asked.one(ReductionErrors)) is not None:
        sections.append(Reduction(reduced))
    return sections


def _vibrating(look: Look | None, backbone: Backbone | None) -> list[Section]:
    """The sections on a response over frequency, where any of it was found."""
    if look is None:
        return []
    elements = [Friction(look)] if look.curve.coordinates else []
    return [ForcedResponse(look, backbone), *elements, Harmonics(look)]


def _family(family: CurveFamily, dofs: tuple[str, ...], amplitude: str) -> list[Section]:
    """The sections on curves for several values of a parameter, and on the contacts at the best value."""
    if not dofs:
        return []
    best = best_curve(family, dofs[0], amplitude)
    lead = f"With {family.parameter} = {value_text(family, family.best(dofs[0], amplitude))}, "
    contacts = [Friction(Look.of(best, dofs[:1], amplitude), lead)] if best.coordinates else []
    return [Family(family, dofs, amplitude), *contacts]
