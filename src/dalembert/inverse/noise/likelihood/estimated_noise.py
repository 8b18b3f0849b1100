"""Noise that was estimated with the parameters of a model."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from dalembert.inverse.noise.correlation.series import Series
from dalembert.inverse.noise.models.noise_catalogue import as_table, from_table
from dalembert.inverse.noise.models.noise_model import NoiseModel
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters
from dalembert.stored_fields import Over, Source, Store, encoded


class _Models:
    """Noise models as settings."""

    def store(self, to: Store, settings: dict[str, Any], name: str, value: Mapping[str, NoiseModel]) -> None:
        settings[name] = {channel: as_table(model) for channel, model in value.items()}

    def load(self, source: Source, settings: Mapping[str, Any], name: str) -> dict[str, NoiseModel]:
        return {channel: from_table(table) for channel, table in settings[name].items()}


class _NoiseParameters:
    """Parameters as settings, and the names of the free ones as a coordinate."""

    def store(self, to: Store, settings: dict[str, Any], name: str, value: Parameters) -> None:
        settings[name] = [encoded(item) for item in value.declared]
        to.coordinates["noise_parameter"] = ("noise_parameter", list(value.names))

    def load(self, source: Source, settings: Mapping[str, Any], name: str) -> Parameters:
        return Parameters(tuple(Parameter(**item) for item in settings[name]))


@dataclass(frozen=True, eq=False)
class EstimatedNoise:
    """Noise models with their estimated parameters.

    Parameters
    ----------
    models : mapping of str to NoiseModel
        By channel, with several experiments ``"NAME.channel"``; orders that were left open are chosen.
    bases : mapping of str to str
        How the names of a channel's noise parameters begin.
    parameters : Parameters
        Of the noise alone.
    values, deviations : array, shape (parameters,)
        Estimated values, and their standard deviations from the restricted likelihood.
    correlation : array, shape (parameters, parameters)
    log_likelihood : float
        Of model and noise, without priors and restriction.
    whitened : array, shape (samples, channels)
        Standardised residuals, less their prediction from those before: N(0, 1) and independent if model and noise are
        right. NaN where a value was not fitted.
    """

    models: Annotated[Mapping[str, NoiseModel], _Models()]
    bases: Mapping[str, str]
    parameters: Annotated[Parameters, _NoiseParameters()]
    values: Annotated[np.ndarray, Over("noise_parameter", name="noise_values")]
    deviations: Annotated[np.ndarray, Over("noise_parameter", name="noise_deviations")]
    correlation: Annotated[np.ndarray, Over("noise_parameter", "noise_parameter_", name="noise_correlation")]
    log_likelihood: float
    whitened: Annotated[np.ndarray, Over("sample", "channel", name="whitened_residuals")]

    @property
    def known(self) -> bool:
        """Return True if no parameter of the noise was estimated."""
        return len(self.parameters) == 0

    @property
    def estimates(self) -> dict[str, float]:
        """Values of noise parameters by name, fixed ones among them."""
        return self.parameters.mapping(self.values)

    def sizes(self, channel: str, response: np.ndarray, given: float | np.ndarray) -> np.ndarray:
        """Return the standard deviation of the noise of a channel at a response, both (samples,).

        ``given`` is the known deviation of the data.
        """
        model, values = self.models[channel], self.of_channel(channel, self.estimates)
        return np.asarray(model.deviations(response, np.broadcast_to(given, response.shape), values))

    def whiten(self, series: Iterable[Series], table: np.ndarray) -> np.ndarray:
        """Return standardised rows (values, ...) of a flat table, each less its prediction from those before."""
        whitened = np.array(table, dtype=float)
        for signal in series:
            whitening = self.models[signal.name].whitening(signal)
            if whitening is not None:
                whitened[signal.rows] = (
                    whitening.matrix(self.of_channel(signal.name, self.estimates)) @ whitened[signal.rows]
                )
        return whitened

    def of_channel(self, channel: str, values: Mapping[str, float]) -> dict[str, np.ndarray]:
        """Return the noise parameters of a channel by their names within its model, out of ``values`` of all."""
        base = f"{self.bases[channel]}."
        named = {name.removeprefix(base): value for name, value in values.items() if name.startswith(base)}
        return {name: np.asarray(value) for name, value in named.items() if "." not in name}
