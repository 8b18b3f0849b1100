"""Models that fail in a part of a box: the runs that fail are told, and never take the others down."""

import re

import numpy as np
import pytest

from conclusions import only
from dalembert.errors import InputError, SolveError
from dalembert.forward import PythonModel
from dalembert.surrogate import Tensor
from dalembert.uncertainty import Chebyshev, LatinHypercube, MonteCarlo, Optimise, Scan, compare, propagate
from support import says

TIMES = np.linspace(0, 1, 5)


def broken(load):
    """Buckles above 0.8."""
    if np.real(load) > 0.8:
        raise RuntimeError("buckled")
    return load * TIMES + 1


def ends_early(load):
    return np.where(np.real(load) > 0.8, np.nan, load) * TIMES


def model(function, **options):
    return PythonModel(function, {"load": (0.0, 1.0)}, ["x"], TIMES, **options)


BOX = {"load": (0.0, 1.0)}


@pytest.mark.parametrize("method", [Scan(11), MonteCarlo(200), LatinHypercube(100), Optimise(most_runs=200)], ids=str)
def test_the_bounds_are_those_where_the_model_runs_and_say_so(method):
    bands = propagate(model(broken), BOX, method)
    assert bands.upper[-1, 0] == pytest.approx(1.8, abs=0.02)
    assert np.all(bands.upper <= 1.8 + 1e-12)
    assert np.all(bands.at_upper <= 0.8)
    assert not bands.success
    assert bands.failures
    assert all(
        re.match(r"RuntimeError: buckled \(test_failing_models.py, line \d+\) \(at load = ", reason)
        for reason in bands.failures
    )
    assert only(bands, "failed-runs").values == {"failures": len(bands.failures), "first": bands.failures[0]}


def test_a_response_that_is_not_finite_is_a_failed_run():
    bands = propagate(model(ends_early), BOX, Scan(11))
    assert len(bands.failures) == 2
    assert "not finite" in bands.failures[0]
    assert bands.failures[0].endswith("(at load = 1)")
    assert bands.upper[-1, 0] == pytest.approx(0.8)


@pytest.mark.parametrize("method", ["vertex", "taylor", "latin-hypercube", "optimise"])
def test_a_model_that_never_runs_is_an_error_with_its_reason(method):
    with pytest.raises(SolveError) as error:
        propagate(model(broken), {"load": (0.9, 1.0)}, method)
    told = str(error.value)
    assert told.startswith(f"{method}: all ")
    assert " runs failed, the first: " in told
    assert re.search(r"buckled \(test_failing_models.py, line \d+\) \(at load = 0.9", told)


def test_a_tensor_surrogate_cannot_do_without_a_run():
    with pytest.raises(SolveError, match="failed"):
        propagate(model(broken), BOX, Chebyshev(Tensor(6)))


def test_a_comparison_tells_which_method_gave_no_bounds():
    comparison = compare(model(broken), BOX, [Chebyshev(Tensor(6)), Scan(5)], reference=Optimise(most_runs=100))
    assert [result.kind for result in comparison.results] == ["inner bound", "inner bound"]
    assert [method for method, _ in comparison.refused] == ["chebyshev (scheme=Tensor(order=6))"]


@pytest.mark.parametrize("method", ["taylor", "optimise"])
def test_a_model_that_cannot_be_differentiated_says_what_to_do(method):
    given = model(lambda load: float(np.real(load)) * TIMES)
    line = given.function.__code__.co_firstlineno
    sentence = (
        f"the model's function (test_failing_models.py, line {line}) drops the imaginary part of its parameters, so "
        "its complex-step derivative would be zero; give derivative='central-differences', or make it complex-safe"
    )
    with pytest.raises(InputError, match=says(sentence)):
        propagate(given, BOX, method)
    coarse = propagate(model(given.function, derivative="central-differences"), BOX, method)
    assert coarse.upper[-1, 0] == pytest.approx(1.0, abs=1e-9)
