import numpy as np
import pytest
from scipy.stats import qmc

from dalembert.latin_hypercube import latin_hypercube


@pytest.mark.parametrize(("directions", "points"), [(0, 3), (1, 1), (3, 8), (8, 3)])
def test_the_points_are_those_of_scipy(directions: int, points: int) -> None:
    ours = latin_hypercube(directions, points, np.random.default_rng((5, 1)))
    theirs = qmc.LatinHypercube(directions, rng=np.random.default_rng((5, 1))).random(points)
    assert ours.shape == (points, directions)
    np.testing.assert_array_equal(ours, theirs)
