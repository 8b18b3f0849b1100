"""Settings of an identification, as its provenance keeps them."""

from collections.abc import Mapping
from dataclasses import asdict

import numpy as np

from dalembert.inverse.experiments.experiments import JointModel
from dalembert.inverse.experiments.validation import HeldOut
from dalembert.inverse.noise.likelihood.estimate_noise import NoiseFit
from dalembert.inverse.noise.models.noise_catalogue import as_table
from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.inverse.shooting.shooting import MultipleShooting
from dalembert.stored_fields import encoded


def weights_source(weights: object, smooth: np.ndarray | None, noise: object) -> str:
    """Return where the weights are from."""
    if noise is not None:
        return "noise"
    return "given" if weights is not None else "data" if smooth is None else "smoothed"


def settings(
    loss: str, posed: MisfitProblem, validation: HeldOut, shooting: MultipleShooting | None, settled: NoiseFit | None
) -> dict[str, object]:
    """Settings of the provenance that are not the usual ones."""
    told: dict[str, object] = {}
    if shooting is not None:
        told["shooting"] = asdict(shooting)
    if posed.loss is not None:
        told["loss"] = {"name": loss, "scale": posed.loss.scale}
    if validation is not None:
        told["validation"] = encoded(
            validation if isinstance(validation, float | int | str | Mapping) else list(validation)
        )
    if settled is not None:
        told["noise"] = {channel: as_table(model) for channel, model in settled.noise.models.items()}
    if isinstance(posed.model, JointModel):
        told["experiments"] = [part.name for part in posed.model.parts]
    return told
