import numpy as np

from dalembert.surrogate import Adaptive, fit
from dalembert.surrogate.decay import power, slow_tail


def test_a_geometric_decay_is_not_that_of_a_kink() -> None:
    """Of few degrees its power is as small as that of a kink."""
    shells = 0.5 ** np.arange(9.0)[:, None]
    assert power(shells)[0] < 4
    assert slow_tail(shells)[0] == 0


def test_a_power_of_the_degree_is_a_kink_at_every_order() -> None:
    for order in (8, 20, 60, 200):
        shells = np.append(1.0, np.arange(1.0, order + 1) ** -4.0)[:, None]
        assert slow_tail(shells)[0] > np.sum(np.arange(order + 1.0, 100 * order) ** -4.0)


def test_a_kink_of_the_second_derivative_is_never_worse_than_claimed() -> None:
    """|x − c|³ at 40 random places: a former version was wrong at 14 of them, by up to 10 times the claimed error."""
    x = np.linspace(-1, 1, 2001)
    for seed in range(40):
        place = np.random.default_rng(seed).uniform(-1, 1)
        found = fit(lambda p, c=place: np.abs(p - c) ** 3, [-1], [1], Adaptive(most_runs=120), seed=seed)
        points = np.append(x, place)[:, None]
        assert np.abs(found(points) - np.abs(points - place) ** 3).max() <= found.error[0], place


def test_smooth_functions_take_few_runs_at_a_loose_tolerance() -> None:
    def smooth(p: np.ndarray) -> np.ndarray:
        return 1 / (1 + 3 * (p - 0.3) ** 2)

    found = fit(smooth, [-1], [1], Adaptive(1e-2))
    assert found.runs <= 25  # ten of them are held out
    assert found.error[0] <= 1e-2 * found.scale[0]
