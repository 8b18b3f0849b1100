"""Simulate: the motion of a mechanism at the first guesses of its parameters."""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import Field

from dalembert.study.run.duration import Effort, shortest_of
from dalembert.study.run.events import Emit
from dalembert.study.tables.study import Study
from dalembert.study.tasks.requirements import needs_mechanism
from dalembert.study.tasks.samples_file import write_samples
from dalembert.study.tasks.task import Outcome, ResultTask, silent
from dalembert.study.text.numbers import Seconds, Times
from dalembert.study.text.table import StudyTable, placed, problem

OUTPUTS = "outputs.csv"


class SimulateTable(StudyTable):
    """Simulate the mechanism until ``end``."""

    end: Seconds | None = Field(None, description="last time; that of times if not given")
    times: Times | None = Field(None, description="output times; every step if not given")
    channels: list[str] = Field(
        [],
        description="what the result keeps (all if not given) and the report draws over time: 'AB.end.x'",
    )
    points: list[str] = Field([], description="points whose paths and coordinates over time the report draws: 'AB.end'")

    def _wrong(self) -> list[str]:
        if self.end is None and self.times is None:
            raise problem("neither end nor times is given; expected one of them")
        if self.end is not None and self.end <= 0:
            raise problem(f"end is {self.end:g} s; expected a time after 0")
        if self.end is not None and self.times is not None and self.times[-1] > self.end:
            raise problem(f"the last of times is {self.times[-1]:g} s, after end = {self.end:g} s")
        return []

    @property
    def last(self) -> float:
        """Last time, s."""
        if self.end is not None:
            return self.end
        assert self.times is not None  # checked above
        return self.times[-1]


class Motion(Outcome):
    """A simulated motion, and a file with the channels and points that the study asks for."""

    @property
    def success(self) -> bool:
        return True

    @property
    def status(self) -> str:
        return f"simulated to {self.result.times[-1]:g} s"

    def save(self, path: Path) -> None:
        self.result.save(path, self.study.table.channels or None)
        if outputs := self._outputs():
            write_samples(path.with_name(OUTPUTS), outputs, self.result.times, self.result.channels(outputs))

    def _outputs(self) -> list[str]:
        table, axes = self.study.table, self.result.system.AXES
        return list(dict.fromkeys((*table.channels, *(f"{point}.{axis}" for point in table.points for axis in axes))))


class Simulate(ResultTask):
    """The task ``[simulate]``."""

    name = "simulate"
    rank = 1
    schema = SimulateTable

    def wrong(self, file: Any) -> list[str]:
        if file.model.forward is not None:
            return ["[simulate] needs a mechanism; a forward model is for [identify] and [sweep]"]
        if file.vibrates:
            return needs_mechanism(file, "simulate")
        return [] if file.solver else ["the table [solver] is missing; expected at least its step"]

    def plan(self, study: Study) -> str:
        from dalembert.multibody import TimeResponse

        study.system()
        study.require_inputs(study.table.last)
        table, ends = study.table, np.array([0.0, study.table.last])
        for key, names in (("channels", table.channels), ("points", [f"{name}.x" for name in table.points])):
            if names:
                with placed(f"[simulate], {key}"):
                    TimeResponse(study.builder, study.parameters, names, ends, solver=study.solver).channels  # noqa: B018
        return f"simulates the motion to {study.table.last:g} s: 1 simulation"

    def effort(self, study: Study) -> Effort:
        end, times = study.table.last, study.table.times

        def part(share: float) -> float:
            last = share * end
            study.motion(last, times=None if times is None else np.unique([*(t for t in times if t < last), last]))
            return share

        return Effort(part, 1, 1, 1, "the motion", shortest_of(study.solver, end))

    def parts(self, study: Study) -> Iterable[Callable[[], object]]:
        """The checks of the simulation, which has no checkpoint to end it."""
        from dalembert.multibody.motion.simulation import posed

        times = study.table.times
        return (
            lambda: posed(study.system(), study.table.last, study.solver, None if times is None else np.array(times)),
        )

    def result(self, study: Study, emit: Emit) -> Any:
        emit("simulating", end=study.table.last)
        times = study.table.times
        return study.motion(study.table.last, times=None if times is None else np.array(times))

    def outcome(self, study: Study, result: Any) -> Outcome:
        return Motion(study, result, options={"points": study.table.points, "channels": study.table.channels})

    def load(self, study: Study, path: Path) -> Outcome:
        """The motion again: a result does not keep all that a drawing needs, and the same study moves the same."""
        return self.run(study, silent)
