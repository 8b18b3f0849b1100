"""A resonance over a parameter."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.report import charts
from dalembert.report.charts.resonance_peaks import value_text
from dalembert.report.digits import shown
from dalembert.report.focus import unit_of
from dalembert.report.plot import Plot
from dalembert.report.prefixes import in_words
from dalembert.report.quantities import labelled
from dalembert.report.sections.findings import Findings
from dalembert.report.table import Table, cell, noted
from dalembert.vibration import ResonanceTrack


@dataclass(frozen=True)
class Tracks(Findings):
    """Height and frequency of the peak over the parameter."""

    heading: ClassVar[str] = "Resonance over the parameter"
    track: ResonanceTrack

    @property
    def sentences(self) -> tuple[str, ...]:
        track = self.track
        if not track.converged.any():
            return ()
        top, low = int(np.nanargmax(track.amplitudes)), int(np.nanargmin(track.amplitudes))
        least, most = (
            f"{in_words(float(track.amplitudes[at]), unit_of(track.dof), 4)} at "
            f"{shown(float(track.frequencies[at]))} Hz"
            for at in (low, top)
        )
        told = f"The peak of {track.dof} is smallest with {track.parameter} = {value_text(track, track.values[low])}: "
        told += f"{least}; largest with {value_text(track, track.values[top])}: {most}."
        followed = (
            f"Followed by {int(np.sum(track.solves))} balanced points, without whole curves; it is the peak that "
        )
        return (told, followed + "goes on from the first one, and another one may have become larger.")

    @property
    def wide(self) -> tuple[Plot, ...]:
        how = "Below, the frequency of the peak."
        return (Plot("resonance-track", charts.resonance_track(self.track), how),)

    @property
    def tables(self) -> tuple[Table, ...]:
        track = self.track
        rows = [
            (
                cell(float(value)),
                cell(float(track.amplitudes[k])),
                cell(float(track.frequencies[k])),
                cell(int(track.solves[k])),
                cell("" if track.converged[k] else "not found", mark=not track.converged[k]),
            )
            for k, value in enumerate(track.values)
        ]
        columns = (
            labelled(track.parameter, track.unit),
            labelled("peak", unit_of(track.dof)),
            "at frequency (Hz)",
            "points balanced",
            "note",
        )
        return (noted(Table("resonance", f"Peaks of {track.dof}", columns, rows)),)
