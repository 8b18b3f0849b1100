"""Sample: the posterior distribution of parameters from measured data."""

from functools import partial
from pathlib import Path
from typing import Any

from pydantic import Field

from dalembert.errors import InputError, unknown
from dalembert.kinds import named
from dalembert.study.run.duration import Effort, evaluated
from dalembert.study.run.events import Emit, teller
from dalembert.study.tables.catalogue import part, schemes
from dalembert.study.tables.dataclass_tables import chosen, settings_of
from dalembert.study.tables.experiments import measured_channels
from dalembert.study.tables.posing import posed, unknown_names
from dalembert.study.tables.priors import PriorTable, prior
from dalembert.study.tables.study import Study
from dalembert.study.tasks import assessments
from dalembert.study.tasks.noise import Noise, likelihood_of, noise_of, wrong_noise
from dalembert.study.tasks.requirements import needs_parameters, needs_solver, unmatched, unnamed
from dalembert.study.tasks.task import Outcome, Task, load_further_results
from dalembert.study.text.numbers import Number, read_number
from dalembert.study.text.table import StudyTable

STEPS = 5
"""Gradients of a draw of the No-U-Turn sampler on a nearly round posterior, about: 3 to 7."""


class SampleTable(StudyTable):
    """Draw the parameters from their posterior distribution."""

    sampler: Any = None
    surrogate: Any = None
    chains: int = Field(4, ge=1, description="independent chains")
    draws: int = Field(1000, ge=1, description="draws of each chain that are kept")
    warmup: int = Field(500, ge=1, description="draws of each chain before them")
    seed: int = Field(0, ge=0, description="of all random numbers")
    blocks: int = Field(10, ge=2, description="blocks of each record that comparisons of models leave out")
    weights: dict[str, Number] | None = Field(None, description="weight of each channel; from deviations if not given")
    noise: Noise = Field(
        None,
        description="noise model, or a table: noise whose parameters are sampled too; by default the deviations of the "
        "data, or a constant one for each channel",
    )
    priors: dict[str, PriorTable] = Field(
        {}, description="priors of noise parameters: 'noise.x.deviation'; those of others are in [parameters]"
    )
    start: dict[str, Number] = Field({}, description="where the posterior is large; identified first if not given")
    profile: bool = Field(False, description="whether to make the profile likelihood of each parameter too")


class Sampled(Outcome):
    """A posterior, and profiles if they were asked for."""

    @property
    def summary(self) -> str:
        return "\n\n".join([self.result.summary(), *assessments.summaries(self.further_results)])


