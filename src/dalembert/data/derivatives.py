"""Derivatives of measured channels by local polynomials, with their error."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial.legendre import legder, legval, legvander

from dalembert.arguments import takes_checked
from dalembert.data.record import Record
from dalembert.data.stretches import stretches
from dalembert.errors import DataError, InputError, unknown

WIDEST = 201
"""Samples of the widest window that is tried."""

STIFF = 1.2
"""How much more than noise polynomials may leave."""

LOOKED_AT = 5000
"""Samples, spread over all, at which windows are compared."""

BLOCK = 1000
"""Samples whose windows are held at once."""


@dataclass(frozen=True, eq=False)
class Derivative:
    """Derivative of a channel along the coordinate.

    Parameters
    ----------
    values : array, shape (samples,)
        In the channel's unit by that of the coordinate; NaN where a run without gaps is too short.
    noise : array, shape (samples,)
        Standard deviation that the channel's noise leaves in each value. Neighbouring values share their noise.
    bias : float
        Root mean square, over the samples, of what the polynomial misses: what one of two degrees more changes, less
        what noise does to that, to two of its standard errors.
    deviation : float
        Standard deviation of the channel's noise: the one given with the data, or else what polynomials over the
        shortest windows leave.
    left : float
        What the polynomials leave, as a standard deviation; more than ``deviation`` where they are too stiff.
    window : int
        Samples that each polynomial is fitted to.
    """

    values: np.ndarray
    noise: np.ndarray
    bias: float
    deviation: float
    left: float
    window: int

    @property
    def error(self) -> float:
        """Root mean square of the whole error, noise and bias."""
        return float(np.sqrt(np.nanmean(self.noise**2) + self.bias**2))


@takes_checked()
def derivative(
    data: Record,
    channel: str,
    *,
    order: int = 1,
    window: int | None = None,
    degree: int = 3,
    gap: float | None = None,
) -> Derivative:
    """Derivative of a channel: that of a polynomial fitted by least squares to the samples around each.

    Parameters
    ----------
    data : Measurements
    channel : str
        One that wraps is taken without its jumps.
    order : int
        1 for a velocity, 2 for an acceleration.
    window : int, optional
        Samples of a polynomial, odd; if not given, that of the least :attr:`Derivative.error` among those whose
        polynomials leave no more than noise.
    degree : int
        Of the polynomial, at least the order.
    gap : float, optional
        Longest step of the coordinate that is no gap; 1.5 times the usual one if not given, as in
        :meth:`Measurements.resampled`.

    Raises
    ------
    DataError
        For a channel that there is not, or without a run of enough samples without gaps.
    InputError
        For an order, a window or a degree that cannot be meant.

    Notes
    -----
    At evenly spaced samples this is the filter of Savitzky & Golay, Analytical Chemistry 36 (1964); it takes uneven
    ones as they are. No window reaches over a gap; near an end or a gap it stays inside and is evaluated off its
    middle, where the noise is several times larger.

    Examples
    --------
    >>> times = np.linspace(0, 1, 101)
    >>> from dalembert.data import Measurements
    >>> data = Measurements.of(times, {"x": np.sin(3 * times)}, deviations=1e-6)
    >>> found = derivative(data, "x")
    >>> bool(np.max(np.abs(found.values - 3 * np.cos(3 * times))) < 5 * found.error), found.error < 1e-3
    (True, True)
    """
    if channel not in data.channels:
        raise DataError(unknown("channel", channel, data.channels, "derivative"))
    least = _check(order, window, degree)
    column = data.channels.index(channel)
    rows = data.taken[:, column]
    along, values = data.coordinate.values[rows], data.continuous[rows, column]
    runs = [
        run for run in stretches(data.present[rows, column], along, gap) if run.stop - run.start >= (window or least)
    ]
    if not runs:
        raise DataError(
            f"channel {channel!r}: fewer than {window or least} samples without a gap; expected at least as many "
            f"for a derivative by polynomials of degree {degree}; take a smaller window or degree"
        )
    step = max(1, len(along) // LOOKED_AT)
    if data.deviations is None:
        deviation = _derivative(along, values, runs, order, least, degree, 0.0, step).left
    else:
        deviation = float(data.deviations[column])
    shortest = min(run.stop - run.start for run in runs)
    windows = [window] if window else _windows(least, min(shortest, WIDEST))
    candidates = [_derivative(along, values, runs, order, size, degree, deviation, step) for size in windows]
    loose = [candidate for candidate in candidates if candidate.left <= STIFF * max(deviation, candidates[0].left)]
    best = min(loose, key=lambda candidate: candidate.error)
    best = best if step == 1 else _derivative(along, values, runs, order, best.window, degree, deviation)
    return replace(best, values=_spread(best.values, rows), noise=_spread(best.noise, rows))


def _spread(values: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Values at all samples, NaN but in some rows (samples,)."""
    spread = np.full(len(rows), np.nan)
    spread[rows] = values
    return spread


