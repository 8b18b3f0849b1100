"""Tasks around an identification: populations, profiles and predictions, and a check before it."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dalembert.errors import DalembertError
from dalembert.study.tasks.task import load_further_results

if TYPE_CHECKING:
    from dalembert.inverse import Fit
    from dalembert.inverse.events import OnEvent

POPULATION, PROFILES, PREDICTION = "population", "profiles", "prediction"
"""Names of the files beside the result; of several experiments each has its own prediction, ``prediction-NAME``."""
FORESEEN = ("slip-rate", "harmonics-chosen", "few-harmonics", "unchecked-harmonics")
"""Findings on a model that are known before a run."""


def beyond(table: Any, model: Any, data: Any, fit: "Fit", on_event: "OnEvent") -> dict[str, Any]:
    """Profiles and predictions of a fit, as far as the table asks for them, by the names of their files."""
    from dalembert.inverse import population, predict, profile

    further_results: dict[str, Any] = {}
    if table.population:
        names = None if table.population is True else table.population
        further_results[POPULATION] = population(fit, names, level=table.level)
    if table.profile:
        further_results[PROFILES] = profile(model, data, fit, level=table.level, on_event=on_event)
    if table.prediction:
        each = {_of(item.name): item for item in model} if isinstance(model, list) else {PREDICTION: model}
        further_results |= {name: predict(model_here, fit, table.level) for name, model_here in each.items()}
    return further_results


def summaries(further_results: Mapping[str, Any]) -> list[str]:
    """Each as text, with the name of its experiment."""
    each = {name: name.partition("-")[2] for name in further_results}
    return [f"experiment {each[name]}\n" * bool(each[name]) + part.summary() for name, part in further_results.items()]


def reported(further_results: Mapping[str, Any]) -> list[Any]:
    """What a report takes: predictions of several experiments together."""
    several = {name.partition("-")[2]: result for name, result in further_results.items() if "-" in name}
    return [*(result for name, result in further_results.items() if "-" not in name), *([several] if several else [])]


def _of(experiment: str) -> str:
    return f"{PREDICTION}-{experiment}"


def load(result: Path, experiments: Iterable[str]) -> dict[str, Any]:
    """What was written beside a result, of experiments by these names."""
    from dalembert.inverse import Population, Prediction, Profiles

    return load_further_results(
        result,
        {POPULATION: Population, PROFILES: Profiles, **dict.fromkeys([PREDICTION, *map(_of, experiments)], Prediction)},
    )


def foreseen(model: Any, data: Any) -> tuple[str, ...]:
    """Sentences on identifiability, suspected units and friction that does not suit the motion, at the first guesses.

    Where harmonics are chosen, their number is among them. They are from one simulation with sensitivities, one
    without, and another one with friction; ``model`` may be experiments.
    """
    from dalembert.forward import findings_at
    from dalembert.inverse import identifiability
    from dalembert.inverse.experiments.experiments import joint
    from dalembert.inverse.plausibility.suspect_units import first_unit_findings

    if data is None:
        model, data = joint(model)
    try:
        report = identifiability(model, data=data)
    except DalembertError as error:
        return (f"Identifiability could not be computed in advance: {error}",)
    sentences = map(str, report.findings or (report,))
    of_model = (item for item in findings_at(model, model.parameters.start) if item.code in FORESEEN)
    units = first_unit_findings(model, data)
    return tuple(f"At the first guesses: {sentence}" for sentence in (*sentences, *of_model, *units))


def full(model: Any) -> Any:
    """The model, or the one that all experiments together are."""
    from dalembert.inverse.experiments.experiments import joint

    return joint(model)[0] if isinstance(model, list) else model


def weights(by_channel: dict[str, float] | None, model: Any, data: Any) -> Any:
    """Weights of channels by name, as identify takes them."""
    if by_channel is None:
        return None
    if data is not None:
        return [by_channel[channel] for channel in data.channels]
    return {item.name: [by_channel[channel] for channel in item.data.channels] for item in model}