class Sample(Task):
    """The task ``[sample]``."""

    name = "sample"
    rank = 3
    schema = SampleTable
    keeps_responses = True
    needs = (needs_parameters, needs_solver)

    def keys(self) -> dict[str, Any]:
        surrogate = settings_of(schemes()) | bool | None
        words = "true, or a scheme: a surrogate proposes the draws, and the model decides; for costly models"
        return {
            "sampler": chosen(samplers(), "or a table with kind and settings; chosen by the model if not given", part),
            "surrogate": (surrogate, Field(None, description=words)),
        }

    def wrong(self, file: Any) -> list[str]:
        wrong, table = super().wrong(file), file.sample
        if file.data is None and not file.experiments:
            wrong.append("[sample] needs a [data] table")
        channels = measured_channels(file)
        if channels:
            wrong += unmatched(table.weights, channels, "weight", "[sample], weights")
        wrong += wrong_noise(table, self.name, channels)
        if table.sampler is not None and table.surrogate and table.sampler.kind != "delayed-acceptance":
            wrong.append(
                f"[sample]: sampler {table.sampler.kind!r} and surrogate are given; a surrogate proposes draws of the "
                "sampler 'delayed-acceptance'. Leave one of the keys out"
            )
        return [*wrong, *unnamed(table.start, file.parameters, "[sample.start]")]

    def plan(self, study: Study) -> str:
        table, names = study.table, unknown_names(study)
        _priors(study, *posed(study))
        least, most = _cost(table, len(names))
        return (
            f"draws {', '.join(names)} from their posterior, {table.chains} chains of {table.warmup} + {table.draws} "
            f"draws, by {least} to {most} simulations"
        )

    def effort(self, study: Study) -> Effort:
        model = assessments.full(posed(study)[0])
        return evaluated(model, model.parameters.start, *_cost(study.table, len(model.parameters)))

    def foresight(self, study: Study) -> int:
        return 2 + len(unknown_names(study))

    def foreseen(self, study: Study) -> tuple[str, ...]:
        return assessments.foreseen(*posed(study))

    def unknowns(self, study: Study) -> tuple[str, ...]:
        return unknown_names(study)

    def run(self, study: Study, emit: Emit) -> Outcome:
        from dalembert.inverse import identify, profile, sample
        from dalembert.inverse.events import as_record

        table, tell = study.table, teller(emit, as_record)
        model, data = posed(study)
        weights = assessments.weights(table.weights, model, data)
        noise = noise_of(table, model, self.name)
        start: Any = {**_starts(model), **table.start} if table.start else None
        further_results = {}
        if table.profile:
            start = identify(model, data, weights=weights, noise=noise, seed=table.seed, start=start, on_event=tell)
            further_results[assessments.PROFILES] = profile(model, data, start, on_event=tell)
        posterior = sample(
            model,
            data,
            weights=weights,
            noise=noise,
            priors=_priors(study, model, data),
            start=start,
            sampler=None if table.sampler is None else table.sampler.settings(),
            surrogate=getattr(table.surrogate, "settings", lambda: table.surrogate)(),
            on_event=tell,
            **table.picked("chains", "draws", "warmup", "seed", "blocks"),
        )
        return _outcome(study, posterior, further_results)

    def load(self, study: Study, path: Path) -> Outcome:
        from dalembert.inverse import Posterior, Profiles

        return _outcome(study, Posterior.load(path), load_further_results(path, {assessments.PROFILES: Profiles}))


def samplers() -> dict[str, type]:
    """Samplers by the names that a study file gives them."""
    from dalembert.inverse.posterior.samplers.sampler import Sampler

    return dict(sorted(named("dalembert.inverse.posterior.samplers", Sampler).items()))


def _starts(model: Any) -> dict[str, float]:
    parameters = assessments.full(model).parameters
    return parameters.mapping(parameters.start)


def _cost(table: Any, parameters: int) -> tuple[int, int]:
    kind = "nuts" if table.sampler is None else table.sampler.kind
    if table.surrogate or kind == "delayed-acceptance":
        return table.chains * table.draws // 2, table.chains * (table.draws + 20) + 2000
    if kind == "affine-invariant":
        count = max(table.chains, 4 * parameters) * (table.draws + table.warmup) * 5
        return count, count
    gradients = table.chains * (table.draws + table.warmup)
    return 2 * gradients * (1 + parameters), 2 * STEPS * gradients * (1 + parameters)


def _priors(study: Study, model: Any, data: Any) -> dict[str, Any]:
    """Priors of noise parameters, by their names."""
    table, where = study.table, "[sample.priors]"
    weights = assessments.weights(table.weights, model, data)
    known = likelihood_of(table, model, data, weights, "sample", open_orders=False).noise_parameters
    items, priors = {item.name: item for item in known}, {}
    for name, table_here in table.priors.items():
        if name not in items:
            raise InputError(unknown("noise parameter", name, items, where))
        item = items[name]
        try:
            priors[name] = prior(table_here, (item.lower, item.upper), partial(_quantity, unit=item.unit or None))
        except InputError as error:
            raise InputError(f"{where}, {name}: {error}") from None
    return priors


def _quantity(value: Any, unit: str | None) -> float:
    return read_number(value, unit)  # pyright: ignore[reportReturnType] - no names are offered to it


def _outcome(study: Study, posterior: Any, further_results: dict[str, Any]) -> Sampled:
    deviations = dict(zip(posterior.parameters.names, posterior.deviations.tolist(), strict=True))
    best = {"values": posterior.estimates, "deviations": deviations}
    return Sampled(study, posterior, best, further_results=further_results)
