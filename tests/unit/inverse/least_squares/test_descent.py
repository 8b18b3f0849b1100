"""What a descent simulates."""

import numpy as np

from dalembert.inverse.least_squares.descent import Memo
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import pose
from small_models import DECAY, measured


def test_the_linearisation_of_an_accepted_point_outlives_a_rejected_trial():
    problem = pose(DECAY, measured(DECAY, [2.0, 1.0], noise=0.01), None, Journal(41))
    memo = Memo(problem)
    accepted, rejected = problem.search.points(np.array([[2.0, 1.1], [2.1, 0.9]]))
    memo.residual(accepted)
    memo.jacobian(accepted)
    memo.residual(rejected)
    kept = memo.known(problem.search.vectors(accepted))
    assert kept is not None
    np.testing.assert_allclose(kept.vector, [2.0, 1.1])
    assert problem.journal.simulations == 6
    assert memo.known(np.array([3.0, 1.0])) is None


def test_a_point_ahead_has_no_sensitivities_and_known_points_cost_nothing():
    """Two parameters: the start costs 3 simulations, the point ahead 1, and the next point 3."""
    problem = pose(DECAY, measured(DECAY, [2.0, 1.0], noise=0.01), None, Journal(41))
    memo = Memo(problem)
    accepted, ahead, following = problem.search.points(np.array([[2.0, 1.1], [2.01, 1.09], [2.1, 0.9]]))
    memo.residual(accepted)
    memo.jacobian(accepted)
    first = memo.ahead(ahead)
    assert problem.journal.simulations == 4
    memo.residual(following)
    assert problem.journal.simulations == 7
    memo.residual(accepted)
    memo.jacobian(following)
    assert problem.journal.simulations == 7
    np.testing.assert_array_equal(first, Memo(problem).residual(ahead))
