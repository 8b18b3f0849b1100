"""A resonance over a parameter."""

import numpy as np

from dalembert.report import charts
from dalembert.report.asked import Asked
from dalembert.report.charts.frequency.resonance_peaks import value_text
from dalembert.report.digits import counted, shown
from dalembert.report.headline import Headline
from dalembert.report.prefixes import in_words
from dalembert.report.quantities import labelled
from dalembert.report.registry import sections_of
from dalembert.report.section import Fold, Plot, Section
from dalembert.report.table import Table, noted, unless
from dalembert.units import unit_of
from dalembert.vibration import ResonanceTrack


@sections_of(ResonanceTrack)
def resonance_track(track: ResonanceTrack, asked: Asked) -> list[Section]:
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
    return [_headline(track), Section("Resonance over the parameter", (*_sentences(track), plot, Fold(table)))]


def _headline(track: ResonanceTrack) -> Headline:
    found = np.asarray(track.converged)
    facts = {"values": counted(len(found)), "points balanced": counted(int(np.sum(track.solves)))}
    if found.any():
        facts[f"{track.parameter} of the smallest peak"] = value_text(track, track.best())
        facts[f"peak of {track.dof} there"] = in_words(float(np.nanmin(track.amplitudes)), unit_of(track.dof), 5)
    title, verdicts = f"Resonance over {track.parameter}", ("tracked", "incomplete")
    status = f"The peak was found at {int(found.sum())} of {len(found)} values of {track.parameter}."
    return Headline.of(title, bool(found.all()), verdicts, status, facts)


def _sentences(track: ResonanceTrack) -> tuple[str, ...]:
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
