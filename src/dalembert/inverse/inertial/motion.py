"""Positions, velocities, accelerations and torques of joints from records: filtered without delay."""

from dataclasses import dataclass

import numpy as np

from dalembert.errors import InputError

ORDER = 4  # of the Butterworth filter, which runs forward and back
# Periods of the cutoff frequency that are dropped at each end; the filter's transient falls to 1e-3 there.
PERIODS = 3.0
EVEN = 1e-3  # relative difference of two steps of time up to which samples are even
DEGREE = 7  # of the splines whose derivatives are velocities and accelerations


@dataclass(frozen=True, eq=False)
class FilteredMotion:
    """Motion and torques of joints below a cutoff frequency.

    Parameters
    ----------
    times : array, shape (samples,)
        s.
    positions, velocities, accelerations, torques : array, shape (samples, joints)
    cutoff : float
        Hz.
    decimation : int
        Samples of the record for one sample here.
    """

    times: np.ndarray
    positions: np.ndarray
    velocities: np.ndarray
    accelerations: np.ndarray
    torques: np.ndarray
    cutoff: float
    decimation: int


def lowpass(values: np.ndarray, rate: float, cutoff: float, *, order: int = ORDER) -> np.ndarray:
    """Return values (samples, ...) without what is faster than a cutoff frequency, and without delay.

    Parameters
    ----------
    values : array, shape (samples, ...)
    rate, cutoff : float
        Samples per second; Hz.
    order : int
        Of the Butterworth filter. It runs forward and back, so its gain is 1 / (1 + (f/cutoff)^(2 order)).

    Raises
    ------
    InputError
        For a cutoff that is not between 0 and half the rate, or fewer samples than a period of it.

    Examples
    --------
    >>> times = np.arange(2000) / 1000
    >>> slow, fast = np.sin(2 * np.pi * 2 * times), np.sin(2 * np.pi * 100 * times)
    >>> bool(np.max(np.abs(lowpass(slow + fast, 1000.0, 20.0) - slow)[200:-200]) < 1e-4)
    True
    """
    from scipy.signal import butter, sosfiltfilt

    if not 0 < cutoff < rate / 2:
        raise InputError(
            f"lowpass: the cutoff frequency is {cutoff:g} Hz and the sampling rate {rate:.6g} Hz; expected a cutoff "
            "between 0 and half the rate"
        )
    table = np.asarray(values, dtype=float)
    period = int(np.ceil(rate / cutoff))
    if len(table) <= period:
        raise InputError(
            f"lowpass: {len(table)} samples are shorter than the period of the cutoff frequency ({period} samples). "
            "Give a longer record or a higher cutoff"
        )
    sections = np.asarray(butter(order, cutoff, fs=rate, output="sos"))
    return sosfiltfilt(sections, table, axis=0, padlen=min(3 * period, len(table) - 1))


def filtered_motion(
    times: np.ndarray,
    positions: np.ndarray,
    torques: np.ndarray,
    cutoff: float,
    *,
    order: int = ORDER,
    decimation: int | None = None,
) -> FilteredMotion:
    """Return filtered positions, their derivatives, and torques through the same filter.

    Parameters
    ----------
    times : array, shape (samples,)
        Even, s.
    positions, torques : array, shape (samples, joints)
        Wrapped angles must be without jumps (:func:`numpy.unwrap`).
    cutoff : float
        Hz. Choose about ten times the highest frequency of the planned motion.
    order : int
        Of the filter, see :func:`lowpass`.
    decimation : int, optional
        Every such sample is kept. If not given, samples are two a period of the cutoff, so that the noise of
        neighbours is hardly correlated.

    Raises
    ------
    InputError
        For arrays of other shapes, times that are not even, or a record that is too short.

    Notes
    -----
    Velocities and accelerations are the derivatives of a spline of degree 7 through the filtered positions. Three
    periods of the cutoff at each end are dropped, since the filter has no neighbours there.

    Source: M. Gautier, Dynamic identification of robots with power model, IEEE ICRA (1997).

    Examples
    --------
    >>> times = np.arange(4000) / 1000
    >>> swing = np.sin(2 * np.pi * times)[:, None]
    >>> found = filtered_motion(times, swing, 2 * swing, 20.0)
    >>> exact = -((2 * np.pi) ** 2) * np.sin(2 * np.pi * found.times)
    >>> found.decimation, bool(np.max(np.abs(found.accelerations[:, 0] - exact)) < 1e-3)
    (25, True)
    """
    from scipy.interpolate import make_interp_spline

    along, path, effort = (np.asarray(record, dtype=float) for record in (times, positions, torques))
    if along.ndim != 1 or path.ndim != 2 or path.shape != effort.shape or len(path) != len(along):
        raise InputError(
            f"filtered_motion: times, positions and torques have the shapes {along.shape}, {path.shape} and "
            f"{effort.shape}; expected (samples,), (samples, joints) and (samples, joints)"
        )
    if not all(np.all(np.isfinite(record)) for record in (along, path, effort)):
        raise InputError("filtered_motion: a time, position or torque is not finite. Remove this sample, and resample")
    # Samples per second.
    if len(along) < 10:
        raise InputError(f"filtered_motion: {len(along)} samples; expected at least 10")
    steps = np.diff(along)
    usual = (along[-1] - along[0]) / len(steps)
    worst = int(np.argmax(np.abs(steps - usual)))
    if not usual > 0 or abs(steps[worst] - usual) > EVEN * usual:
        raise InputError(
            f"filtered_motion: the times are not even: mostly {usual:.6g} s, and {steps[worst]:.6g} s after "
            f"{along[worst]:.6g} s. Resample the record"
        )
    rate = float(1.0 / usual)
    slow, quiet = (lowpass(record, rate, cutoff, order=order) for record in (path, effort))
    curve = make_interp_spline(along - along[0], slow, k=DEGREE)
    kept, step = kept_samples(len(along), rate, cutoff, decimation)
    velocities, accelerations = (curve.derivative(k)(along[kept] - along[0]) for k in (1, 2))
    return FilteredMotion(along[kept], slow[kept], velocities, accelerations, quiet[kept], float(cutoff), step)


def kept_samples(count: int, rate: float, cutoff: float, decimation: int | None = None) -> tuple[np.ndarray, int]:
    """Rows (kept,) of a filtered record that are kept, and the step between them: two in a period of the cutoff."""
    step = max(1, int(rate / (2.0 * cutoff) * (1 + EVEN))) if decimation is None else decimation
    if not isinstance(step, int) or step < 1:
        raise InputError(f"filtered_motion: decimation is {step}; expected a whole number of at least 1")
    ends = int(np.ceil(PERIODS * rate / cutoff))
    kept = np.arange(ends, count - ends, step)
    if len(kept) < 2:
        raise InputError(
            f"filtered_motion: {count} samples leave {len(kept)} after {ends} are dropped at each end. Give a "
            "longer record or a higher cutoff"
        )
    return kept, step
