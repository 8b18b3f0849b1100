"""Noise models by name, and as tables of plain values."""

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from dalembert.errors import InputError, require_known, shown
from dalembert.inverse.noise.models.correlated_noise import AutoregressiveNoise, CorrelatedNoise, OrnsteinUhlenbeckNoise
from dalembert.inverse.noise.models.independent_noise import ConstantNoise, KnownNoise, MixedNoise, ProportionalNoise
from dalembert.inverse.noise.models.noise_model import NoiseModel

MODELS: dict[str, type[NoiseModel]] = {
    kind.name: kind
    for kind in (KnownNoise, ConstantNoise, ProportionalNoise, MixedNoise, AutoregressiveNoise, OrnsteinUhlenbeckNoise)
}


def noise_model(model: object) -> NoiseModel:
    """Return a noise model, from itself or from its name with its defaults."""
    if isinstance(model, str):
        require_known("noise model", model, MODELS, "noise")
        return MODELS[model]()
    if not isinstance(model, NoiseModel):
        hint = f"; write {model.__name__}()" if isinstance(model, type) else ""
        raise InputError(
            f"noise is {shown(model)}; expected a noise model such as ConstantNoise(), its name, or a mapping from "
            f"channels to such models{hint}"
        )
    return model


def as_table(model: NoiseModel) -> dict[str, Any]:
    """Return a noise model as plain values, its name as ``"model"``."""
    values = {part.name: getattr(model, part.name) for part in fields(model)}
    plain = {
        name: as_table(value) if isinstance(value, NoiseModel) else list(value) if isinstance(value, tuple) else value
        for name, value in values.items()
    }
    return {"model": model.name, **plain}


def from_table(table: Mapping[str, Any]) -> NoiseModel:
    """Return the noise model of a table, see :func:`as_table`."""
    values: dict[str, Any] = {
        name: from_table(value) if isinstance(value, Mapping) else tuple(value) if isinstance(value, list) else value
        for name, value in table.items()
        if name != "model"
    }
    require_known("noise model", table.get("model"), MODELS, "noise")
    kind = MODELS[table["model"]]
    for name in values:
        require_known("argument", name, [part.name for part in fields(kind)], f"noise model {kind.name!r}")
    if issubclass(kind, CorrelatedNoise) and isinstance(values.get("deviation"), int | float | tuple):
        values["deviation"] = ConstantNoise(deviation=values["deviation"])
    return kind(**values)
