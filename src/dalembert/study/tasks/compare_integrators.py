"""Work and precision: integrators compared on the study's mechanism."""

from dataclasses import replace
from typing import Any

import numpy as np
from pydantic import Field

from dalembert.errors import repeated
from dalembert.study.run.duration import Effort, shortest_of
from dalembert.study.run.events import Emit
from dalembert.study.tables.catalogue import solver
from dalembert.study.tables.study import Study
from dalembert.study.tasks.requirements import needs_mechanism
from dalembert.study.tasks.task import Outcome, ResultTask
from dalembert.study.text.numbers import MOST, Seconds, pair
from dalembert.study.text.table import StudyTable, checked, completed, placed, problem


class SeriesTable(StudyTable):
    """One integrator at several settings."""

    name: str | None = Field(None, description="of the line in the figure; the integrator's kind if not given")
    solver: Any
    over: dict[str, list[float]] = Field(
        min_length=1, max_length=1, description="values of one setting: { step = [0.01, 0.005] }"
    )

    def _wrong(self) -> list[str]:
        checked(self.integrators)
        return []

    def integrators(self) -> list[Any]:
        """The integrator with each value of the setting."""
        ((setting, values),) = self.over.items()
        first = self.solver.settings()
        if setting not in type(first).__dataclass_fields__:
            raise problem(f"over: a {type(first).__name__} has no setting {setting!r}")
        return [replace(first, **{setting: value}) for value in values]

    @property
    def label(self) -> str:
        """The name in figure and table."""
        return self.name or type(self.solver.settings()).__name__


class WorkPrecisionTable(StudyTable):
    """Compare integrators on the mechanism's motion at the first guesses: error against run time."""

    end: Seconds = Field(gt=0)
    channels: list[str] = Field(min_length=1, description="what errors are measured on: 'AB.end.x'")
    samples: int = Field(41, ge=2, le=MOST, description="output times, evenly from 0 to end")
    repeats: int = Field(3, ge=1, le=1000, description="timed runs of each; the fastest counts")


class CompareIntegrators(ResultTask):
    """The task ``[work_precision]``."""

    name = "work_precision"
    kind = "dalembert.multibody:WorkPrecision"
    rank = 8
    schema = WorkPrecisionTable
    needs = (needs_mechanism,)

    def keys(self) -> dict[str, Any]:
        series = completed(SeriesTable, solver=(solver(), ...))
        described = Field(description="two fine ones: the second says how good the first is")
        return {"series": (list[series], Field(min_length=1)), "reference": (pair(solver()), described)}

    def wrong(self, file: Any) -> list[str]:
        several = repeated(series.label for series in file.work_precision.series)
        wrong = [
            f"[[work_precision.series]]: {label!r} names {count} series; give each a name"
            for label, count in several.items()
        ]
        if file.model.forward is not None:
            wrong.append("[work_precision] needs a mechanism; a forward model has no steps")
        return [*wrong, *super().wrong(file)]

    def plan(self, study: Study) -> str:
        from dalembert.multibody import TimeResponse

        table, ends = study.table, np.array([0.0, study.table.end])
        study.require_inputs(table.end)
        for method in table.reference:
            response = TimeResponse(study.builder, study.parameters, table.channels, ends, solver=method.settings())
            with placed("[work_precision], channels"):
                response.channels  # noqa: B018
            response.fingerprint  # noqa: B018 (what cannot be assembled is refused here)
        count = sum(len(series.integrators()) for series in table.series)
        plan = f"compares {len(table.series)} integrators in {count} settings over {table.end:g} s"
        return f"{plan}: {_simulations(table)} simulations"

    def effort(self, study: Study) -> Effort:
        from dalembert.multibody import simulate

        table, end, system = study.table, study.table.end, study.system()
        solvers = [method.settings() for method in table.reference]
        solvers += [method for series in table.series for method in series.integrators()]

        def part(share: float) -> float:
            for method in solvers:
                simulate(system, share * end, method, np.array([share * end]))
            return share

        count, shortest = _simulations(table), min(shortest_of(method, end) for method in solvers)
        return Effort(part, len(solvers), count, count, "the motion with each integrator", shortest)

    def unknowns(self, study: Study) -> tuple[str, ...]:
        return ()

    def result(self, study: Study, emit: Emit) -> Any:
        from dalembert.multibody import work_precision

        table = study.table
        solvers = {series.label: series.integrators() for series in table.series}
        total = sum(map(len, solvers.values()))
        done = 0

        def on_row(row: Any) -> None:
            nonlocal done
            done += 1
            emit("compared", solver=row.settings, error=row.error, seconds=row.seconds, done=done, total=total)

        return work_precision(
            study.system(),
            table.end,
            table.channels,
            solvers,
            reference=[method.settings() for method in table.reference],
            samples=table.samples,
            repeats=table.repeats,
            checkpoint=study.checkpoint,
            on_row=on_row,
        )

    def outcome(self, study: Study, comparison: Any) -> Outcome:
        """Outcome of a comparison, with the smallest error."""
        errors = [row.error for row in comparison.rows if not row.failure]
        return Outcome(study, comparison, {"values": {"smallest error": min(errors)}} if errors else {})


def _simulations(table: Any) -> int:
    """Timed runs, one more of each that is not, and the references."""
    return sum(len(series.integrators()) for series in table.series) * (table.repeats + 1) + len(table.reference)
