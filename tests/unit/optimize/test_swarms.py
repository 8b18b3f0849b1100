"""The standard swarm, and what both swarms share: batches, seeds, steps, failed samples."""

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.optimize import ImprovedParticleSwarm, ParticleSwarm

LOWER, UPPER = np.array([-2.0, -1.0]), np.array([2.0, 3.0])


def sphere(points):
    return np.sum((points - [0.3, 0.7]) ** 2, axis=1)


def rosenbrock(points):
    x, y = points.T
    return (1 - x) ** 2 + 100 * (y - x**2) ** 2


SWARMS = [ParticleSwarm(), ImprovedParticleSwarm(), ParticleSwarm(inertia=0.7298, c1=1.49618, c2=1.49618)]


@pytest.mark.parametrize("swarm", SWARMS)
def test_the_minimum_of_a_sphere_is_found_in_the_median_of_seeds(swarm):
    found = [swarm.minimise(sphere, [0.1, 0.4], [0.5, 1.0], seed) for seed in range(5)]
    assert np.median([one.misfit for one in found]) < 1e-12
    assert np.median([np.max(np.abs(one.x - [0.3, 0.7])) for one in found]) < 1e-6


def test_the_minimum_of_rosenbrocks_valley_is_found():
    swarm = ParticleSwarm(iterations=300, inertia=0.7298, c1=1.49618, c2=1.49618, velocity_limit=None)
    found = swarm.minimise(rosenbrock, LOWER, UPPER, seed=0)
    np.testing.assert_allclose(found.x, [1, 1], atol=1e-6)


@pytest.mark.parametrize("swarm", SWARMS)
def test_a_run_costs_one_batch_of_all_particles_an_iteration(swarm):
    batches = []

    def counted(points):
        batches.append(points.shape)
        return sphere(points)

    found = swarm.minimise(counted, LOWER, UPPER, seed=0)
    assert batches == [(40, 2)] * 100
    assert (found.iterations, found.evaluations) == (100, 4000)


@pytest.mark.parametrize("swarm", SWARMS)
def test_a_seed_fixes_every_bit_and_another_seed_changes_them(swarm):
    one, same, other = (swarm.minimise(rosenbrock, LOWER, UPPER, seed).x for seed in (3, 3, 4))
    assert one.tobytes() == same.tobytes()
    assert one.tobytes() != other.tobytes()


@pytest.mark.parametrize("swarm", SWARMS)
def test_stepping_gives_the_bits_of_the_whole_run(swarm):
    state = swarm.start(rosenbrock, LOWER, UPPER, seed=5)
    for _ in range(swarm.iterations - 1):
        state = swarm.advance(state, rosenbrock)
    whole = swarm.minimise(rosenbrock, LOWER, UPPER, seed=5)
    assert state.best.tobytes() == whole.x.tobytes()
    assert state.best_misfit == whole.misfit


@pytest.mark.parametrize("swarm", SWARMS)
def test_failed_samples_are_infinitely_bad_and_end_nothing(swarm):
    def fragile(points):
        values = sphere(points)
        values[points[:, 0] < 0] = np.nan
        values[points[:, 1] < 0] = -np.inf
        values[points[:, 1] > 2] = np.inf
        return values

    found = swarm.minimise(fragile, LOWER, UPPER, seed=0)
    assert found.success
    assert found.misfit < 1e-4


@pytest.mark.parametrize("swarm", SWARMS)
def test_a_swarm_of_which_every_sample_fails_says_so(swarm):
    found = swarm.minimise(lambda points: np.full(len(points), np.nan), LOWER, UPPER, seed=0)
    assert not found.success
    assert found.misfit == np.inf
    assert found.message == "every sample of the swarm failed"


@pytest.mark.parametrize("swarm", SWARMS)
def test_particles_stay_in_the_box_and_under_their_velocity_limit(swarm):
    lower, upper = np.array([0.1, 0.4]), np.array([0.5, 1.0])
    beyond = lambda points: np.sum((points - [0.6, 1.1]) ** 2, axis=1)  # noqa: E731
    state = swarm.start(beyond, lower, upper, seed=1)
    limit = swarm.velocity_bound(lower, upper)
    for _ in range(swarm.iterations - 1):
        state = swarm.advance(state, beyond)
        assert np.all((state.positions >= lower) & (state.positions <= upper))
        assert np.all(np.abs(state.velocities) <= limit)
    if isinstance(swarm, ParticleSwarm):  # the improved one is held back by its quality set
        np.testing.assert_array_equal(state.best, upper)


def test_progress_tells_iteration_evaluations_and_a_best_that_never_rises():
    seen = []
    found = ParticleSwarm(particles=10, iterations=20).minimise(sphere, LOWER, UPPER, 0, on_iteration=seen.append)
    assert [one.iteration for one in seen] == list(range(1, 21))
    assert [one.evaluations for one in seen] == list(range(10, 201, 10))
    assert np.all(np.diff([one.best for one in seen]) <= 0)
    assert seen[-1].best == found.misfit


def test_the_first_particle_begins_at_a_given_start():
    state = ParticleSwarm().start(sphere, LOWER, UPPER, seed=0, start=[0.3, 0.7])
    np.testing.assert_array_equal(state.positions[0], [0.3, 0.7])
    assert state.best_misfit == 0


def test_the_standard_move_is_the_textbook_formula():
    """One particle at its own best and one elsewhere: each velocity lies between ω v and ω v + the full pulls."""
    swarm = ParticleSwarm(particles=2, iterations=10, inertia=(0.9, 0.4), velocity_limit=None)
    state = swarm.start(sphere, LOWER, UPPER, seed=2)
    after = swarm.advance(state, sphere)
    inertia = 0.9 - 0.5 * 1 / 10
    pull = (after.velocities - inertia * state.velocities) / (state.best - state.positions + 1e-300)
    leader = int(np.argmin(state.personal_misfit))
    np.testing.assert_allclose(after.velocities[leader], inertia * state.velocities[leader], atol=1e-14)
    assert np.all((pull[1 - leader] >= 0) & (pull[1 - leader] <= 2))


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        (lambda: ParticleSwarm(particles=0), "ParticleSwarm: particles is 0; expected a whole number from 1 to 1e+06"),
        (
            lambda: ImprovedParticleSwarm(iterations=0),
            "ImprovedParticleSwarm: iterations is 0; expected a whole number of at least 1",
        ),
        (
            lambda: ParticleSwarm(velocity_limit=-1.0),
            "ParticleSwarm: velocity_limit is -1; expected a positive number",
        ),
        (
            lambda: ParticleSwarm().minimise(sphere, [1, 1], [0, 2], 0),
            "bounds are [1.0, 1.0] and [0.0, 2.0]; expected two finite vectors of equal length, lower < upper",
        ),
        (
            lambda: ParticleSwarm(particles=3).minimise(lambda points: points, LOWER, UPPER, 0),
            "the objective returned an array of shape (3, 2); expected (3,), one number a point",
        ),
    ],
)
def test_wrong_settings_are_answered_in_a_sentence(wrong, sentence):
    with pytest.raises(InputError) as error:
        wrong()
    assert str(error.value) == sentence
