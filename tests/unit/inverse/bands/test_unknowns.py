"""Middles and radii as one vector, and the boxes that they stand for."""

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.inverse.bands.unknowns import unknowns_of
from dalembert.parameters import Parameters
from support import says

PARAMETERS = Parameters.of({"a": (1.0, 3.0), "b": (1e3, 1e6), "c": (-2.0, 4.0)})


@pytest.mark.parametrize("intervals", [None, ["a", "b", "c"], ["b"], ["c", "a"], []])
def test_a_box_comes_back_from_its_unknowns(intervals):
    unknowns = unknowns_of(PARAMETERS, intervals)
    lower = unknowns.search.points(np.array([1.5, 2e4, -1.0]))
    upper = lower.copy()
    upper[unknowns.chosen] += 0.1
    for end, again in zip((lower, upper), unknowns.ends(unknowns.of(lower, upper)), strict=True):
        np.testing.assert_allclose(again, end, rtol=1e-14)


def test_the_names_say_what_is_unknown():
    assert unknowns_of(PARAMETERS, ["c", "a"]).names == ("a middle", "b middle", "c middle", "a radius", "c radius")


def test_no_unknowns_within_their_bounds_leave_the_search_box():
    unknowns = unknowns_of(PARAMETERS, None)
    random = np.random.default_rng(0).random((1000, 6))
    lower, upper = unknowns.ends(unknowns.lower + (unknowns.upper - unknowns.lower) * random)
    assert np.all(unknowns.search.lower <= lower)
    assert np.all(lower <= upper)
    assert np.all(upper <= unknowns.search.upper)
    assert np.any(lower == unknowns.search.lower)


@pytest.mark.parametrize("seed", range(5))
def test_slopes_of_the_ends_are_their_differences(seed):
    unknowns = unknowns_of(PARAMETERS, ["a", "c"])
    x = unknowns.lower + (unknowns.upper - unknowns.lower) * np.random.default_rng(seed).random(5)
    steps = 1e-7 * np.eye(5)
    for side, slopes in enumerate(unknowns.slopes(x)):
        differences = (unknowns.ends(x + steps)[side] - unknowns.ends(x - steps)[side]) / 2e-7
        np.testing.assert_allclose(slopes, differences.T, atol=1e-7)


def test_a_region_around_a_box_stays_in_the_search_box_and_tells_when_it_is_left():
    unknowns = unknowns_of(PARAMETERS, None)
    low, high = unknowns.search.lower, unknowns.search.upper
    lower, upper = low.copy(), low + 0.5 * (high - low)
    near = unknowns.around(lower, upper, 0.5, 0.02)
    np.testing.assert_allclose(near.bounds[0], low)
    np.testing.assert_allclose(near.bounds[1], upper + 0.145 * (high - low))
    assert not near.leaves(lower, upper)
    assert near.leaves(lower, near.bounds[1])
    assert unknowns.leaves(lower, upper)
    assert np.all(near.ends(unknowns.upper)[1] <= near.bounds[1])


def test_physical_unknowns_are_those_of_the_box_in_units_of_the_parameters():
    unknowns = unknowns_of(PARAMETERS, ["b"])
    lower, upper = np.array([2.0, 1e4, 0.5]), np.array([2.0, 9e4, 0.5])
    x = unknowns.of(unknowns.search.points(lower), unknowns.search.points(upper))
    np.testing.assert_allclose(unknowns.physical(x), [2.0, 5e4, 0.5, 4e4], rtol=1e-12)


def test_an_unknown_name_is_told_with_the_closest():
    with pytest.raises(InputError, match=says("intervals: unknown parameter 'aa'; did you mean 'a'?")):
        unknowns_of(PARAMETERS, ["aa"])


def test_one_name_that_is_no_list_is_told():
    with pytest.raises(InputError, match=says("intervals is 'a'; expected names in a list, for example ['a']")):
        unknowns_of(PARAMETERS, "a")
