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
