"""Backbone: frequency and damping of a nonlinear mode over its amplitude."""

from typing import Annotated, Any

import numpy as np
from pydantic import Field

from dalembert.study.run.duration import Effort, repeatedly
from dalembert.study.run.events import Emit
from dalembert.study.tables.study import Study
from dalembert.study.tasks.requirements import needs_structure
from dalembert.study.tasks.task import Outcome, ResultTask
from dalembert.study.text.numbers import fixed, pair, samples
from dalembert.study.text.table import Read, StudyTable, placed, problem


class BackboneTable(StudyTable):
    """Follow a nonlinear mode of a structure over its amplitude."""

    amplitudes: Annotated[tuple[float, ...], Read(samples("m"))] | None = Field(
        None, description="of the first harmonic of dof: a list, or a range"
    )
    between: Annotated[list[float], Read(pair(fixed("m")))] | None = Field(
        None, description="two amplitudes, from the first to the second past folds of the amplitude"
    )
    mode: int = Field(1, ge=1, description="number among the linear modes at rest, where loaded contacts stick")
    dof: str | None = Field(
        None, description="by which the amplitude is measured; the one that moves most if not given"
    )

    def _wrong(self) -> list[str]:
        if (self.amplitudes is None) == (self.between is None):
            stated = "neither amplitudes nor between is" if self.between is None else "amplitudes and between are both"
            raise problem(f"{stated} given; expected one of them")
        if not min(self.given) > 0:
            raise problem(f"the amplitude {min(self.given):g} m was given; expected positive ones")
        return []

    @property
    def given(self) -> tuple[float, ...]:
        """The amplitudes, or the two ends."""
        return tuple(self.amplitudes or self.between or ())

    def follow(self, study: Study, system: Any) -> Any:
        """The mode of a system."""
        from dalembert.vibration import backbone

        along = self.given if self.amplitudes is None else np.array(self.given)
        return backbone(system, along, self.mode, study.balance, dof=self.dof, checkpoint=study.checkpoint)


class BackboneTask(ResultTask):
    """The task ``[backbone]``."""

    name = "backbone"
    kind = "dalembert.vibration:Backbone"
    rank = 11
    of_structures = True
    schema = BackboneTable
    needs = (needs_structure,)

    def plan(self, study: Study) -> str:
        from dalembert.vibration.system.requirements import require_viscous

        table = study.table
        with placed("[backbone]"):
            require_viscous(study.equations().lowered.structure, "nonlinear modes")
        count = "as many amplitudes as it needs" if table.between else f"{len(table.given)} amplitudes"
        return f"follows mode {table.mode} from {table.given[0]:g} to {table.given[-1]:g} m ({count}): 1 simulation"

    def effort(self, study: Study) -> Effort:
        from dalembert.vibration import backbone

        table = study.table
        count = None if table.between else len(table.given)

        def once() -> None:
            backbone(study.system(), np.array(table.given[:1]), table.mode, study.balance, dof=table.dof)

        return Effort(repeatedly(once), 1, count, count, "the first amplitude")

    def result(self, study: Study, emit: Emit) -> Any:
        study.equations()
        return study.table.follow(study, study.system())

    def outcome(self, study: Study, mode: Any) -> Outcome:
        """Outcome of a mode, with its frequencies at both ends and its largest damping."""
        if not mode.converged.any():
            return Outcome(study, mode, {})
        frequencies = mode.frequencies[mode.converged]
        ends = {"frequency at first": float(frequencies[0]), "frequency at last": float(frequencies[-1])}
        return Outcome(study, mode, {"values": ends | {"largest damping": float(np.nanmax(mode.damping))}})
