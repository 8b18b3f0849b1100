"""What an identification tells beyond its values: profiles and predictions beside its result, and a look before it."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from dalembert.errors import DalembertError

if TYPE_CHECKING:
    from dalembert.inverse import Fit
    from dalembert.inverse.events import OnEvent

FILES = {"profiles": "profiles.nc", "prediction": "prediction.nc"}
"""Names of the files beside the result, by the options of a report."""


def beyond(table: Any, model: Any, data: Any, fit: "Fit", on_event: "OnEvent") -> dict[str, Any]:
    """Profiles and prediction of a fit, as far as the table asks for them."""
    from dalembert.inverse import predict, profile

    told: dict[str, Any] = {}
    if table.profile:
        told["profiles"] = profile(model, data, fit, level=table.level, on_event=on_event)
    if table.prediction:
        told["prediction"] = predict(model, fit, table.level)
    return told


def save(told: dict[str, Any], result: Path) -> None:
    """Write each beside the result."""
    for name, one in told.items():
        one.save(result.with_name(FILES[name]))


def load(result: Path) -> dict[str, Any]:
    """What was written beside a result."""
    from dalembert.inverse import Prediction, Profiles

    kinds: dict[str, Any] = {"profiles": Profiles, "prediction": Prediction}
    paths = {name: result.with_name(file) for name, file in FILES.items()}
    return {name: kinds[name].load(path) for name, path in paths.items() if path.is_file()}


def foreseen(model: Any, data: Any) -> tuple[str, ...]:
    """Sentences on what the data can tell, from one simulation at the first guesses; ``model`` may be experiments."""
    from dalembert.inverse import identifiability
    from dalembert.inverse.experiments import joint

    if data is None:
        model, data = joint(model)
    try:
        told = identifiability(model, data=data)
    except DalembertError as error:
        return (f"What the data can tell could not be foreseen: {error}",)
    sentences = told.sentences or ("The data tell every parameter, and tell them apart.",)
    return tuple(f"At the first guesses: {sentence}" for sentence in sentences)
