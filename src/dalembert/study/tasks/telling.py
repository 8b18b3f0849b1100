"""What an identification tells beyond its values: profiles and predictions beside its result, and a look before it."""

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dalembert.errors import DalembertError

if TYPE_CHECKING:
    from dalembert.inverse import Fit
    from dalembert.inverse.events import OnEvent

PROFILES, PREDICTION = "profiles.nc", "prediction.nc"
"""Names of the files beside the result; of several experiments each has its own prediction, ``prediction-NAME.nc``."""


def beyond(table: Any, model: Any, data: Any, fit: "Fit", on_event: "OnEvent") -> dict[str, Any]:
    """Profiles and prediction of a fit, as far as the table asks for them, by the options of a report."""
    from dalembert.inverse import predict, profile

    told: dict[str, Any] = {}
    if table.profile:
        told["profiles"] = profile(model, data, fit, level=table.level, on_event=on_event)
    if table.prediction:
        several = isinstance(model, list)
        told["prediction"] = (
            {item.name: predict(item, fit, table.level) for item in model}
            if several
            else predict(model, fit, table.level)
        )
    return told


def summaries(told: dict[str, Any]) -> list[str]:
    """Each as text, with the name of its experiment."""
    found = []
    for one in told.values():
        each = one.items() if isinstance(one, dict) else [("", one)]
        found += [f"experiment {name}\n{part.summary()}" if name else part.summary() for name, part in each]
    return found


def save(told: dict[str, Any], result: Path) -> None:
    """Write each beside the result."""
    for name, one in _files(told).items():
        one.save(result.with_name(name))


def _files(told: dict[str, Any]) -> dict[str, Any]:
    """What is kept, by the name of its file."""
    files = {PROFILES: told["profiles"]} if "profiles" in told else {}
    prediction = told.get("prediction", {})
    if not isinstance(prediction, dict):
        return {**files, PREDICTION: prediction}
    return {**files, **{_of(name): one for name, one in prediction.items()}}


def _of(experiment: str) -> str:
    """Name of the file of an experiment's prediction."""
    return PREDICTION.replace(".", f"-{experiment}.")


def load(result: Path, experiments: Iterable[str]) -> dict[str, Any]:
    """What was written beside a result, of experiments by these names."""
    from dalembert.inverse import Prediction, Profiles

    told: dict[str, Any] = {}
    if (path := result.with_name(PROFILES)).is_file():
        told["profiles"] = Profiles.load(path)
    if (path := result.with_name(PREDICTION)).is_file():
        told["prediction"] = Prediction.load(path)
    each = {name: path for name in experiments if (path := result.with_name(_of(name))).is_file()}
    if each:
        told["prediction"] = {name: Prediction.load(path) for name, path in each.items()}
    return told


def foreseen(model: Any, data: Any) -> tuple[str, ...]:
    """Sentences on identifiability, suspected units and friction that does not suit the motion, at the first guesses.

    They are from one simulation with sensitivities, one without, and another one with friction; ``model`` may be
    experiments.
    """
    from dalembert.forward import findings_at
    from dalembert.inverse import identifiability
    from dalembert.inverse.experiments.experiments import joint
    from dalembert.inverse.experiments.suspect_units import first_unit_findings

    if data is None:
        model, data = joint(model)
    try:
        told = identifiability(model, data=data)
    except DalembertError as error:
        return (f"Identifiability could not be computed in advance: {error}",)
    sentences = map(str, told.findings or (told,))
    rubbing = (item for item in findings_at(model, model.parameters.start) if item.code == "slip-rate")
    units = first_unit_findings(model, data)
    return tuple(f"At the first guesses: {sentence}" for sentence in (*sentences, *rubbing, *units))
