"""The firefly algorithm: standard functions, its move, its three ends, its errors."""

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.optimize import Firefly
from support import says

LOWER, UPPER = np.array([-2.0, -1.0]), np.array([2.0, 3.0])


def sphere(points):
    return np.sum((points - [0.3, 0.7]) ** 2, axis=1)


def rosenbrock(points):
    x, y = points.T
    return (1 - x) ** 2 + 100 * (y - x**2) ** 2


def raised(points):
    """A narrow bowl that no target is below."""
    x, y = points.T
    return 0.01 + (x - 0.3) ** 2 + 3 * (y - 0.7 + 0.5 * x) ** 2


@pytest.mark.parametrize(("function", "x"), [(sphere, [0.3, 0.7]), (rosenbrock, [1, 1]), (raised, [0.3, 0.55])])
def test_minima_of_standard_functions_are_found_in_the_median_of_seeds(function, x):
    found = [Firefly().minimise(function, LOWER, UPPER, seed) for seed in range(9)]
    assert np.median([np.max(np.abs(one.x - x)) for one in found]) < 1e-6
    assert all(one.success for one in found)


def test_units_do_not_matter():
    plain = Firefly().minimise(raised, LOWER, UPPER, seed=1)
    scaled = Firefly().minimise(
        lambda points: raised(points / [1024.0, 0.125]), LOWER * [1024, 0.125], UPPER * [1024, 0.125], 1
    )
    np.testing.assert_array_equal(scaled.x, plain.x * [1024, 0.125])


def test_the_move_is_the_published_formula():
    """Three fireflies on a line; the second generation adds what is remembered of the first."""
    tried = []

    def slope(points):
        tried.append(points[:, 0].copy())
        return points[:, 0]

    Firefly(fireflies=3, generations=3, absorption=2.0).minimise(slope, [0.0], [4.0], seed=4)
    places = tried[0]
    others = places > places.min()
    away = places.min() - places[others]
    memory = 0.7 * np.exp(-2.0 * (away / 4) ** 2) * away
    np.testing.assert_allclose(tried[1], places[others] + memory, rtol=1e-14)
    places = places[others] + memory  # all went down the slope
    away = tried[0].min() - places
    memory = 0.7 * memory + 0.7 * np.exp(-2.0 * (away / 4) ** 2) * away
    np.testing.assert_allclose(tried[2], np.clip(places + memory, 0.0, 4.0), rtol=1e-14)


def test_what_was_refused_is_not_computed_again_and_changes_nothing():
    """A search of whole generations, written out, finds the same place with more evaluations."""
    found = Firefly(resolution=0.0).minimise(raised, LOWER, UPPER, seed=3)
    places = LOWER + (UPPER - LOWER) * np.random.default_rng(3).random((60, 2))
    misfit, memory = raised(places), np.zeros((60, 2))
    for _ in range(999):
        away = places[np.argmin(misfit)] - places
        distance = np.sum((away / (UPPER - LOWER)) ** 2, axis=1, keepdims=True)
        memory = 0.7 * memory + 0.7 * np.exp(-distance) * away
        trial = np.clip(places + memory, LOWER, UPPER)
        better = raised(trial) < misfit
        places[better] = trial[better]
        misfit = raised(places)
    np.testing.assert_array_equal(found.x, places[np.argmin(misfit)])
    assert found.message == f"no firefly moves any more after {found.iterations} generations"
    assert found.evaluations < 60 * found.iterations < 60 * 1000
    coarse = Firefly().minimise(raised, LOWER, UPPER, seed=3)
    assert coarse.evaluations < 0.8 * found.evaluations
    np.testing.assert_allclose(coarse.x, found.x, atol=1e-8)


def test_it_ends_below_its_target_or_after_its_generations():
    found = Firefly(target=1e-3).minimise(sphere, LOWER, UPPER, seed=0)
    assert 0 < found.misfit < 1e-3
    assert found.message == "the misfit fell below the target of 0.001"
    found = Firefly(generations=5).minimise(raised, LOWER, UPPER, seed=0)
    assert (found.iterations, found.message) == (5, "all 5 generations done")


def test_a_seed_fixes_every_bit_and_another_seed_changes_them():
    one, same, other = (Firefly().minimise(raised, LOWER, UPPER, seed).x for seed in (3, 3, 4))
    assert one.tobytes() == same.tobytes()
    assert one.tobytes() != other.tobytes()


def test_the_first_firefly_begins_at_a_given_start():
    found = Firefly(generations=1).minimise(sphere, LOWER, UPPER, seed=0, start=[0.3, 0.7])
    assert found.misfit == 0


def test_failed_samples_are_infinitely_bad_and_a_search_that_finds_none_says_so():
    def fragile(points):
        values = sphere(points)
        values[points[:, 0] < 0] = np.nan
        return values

    assert Firefly().minimise(fragile, LOWER, UPPER, seed=0).misfit < 1e-12
    found = Firefly().minimise(lambda points: np.full(len(points), np.nan), LOWER, UPPER, seed=0)
    assert (found.success, found.misfit, found.message) == (False, np.inf, "every sample failed")


def test_progress_tells_a_best_that_never_rises():
    seen = []
    found = Firefly().minimise(raised, LOWER, UPPER, 0, on_iteration=seen.append)
    assert [one.iteration for one in seen] == list(range(1, len(seen) + 1))
    assert np.all(np.diff([one.best for one in seen]) <= 0)
    assert seen[-1].best == found.misfit


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"fireflies": 0}, "Firefly: fireflies is 0; expected a whole number from 1 to 1e+06"),
        ({"absorption": -1.0}, "Firefly: absorption is -1; expected zero or a positive number"),
        ({"attraction": 0.0}, "Firefly: attraction is 0; expected a positive number"),
        ({"randomness": 1.0}, "Firefly: randomness is 1; expected a number of at least 0 and below 1"),
    ],
)
def test_wrong_settings_are_answered_in_a_sentence(settings, sentence):
    with pytest.raises(InputError, match=says(sentence)):
        Firefly(**settings)
