"""A disk that has no room for one answer: the method ends, and does not take it for a failed simulation."""

import numpy as np
import pytest

import dalembert as da
from dalembert.errors import StorageError
from dalembert.forward import Checkpoint, Recorded
from dalembert.structure import lumped
from dalembert.vibration import ElasticSlider, FrictionContact, HarmonicForce, VibrationSystem, frequency_responses

TIMES = np.linspace(0.0, 1.0, 11)
VALUES = np.exp(-0.7 * TIMES) + 0.01 * np.sin(20 * TIMES)


class Full(Checkpoint):
    """No room for the answer of a number."""

    def __init__(self, path, number):
        super().__init__(path)
        self.left = number

    def keep(self, key, arrays, seconds=0.0):
        self.left -= 1
        if self.left == 0:
            raise StorageError("no room")
        super().keep(key, arrays, seconds)


def decay(rate, size):
    return size * np.exp(-rate * TIMES)


MODEL = da.PythonModel(decay, {"rate": (0.1, 2.0), "size": (0.5, 2.0)}, ["x"], TIMES)
DATA = da.Measurements.of(TIMES, {"x": VALUES})
BOX = {"rate": da.Interval(0.5, 0.9), "size": da.Interval(0.9, 1.1)}


def profiled(model):
    return da.profile(model, DATA, da.identify(MODEL, DATA))


def family(checkpoint):
    def damped(preload):
        system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.04)]))
        system.add(HarmonicForce("m", 1.0))
        system.add(FrictionContact("damper", "m", friction=0.5, preload=preload, law=ElasticSlider(0.8)))
        return system

    return frequency_responses(damped, "preload", [0.0, 1.0], np.linspace(0.12, 0.25, 5), checkpoint=checkpoint)


KINDS = {
    "least squares": lambda model: da.identify(model, DATA, starts=3),
    "improved swarm": lambda model: da.identify(model, DATA, method=da.ImprovedParticleSwarm(6, 5), seed=0),
    "minimiser": lambda model: da.identify(model, DATA, method=da.Minimiser("L-BFGS-B"), seed=0),
    "profile": profiled,
    "identifiability": lambda model: da.identifiability(model, data=DATA),
    "taylor": lambda model: da.propagate(model, BOX, "taylor"),
    "optimise": lambda model: da.propagate(model, BOX, "optimise"),
    "chebyshev": lambda model: da.propagate(model, BOX, "chebyshev"),
    "compared": lambda model: da.compare(model, BOX, ["taylor", "vertex"], reference="scan"),
    "set": lambda model: da.identify_set(model, DATA, error=0.05),
}


@pytest.mark.parametrize("number", [1, 2, 5])
@pytest.mark.parametrize("kind", KINDS)
def test_no_room_for_one_answer_ends_a_method(kind, number, tmp_path):
    with Full(tmp_path / "checkpoint", number) as checkpoint:
        try:
            KINDS[kind](Recorded(MODEL, checkpoint))
        except StorageError:
            return
        assert checkpoint.left > 0, "it went on without an answer"


@pytest.mark.parametrize("number", [1, 4])
def test_no_room_for_a_point_ends_a_family_of_curves(number, tmp_path):
    with Full(tmp_path / "checkpoint", number) as checkpoint, pytest.raises(StorageError, match="no room"):
        family(checkpoint)
