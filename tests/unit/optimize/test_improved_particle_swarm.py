"""Each published rule of the improved swarm."""

from dataclasses import replace

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.optimize import ImprovedParticleSwarm
from dalembert.optimize.improved_particle_swarm import subset_means

LOWER, UPPER = np.array([0.6, 0.4]), np.array([1.0, 0.65])
GROUP = np.repeat([1, 2, 3], (30, 5, 5))


def bowl(points):
    return np.sum((points - [0.7854, 0.5236]) ** 2, axis=1)


def quiet(swarm, seed=0):
    """A started state whose velocities are zero, so that a move shows the pulls alone."""
    state = swarm.start(bowl, LOWER, UPPER, seed)
    return replace(state, velocities=np.zeros_like(state.velocities))


def test_the_published_settings_are_the_defaults():
    swarm = ImprovedParticleSwarm()
    assert (swarm.particles, swarm.iterations, swarm.sizes) == (40, 100, (30, 5, 5))
    assert (swarm.c1, swarm.c2, swarm.c3, swarm.alpha) == (1, 1, 1, 0.5)
    assert (swarm.quality_misfit, swarm.quality_size) == (0.1, 500)
    assert swarm.inertia == (0.8, pytest.approx(0.1))


@pytest.mark.parametrize(
    ("particles", "sizes"), [(40, (30, 5, 5)), (80, (60, 10, 10)), (10, (8, 1, 1)), (4, (4, 0, 0))]
)
def test_groups_keep_their_shares_for_other_numbers_of_particles(particles, sizes):
    assert ImprovedParticleSwarm(particles=particles).sizes == sizes


def test_the_velocity_limit_is_a_hundredth_of_the_largest_position_or_of_the_width():
    np.testing.assert_allclose(ImprovedParticleSwarm().velocity_bound(LOWER, UPPER), [0.01, 0.0065])
    np.testing.assert_allclose(ImprovedParticleSwarm().velocity_bound(-UPPER, -LOWER), [0.01, 0.0065])
    np.testing.assert_allclose(ImprovedParticleSwarm(span="width").velocity_bound(LOWER, UPPER), [0.004, 0.0025])


def test_inertia_falls_from_0_8_by_0_7_t_over_the_iterations():
    """Where all pulls vanish, what is left of a velocity is ω."""
    swarm = ImprovedParticleSwarm(groups=(40, 0, 0))
    still = lambda points: np.ones(len(points))  # noqa: E731  (nothing is good, so nothing enters the quality set)
    state = swarm.start(still, LOWER, UPPER, seed=0)
    here = np.repeat([[0.8, 0.5]], 40, axis=0)
    for iteration in (1, 50, 99):
        at = replace(state, iteration=iteration, positions=here, personal_best=here)
        left = swarm.advance(at, still).velocities / at.velocities
        np.testing.assert_allclose(left, 0.8 - 0.7 * iteration / 100, rtol=1e-12)


def test_group_1_is_pulled_to_own_best_best_and_quality_set():
    """All three targets at one place: the velocity is (r1 + r2 + r3) times the way to it, in mean 1.5 of it."""
    swarm = ImprovedParticleSwarm(velocity_limit=10.0)
    goal, here = np.array([0.9, 0.6]), np.repeat([[0.7, 0.5]], 40, axis=0)
    state = quiet(swarm)
    pulls = []
    for seed in range(40):
        at = replace(
            state, seed=seed, positions=here, personal_best=np.repeat(goal[None], 40, axis=0), personal_misfit=np.zeros(40),
            quality=goal[None], quality_misfit=np.zeros(1),
        )  # fmt: skip
        pulls.append((swarm.advance(at, bowl).velocities[GROUP == 1]) / (goal - here[0]))
    assert np.min(pulls) >= 0
    assert 2 < np.max(pulls) <= 3
    assert abs(np.mean(pulls) - 1.5) < 0.05
    assert abs(np.var(pulls) - 3 / 12) < 0.02


def test_without_a_quality_set_group_1_has_two_pulls():
    swarm = ImprovedParticleSwarm(velocity_limit=10.0, quality_misfit=-1.0)
    goal, here = np.array([0.9, 0.6]), np.repeat([[0.7, 0.5]], 40, axis=0)
    state = quiet(swarm)
    at = replace(state, positions=here, personal_best=np.repeat(goal[None], 40, axis=0), personal_misfit=np.zeros(40))
    assert len(at.quality) == 0
    pulls = swarm.advance(at, bowl).velocities / (goal - here[0])
    assert np.max(pulls) <= 2


def test_group_2_leaves_the_best_behind_half_the_time():
    """v = (x − best)·r·α lies between 0 and half the way from the best, outwards."""
    swarm = ImprovedParticleSwarm(velocity_limit=10.0)
    state = quiet(swarm)
    outwards = 0
    for seed in range(200):
        at = replace(state, seed=seed)
        part = (swarm.advance(at, bowl).velocities / (at.positions - at.best + 1e-300))[GROUP == 2]
        away = np.all((part >= 0) & (part <= 0.5), axis=1)
        outwards += int(away.sum())
    assert 0.42 < outwards / 1000 < 0.6


def test_group_3_goes_to_the_mean_of_half_the_quality_set_half_the_time():
    """With one position in the set that mean is the position itself, and the velocity stays."""
    swarm = ImprovedParticleSwarm()
    state = swarm.start(bowl, LOWER, UPPER, seed=0)
    lone = np.array([[0.77, 0.51]])
    gathered = 0
    for seed in range(200):
        after = swarm.advance(replace(state, seed=seed, quality=lone, quality_misfit=np.array([0.01])), bowl)
        there = np.all(after.positions == lone, axis=1)
        assert not there[GROUP != 3].any()
        np.testing.assert_array_equal(after.velocities[there], state.velocities[there])
        gathered += int(there.sum())
    assert 0.45 < gathered / 1000 < 0.55


def test_the_quality_set_keeps_the_best_500_positions_below_h():
    swarm = ImprovedParticleSwarm(quality_misfit=0.01)
    visited, state = [], swarm.start(bowl, LOWER, UPPER, seed=0)
    for _ in range(60):
        visited.append(state.positions)
        state = swarm.advance(state, bowl)
    everywhere = bowl(np.concatenate([*visited, state.positions]))
    good = np.sort(everywhere[everywhere < 0.01])
    assert len(good) > 500
    assert state.quality.shape == (500, 2)
    np.testing.assert_array_equal(state.quality_misfit, good[:500])
    np.testing.assert_array_equal(bowl(state.quality), state.quality_misfit)


def test_subset_means_use_the_given_share_without_repetition():
    rows = 2.0 ** np.arange(10)[:, None]
    sums = np.rint(subset_means(np.random.default_rng(0), rows, 0.9, 50) * 9).astype(int)
    left_out = 1023 - sums[:, 0]
    assert set(left_out.tolist()) <= {2**k for k in range(10)}
    assert len(set(left_out.tolist())) > 5


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        (
            lambda: ImprovedParticleSwarm(groups=(30, 5, 6)),
            "ImprovedParticleSwarm: groups (30, 5, 6) hold 41 particles; "
            "expected three sizes that sum to particles = 40",
        ),
        (
            lambda: ImprovedParticleSwarm(span="widths"),
            "ImprovedParticleSwarm: unknown span 'widths'; did you mean 'width'?",
        ),
    ],
)
def test_wrong_settings_are_answered_in_a_sentence(wrong, sentence):
    with pytest.raises(InputError) as error:
        wrong()
    assert str(error.value) == sentence
