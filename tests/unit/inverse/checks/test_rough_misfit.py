"""A misfit that is rough ends the search early; a finding says how close the values are."""

from dataclasses import dataclass

import numpy as np
import pytest

from dalembert.data import Measurements
from dalembert.forward import PythonModel, Responses
from dalembert.inverse import identify

TIMES = np.linspace(0, 5, 41)
DECAY = PythonModel(
    lambda size, rate: size * np.exp(-rate * TIMES), {"size": (0.1, 5.0), "rate": (0.1, 3.0)}, ["x"], TIMES
)


@dataclass(frozen=True)
class Rough:
    """A model whose response has an error that its sensitivities do not know of, as that of coarse steps."""

    model: PythonModel
    size: float

    def __getattr__(self, name):
        return getattr(self.model, name)

    def first(self, samples):
        return Rough(self.model.first(samples), self.size)

    def evaluate(self, vectors):
        values = self.model.evaluate(vectors).values
        return Responses(
            np.array([self.shaken(*pair) for pair in zip(vectors, values, strict=True)]), (None,) * len(values)
        )

    def linearise(self, vector):
        response, jacobian = self.model.linearise(vector)
        return self.shaken(vector, response), jacobian

    def shaken(self, vector, response):
        seed = np.frombuffer(np.asarray(vector, dtype=float).tobytes(), dtype=np.uint32)
        return response + self.size * np.random.default_rng(seed).standard_normal(response.shape)


def fitted(size, seed=0):
    noise = 0.05 * np.random.default_rng(seed).standard_normal(len(TIMES))
    data = Measurements.of(TIMES, {"x": DECAY.function(2.0, 0.8) + noise})
    fit = identify(Rough(DECAY, size), data, starts=1, horizon=None)
    return fit, [finding for finding in fit.findings if finding.code == "rough-misfit"]


def test_a_smooth_misfit_has_no_finding():
    assert fitted(0.0)[1] == []


@pytest.mark.parametrize("seed", range(3))
def test_a_rough_misfit_is_noted_with_how_close_the_values_are(seed):
    smooth, _ = fitted(0.0, seed)
    fit, (finding,) = fitted(1e-3, seed)
    assert fit.success
    apart = np.abs(fit.values - smooth.values)
    assert 0 < finding.values["size"] < 0.01
    assert np.all(apart < 20 * np.array([finding.values["size"], finding.values["rate"]]) + 1e-4)
    assert finding.severity == "note"
    assert finding.values["deviations"] < 0.5
    assert "slip_rate" in finding.advice


def test_exact_data_are_fitted_to_rounding_which_is_no_roughness():
    data = Measurements.of(TIMES, {"x": DECAY.function(2.0, 0.8)})
    assert identify(DECAY, data).findings == ()
