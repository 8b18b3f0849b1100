"""Identify intervals of parameters from bands of the response."""

from typing import Any

from pydantic import Field

from dalembert.study.run.duration import TOGETHER, Effort, evaluated
from dalembert.study.run.events import Emit, teller
from dalembert.study.tables.catalogue import band_methods, part
from dalembert.study.tables.dataclass_tables import chosen
from dalembert.study.tables.study import Study
from dalembert.study.tasks.requirements import needs_bands, needs_parameters, needs_solver, unmatched, unnamed
from dalembert.study.tasks.task import Outcome, ResultTask
from dalembert.study.text.intervals import IntervalKey
from dalembert.study.text.numbers import Number
from dalembert.study.text.table import StudyTable

DEFAULT = "global"


class IdentifyBandsTable(StudyTable):
    """Identify intervals of the parameters from the bands."""

    method: Any = None
    intervals: list[str] | None = Field(
        None, description="parameters that are intervals; all if not given, the others are identified as numbers"
    )
    weights: dict[str, Number] | None = Field(None, description="weight of each channel; 1 if not given")
    seed: int = Field(0, ge=0, description="of all random numbers")
    truth: dict[str, IntervalKey] = Field({}, description="intervals that are known, to be drawn beside those found")


class IdentifyBands(ResultTask):
    """The task ``[identify_bands]``."""

    name = "identify_bands"
    kind = "dalembert.inverse:BandFit"
    rank = 5
    schema = IdentifyBandsTable
    keeps_responses = True
    needs = (needs_parameters, needs_bands, needs_solver)

    def keys(self) -> dict[str, Any]:
        return {"method": chosen(band_methods(), "or a table of settings", part)}

    def wrong(self, file: Any) -> list[str]:
        table = file.identify_bands
        wrong = super().wrong(file)
        wrong += unnamed(table.intervals or (), file.parameters, "[identify_bands], intervals")
        wrong += unnamed(table.truth, file.parameters, "[identify_bands.truth]")
        if file.bands is not None:
            wrong += unmatched(table.weights, file.bands.columns, "weight", "[identify_bands], weights")
        return wrong

    def plan(self, study: Study) -> str:
        bands, table, names = study.bands(), study.table, study.parameters.names
        wide = names if table.intervals is None else table.intervals
        fixed = [name for name in names if name not in wide]
        numbers = f" and the numbers {', '.join(fixed)}" if fixed else ""
        return (
            f"identifies intervals of {', '.join(wide)}{numbers} from the bands of {', '.join(bands.channels)} at "
            f"{len(bands.coordinate.values)} samples by {_cost(_method(study), len(names))[0]}"
        )

    def effort(self, study: Study) -> Effort:
        bands, (_, count) = study.bands(), _cost(_method(study), len(study.parameters))
        model = study.forward(bands.channels, bands.coordinate.values)
        return evaluated(model, study.parameters.start, count, count, TOGETHER)

    def unknowns(self, study: Study) -> tuple[str, ...]:
        """Middles of all parameters, then radii of those that are intervals."""
        names, wide = study.parameters.names, study.table.intervals
        radii = [name for name in names if wide is None or name in wide]
        return (*(f"{name} middle" for name in names), *(f"{name} radius" for name in radii))

    def result(self, study: Study, emit: Emit) -> Any:
        from dalembert.inverse import as_record, identify_bands

        bands, table = study.bands(), study.table
        return identify_bands(
            study.forward(bands.channels, bands.coordinate.values),
            bands,
            intervals=table.intervals,
            method=_method(study),
            weights=None if table.weights is None else [table.weights[channel] for channel in bands.channels],
            seed=table.seed,
            on_event=teller(emit, as_record),
        )

    def outcome(self, study: Study, fit: Any) -> Outcome:
        """Outcome of identified intervals, with their ends; the known ones are drawn beside them."""
        known = {name: table.interval() for name, table in study.table.truth.items()}
        truth = {name: (interval.lower, interval.upper) for name, interval in known.items()}
        return Outcome(study, fit, {"misfit": fit.misfit, "values": fit.estimates}, {"truth": truth})


def _method(study: Study) -> Any:
    method = study.table.method
    return band_methods()[DEFAULT]() if method is None else method.settings()


def _cost(method: Any, parameters: int) -> tuple[str, int | None]:
    from dalembert.inverse import Nested

    name = type(method).__name__
    if not isinstance(method, Nested):
        return f"{name}: as many simulations as its surrogate needs", None
    swarm, each = method.swarm, method.scheme.runs(parameters)
    count = swarm.particles * swarm.iterations * each
    sizes = f"{swarm.particles} particles x {swarm.iterations} iterations x {each} runs"
    return f"{name}: {sizes} = {count} simulations", count
