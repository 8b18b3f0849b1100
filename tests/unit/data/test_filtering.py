"""The low-pass filter of measurements, and decimation."""

import numpy as np
import pytest

from dalembert.data import Measurements, merged
from dalembert.errors import DataError
from support import says

TIMES = np.arange(4000) / 1000.0
MIDDLE = slice(500, -500)


def sine(frequency: float) -> np.ndarray:
    return np.sin(2 * np.pi * frequency * TIMES)


def of(values: np.ndarray, times: np.ndarray = TIMES, **more) -> Measurements:
    return Measurements.of(times, {"x": values}, **more)


@pytest.mark.parametrize("frequency", [5.0, 40.0 / 3, 20.0, 40.0, 60.0])
def test_a_component_keeps_its_share_and_its_phase(frequency: float) -> None:
    found = of(sine(frequency)).filtered(40.0).values[MIDDLE, 0]
    share = 1 / (1 + (frequency / 40.0) ** 8)
    np.testing.assert_allclose(found, share * sine(frequency)[MIDDLE], rtol=0, atol=3e-3)
    if frequency <= 20.0:
        np.testing.assert_allclose(np.abs(found - sine(frequency)[MIDDLE]).max(), 1 - share, rtol=0.05, atol=1e-5)


def test_deviations_are_those_of_the_filtered_noise() -> None:
    noise = np.random.default_rng(0).standard_normal((4000, 20))
    data = Measurements.of(TIMES, {f"x{k}": noise[:, k] for k in range(20)}, deviations=1.0).filtered(40.0)
    np.testing.assert_allclose(np.sqrt(np.mean(data.values[MIDDLE] ** 2)), data.deviations[0], rtol=0.03)


def test_stretches_between_gaps_are_filtered_for_themselves() -> None:
    values = sine(5.0)
    values[1000:1010] = np.nan
    values[3980] = np.nan
    kept = np.r_[0:2000, 2500:4000]
    data = of(values[kept], TIMES[kept], missing="leave-out")
    found = data.filtered(40.0)
    alone = of(values[:1000], TIMES[:1000]).filtered(40.0).values[:, 0]
    np.testing.assert_array_equal(found.values[:1000, 0], alone)
    np.testing.assert_array_equal(np.flatnonzero(np.isnan(found.values[:, 0])), np.r_[1000:1010, 3480:3500])
    moved = values[kept].copy()
    moved[2000:] += 3.0  # behind the gap of stamps
    np.testing.assert_allclose(
        of(moved, TIMES[kept], missing="leave-out").filtered(40.0).values[:2000], found.values[:2000], rtol=1e-12
    )


def test_angles_that_wrap_are_filtered_without_their_jumps() -> None:
    turning = 10.0 * TIMES
    data = of((turning + np.pi) % (2 * np.pi) - np.pi, wraps=["x"]).filtered(40.0)
    np.testing.assert_allclose(data.difference(turning[:, None]), 0, atol=1e-4)
    assert np.abs(data.values).max() <= np.pi


def test_decimation_keeps_what_is_slow_and_removes_what_would_be_aliased() -> None:
    data = of(sine(5.0) + sine(97.0), deviations=0.1).decimated(10)
    assert len(data.values) == 400
    inside = slice(50, -50)
    np.testing.assert_allclose(data.values[inside, 0], sine(5.0)[::10][inside], rtol=0, atol=2e-3)
    assert np.abs(of(sine(5.0) + sine(97.0)).every(10).values[inside, 0] - sine(5.0)[::10][inside]).max() > 0.9
    assert data.deviations[0] < 0.05
    assert of(sine(5.0)).decimated(1).values.shape == (4000, 1)
    np.testing.assert_array_equal(of(sine(5.0)).decimated(10, 20.0).values, of(sine(5.0)).filtered(20.0).values[::10])


def test_channels_of_different_rates_are_filtered_and_decimated_each_on_its_own() -> None:
    """Two records with other stamps, merged; decimation counts the samples of each."""
    slow = np.arange(400) / 100.0 + 0.0003
    parts = [
        of(sine(5.0) + sine(97.0)),
        Measurements.of(slow, {"y": np.sin(2 * np.pi * 2.0 * slow)}),
    ]
    both = merged(parts)
    found = both.filtered(20.0)
    np.testing.assert_array_equal(found.values[both.present[:, 0], 0], parts[0].filtered(20.0).values[:, 0])
    np.testing.assert_array_equal(found.values[both.present[:, 1], 1], parts[1].filtered(20.0).values[:, 0])
    thin = both.decimated(2)
    assert thin.present.sum(axis=0).tolist() == [2000, 200]
    for column, part in enumerate(parts):
        alone = part.decimated(2, 20.0)
        there = thin.present[:, column]
        np.testing.assert_array_equal(thin.coordinate.values[there], alone.coordinate.values)
        np.testing.assert_array_equal(thin.values[there, column], alone.values[:, 0])


def test_decimation_keeps_the_grid_of_samples_over_gaps() -> None:
    values = sine(5.0)
    values[1003] = np.nan
    kept = np.r_[0:2001, 2505:4000]
    found = of(values[kept], TIMES[kept], missing="leave-out").decimated(10)
    np.testing.assert_allclose(found.coordinate.values, np.r_[0:2010:10, 2510:4000:10] / 1000, atol=1e-12)


@pytest.mark.parametrize(
    ("made", "sentence"),
    [
        (
            lambda: of(sine(5.0)).filtered(500.0),
            "the cutoff frequency is 500 Hz and the sampling rate 1000 Hz; expected less than half of it",
        ),
        (lambda: of(sine(5.0)).filtered(-1.0), "the cutoff frequency is -1.0 Hz; expected a positive number"),
        (
            lambda: of(np.zeros(4), [0.0, 0.1, 0.22, 0.32]).filtered(1.0),
            "the samples are not evenly spaced: mostly 0.1 s, and 0.12 s behind 0.1 s; a low-pass filter needs even "
            "ones; resample the data first",
        ),
        (
            lambda: of(sine(5.0)).filtered(0.2),
            "no stretch of samples is as long as the period of the cutoff frequency, 5 s; expected a higher cutoff, or "
            "fewer gaps",
        ),
        (
            lambda: of(sine(5.0)).decimated(10, 60.0),
            "the cutoff frequency is 60 Hz and every 10-th sample a rate of 100 Hz; expected a cutoff of at most half "
            "the rate, since what is faster would appear as a slow motion",
        ),
        (lambda: of(sine(5.0)).decimated(0), "every 0-th sample; expected a whole number of at least 1"),
        (lambda: of(np.zeros(1), [0.0]).filtered(1.0), "there is one sample; a low-pass filter needs several"),
    ],
)
def test_what_cannot_be_filtered_is_refused(made, sentence: str) -> None:
    with pytest.raises(DataError, match=says(sentence)):
        made()