def _check(order: int, window: int | None, degree: int) -> int:
    """Fewest samples of a window."""
    if order < 1:
        raise InputError(f"order is {order}; expected at least 1")
    if degree < order:
        raise InputError(f"degree is {degree} for a derivative of order {order}; expected at least the order")
    least = degree + 3 + degree % 2  # odd, and enough for the polynomial of two degrees more that tells the bias
    if window is not None and (window < least or window % 2 == 0):
        raise InputError(f"window is {window}; expected an odd number of at least {least} samples for degree {degree}")
    return least


def _windows(least: int, most: int) -> list[int]:
    """Odd sizes up to ``most``, each some fifth larger than the one before."""
    sizes = [least]
    while (size := 2 * int(0.6 * sizes[-1] + 1) + 1) <= most:
        sizes.append(size)
    return sizes


def _derivative(
    along: np.ndarray,
    values: np.ndarray,
    runs: list[slice],
    order: int,
    window: int,
    degree: int,
    deviation: float,
    step: int = 1,
) -> Derivative:
    """The derivative by windows of one size, on runs that are at least as long, at every ``step``-th sample."""
    rates, gain, finer, finer_gain, left = (np.full(len(along), np.nan) for _ in range(5))
    for run in runs:
        samples = np.arange(run.start, run.stop, step)
        for at in np.array_split(samples, 1 + len(samples) // BLOCK):
            begin = np.clip(at - window // 2, run.start, run.stop - window)
            near = begin[:, None] + np.arange(window)
            x, around = along[near], values[near]
            rows, rest = _polynomials(x, around, along[at], order, degree)
            more = _polynomials(x, around, along[at], order, degree + 2)[0] - rows
            rates[at], gain[at] = np.sum(rows * around, axis=1), np.linalg.norm(rows, axis=1)
            finer[at], finer_gain[at] = np.sum(more * around, axis=1), np.linalg.norm(more, axis=1)
            left[at] = np.sum(rest**2, axis=1) / (window - degree - 1)
    computed = np.isfinite(rates)
    expected = (deviation * finer_gain[computed]) ** 2
    apart = max(1.0, window / step)  # values that share noise: what is left of their number in the mean's error
    uncertain = np.sqrt(2 * apart * np.sum(expected**2)) / len(expected)
    bias = np.sqrt(max(0.0, np.mean(finer[computed] ** 2 - expected) + 2 * uncertain))
    return Derivative(rates, deviation * gain, float(bias), deviation, float(np.sqrt(np.nanmean(left))), window)


def _polynomials(
    x: np.ndarray, y: np.ndarray, at: np.ndarray, order: int, degree: int
) -> tuple[np.ndarray, np.ndarray]:
    """Polynomials by least squares over windows (samples, window), with derivatives ``at`` (samples,).

    Returns the rows (samples, window) that give the derivatives from the values, and what the polynomials leave over.
    """
    middle, half = (x[:, -1] + x[:, 0]) / 2, (x[:, -1] - x[:, 0]) / 2
    basis = legvander((x - middle[:, None]) / half[:, None], degree)
    slopes = [legval((at - middle) / half, legder(unit, order)) for unit in np.eye(degree + 1)]
    normal = np.swapaxes(basis, 1, 2) @ basis
    rows = basis @ np.linalg.solve(normal, (np.array(slopes) / half**order).T[..., None])
    fitted = basis @ np.linalg.solve(normal, np.swapaxes(basis, 1, 2) @ y[..., None])
    return rows[..., 0], y - fitted[..., 0]
