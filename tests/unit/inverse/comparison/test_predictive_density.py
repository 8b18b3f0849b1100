"""Log densities of values that a fit did not see, by the formulas of the normal and of Student's distribution."""

import numpy as np
import pytest
from scipy import stats

from dalembert.inverse.comparison.predictive import log_density


@pytest.mark.parametrize("values", [[0.0], [0.3, -1.2, 0.7]])
def test_a_density_is_that_of_scipy(values):
    square, count = float(np.sum(np.square(values))), len(values)
    normal = stats.multivariate_normal(np.zeros(count), 2.25 * np.eye(count)).logpdf(values)
    assert log_density(square, count, 2.25, None) == pytest.approx(normal, rel=1e-13)
    student = stats.multivariate_t(np.zeros(count), 2.25 * np.eye(count), df=7).logpdf(values)
    assert log_density(square, count, 2.25, 7.0) == pytest.approx(student, rel=1e-13)


def test_without_variance_there_is_no_density():
    assert log_density(1.0, 1, 0.0, None) == -np.inf
