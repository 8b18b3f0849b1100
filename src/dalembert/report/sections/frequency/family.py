"""Responses over frequency, and a resonance, for several values of a parameter."""

import numpy as np

from dalembert.report import charts
from dalembert.report.charts.frequency.curve_family import value_text
from dalembert.report.focus import Look, family_dofs
from dalembert.report.headline import Headline
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Fold, Plot, Row, Section
from dalembert.report.sections.frequency.curve import beside, friction
from dalembert.tables import Table, cells, counted, in_words, labelled, marks, noted, percent, shown, unless
from dalembert.units import unit_of
from dalembert.vibration import CurveFamily, ResonanceTrack


@sections_of(CurveFamily)
def curve_family(family: CurveFamily, options: ReportOptions) -> list[Section]:
    """Curves for several values of a parameter, and what was computed beside the best."""
    dofs, kind = tuple(options.dofs or family_dofs(family, options.amplitude)), options.amplitude
    facts, own = {"values": counted(len(family.values))}, []
    if dofs:
        best = _best(family, dofs[0], kind)
        facts |= _facts(family, dofs[0], kind, best)
        own.append(_section(family, dofs, kind, best))
        curve = family.curves[best]
        if curve is not None and curve.coordinates:
            lead = f"With {family.parameter} = {value_text(family, float(family.values[best]))}, "
            own.append(friction(Look.of(curve, dofs[:1], kind), lead))
    title, verdicts = f"Forced response over {family.parameter}", ("computed", "incomplete")
    headline = Headline.of(title, family.success, verdicts, f"{family.status}.", facts)
    return [headline, *own, *beside(options)]


def _best(family: CurveFamily, dof: str, kind: str) -> int:
    """Number of the curve with the smallest peak."""
    return int(np.flatnonzero(np.asarray(family.values) == family.best(dof, kind))[0])


def _facts(family: CurveFamily, dof: str, kind: str, best: int) -> dict[str, str]:
    gain = float(family.reduction(dof, kind)[best])
    facts = {
        f"{family.parameter} of the smallest peak": value_text(family, float(family.values[best])),
        f"peak of {dof} there": in_words(family.peaks(dof, kind)[best].amplitude, unit_of(dof), 5),
    }
    return facts | (
        {f"reduction from {value_text(family, float(family.values[0]))}": percent(gain)} if gain > 0 else {}
    )


def _section(family: CurveFamily, dofs: tuple[str, ...], kind: str, best: int) -> Section:
    """Curves with their envelope, peaks over the parameter, and a table of the peaks and what they gain."""
    how = "Dotted and dashed: what the best and the worst value would give at each frequency alone."
    below, numbered = "Below, the frequency of the peak.", list(enumerate(dofs, start=1))
    wide = [Plot(f"curve-family-{place}", charts.curve_family(family, dof, kind=kind), how) for place, dof in numbered]
    pairs = [
        Plot(f"family-peaks-{place}", charts.family_peaks(family, dof, kind=kind), below) for place, dof in numbered
    ]
    tables = [Fold(_table(family, place, dof, kind)) for place, dof in numbered]
    sentences = _sentences(family, dofs[0], kind, best)
    return Section("Responses over the parameter", (*sentences, *wide, Row(pairs), *tables))


def _sentences(family: CurveFamily, dof: str, kind: str, best: int) -> list[str]:
    peaks, values = family.peaks(dof, kind), np.asarray(family.values)
    gain = float(family.reduction(dof, kind)[best])
    told = f"The smallest peak of {dof} is at {family.parameter} = {value_text(family, values[best])}: "
    told += f"{in_words(peaks[best].amplitude, unit_of(dof), 4)} at {shown(peaks[best].frequency)} Hz"
    if best and np.isfinite(gain):
        told += f", {percent(gain)} below that at {value_text(family, values[0])}"
    told_all = [f"{told}."]
    ends = [place for place in (0, len(values) - 1) if np.isfinite(peaks[place].frequency)]
    if len(ends) == 2:
        first, last = (shown(peaks[place].frequency) for place in ends)
        shift = f"From {value_text(family, values[0])} to {value_text(family, values[-1])} "
        told_all.append(f"{shift}the frequency of the peak goes from {first} to {last} Hz.")
    if len(values) > 1 and values[best] in (values.min(), values.max()):
        told_all.append("It lies at the end of the values: beyond them the peak may be smaller still.")
    return told_all


def _table(family: CurveFamily, place: int, dof: str, kind: str) -> Table:
    peaks, curves = family.peaks(dof, kind), family.curves
    columns = {
        labelled(family.parameter, family.unit): family.values,
        labelled("peak", unit_of(dof)): [peak.amplitude for peak in peaks],
        "at frequency (Hz)": [peak.frequency for peak in peaks],
        "change from the first (%)": cells(-100 * np.asarray(family.reduction(dof, kind)), 4),
        "points found": [
            "" if curve is None else f"{int(curve.converged.sum())} of {len(curve.converged)}" for curve in curves
        ],
        "note": marks(reason or "" for reason in family.failures),
    }
    return noted(Table.of(f"family-{place}", f"Peaks of {dof}", columns))


@sections_of(ResonanceTrack)
def resonance_track(track: ResonanceTrack, options: ReportOptions) -> list[Section]:
    """Height and frequency of the peak over the parameter."""
    columns = {
        labelled(track.parameter, track.unit): track.values,
        labelled("peak", unit_of(track.dof)): track.amplitudes,
        "at frequency (Hz)": track.frequencies,
        "points balanced": track.solves,
        "note": unless(track.converged, "not found"),
    }
    plot = Plot("resonance-track", charts.resonance_track(track), "Below, the frequency of the peak.")
    table = noted(Table.of("resonance", f"Peaks of {track.dof}", columns))
    return [_headline(track), Section("Resonance over the parameter", (*_track_sentences(track), plot, Fold(table)))]


def _headline(track: ResonanceTrack) -> Headline:
    found = np.asarray(track.converged)
    facts = {"values": counted(len(found)), "points balanced": counted(int(np.sum(track.solves)))}
    if found.any():
        facts[f"{track.parameter} of the smallest peak"] = value_text(track, track.best())
        facts[f"peak of {track.dof} there"] = in_words(float(np.nanmin(track.amplitudes)), unit_of(track.dof), 5)
    title, verdicts = f"Resonance over {track.parameter}", ("tracked", "incomplete")
    status = f"The peak was found at {int(found.sum())} of {len(found)} values of {track.parameter}."
    return Headline.of(title, bool(found.all()), verdicts, status, facts)


def _track_sentences(track: ResonanceTrack) -> tuple[str, ...]:
    if not track.converged.any():
        return ()
    top, low = int(np.nanargmax(track.amplitudes)), int(np.nanargmin(track.amplitudes))
    least, most = (
        f"{in_words(float(track.amplitudes[at]), unit_of(track.dof), 4)} at {shown(float(track.frequencies[at]))} Hz"
        for at in (low, top)
    )
    told = f"The peak of {track.dof} is smallest with {track.parameter} = {value_text(track, track.values[low])}: "
    told += f"{least}; largest with {value_text(track, track.values[top])}: {most}."
    followed = f"Followed by {int(np.sum(track.solves))} balanced points, without whole curves; this peak "
    return (told, followed + "continues the first one; another one may be larger by now.")
