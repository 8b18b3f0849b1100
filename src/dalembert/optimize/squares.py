"""The minimisers of sums of squares, which share one call."""

from dalembert.optimize.least_squares import LeastSquares
from dalembert.optimize.response_sensitivity import ResponseSensitivity

Squares = LeastSquares | ResponseSensitivity
"""``minimise(residual, jacobian, lower, upper, start, *, scale, on_iteration)``; settings ``trials``, ``tolerance``,
``gain``."""
