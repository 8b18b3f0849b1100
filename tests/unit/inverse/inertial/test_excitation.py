"""Exciting trajectories: limits at all times, seeds, and a closed form."""

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.inverse.inertial import ExcitingTrajectory, JointLimits, base_parameters, exciting_trajectory
from dalembert.inverse.inertial.fourier_motion import largest_motion
from serial_arm import PLANAR

LIMITS = JointLimits([-1.0, -2.0], [1.5, 0.5], [2.0, 3.0], [8.0, np.inf])


@pytest.mark.parametrize("seed", range(20))
def test_limits_hold_at_all_times_and_one_is_reached(seed):
    shape = np.random.default_rng(seed).uniform(-1, 1, (2, 11))
    motion = largest_motion(shape, 4.0, LIMITS)
    path, velocity, acceleration = motion.motion(np.linspace(0.0, 4.0, 20001))
    assert np.all((path >= LIMITS.lower) & (path <= LIMITS.upper))
    assert np.all(np.abs(velocity) <= LIMITS.velocity)
    assert np.all(np.abs(acceleration) <= LIMITS.acceleration)
    shares = [
        np.ptp(path, axis=0) / (LIMITS.upper - LIMITS.lower),
        np.abs(velocity).max(axis=0) / LIMITS.velocity,
        np.abs(acceleration).max(axis=0) / LIMITS.acceleration,
    ]
    assert np.all(np.max(shares, axis=0) > 0.99)


def test_velocities_and_accelerations_are_derivatives():
    motion = largest_motion(np.random.default_rng(0).uniform(-1, 1, (2, 7)), 3.0, LIMITS)
    times, step = np.linspace(0, 3, 17), 1e-5
    ahead, behind = motion.motion(times + step), motion.motion(times - step)
    now = motion.motion(times)
    np.testing.assert_allclose(now[1], (ahead[0] - behind[0]) / (2 * step), atol=1e-8)
    np.testing.assert_allclose(now[2], (ahead[1] - behind[1]) / (2 * step), atol=1e-7)


def test_inertia_and_damping_of_one_harmonic_are_independent():
    """Columns a and v of one harmonic are orthogonal: condition number 1."""
    found = exciting_trajectory(
        lambda q, v, a: np.stack([a, v], axis=-1), ["inertia", "damping"],
        JointLimits([-1.0], [1.0], [2.0], [9.0]), period=2.0, harmonics=1, criterion="condition", evaluations=20,
    )  # fmt: skip
    assert found.condition == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("criterion", ["D", "condition"])
def test_a_search_is_better_than_random_motions_and_repeats(criterion):
    searches = [
        exciting_trajectory(
            PLANAR.regressor, PLANAR.names, LIMITS, period=5.0, criterion=criterion, evaluations=20, random=3, seed=3
        )
        for _ in range(2)
    ]
    one, two = searches
    np.testing.assert_array_equal(one.motion.sine, two.motion.sine)
    assert one.score < one.usual_score
    assert np.all(np.diff(one.history) <= 0)
    table = PLANAR.regressor(*one.sampled(20.0)[1:])
    assert base_parameters(table, PLANAR.names).rank == 6


def test_a_summary_and_a_stored_result(tmp_path):
    found = exciting_trajectory(PLANAR.regressor, PLANAR.names, LIMITS, period=5.0, evaluations=5, random=3)
    found.save(tmp_path / "path.nc")
    again = ExcitingTrajectory.load(tmp_path / "path.nc")
    assert again.summary() == found.summary()
    assert found.facts()["period"] == "5 s, 5 harmonics"
    assert [one.code for one in again.conclusions] == ["exciting-trajectory"]


@pytest.mark.parametrize(
    ("limits", "message"),
    [
        (([0.0], [1.0, 2.0], [1.0], [1.0]), "JointLimits: the arrays have the shapes (1,), (2,), (1,), (1,); expected (joints,) for all"),
        (([0.0], [np.inf], [1.0], [1.0]), "JointLimits: joint 1 has positions from 0 to inf; expected finite ones, the lower one first"),
        (([0.0], [1.0], [0.0], [1.0]), "JointLimits: joint 1 has a velocity of 0 and an acceleration of 1; expected positive limits"),
    ],
)  # fmt: skip
def test_invalid_limits(limits, message):
    with pytest.raises(InputError) as refused:
        JointLimits(*limits)
    assert str(refused.value) == message


def test_invalid_input():
    with pytest.raises(InputError, match="unknown criterion 'E'; known: D, condition"):
        exciting_trajectory(PLANAR.regressor, PLANAR.names, LIMITS, period=5.0, criterion="E")
    with pytest.raises(InputError, match=r"period 0\.0, harmonics 5, random 20, evaluations 1000; expected a positive"):
        exciting_trajectory(PLANAR.regressor, PLANAR.names, LIMITS, period=0.0)
