"""Identify all parameters that are consistent with measurements of bounded error."""

from typing import Any

from pydantic import Field

from dalembert.study.run.duration import TOGETHER, Effort, evaluated
from dalembert.study.run.events import Emit, teller
from dalembert.study.tables.catalogue import schemes
from dalembert.study.tables.dataclass_tables import chosen
from dalembert.study.tables.study import Study
from dalembert.study.tasks.requirements import needs_data, needs_parameters, needs_solver, unmatched, unnamed
from dalembert.study.tasks.task import Outcome, ResultTask
from dalembert.study.text.numbers import Number, NumberOfEach
from dalembert.study.text.table import StudyTable


class IdentifySetTable(StudyTable):
    """Pave the set of all parameters that explain the data within their errors."""

    error: NumberOfEach = Field(description="largest error of the data: a number, or one for each channel")
    scheme: Any = None
    resolution: float | None = Field(
        None, gt=0, lt=1, description="sides of the smallest boxes, as a part of the box around the set"
    )
    most_boxes: int | None = Field(None, ge=1, description="boxes looked at before it ends with a coarser paving")
    seed: int = Field(0, ge=0, description="of all random numbers")
    truth: dict[str, Number] = Field({}, description="parameters that are known, to be marked in the figures")


class IdentifySet(ResultTask):
    """The task ``[identify_set]``."""

    name = "identify_set"
    kind = "dalembert.inverse:ParameterSet"
    rank = 6
    schema = IdentifySetTable
    keeps_responses = True
    needs = (needs_parameters, needs_data, needs_solver)

    def keys(self) -> dict[str, Any]:
        return {"scheme": chosen(schemes(), "or a table of settings")}

    def wrong(self, file: Any) -> list[str]:
        table = file.identify_set
        wrong = super().wrong(file)
        wrong += unnamed(table.truth, file.parameters, "[identify_set.truth]")
        if file.data is not None and isinstance(table.error, dict):
            wrong += unmatched(table.error, file.data.channels, "error", "[identify_set], error")
        return wrong

    def plan(self, study: Study) -> str:
        data = study.data()
        return (
            f"paves the set of {', '.join(study.parameters.names)} that explain {len(data.coordinate.values)} samples "
            f"of {', '.join(data.channels)} within their errors, on a surrogate of as many simulations as it needs"
        )

    def effort(self, study: Study) -> Effort:
        data = study.data()
        model = study.forward(data.channels, data.coordinate.values)
        return evaluated(model, study.parameters.start, None, None, TOGETHER)

    def result(self, study: Study, emit: Emit) -> Any:
        from dalembert.inverse import as_record, identify_set

        data, table = study.data(), study.table

        picked = table.picked("resolution", "most_boxes")
        settings = {key: value for key, value in picked.items() if value is not None}
        if table.scheme is not None:
            settings["scheme"] = table.scheme.settings()
        model = study.forward(data.channels, data.coordinate.values)
        return identify_set(
            model, data, error=table.error, seed=table.seed, on_event=teller(emit, as_record), **settings
        )

    def outcome(self, study: Study, result: Any) -> Outcome:
        """Outcome of a set, with the ends of its outer box."""
        box = result.outer
        ends = () if box is None else ((name, interval) for name, interval in box.items())
        values = {f"{name} {side}": getattr(interval, side) for name, interval in ends for side in ("lower", "upper")}
        return Outcome(study, result, {"values": values}, {"truth": study.table.truth})
