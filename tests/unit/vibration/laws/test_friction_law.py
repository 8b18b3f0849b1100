"""The compiled law of dry friction: its states, its memory, its exact tangent."""

import numpy as np
import pytest

from dalembert.vibration.fourier import Fourier
from dalembert.vibration.laws.contact_sums import PlainSums, Shape
from dalembert.vibration.laws.friction_law import SEPARATED, SLIPPING, STUCK

SERIES = Fourier(tuple(range(6)), 64)
NUMBERS = np.array([[2.0, 3.0, 0.1, 0.5, 0.4]])


def forces(samples: np.ndarray, numbers: np.ndarray, *form: int) -> tuple[np.ndarray, np.ndarray]:
    return PlainSums(numbers, Shape(*form), SERIES).at_samples(samples)


def motion(columns: int, size: float, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=(1, columns, SERIES.count)) * size


@pytest.mark.parametrize("memory", [True, False])
@pytest.mark.parametrize(
    ("tangents", "normal", "size", "states"),
    [
        (1, False, 0.01, {STUCK}),
        (1, False, 0.1, {STUCK, SLIPPING}),
        (1, True, 0.01, {STUCK, SLIPPING, SEPARATED}),
        (1, True, 1.0, {SLIPPING, SEPARATED}),
        (2, False, 0.01, {STUCK}),
        (2, False, 0.1, {STUCK, SLIPPING}),
        (2, True, 0.01, {STUCK, SLIPPING}),
        (2, True, 0.1, {STUCK, SLIPPING, SEPARATED}),
    ],
)
def test_the_tangent_is_that_of_the_complex_step_in_every_state(
    tangents: int, normal: bool, size: float, states: set[int], memory: bool
) -> None:
    columns = tangents + normal
    coefficients = motion(columns, size)
    form = (tangents, normal, memory)
    samples = coefficients @ SERIES.synthesis.T
    force, found, jacobian = PlainSums(NUMBERS, Shape(*form), SERIES).tangent(samples)
    assert states <= set(found.ravel().tolist())
    np.testing.assert_array_equal(force, forces(samples, NUMBERS, *form)[0])
    for column in range(columns * SERIES.count):
        moved = coefficients.astype(complex)
        moved[0].reshape(-1)[column] += 1e-30j
        stepped, _ = forces(moved @ SERIES.synthesis.T, NUMBERS.astype(complex), *form)
        exact = (stepped.imag / 1e-30) @ SERIES.analysis.T
        np.testing.assert_allclose(jacobian[0, :, column], exact.ravel(), atol=1e-13 * np.abs(jacobian).max())


@pytest.mark.parametrize("size", [0.01, 0.05, 0.1, 1.0, 10.0])
def test_a_slider_in_one_dimension_is_one_in_two_that_moves_along_a_line(size: float) -> None:
    for seed in range(20):
        samples = motion(1, size, seed) @ SERIES.synthesis.T
        plane = np.concatenate([samples, np.zeros_like(samples)], axis=1)
        force, states, jacobian = PlainSums(NUMBERS, Shape(1, False, True), SERIES).tangent(samples)
        other, expected, exact = PlainSums(NUMBERS, Shape(2, False, True), SERIES).tangent(plane)
        np.testing.assert_array_equal(states, expected)
        np.testing.assert_allclose(force, other[:, :1], atol=1e-13)
        own = slice(SERIES.count)
        np.testing.assert_allclose(jacobian[0], exact[0, own, own], atol=1e-12)


def test_a_slider_that_slips_only_while_the_motion_begins_keeps_its_place_and_its_derivative() -> None:
    """From rest it slips once, and then sticks for good: the derivative must remember the slip."""
    coefficients = np.zeros((1, 1, SERIES.count))
    coefficients[0, 0, :2] = 0.5, 0.05
    samples, numbers = coefficients @ SERIES.synthesis.T, NUMBERS.copy()
    _, states, jacobian = PlainSums(numbers, Shape(1, False, True), SERIES).tangent(samples)
    assert set(states.ravel().tolist()) == {STUCK}
    moved = samples + 1e-30j
    exact = forces(moved, numbers.astype(complex), 1, False, True)[0].imag / 1e-30
    np.testing.assert_allclose(jacobian[0, 0, 0], exact.mean(), atol=1e-13)


def test_full_slip_dissipates_four_times_the_limit_times_the_amplitude_less_the_elastic_part() -> None:
    """Jenkins' loop is a parallelogram of height 2 μN and width 2 (X - μN/k)."""
    amplitude, stiffness, limit = 1.0, 2.0, 0.2
    phases = 2 * np.pi * np.arange(4096) / 4096
    samples = amplitude * np.cos(phases)[None, None]
    force, _ = forces(samples, np.array([[stiffness, 0.0, 0.0, 0.5, 0.4]]), 1, False, True)
    work = np.trapezoid(np.append(force[0, 0], force[0, 0, 0]), np.append(samples[0, 0], samples[0, 0, 0]))
    assert work == pytest.approx(4 * limit * (amplitude - limit / stiffness), rel=1e-5)


def test_friction_in_two_directions_opposes_the_motion_on_a_circle() -> None:
    phases = 2 * np.pi * np.arange(512) / 512
    samples = np.stack([np.cos(phases), np.sin(phases)])[None]
    force, states = forces(samples, np.array([[1e4, 0.0, 0.0, 0.5, 0.4]]), 2, False, True)
    assert set(states.ravel().tolist()) == {SLIPPING}
    velocity = np.stack([-np.sin(phases), np.cos(phases)])
    np.testing.assert_allclose(force[0], 0.2 * velocity, atol=2e-3)
