"""Track resonance: the peak of a response over a parameter, without whole curves."""

from typing import Annotated, Any

import numpy as np
from pydantic import Field

from dalembert.study.run.duration import Effort, repeatedly
from dalembert.study.run.events import Emit
from dalembert.study.tables.study import Study
from dalembert.study.tasks.requirements import needs_structure, unnamed
from dalembert.study.tasks.sweep import Along, values_along
from dalembert.study.tasks.task import Outcome, ResultTask
from dalembert.study.text.numbers import FrequencyEnds, fixed
from dalembert.study.text.table import Read, StudyTable, placed


class TrackResonanceTable(StudyTable):
    """Follow the peak of a response over a parameter."""

    parameter: str = Field(description="such as a preload or the level of a force; the others keep their first guesses")
    values: Along = Field(description="in their order: a list, a range, or { count = 9 } between the bounds")
    between: FrequencyEnds = Field(description="frequencies around the peak at the first value")
    dof: str = Field(description="whose peak is followed: 'm2', or 'm2.x'")
    amplitude: str = Field("peak", description="'peak', 'rms', or 'harmonic 1' and so on")
    phase: Annotated[float, Read(fixed("rad"))] | None = Field(
        None, description="of the first harmonic relative to the force, in place of the peak: '-90 deg'"
    )


class TrackResonance(ResultTask):
    """The task ``[track_resonance]``."""

    name = "track_resonance"
    kind = "dalembert.vibration:ResonanceTrack"
    rank = 10
    of_structures = True
    schema = TrackResonanceTable
    needs = (needs_structure,)

    def wrong(self, file: Any) -> list[str]:
        where = "[track_resonance], parameter"
        return [*super().wrong(file), *unnamed([file.track_resonance.parameter], file.parameters, where)]

    def plan(self, study: Study) -> str:
        from dalembert.vibration.paths.amplitudes import Amplitude, highest_order

        table, lowered = study.table, study.equations().lowered
        with placed("[track_resonance], dof"):
            lowered.structure.dofs.index(table.dof)
        with placed("[track_resonance], amplitude"):
            Amplitude(table.amplitude, study.balance.keeping(highest_order(table.amplitude)).first().orders)
        values = _values(study)
        what = "peak" if table.phase is None else "phase resonance"
        return (
            f"follows the {what} of {table.dof} ({table.amplitude}) over {len(values)} values of {table.parameter}, "
            f"{values[0]:g} to {values[-1]:g}: {len(values)} simulations"
        )

    def effort(self, study: Study) -> Effort:
        count = len(_values(study))
        part = repeatedly(lambda: _track(study, _values(study)[:1]))
        return Effort(part, 1, count, count, "the peak at the first value")

    def result(self, study: Study, emit: Emit) -> Any:
        return _track(study, _values(study))

    def outcome(self, study: Study, track: Any) -> Outcome:
        """Outcome of a track, with its smallest peak."""
        if not track.converged.any():
            return Outcome(study, track, {})
        best, row = track.best(), int(np.nanargmin(track.amplitudes))
        peak = {
            f"{track.kind} of {track.dof}": float(track.amplitudes[row]),
            "frequency (Hz)": float(track.frequencies[row]),
        }
        return Outcome(study, track, {"values": {track.parameter: best, **peak}})


def _values(study: Study) -> np.ndarray:
    """Values of the parameter, (values,)."""
    return values_along(study.parameters, study.table.parameter, study.table.values)


def _track(study: Study, values: np.ndarray) -> Any:
    from dalembert.vibration import track_resonance

    table, name = study.table, study.table.parameter
    return track_resonance(
        study.along(name),
        name,
        values,
        tuple(table.between),
        study.balance,
        dof=table.dof,
        kind=table.amplitude,
        phase=table.phase,
        unit=next(item.unit for item in study.parameters if item.name == name),
        checkpoint=study.checkpoint,
    )
