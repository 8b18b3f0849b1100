"""Measurements at other samples, and the operations on gaps and wrapping channels."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from dalembert.data import Measurements, derivative
from dalembert.data.stretches import gaps
from dalembert.errors import DataError

TURN = 2 * np.pi
TIMES = np.array([0.0, 0.1, 0.25, 0.3, 0.5, 0.6, 0.8, 1.0])


def cubic(t):
    return 1 - 2 * t + 3 * t**2 - t**3


def test_a_cubic_is_interpolated_exactly_from_uneven_samples():
    data = Measurements.of(TIMES, {"x": cubic(TIMES), "y": TIMES}, deviations={"x": 0.1, "y": 0.2})
    new = np.linspace(0, 1, 21)
    found = data.resampled(new)
    np.testing.assert_allclose(found.values, np.column_stack([cubic(new), new]), atol=1e-14)
    assert found.coordinate.values.tolist() == new.tolist()
    assert found.deviations.tolist() == [0.1, 0.2]


def test_the_error_of_the_spline_falls_with_the_fourth_power_of_the_step():
    errors = []
    for count in (21, 41, 81):
        times = np.linspace(0, 2, count)
        new = np.linspace(0, 2, 777)
        found = Measurements.of(times, {"x": np.sin(3 * times)}).resampled(new)
        errors.append(np.max(np.abs(found.values[:, 0] - np.sin(3 * new))))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(orders > 3.7), orders


def test_own_samples_give_the_same_values():
    data = Measurements.of(TIMES, {"x": np.sin(9 * TIMES)})
    np.testing.assert_allclose(data.resampled(TIMES).values, data.values, atol=1e-15)


def test_nothing_is_made_up_in_a_gap():
    values = cubic(TIMES)
    values[3:5] = np.nan
    data = Measurements.of(TIMES, {"x": values, "y": TIMES}, missing="leave-out")
    found = data.resampled([0.05, 0.25, 0.27, 0.4, 0.59, 0.6, 0.9])
    assert found.present[:, 0].tolist() == [True, True, False, False, False, True, True]
    assert found.present[:, 1].all()
    np.testing.assert_allclose(found.values[[0, 1], 0], cubic(np.array([0.05, 0.25])), atol=1e-3)  # by a parabola
    assert found.missing == "leave-out"


def test_an_angle_is_interpolated_across_its_jump():
    times = np.linspace(0, 2, 21)
    angle = 3.0 + 4 * times
    data = Measurements.of(times, {"angle": (angle + np.pi) % TURN - np.pi}, wraps=["angle"])
    new = np.linspace(0, 2, 57)
    found = data.resampled(new)
    np.testing.assert_allclose(found.difference((3.0 + 4 * new)[:, None]), 0, atol=1e-12)
    assert np.all(np.abs(found.values) <= np.pi)
    np.testing.assert_allclose(data.continuous[:, 0], angle, atol=1e-12)


def test_gaps_do_not_break_the_winding():
    times = np.linspace(0, 2, 41)
    angle = 3.0 + 4 * times
    wrapped = (angle + np.pi) % TURN - np.pi
    wrapped[::3] = np.nan
    data = Measurements.of(times, {"angle": wrapped}, missing="leave-out", wraps=["angle"])
    turns = (angle[data.present[:, 0]] - data.continuous[data.present]) / TURN
    np.testing.assert_allclose(turns, round(turns[0]), atol=1e-12)


@given(st.lists(st.floats(-50, 50), min_size=2, max_size=12), st.integers(-3, 3))
def test_a_difference_lies_within_half_a_turn_and_knows_no_turns(angles, turns):
    times = np.arange(len(angles))
    angles = np.array(angles)
    data = Measurements.of(times, {"angle": angles, "x": angles}, wraps=["angle"])
    response = np.column_stack([np.cos(times), np.cos(times)])
    difference = data.difference(response)
    assert np.all(np.abs(difference[:, 0]) <= np.pi + 1e-9)
    np.testing.assert_allclose(np.exp(1j * difference[:, 0]), np.exp(1j * (response[:, 0] - angles)), atol=1e-12)
    np.testing.assert_array_equal(difference[:, 1], response[:, 1] - angles)
    further = data.difference(response + turns * TURN)[:, 0]
    np.testing.assert_allclose(np.exp(1j * further), np.exp(1j * difference[:, 0]), atol=1e-12)


@given(
    st.lists(st.booleans(), min_size=8, max_size=8),
    st.lists(st.floats(0, 1), min_size=1, max_size=10, unique=True).map(sorted),
)
def test_a_new_sample_is_there_exactly_where_its_neighbours_are(present, new):
    if np.any(np.diff(new) < 1e-6) or np.any(np.abs(np.subtract.outer(new, TIMES)) < 1e-6):
        return
    values = np.where(present, TIMES, np.nan)
    found = Measurements.of(TIMES, {"x": values}, missing="leave-out").resampled(new)
    right = np.searchsorted(TIMES, new)
    expected = np.array(present)[right - 1] & np.array(present)[right]
    assert found.present[:, 0].tolist() == expected.tolist()
    np.testing.assert_allclose(found.values[expected, 0], np.array(new)[expected], atol=1e-9)


def test_samples_are_cut_and_thinned_with_all_that_belongs_to_them():
    data = Measurements.of(TIMES, {"x": TIMES}, 0.1, missing="leave-out", wraps=["x"])
    for found, times in (
        (data.between(0.1, 0.5), TIMES[1:5]),
        (data.every(3), TIMES[[0, 3, 6]]),
        (data.first(2), TIMES[:2]),
    ):
        assert found.coordinate.values.tolist() == times.tolist()
        assert found.values[:, 0].tolist() == times.tolist()
        assert (found.missing, found.wraps, found.deviations.tolist()) == ("leave-out", ("x",), [0.1])


def test_the_fingerprint_knows_what_wraps():
    data = Measurements.of(TIMES, {"x": TIMES})
    assert data.fingerprint != Measurements.of(TIMES, {"x": TIMES}, wraps=["x"]).fingerprint


DATA = Measurements.of(TIMES, {"x": TIMES})


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        (
            lambda: DATA.resampled([0.5, 1.2]),
            "time 1.2 s lies outside the data, which run from 0 to 1 s; expected samples within; "
            "nothing is known beyond",
        ),
        (
            lambda: DATA.resampled([0.5, 0.2]),
            "sample 1: time 0.2 comes after 0.5; expected values that grow; "
            "sort the samples or remove the repeated one",
        ),
        (lambda: DATA.between(2, 3), "no sample lies from 2 to 3; the time runs from 0 to 1 s"),
        (lambda: DATA.every(0), "every 0 samples; expected at least 1"),
        (
            lambda: Measurements.of(TIMES, {"x": TIMES}, missing="leave"),
            "missing: unknown word 'leave'; did you mean 'leave-out'?",
        ),
        (
            lambda: Measurements.of(TIMES, {"crank.angle": TIMES}, wraps=["crank.angel"]),
            "wraps: unknown channel 'crank.angel'; did you mean 'crank.angle'?",
        ),
    ],
)
def test_what_cannot_be_is_refused(wrong, sentence):
    with pytest.raises(DataError) as error:
        wrong()
    assert str(error.value) == sentence


def test_missing_time_stamps_are_a_gap():
    """49 samples were not stored: no value is invented between those beside them."""
    times = np.delete(np.arange(201) * 0.01, np.arange(60, 109))
    data = Measurements.of(times, {"x": np.sin(3 * times)}, deviations=1e-6)
    found = data.resampled(np.arange(201) * 0.01)
    assert np.flatnonzero(~found.present[:, 0]).tolist() == list(range(60, 109))
    np.testing.assert_allclose(found.values[found.present[:, 0], 0], np.sin(3 * times), atol=1e-12)
    rates = derivative(data, "x").values
    np.testing.assert_allclose(rates, 3 * np.cos(3 * times), atol=1e-3)


@pytest.mark.parametrize("seed", range(5))
def test_uneven_stamps_have_few_gaps(seed):
    """Jittered stamps none, and those of a random process no more than a hundredth."""
    draw = np.random.default_rng(seed)
    jittered = np.arange(1000) + draw.uniform(-0.2, 0.2, 1000)
    assert len(gaps(jittered)) == 0
    assert len(gaps(np.cumsum(draw.exponential(size=1000)))) < 25


def test_the_longest_step_that_is_no_gap_can_be_given():
    times = np.concatenate([np.arange(60), np.arange(109, 201)]) * 0.01
    data = Measurements.of(times, {"x": np.sin(3 * times)}, deviations=1e-6)
    new = np.arange(201) * 0.01
    assert data.resampled(new, gap=0.5).present.all()
    assert data.resampled(new, gap=0.4).present.sum() == 201 - 49
    assert not data.resampled(new[:-1] + 0.005, gap=0.005).present.any()
    whole = data.with_derivative("x", "rate", gap=0.5, window=9)
    assert derivative(data, "x", gap=0.005 + 0.01, window=9).values[59] != whole.values[59, 1]


def test_many_stamps_lost_at_random_are_seen_with_a_given_gap():
    """Where a tenth of the stamps is lost, twice the step is a usual one; a given gap finds each loss."""
    kept = np.random.default_rng(0).random(1000) > 0.1
    kept[[0, -1]] = True
    times = np.arange(1000)[kept] * 0.01
    data = Measurements.of(times, {"x": times})
    found = data.resampled(np.arange(1000) * 0.01, gap=0.015)
    np.testing.assert_array_equal(found.present[:, 0], kept)
