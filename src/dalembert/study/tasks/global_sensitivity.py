"""Global sensitivity and screening: which parameters matter while all vary in their intervals or by their priors."""

from typing import Any

from pydantic import Field

from dalembert.study.run.duration import TOGETHER, Effort, evaluated
from dalembert.study.run.events import Emit, teller
from dalembert.study.tables.catalogue import schemes
from dalembert.study.tables.dataclass_tables import chosen
from dalembert.study.tables.study import Study
from dalembert.study.tasks.requirements import needs_parameters, needs_samples, needs_solver, response, unnamed
from dalembert.study.tasks.task import Outcome, ResultTask
from dalembert.study.text.intervals import IntervalKey
from dalembert.study.text.numbers import Frequencies, Times
from dalembert.study.text.table import StudyTable


class _InputsTable(StudyTable):
    times: Times | None = Field(None, description="output times of a mechanism: a list, or a range")
    frequencies: Frequencies | None = Field(None, description="of a structure's response: a list, or a range")
    channels: list[str] | None = Field(None, min_length=1, description="outputs of a mechanism or a structure")
    intervals: dict[str, IntervalKey] = Field(
        {}, description="interval of a parameter, in which it is uniform; without it its prior, or its bounds"
    )
    seed: int = Field(0, ge=0, description="of all random numbers")


class GlobalSensitivityTable(_InputsTable):
    """Compute the parts of the variance of the response that the parameters cause (Sobol indices)."""

    scheme: Any = None
    tolerance: float = Field(0.02, gt=0, lt=1, description="largest uncertainty of the indices of a whole channel")
    checks: int | None = Field(None, ge=2, description="random simulations that the surrogate is compared with")


class ScreeningTable(_InputsTable):
    """Rank many parameters by their effects on the response, from few simulations (Morris)."""

    trajectories: int = Field(20, ge=2, description="each changes one parameter after the other")
    levels: int = Field(4, ge=2, multiple_of=2, description="of each parameter; an even number")


class _OfInputs(ResultTask):
    """A task that varies the parameters by their distributions."""

    needs = (needs_parameters, needs_samples, needs_solver)

    def wrong(self, file: Any) -> list[str]:
        table = getattr(file, self.name)
        return [*super().wrong(file), *unnamed(table.intervals, file.parameters, f"[{self.name}.intervals]")]

    def intervals(self, study: Study, model: Any) -> dict[str, Any]:
        """Interval or distribution of each parameter."""
        from dalembert.uncertainty.inputs import completed

        intervals = {name: key.interval() for name, key in study.table.intervals.items()}
        return completed(intervals, model, self.name)

    def planned(self, study: Study, what: str) -> str:
        """Sentence on what runs, with the distributions."""
        from dalembert.uncertainty.inputs import inputs_of

        model = response(study)
        inputs = inputs_of(model, self.intervals(study, model), self.name)
        spread = [
            f"{name} {interval}" + ("" if text == "uniform" else f" {text}")
            for (name, interval), text in zip(inputs.box.items(), inputs.texts, strict=True)
        ]
        channels = ", ".join(channel.name for channel in model.channels)
        samples = f"{channels} at {len(model.coordinate.values)} samples"
        return f"{what} {samples} over {', '.join(spread)}"


class GlobalSensitivity(_OfInputs):
    """The task ``[global_sensitivity]``."""

    name = "global_sensitivity"
    rank = 5
    schema = GlobalSensitivityTable
    keeps_responses = True
    kind = "dalembert.uncertainty:SensitivityIndices"

    def keys(self) -> dict[str, Any]:
        return {"scheme": chosen(schemes(), "of the surrogate; adaptive if not given")}

    def plan(self, study: Study) -> str:
        return self.planned(study, "computes Sobol indices of") + " by as many simulations as the surrogate needs"

    def effort(self, study: Study) -> Effort:
        model = response(study)
        return evaluated(model, model.parameters.start, None, None, TOGETHER)

    def result(self, study: Study, emit: Emit) -> Any:
        from dalembert.uncertainty import as_record, global_sensitivity

        model, table = response(study), study.table
        return global_sensitivity(
            model,
            self.intervals(study, model),
            None if table.scheme is None else table.scheme.settings(),
            tolerance=table.tolerance,
            checks=table.checks,
            seed=table.seed,
            on_event=teller(emit, as_record),
        )

    def outcome(self, study: Study, result: Any) -> Outcome:
        """Outcome with the total index of each parameter in each channel."""
        values = {
            f"total index of {name} in {channel}": float(result.aggregated_total[c, p])
            for c, channel in enumerate(result.channels)
            for p, name in enumerate(result.box.names)
        }
        return Outcome(study, result, {"values": values})


class Screening(_OfInputs):
    """The task ``[screening]``."""

    name = "screening"
    rank = 5
    schema = ScreeningTable
    keeps_responses = True
    kind = "dalembert.uncertainty:Screening"

    def plan(self, study: Study) -> str:
        count = study.table.trajectories * (1 + len(study.parameters))
        return self.planned(study, "ranks the effects of the parameters on") + f" by {count} simulations"

    def effort(self, study: Study) -> Effort:
        model, count = response(study), study.table.trajectories * (1 + len(study.parameters))
        return evaluated(model, model.parameters.start, count, count, TOGETHER)

    def result(self, study: Study, emit: Emit) -> Any:
        from dalembert.uncertainty import as_record, screen

        model, table = response(study), study.table
        return screen(
            model,
            self.intervals(study, model),
            trajectories=table.trajectories,
            levels=table.levels,
            seed=table.seed,
            on_event=teller(emit, as_record),
        )

    def outcome(self, study: Study, result: Any) -> Outcome:
        """Outcome with the mean absolute effect of each parameter on each channel."""
        values = {
            f"effect of {name} on {channel}": float(result.aggregated_effects[c, p])
            for c, channel in enumerate(result.channels)
            for p, name in enumerate(result.box.names)
        }
        return Outcome(study, result, {"values": values})
