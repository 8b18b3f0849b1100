"""Campbell diagram: modes about the steady rotation of a mechanism, over its speed."""

from typing import Any, Literal

import numpy as np
from pydantic import Field

from dalembert.study.run.duration import Effort, repeatedly
from dalembert.study.run.events import Emit
from dalembert.study.tables.study import Study
from dalembert.study.tasks.requirements import needs_mechanism, unnamed
from dalembert.study.tasks.sweep import Along, values_along
from dalembert.study.tasks.task import Outcome, ResultTask
from dalembert.study.text.table import StudyTable


class CampbellTable(StudyTable):
    """Find the modes of a rotating mechanism over its speed, the other parameters at their first guesses."""

    over: dict[str, Along] = Field(
        min_length=1,
        max_length=1,
        description="values of the parameter that sets the speed: { count = 41 } between bounds, a list, or a range",
    )
    count: int | None = Field(None, ge=1, description="how many modes, from the lowest on; all if not given")
    frame: Literal["fixed", "rotating"] | None = Field(
        None, description="where frequencies are observed; the fixed frame if equations are constant there"
    )


class CampbellTask(ResultTask):
    """The task ``[campbell]``."""

    name = "campbell"
    kind = "dalembert.structure:Campbell"
    rank = 13
    schema = CampbellTable
    needs = (needs_mechanism,)

    def wrong(self, file: Any) -> list[str]:
        wrong = unnamed(file.campbell.over, file.parameters, "[campbell.over]")
        if file.model.forward is not None:
            wrong = [*wrong, "[campbell] needs a mechanism; a forward model has no bodies"]
        return [*wrong, *super().wrong(file)]

    def plan(self, study: Study) -> str:
        name, values = _values(study)
        _modes(study, name, float(values[np.argmax(np.abs(values))]))
        return f"finds the modes at {len(values)} values of {name}: {len(values)} simulations"

    def effort(self, study: Study) -> Effort:
        name, values = _values(study)
        return Effort(repeatedly(lambda: _modes(study, name, float(values[-1]))), 1, len(values), len(values), "modes")

    def unknowns(self, study: Study) -> tuple[str, ...]:
        return ()

    def result(self, study: Study, emit: Emit) -> Any:
        from dalembert.multibody import campbell

        (name, values), table, done = _values(study), study.table, 0
        build = study.along(name)

        def on_speed(speed: float, modes: Any) -> None:
            nonlocal done
            done += 1
            emit("swept", parameter=name, value=speed, done=done, total=len(values), failure=None)

        unit = next(item.unit for item in study.parameters if item.name == name)
        return campbell(
            lambda speed: build(**{name: speed}), values, table.count, frame=table.frame, parameter=name, unit=unit,
            on_speed=on_speed,
        )  # fmt: skip

    def outcome(self, study: Study, diagram: Any) -> Outcome:
        """Outcome of a diagram, with its critical speeds."""
        speeds = enumerate(diagram.critical_speeds, start=1)
        return Outcome(
            study, diagram, {"values": {f"critical speed {number}": critical.speed for number, critical in speeds}}
        )


def _values(study: Study) -> tuple[str, np.ndarray]:
    ((name, along),) = study.table.over.items()
    return name, values_along(study.parameters, name, along)


def _modes(study: Study, name: str, value: float) -> Any:
    """Modes at one value: what is not steady is refused before the run."""
    from dalembert.multibody import modes

    return modes(study.along(name)(**{name: value}), frame=study.table.frame if value else None)
