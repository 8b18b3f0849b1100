"""Models that answer differently to the same parameters."""

import numpy as np
import pytest

from dalembert.data import Measurements
from dalembert.forward import Checkpoint, PythonModel, Recorded
from dalembert.inverse import identify

TIMES = np.linspace(0, 1, 30)


def restless(size):
    """A decay with noise of a size, another one at each call."""
    draw = np.random.default_rng(0)

    def decay(height, rate):
        return height * np.exp(-rate * TIMES) + size * draw.standard_normal(len(TIMES))

    return PythonModel(decay, {"height": (0.1, 9.0), "rate": (0.1, 9.0)}, ["x"], TIMES)


DATA = Measurements.of(TIMES, {"x": 2 * np.exp(-3 * TIMES) + 0.01 * np.random.default_rng(1).standard_normal(30)})


@pytest.mark.parametrize("size", [1e-2, 1e-6])
def test_a_model_that_answers_differently_is_an_error(size):
    fit = identify(restless(size), DATA, method="Nelder-Mead")
    (found,) = [finding for finding in fit.findings if finding.code == "non-deterministic-model"]
    assert not fit.success
    assert found.severity == "error"
    assert 0 < found.values["difference"] < 10 * size
    assert found.message.startswith("The model is not deterministic: at the same parameters its responses differ by")


def test_a_checkpoint_does_not_hide_it(tmp_path):
    with Checkpoint(tmp_path / "checkpoint") as checkpoint:
        fit = identify(Recorded(restless(1e-2), checkpoint), DATA, method="Nelder-Mead")
    assert "non-deterministic-model" in [finding.code for finding in fit.findings]


def test_a_deterministic_model_is_simulated_once_more():
    asked = []

    def decay(height, rate):
        asked.append((height, rate))
        return height * np.exp(-rate * TIMES)

    model = PythonModel(decay, {"height": (0.1, 9.0), "rate": (0.1, 9.0)}, ["x"], TIMES)
    fit = identify(model, DATA, method="Nelder-Mead")
    assert "non-deterministic-model" not in [finding.code for finding in fit.findings]
    assert asked[-1] == tuple(fit.values)
    assert fit.success
