"""Propagate: bounds of the response while parameters are anywhere in their intervals."""

from pathlib import Path
from typing import Any

from pydantic import Field

from dalembert.intervals import Box
from dalembert.study.run.duration import TOGETHER, Effort, evaluated
from dalembert.study.run.events import Emit, teller
from dalembert.study.tables.catalogue import part, propagation_methods
from dalembert.study.tables.dataclass_tables import chosen, settings_of
from dalembert.study.tables.study import Study
from dalembert.study.tasks.requirements import needs_parameters, needs_samples, needs_solver, response, unnamed
from dalembert.study.tasks.task import Outcome, ResultTask
from dalembert.study.text.intervals import IntervalKey
from dalembert.study.text.numbers import Frequencies, Times
from dalembert.study.text.table import StudyTable

DEFAULT, REFERENCE = "chebyshev", "optimise"


class PropagateTable(StudyTable):
    """Bound the response over intervals of the parameters."""

    times: Times | None = Field(None, description="output times of a mechanism: a list, or a range")
    frequencies: Frequencies | None = Field(None, description="of a structure's response: a list, or a range")
    channels: list[str] | None = Field(None, min_length=1, description="outputs of a mechanism or a structure")
    intervals: dict[str, IntervalKey] = Field(
        {}, description="interval of each parameter; that between its bounds if not given"
    )
    method: Any = None
    compare: list[Any] = []
    reference: Any = None
    seed: int = Field(0, ge=0, description="of all random numbers")


class Propagate(ResultTask):
    """The task ``[propagate]``."""

    name = "propagate"
    rank = 4
    schema = PropagateTable
    keeps_responses = True
    needs = (needs_parameters, needs_samples, needs_solver)

    def keys(self) -> dict[str, Any]:
        method = settings_of(propagation_methods(), part)
        reference = Field(None, description="method that the compared ones are measured by")
        return {
            "method": chosen(propagation_methods(), "or a table with kind and settings", part),
            "compare": (list[method], Field([], description="more methods, to be compared on the same box")),
            "reference": (method | None, reference),
        }

    def wrong(self, file: Any) -> list[str]:
        table = file.propagate
        wrong = [*super().wrong(file), *unnamed(table.intervals, file.parameters, "[propagate.intervals]")]
        if table.reference is not None and not table.compare:
            wrong.append("[propagate], reference: nothing is compared; name methods in compare, or leave the key out")
        return wrong

    def plan(self, study: Study) -> str:
        from dalembert.uncertainty.methods import label
        from dalembert.uncertainty.runs import Runs

        model, box = response(study), _box(study)
        costs = []
        for method in _methods(study):
            most = method.most(Runs(model, box, label(method)))
            costs.append(
                f"{label(method)} ({'as many simulations as it asks for' if most is None else f'{most} simulations'})"
            )
        wide = [f"{name} {interval}" for name, interval in box.items()]
        channels = ", ".join(channel.name for channel in model.channels)
        return (
            f"bounds {channels} at {len(model.coordinate.values)} samples over {', '.join(wide)} by {', '.join(costs)}"
        )

    def effort(self, study: Study) -> Effort:
        from dalembert.uncertainty.methods import label
        from dalembert.uncertainty.runs import Runs
        from dalembert.uncertainty.samplings import BATCH, Sampling

        model, box = response(study), _box(study)
        known = [method.most(Runs(model, box, label(method))) for method in _methods(study)]
        count = None if None in known else sum(filter(None, known))
        kept = BATCH if all(isinstance(method, Sampling) for method in _methods(study)) else None
        return evaluated(model, box.middle, count, count, TOGETHER, kept)

    def result(self, study: Study, emit: Emit) -> Any:
        from dalembert.uncertainty import as_record, compare, propagate

        model, box, table = response(study), _box(study), study.table
        *methods, last = _methods(study)
        options: Any = {"seed": table.seed, "on_event": teller(emit, as_record)}
        if table.compare:
            return compare(model, box, methods, reference=last, **options)
        return propagate(model, box, last, **options)

    def load(self, study: Study, path: Path) -> Outcome:
        from dalembert.uncertainty import Comparison, Propagation

        return self.outcome(study, (Comparison if study.table.compare else Propagation).load(path))

    def outcome(self, study: Study, result: Any) -> Outcome:
        """Outcome of bounds, or of methods compared, with the largest width of each channel."""
        bands = getattr(result, "results", (result,))[-1]
        widths = zip(bands.channels, (bands.upper - bands.lower).max(axis=0), strict=True)
        values = {f"width of {channel}": float(width) for channel, width in widths}
        return Outcome(study, result, {"values": values})


def _box(study: Study) -> Box:
    intervals = study.table.intervals
    return Box.of(
        {
            item.name: intervals[item.name].interval() if item.name in intervals else (item.lower, item.upper)
            for item in study.parameters
        }
    )


def _methods(study: Study) -> list[Any]:
    """The method, then those to compare it with, and the reference last where any are compared."""
    kinds, table = propagation_methods(), study.table
    first = kinds[DEFAULT]() if table.method is None else table.method.settings()
    if not table.compare:
        return [first]
    reference = kinds[REFERENCE]() if table.reference is None else table.reference.settings()
    compared = [method.settings() for method in table.compare]
    return [*(method for method in (first, *compared) if method != reference), reference]
