"""Descents along long curved valleys: Levenberg and Marquardt's steps with geodesic acceleration."""

from typing import NoReturn

import numpy as np

from dalembert.optimize.linear_model import LinearModel
from dalembert.optimize.path import SearchPath
from dalembert.optimize.stopping import Stopping

AHEAD = 0.1  # part of a step at which residuals are computed to see how the valley bends
BENT = 0.75  # largest correction ‖a‖, relative to the step's ‖v‖/2, that a step may have
HARDER, EASIER = 3.0, 5.0  # factors of the squared damping after a rejected and after an accepted step
DAMPING, LEAST = 1e-3, 1e-16  # squared damping at first and at least, relative to the squared largest singular value


def follow_valley(path: SearchPath, start: np.ndarray, stopping: Stopping, shortest: float) -> NoReturn:
    """Descend from ``start`` (parameters,) along a valley; the exception says why the descent ended.

    A step d = v + a/2 follows the geodesic on the surface of responses to second order: with slopes S, residuals r and
    damping μ, (SᵀS + μ²) v = −Sᵀr and (SᵀS + μ²) a = −Sᵀr″, where r″ is the second derivative of r along v. It comes
    from one more residual: r″ ≈ 2/h ((r(x + h v) − r)/h − S v). Steps that bend more than they lead are shortened.
    Parameters are scaled by the largest norms of their columns so far. A step may go uphill where it leads on along the
    valley: (1 − cos β) ‖r(x + d)‖² must not exceed the least sum of squares, with the angle β between v and the last v.
    Source: M. K. Transtrum, J. P. Sethna, Improvements to the Levenberg-Marquardt algorithm for nonlinear least-squares
    minimization, arXiv:1201.5885 (2012).
    """
    low, high, unit = path.problem.low, path.problem.high, path.problem.unit
    x, r = start, path.residual_at(start)
    size, weight, last = np.zeros_like(x), DAMPING, np.zeros_like(x)
    least = float(r @ r)
    while True:
        slopes, down, up = path.slopes_at(x), (low - x) / unit, (high - x) / unit
        stopping.at(r, slopes, down, up)
        # Scales that never shrink (Moré 1978): a column that vanishes on a plateau would let its parameter run away.
        size = np.maximum(size, np.linalg.norm(slopes, axis=0))
        scale = np.where(size > 0, size, 1.0)
        slopes, down, up = slopes / scale, down * scale, up * scale
        # Both damped systems have the matrix SᵀS + μ²: one triangular factor serves the step and its acceleration.
        q, factor = np.linalg.qr(slopes)
        largest = np.linalg.norm(factor, 2)
        while True:
            mu = np.sqrt(max(weight, LEAST)) * largest
            v = _damped(q.T @ r, factor, mu, down, up)
            if np.linalg.norm(v / scale) < shortest:
                raise stopping.at_rest(0.0)
            stopping.tried(path.best)
            ahead = path.residual_at(np.clip(x + AHEAD * unit * v / scale, low, high), ahead=True)
            if np.all(np.isfinite(ahead)):
                # r″ along v from one residual more: 2/h ((r(x + h v) − r)/h − S v).
                bend = 2 / AHEAD * ((ahead - r) / AHEAD - slopes @ v)
                # The correction a/2, between what bounds leave after v.
                half = _damped(q.T @ bend / 2, factor, mu, down - v, up - v)
                if 4 * np.linalg.norm(half) <= BENT * np.linalg.norm(v):
                    point = np.clip(x + unit * (v + half) / scale, low, high)
                    residual = path.residual_at(point)
                    if residual @ residual < r @ r or (1 - _cosine(v, scale * last)) * (residual @ residual) <= least:
                        break
            # Rejected: more damping turns the step to the gradient and shortens it. Delayed gratification: a little up,
            # much down.
            weight *= HARDER
        x, r, weight, last = point, residual, weight / EASIER, v / scale
        least = min(least, float(r @ r))


def _damped(residual: np.ndarray, slopes: np.ndarray, mu: float, down: np.ndarray, up: np.ndarray) -> np.ndarray:
    """Return the step d (parameters,) of least ‖r + S d‖² + μ² ‖d‖² between bounds; every direction counts."""
    size = slopes.shape[1]
    stacked = np.vstack([slopes, mu * np.eye(size)])
    return LinearModel(np.concatenate([residual, np.zeros(size)]), stacked, down, up).step(0.0)


def _cosine(vector: np.ndarray, other: np.ndarray) -> float:
    """Return the cosine of the angle between two vectors; 0 where one is zero."""
    lengths = np.linalg.norm(vector) * np.linalg.norm(other)
    return float(vector @ other / lengths) if lengths > 0 else 0.0
