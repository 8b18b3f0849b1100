"""Models around a model: what they do not change they hand on."""

from types import SimpleNamespace

import numpy as np
import pytest

import dalembert as da
from dalembert.forward import clock
from dalembert.forward.wrapped import Wrapped

TIMES = np.linspace(0, 1, 5)
VECTOR = np.array([0.7])
READ = ("parameters", "channels", "coordinate", "fingerprint")
ASKED = {
    "evaluate": lambda model: model.evaluate(VECTOR[None]).values,
    "jacobian": lambda model: model.jacobian(VECTOR),
    "linearise": lambda model: np.concatenate([part.ravel() for part in model.linearise(VECTOR)]),
    "first": lambda model: model.first(3).evaluate(VECTOR[None]).values,
}


@pytest.fixture
def decay():
    return da.PythonModel(lambda rate: np.exp(-rate * TIMES), {"rate": (0.1, 2.0)}, ["x"], TIMES)


@pytest.fixture
def checkpoint(tmp_path):
    with da.Checkpoint(tmp_path / "checkpoint") as checkpoint:
        yield checkpoint


@pytest.fixture(params=["wrapped", "recorded", "distributed", "recorded and distributed"])
def around(request, decay, checkpoint):
    client = SimpleNamespace()  # one vector needs no cluster
    return {
        "wrapped": Wrapped(decay),
        "recorded": da.Recorded(decay, checkpoint),
        "distributed": da.Distributed(decay, client),
        "recorded and distributed": da.Recorded(da.Distributed(decay, client), checkpoint),
    }[request.param]


def test_the_tests_below_ask_all_that_a_model_offers():
    assert {name for name in vars(da.ForwardModel) if not name.startswith("_")} == {*READ, *ASKED}


@pytest.mark.parametrize("name", READ)
def test_it_is_described_as_the_model_is(around, decay, name):
    assert isinstance(around, da.ForwardModel)
    assert getattr(around, name) == getattr(decay, name)


@pytest.mark.parametrize("name", ASKED)
def test_it_answers_as_the_model_does(around, decay, name):
    assert ASKED[name](around).tobytes() == ASKED[name](decay).tobytes()


def test_its_beginning_is_around_the_beginning_of_the_model(around):
    short = around.first(3)
    assert type(short) is type(around)
    assert len(short.coordinate.values) == 3


def test_the_clock_counts_what_was_recalled(decay, checkpoint):
    checkpoint.spared = 100.0
    recorded = da.Recorded(decay, checkpoint)
    assert 99 < clock(Wrapped(recorded)) - clock(decay) < 101
    assert 99 < clock(recorded) - clock(Wrapped(decay)) < 101
