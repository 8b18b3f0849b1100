"""Sums of contact forces that are corrected at events between samples: their accuracy, their exact derivatives."""

import numpy as np
import pytest

from dalembert.vibration.contact_sums import EventSums, PlainSums, Shape, contact_sums
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.friction_law import SEPARATED, SLIPPING, STUCK

ORDERS = tuple(range(6))
SLIDER, PRESSED, STOP = Shape(1, False, True), Shape(1, True, True), Shape(0, True, True)
CLIPPED, LIFTED = Shape(1, False, False), Shape(1, True, False)
SHAPES = {"slider": SLIDER, "pressed slider": PRESSED, "stop": STOP, "clipped": CLIPPED, "clipped and pressed": LIFTED}
NUMBERS = np.array([[2.0, 3.0, 0.1, 0.5, 0.4]])
SERIES = Fourier(ORDERS, 64)


def motion(shape: Shape, size: float = 1.0, seed: int = 0) -> np.ndarray:
    values = np.random.default_rng(seed).normal(size=(1, shape.columns, 2 * len(ORDERS) - 1)) * size
    values[:, :, 3:] *= 0.1  # the first harmonic leads
    return values


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("seed", range(5))
def test_the_error_falls_with_the_fifth_power_of_the_interval_and_is_below_1e6_with_128_samples(name, seed) -> None:
    shape = SHAPES[name]
    place = motion(shape, seed=seed)
    exact, _ = EventSums(NUMBERS, shape, Fourier(ORDERS, 8192)).forces(place)
    errors = [
        np.abs(EventSums(NUMBERS, shape, Fourier(ORDERS, count)).forces(place)[0] - exact).max() / np.abs(exact).max()
        for count in (64, 128, 256, 512)
    ]
    assert errors[1] < 1e-6
    assert errors[3] < 40 * 2.0**-15 * max(errors[0], 1e-10)
    plain, _ = PlainSums(NUMBERS, shape, Fourier(ORDERS, 1024)).forces(place)
    assert np.abs(plain - exact).max() / np.abs(exact).max() > errors[1]


@pytest.mark.parametrize("name", SHAPES)
def test_many_plain_samples_come_to_the_same(name: str) -> None:
    shape = SHAPES[name]
    place = motion(shape)
    series = Fourier(ORDERS, 2**17)
    (corrected, states), (plain, sampled) = (
        sums(NUMBERS, shape, series).forces(place) for sums in (EventSums, PlainSums)
    )
    np.testing.assert_allclose(corrected, plain, atol=1e-5 * np.abs(plain).max())
    assert not shape.tangents or np.mean(states != sampled) < 1e-3


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("size", [0.05, 0.3, 1.0, 10.0])
def test_the_jacobian_is_that_of_the_complex_step(name: str, size: float) -> None:
    shape = SHAPES[name]
    place, sums = motion(shape, size), EventSums(NUMBERS, shape, SERIES)
    force, states, jacobian = sums.with_slopes(place)
    again, others = sums.forces(place)
    np.testing.assert_array_equal(force, again)
    np.testing.assert_array_equal(states, others)
    for column in range(place.size):
        moved = place.astype(complex)
        moved[0].reshape(-1)[column] += 1e-30j
        exact = sums.forces(moved)[0].imag / 1e-30
        np.testing.assert_allclose(jacobian[0, :, column], exact.ravel(), atol=1e-12 * np.abs(jacobian).max())


def test_all_states_are_met_in_these_tests() -> None:
    found = {
        state
        for size in (0.05, 1.0)
        for state in np.unique(EventSums(NUMBERS, PRESSED, SERIES).forces(motion(PRESSED, size))[1])
    }
    assert found == {SEPARATED, STUCK, SLIPPING}


@pytest.mark.parametrize("name", SHAPES)
def test_derivatives_by_the_numbers_are_those_of_differences(name: str) -> None:
    shape = SHAPES[name]
    place = motion(shape)
    for column in range(5):
        moved = NUMBERS.astype(complex)
        moved[0, column] += 1e-30j
        slope = EventSums(moved, shape, SERIES).forces(place)[0].imag / 1e-30
        up, down = NUMBERS.copy(), NUMBERS.copy()
        up[0, column] += 1e-6
        down[0, column] -= 1e-6
        values = [EventSums(own, shape, SERIES).forces(place)[0] for own in (up, down)]
        np.testing.assert_allclose(slope, (values[0] - values[1]) / 2e-6, atol=1e-7)


@pytest.mark.parametrize("name", ["slider", "stop", "pressed slider"])
def test_derivatives_are_continuous_where_an_event_passes_a_sample(name: str) -> None:
    """Along a line of motions the Jacobian of plain sums jumps at each change of state of a sample."""
    shape = SHAPES[name]
    first, second = motion(shape, seed=1), motion(shape, seed=2)
    lines = np.linspace(0, 0.3, 1501)

    def jumps(sums: type) -> float:
        slopes = np.array([sums(NUMBERS, shape, SERIES).with_slopes(first + part * second)[2] for part in lines])
        steps = np.abs(np.diff(slopes, axis=0)).max(axis=(1, 2, 3))
        return float(steps.max() / np.abs(slopes).max())

    assert jumps(EventSums) < 2e-3
    assert jumps(PlainSums) > 10 * jumps(EventSums)


def test_a_contact_that_touches_between_two_samples_is_seen() -> None:
    series = Fourier((0, 1), 8)
    place = np.array([[[0.0, np.cos(0.4), np.sin(0.4)]]])  # largest at 0.4, between the samples at 0 and π/4
    gap = np.cos(0.3)
    numbers = np.array([[0.0, 1.0, gap, 0.0, 0.0]])
    force, states = EventSums(numbers, STOP, series).forces(place)
    impulse = (2 * np.sin(0.3) - 0.6 * np.cos(0.3)) / (2 * np.pi)
    assert np.all(states == SEPARATED)
    assert force[0, 0, 0] == pytest.approx(impulse, rel=0.05)
    assert PlainSums(numbers, STOP, series).forces(place)[0][0, 0, 0] == 0.0


def test_slip_in_two_directions_is_summed_by_samples() -> None:
    assert isinstance(contact_sums(NUMBERS, Shape(2, True, True), SERIES, True), PlainSums)
    assert isinstance(contact_sums(NUMBERS, SLIDER, SERIES, False), PlainSums)
    assert isinstance(contact_sums(NUMBERS, SLIDER, SERIES, True), EventSums)
