"""First-order lags: y with T dy/dt + y = R(t), exact for a piecewise polynomial R, with the derivative by T."""

from math import factorial
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.linalg import solve_banded

if TYPE_CHECKING:
    from scipy.interpolate import BSpline

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)
_SHORT = 1.0  # length relative to T below which moments are taken by quadrature; the recursion cancels there


def lagged(
    spline: "BSpline", knots: np.ndarray, at: np.ndarray, constant: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return lagged columns, their rate, and their derivative by the time constant, each (samples, columns). ``spline``
    (columns,): R; its polynomials change at knots only. y = R at the first knot. ``at`` (samples,): from the first to
    the last knot; ``constant``: T, in the unit of the knots; zero is no lag.

    On a piece that begins at s = 0 with y_0, y(s) = exp(-s/T) y_0 + sum_k c_k s^k m_k(s/T) with R = sum_k c_k s^k and
    m_k(z) = z int_0^1 exp(-z v) (1 - v)^k dv. A bidiagonal system gives y at all knots.

    >>> from scipy.interpolate import make_interp_spline
    >>> knots = np.linspace(0.0, 1.0, 11)
    >>> values, *_ = lagged(make_interp_spline(knots, knots[:, None], k=5), knots, np.array([0.35]), 0.1)
    >>> np.allclose(values, 0.35 - 0.1 * (1 - np.exp(-3.5)))
    True
    """
    if constant == 0:
        rates = spline.derivative()(at)
        return spline(at), rates, -rates
    orders = range(spline.k + 1)
    pieces = np.array([spline.derivative(k)(knots[:-1]) / factorial(k) for k in orders])
    first = spline(knots[:1])
    decay, moments, dmoments = _moments(np.diff(knots) / constant, spline.k)
    driven, ddriven = (_sums(pieces, np.diff(knots), of_kind) for of_kind in (moments, dmoments))
    toward = -np.diff(knots)[:, None] / constant**2  # of s/T by T
    system = np.ones((2, len(knots)))
    system[1, :-1] = -decay
    y = solve_banded((1, 0), system, np.concatenate([first, driven]))
    slopes = toward * (ddriven - decay[:, None] * y[:-1])
    dy = solve_banded((1, 0), system, np.concatenate([0.0 * first, slopes]))
    piece = np.clip(np.searchsorted(knots, at, side="right") - 1, 0, len(knots) - 2)
    since = at - knots[piece]
    decay, moments, dmoments = _moments(since / constant, spline.k)
    driven, ddriven = (_sums(pieces[:, piece], since, of_kind) for of_kind in (moments, dmoments))
    values = decay[:, None] * y[piece] + driven
    by_constant = decay[:, None] * dy[piece] - since[:, None] / constant**2 * (ddriven - decay[:, None] * y[piece])
    return values, (spline(at) - values) / constant, by_constant


def _sums(pieces: np.ndarray, lengths: np.ndarray, moments: np.ndarray) -> np.ndarray:
    """Sums of c_k s^k m_k, (pieces, columns), from the coefficients c (orders, pieces, columns)."""
    powers = lengths ** np.arange(len(pieces))[:, None]
    return np.einsum("kpc,kp->pc", pieces, powers * moments)


def _moments(z: np.ndarray, degree: int) -> tuple[np.ndarray, Any, Any]:
    """exp(-z), and the moments m_0 to m_degree with their derivatives, (orders, pieces)."""
    decay = np.exp(-z)
    nodes, weights = (1 + _NODES) / 2, _WEIGHTS / 2
    powers = (1 - nodes) ** np.arange(degree + 1)[:, None] * weights
    short = np.minimum(z, _SHORT)
    kernel = np.exp(-np.outer(nodes, short))
    moments = powers @ (kernel * short)
    rates = powers @ (kernel * (1 - np.outer(nodes, short)))
    long = np.maximum(z, _SHORT)
    moment, rate = 1 - np.exp(-long), np.exp(-long)
    for k in range(degree + 1):
        if k:
            moment, rate = 1 - k / long * moment, k / long**2 * moment - k / long * rate
        moments[k], rates[k] = np.where(z > _SHORT, moment, moments[k]), np.where(z > _SHORT, rate, rates[k])
    return decay, moments, rates
