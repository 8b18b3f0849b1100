"""Sums of contact forces that are corrected at events between samples: their accuracy, their exact derivatives."""

import numpy as np
import pytest

from dalembert.vibration.fourier import Fourier
from dalembert.vibration.laws.contact_sums import ContactSums, EventSums, PlainSums, PlaneEventSums, Shape, contact_sums
from dalembert.vibration.laws.friction_law import SEPARATED, SLIPPING, STUCK

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


PLANE, PLANE_HELD = Shape(2, True, True), Shape(2, False, True)
PLANES = {
    "held": (PLANE_HELD, np.array([[2.0, 0.0, 0.0, 0.5, 2.0]])),
    "pressed": (PLANE, np.array([[2.0, 3.0, 0.1, 0.5, 4.0]])),
    "lifts off": (PLANE, NUMBERS),
}


def in_plane(name: str, size: float = 1.0, seed: int = 0) -> tuple[np.ndarray, Shape, np.ndarray]:
    shape, numbers = PLANES[name]
    place = motion(shape, size, seed)
    if name == "pressed":
        place[:, 2] *= 0.2
    return place, shape, numbers


def error(sums: type, case: tuple[np.ndarray, Shape, np.ndarray], count: int, exact: np.ndarray) -> float:
    place, shape, numbers = case
    return np.abs(sums(numbers, shape, Fourier(ORDERS, count)).forces(place)[0] - exact).max() / np.abs(exact).max()


@pytest.mark.parametrize("name", ["held", "pressed"])
@pytest.mark.parametrize("seed", range(4))
def test_in_two_directions_the_error_falls_with_a_power_above_four_and_is_below_1e6(name: str, seed: int) -> None:
    case = place, shape, numbers = in_plane(name, seed=seed)
    exact, states = PlaneEventSums(numbers, shape, Fourier(ORDERS, 4096)).forces(place)
    assert set(np.unique(states)) == {STUCK, SLIPPING}
    errors = [error(PlaneEventSums, case, count, exact) for count in (64, 128, 256, 512)]
    assert errors[1] < 1e-7
    assert errors[3] < errors[0] / 8**4
    assert error(PlainSums, case, 16_384, exact) > 100 * errors[1]


@pytest.mark.parametrize("seed", range(3))
def test_in_two_directions_lift_off_is_as_exact_with_128_samples_as_without_events_with_8192(seed: int) -> None:
    """Where a contact lifts off, the direction of its force is no smooth function of time."""
    case = place, shape, numbers = in_plane("lifts off", seed=seed)
    exact, states = PlaneEventSums(numbers, shape, Fourier(ORDERS, 8192)).forces(place)
    assert set(np.unique(states)) == {SEPARATED, STUCK, SLIPPING}
    corrected = error(PlaneEventSums, case, 128, exact)
    assert corrected < 4e-5
    assert error(PlaneEventSums, case, 512, exact) < corrected / 8
    assert error(PlainSums, case, 128, exact) > 40 * corrected


@pytest.mark.parametrize("name", PLANES)
def test_in_two_directions_many_plain_samples_approach_the_same_with_the_first_order(name: str) -> None:
    case = place, shape, numbers = in_plane(name)
    exact, _ = PlaneEventSums(numbers, shape, Fourier(ORDERS, 4096)).forces(place)
    errors = [error(PlainSums, case, 2**power, exact) for power in (12, 14, 16)]
    assert errors[2] < 4e-5
    np.testing.assert_allclose(np.divide(errors[:2], errors[1:]), 4.0, rtol=0.1)


@pytest.mark.parametrize("name", PLANES)
@pytest.mark.parametrize("size", [0.05, 0.3, 1.0, 10.0])
def test_in_two_directions_the_jacobian_is_that_of_the_complex_step(name: str, size: float) -> None:
    shape, numbers = PLANES[name]
    place, sums = motion(shape, size), PlaneEventSums(numbers, shape, SERIES)
    force, states, jacobian = sums.with_slopes(place)
    again, others = sums.forces(place)
    np.testing.assert_allclose(force, again, rtol=0, atol=1e-12 * np.abs(force).max())
    np.testing.assert_array_equal(states, others)
    for column in range(place.size):
        moved = place.astype(complex)
        moved[0].reshape(-1)[column] += 1e-30j
        exact = sums.forces(moved)[0].imag / 1e-30
        # short slips before a contact lifts off amplify rounding
        np.testing.assert_allclose(jacobian[0, :, column], exact.ravel(), rtol=0, atol=1e-11 * np.abs(jacobian).max())


@pytest.mark.parametrize("name", PLANES)
def test_in_two_directions_derivatives_by_the_numbers_are_those_of_differences(name: str) -> None:
    place, shape, numbers = in_plane(name)
    for column in range(5):
        moved = numbers.astype(complex)
        moved[0, column] += 1e-30j
        slope = PlaneEventSums(moved, shape, SERIES).forces(place)[0].imag / 1e-30
        up, down = numbers.copy(), numbers.copy()
        up[0, column] += 1e-6
        down[0, column] -= 1e-6
        values = [PlaneEventSums(own, shape, SERIES).forces(place)[0] for own in (up, down)]
        np.testing.assert_allclose(slope, (values[0] - values[1]) / 2e-6, atol=1e-7)


def test_motion_along_a_line_is_that_of_one_direction_of_slip() -> None:
    place, turn = motion(PRESSED), 0.7
    plane = np.stack([place[:, 0] * np.cos(turn), place[:, 0] * np.sin(turn), place[:, 1]], axis=1)
    line, states = EventSums(NUMBERS, PRESSED, SERIES).forces(place)
    force, others = PlaneEventSums(NUMBERS, PLANE, SERIES).forces(plane)
    np.testing.assert_array_equal(states, others)
    along = force[:, 0] * np.cos(turn) + force[:, 1] * np.sin(turn)
    np.testing.assert_allclose(along, line[:, 0], rtol=0, atol=1e-5 * np.abs(line).max())
    np.testing.assert_allclose(force[:, 2], line[:, 1], rtol=0, atol=1e-12)


def test_a_slider_on_a_circle_slips_all_the_time() -> None:
    series, radius, limit, stiffness = Fourier((0, 1), 16), 3.0, 1.0, 2.0
    place = radius * np.array([[[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]])
    numbers = np.array([[stiffness, 0.0, 0.0, 0.5, limit / 0.5]])
    force, states = PlaneEventSums(numbers, PLANE_HELD, series).forces(place)
    lag = np.arccos(limit / (stiffness * radius))  # the force leads the displacement; the slider goes on a circle too
    exact = limit * np.array([[0.0, np.cos(lag), -np.sin(lag)], [0.0, np.sin(lag), np.cos(lag)]])
    assert np.all(states == SLIPPING)
    np.testing.assert_allclose(force[0], exact, atol=1e-5)


def test_what_sums_contacts_have() -> None:
    events: dict[tuple[Shape, float], type[ContactSums]] = {
        (PLANE, 0.5): PlaneEventSums,
        (PLANE, 0.0): PlainSums,  # without friction
        (Shape(2, True, False), 0.5): PlainSums,  # forces for displacements
    }
    for (shape, friction), kind in events.items():
        numbers = np.array([[2.0, 3.0, 0.1, friction, 0.4]])
        assert isinstance(contact_sums(numbers, shape, SERIES, True), kind)
        assert isinstance(contact_sums(numbers, shape, SERIES, False), PlainSums)
    assert isinstance(contact_sums(NUMBERS, SLIDER, SERIES, False), PlainSums)
    assert isinstance(contact_sums(NUMBERS, SLIDER, SERIES, True), EventSums)
