"""Responses over frequency, and a resonance, for several values of a parameter."""

import numpy as np

from dalembert.report import charts
from dalembert.report.charts.frequency.curve_family import value_text
from dalembert.report.headline import headline_of
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Plot, Row, Section, by_name
from dalembert.report.sections.curve_sections import beside, friction
from dalembert.tables import in_words, percent, shown
from dalembert.units import unit_of
from dalembert.vibration import CurveFamily, ResonanceTrack
from dalembert.vibration.paths.focus import Look


@sections_of(CurveFamily)
def curve_family(family: CurveFamily, options: ReportOptions) -> list[Section]:
    """Curves for several values of a parameter, and what was computed beside the best."""
    kind = options.amplitude
    dofs = tuple(options.dofs or family.foremost(kind))
    sections: list[Section] = [headline_of(family, facts=family.facts(dofs, kind))]
    if dofs:
        best = family.best_row(dofs[0], kind)
        how = "Dotted and dashed: what the best and the worst value would give at each frequency alone."
        below, numbered = "Below, the frequency of the peak.", list(enumerate(dofs, start=1))
        wide = [Plot(f"curve-family-{k}", charts.curve_family(family, dof, kind=kind), how) for k, dof in numbered]
        pairs = [Plot(f"family-peaks-{k}", charts.family_peaks(family, dof, kind=kind), below) for k, dof in numbered]
        blocks = (*_sentences(family, dofs[0], kind, best), *wide, Row(pairs), *family.tables(dofs, kind))
        sections.append(Section("Responses over the parameter", blocks))
        curve = family.curves[best]
        if curve is not None and curve.coordinates:
            lead = f"With {family.parameter} = {value_text(family, float(family.values[best]))}, "
            tables = by_name(curve.tables(dofs[:1], kind))
            sections.append(friction(Look.of(curve, dofs[:1], kind), tables, lead))
    return [*sections, *beside(options)]


def _sentences(family: CurveFamily, dof: str, kind: str, best: int) -> list[str]:
    peaks, values = family.peaks(dof, kind), np.asarray(family.values)
    gain = float(family.reduction(dof, kind)[best])
    text = f"The smallest peak of {dof} is at {family.parameter} = {value_text(family, values[best])}: "
    text += f"{in_words(peaks[best].amplitude, unit_of(dof), 4)} at {shown(peaks[best].frequency)} Hz"
    if best and np.isfinite(gain):
        text += f", {percent(gain)} below that at {value_text(family, values[0])}"
    sentences = [f"{text}."]
    ends = [place for place in (0, len(values) - 1) if np.isfinite(peaks[place].frequency)]
    if len(ends) == 2:
        first, last = (shown(peaks[place].frequency) for place in ends)
        shift = f"From {value_text(family, values[0])} to {value_text(family, values[-1])} "
        sentences.append(f"{shift}the frequency of the peak goes from {first} to {last} Hz.")
    if len(values) > 1 and values[best] in (values.min(), values.max()):
        sentences.append("It lies at the end of the values: beyond them the peak may be smaller still.")
    return sentences


@sections_of(ResonanceTrack)
def resonance_track(track: ResonanceTrack, options: ReportOptions) -> list[Section]:
    """Height and frequency of the peak over the parameter."""
    sentences = []
    if track.converged.any():
        sentences = [
            f"Followed by {int(np.sum(track.solves))} balanced points, without whole curves; this peak continues the "
            "first one; another one may be larger by now."
        ]
    plot = Plot("resonance-track", charts.resonance_track(track), "Below, the frequency of the peak.")
    return [headline_of(track), Section("Resonance over the parameter", (*sentences, plot, *track.tables()))]
