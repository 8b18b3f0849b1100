"""Models that fail in a part of the search box, or everywhere, under the interval inverse problems."""

import re

import numpy as np
import pytest

from conclusions import codes, only
from dalembert.errors import SolveError
from dalembert.forward import PythonModel
from dalembert.inverse import GlobalSurrogate, Nested, identify_bands, identify_set
from dalembert.optimize import ParticleSwarm
from dalembert.surrogate import Adaptive, Tensor, TotalDegree
from small_models import DECAY, TIMES, banded, measured

BANDS = banded(DECAY, [1.8, 0.7], [2.2, 0.9], points=2)
DATA = measured(DECAY, [2.0, 0.8])


def model(function):
    return PythonModel(function, DECAY.parameters, ["x"], TIMES)


PLACE = r"\(test_failing_models_of_intervals.py, line \d+\)"


def in_a_corner(size, rate):
    if size > 3.5 and rate < 0.6:
        raise RuntimeError("out of reach")
    return DECAY.function(size, rate)


def everywhere(size, rate):
    raise RuntimeError("out of order")


def test_least_squares_surrogates_do_without_failed_runs():
    fit = identify_bands(model(in_a_corner), BANDS, method=GlobalSurrogate(TotalDegree(6)))
    np.testing.assert_allclose(fit.box.lower, [1.8, 0.7], rtol=1e-5)
    failed = only(fit, "failed-simulations").values["first"]
    assert re.match(rf"RuntimeError: out of reach {PLACE} \(at size = ", failed)


def test_a_swarm_of_boxes_passes_over_those_that_fail():
    fit = identify_bands(model(in_a_corner), BANDS, method=Nested(ParticleSwarm(20, 60)))
    np.testing.assert_allclose(fit.box.lower, [1.8, 0.7], rtol=0.03)
    assert "failed-simulations" in codes(fit)


@pytest.mark.parametrize("scheme", [Adaptive(1e-2), Tensor(6)])
@pytest.mark.parametrize(
    "inverse",
    [
        lambda scheme: identify_bands(model(in_a_corner), BANDS, method=GlobalSurrogate(scheme)),
        lambda scheme: identify_set(model(in_a_corner), DATA, error=0.05, scheme=scheme),
    ],
    ids=["bands", "set"],
)
def test_schemes_that_need_every_run_say_why_one_failed(inverse, scheme):
    with pytest.raises(SolveError) as error:
        inverse(scheme)
    assert "keep the box away from where the model fails, or use TotalDegree" in str(error.value)
    assert re.search(
        rf"; the model's first failure: RuntimeError: out of reach {PLACE} \(at size = [\d.]+, rate = [\d.]+\)$",
        str(error.value),
    )


@pytest.mark.parametrize("method", [GlobalSurrogate(), GlobalSurrogate(TotalDegree(4)), Nested(ParticleSwarm(5, 3))])
def test_a_model_that_always_fails_ends_with_its_reason(method):
    with pytest.raises(SolveError, match=rf"first failure: RuntimeError: out of order {PLACE} \(at size = "):
        identify_bands(model(everywhere), BANDS, method=method)
    with pytest.raises(SolveError, match=rf"first failure: RuntimeError: out of order {PLACE} \(at size = "):
        identify_set(model(everywhere), DATA, error=0.05)
