"""SciPy's minimisers by name."""

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.optimize import Minimiser
from dalembert.optimize.minimiser import GLOBAL, GRADIENT, NAMES

LOWER, UPPER, START = [-2.0, -1.0], [2.0, 3.0], [-0.5, 0.5]
ROUGH = {"dual_annealing": {"maxiter": 30}, "basinhopping": {"niter": 5}, "COBYLA": {"tol": 1e-8}, "shgo": {"n": 50}}


def valley(points):
    x, y = points.T
    return (1 - x) ** 2 + 4 * (y - x**2) ** 2


def downhill(point):
    x, y = point
    return np.array([-2 * (1 - x) - 16 * x * (y - x**2), 8 * (y - x**2)])


@pytest.mark.parametrize("name", NAMES)
def test_every_minimiser_finds_the_minimum(name):
    found = Minimiser(name, ROUGH.get(name, {})).minimise(valley, LOWER, UPPER, 0, start=START, gradient=downhill)
    np.testing.assert_allclose(found.x, [1, 1], atol=2e-2)
    assert found.misfit == valley(found.x[None])[0]
    assert found.evaluations > 3


@pytest.mark.parametrize("name", NAMES)
def test_samples_that_fail_end_nothing(name):
    def fragile(points):
        values = valley(points)
        values[points[:, 0] < -1] = np.nan
        return values

    found = Minimiser(name, ROUGH.get(name, {})).minimise(fragile, LOWER, UPPER, 0, start=START, gradient=downhill)
    np.testing.assert_allclose(found.x, [1, 1], atol=2e-2)


@pytest.mark.parametrize("name", ["Nelder-Mead", "differential_evolution"])
def test_when_every_sample_fails_the_result_says_so(name):
    found = Minimiser(name).minimise(lambda points: np.full(len(points), np.nan), LOWER, UPPER, 0)
    assert (found.success, found.misfit, found.message) == (False, np.inf, "every sample failed")


@pytest.mark.parametrize("name", ["differential_evolution", "dual_annealing", "basinhopping"])
def test_a_seed_fixes_every_bit(name):
    one, same = (Minimiser(name, ROUGH.get(name, {})).minimise(valley, LOWER, UPPER, 7) for _ in range(2))
    assert one.x.tobytes() == same.x.tobytes()
    assert one.evaluations == same.evaluations


def test_an_exact_gradient_saves_evaluations():
    without = Minimiser("L-BFGS-B").minimise(valley, LOWER, UPPER, 0, start=START)
    exact = Minimiser("L-BFGS-B").minimise(valley, LOWER, UPPER, 0, start=START, gradient=downhill)
    assert 2 * exact.evaluations < without.evaluations


def test_differential_evolution_asks_for_whole_batches():
    sizes = []

    def counted(points):
        sizes.append(len(points))
        return valley(points)

    Minimiser("differential_evolution", {"maxiter": 5, "polish": False}).minimise(counted, LOWER, UPPER, 0)
    assert sizes == [30] * 6


def test_progress_is_told_at_each_improvement():
    seen = []
    found = Minimiser("Nelder-Mead").minimise(valley, LOWER, UPPER, 0, start=START, on_iteration=seen.append)
    assert np.all(np.diff([one.best for one in seen]) < 0)
    assert seen[-1].best == found.misfit


def test_the_names_are_sorted_into_what_they_need():
    assert not set(GLOBAL) & set(GRADIENT)
    assert Minimiser("differential_EVOLUTION").name == "differential_evolution"


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        (lambda: Minimiser("Nelder-Meat"), "unknown minimiser 'Nelder-Meat'; did you mean 'Nelder-Mead'?"),
        (
            lambda: Minimiser("dual_annealing", {"maxiters": 3}),
            "Minimiser('dual_annealing'): unknown option 'maxiters'; did you mean 'maxiter'?",
        ),
        (
            lambda: Minimiser("Nelder-Mead", {"maxiters": 3}).minimise(valley, LOWER, UPPER, 0),
            "Minimiser('Nelder-Mead'), options {'maxiters': 3}: Unknown solver options: maxiters",
        ),
        (
            lambda: Minimiser("Newton-CG").minimise(valley, LOWER, UPPER, 0),
            "Minimiser('Newton-CG') needs a gradient of its objective; give gradient=, or use 'BFGS'",
        ),
    ],
)
def test_what_cannot_be_meant_is_answered_in_a_sentence(wrong, sentence):
    with pytest.raises(InputError) as error:
        wrong()
    assert str(error.value) == sentence
