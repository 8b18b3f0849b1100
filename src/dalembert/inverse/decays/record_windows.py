"""Windows along a record: estimates of a mode in each, and their covariance."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations_with_replacement
from typing import NamedTuple

import numpy as np
from numpy.polynomial import polynomial

from dalembert.inverse.decays.decay_record import DecayRecord
from dalembert.inverse.decays.sensors import Phasors, Sensors
from dalembert.inverse.decays.window_fit import HARMONICS, OTHERS, Window, WindowFit, fit_window

OVERLAP = 4
"""Windows that a sample lies in."""


class Place(NamedTuple):
    """Where a window lies: its middle and half its length, s, and the degree of its polynomials."""

    middle: float
    half: float
    degree: int


@dataclass(frozen=True)
class Rates:
    """Frequency ω and decay rate σ of each mode over time, 1/s: times (times,), −σ + iω (modes, times).

    ``ends`` (modes,): times from which a mode is below the noise.
    """

    times: np.ndarray
    slopes: Phasors
    ends: tuple[float, ...] = (np.inf,)

    def at(self, times: np.ndarray) -> Phasors:
        """−σ + iω of each mode, (modes, times)."""
        return np.stack(
            [
                np.interp(times, self.times, slopes.real) + 1j * np.interp(times, self.times, slopes.imag)
                for slopes in self.slopes
            ]
        )

    def with_mode(self, slope: complex, end: float) -> "Rates":
        """With another mode, of constant frequency and decay rate."""
        return Rates(self.times, np.vstack([self.slopes, np.full(len(self.times), slope)]), (*self.ends, end))

    def with_first(self, times: np.ndarray, slopes: Phasors) -> "Rates":
        """With the first mode's rates −σ + iω at times, (times,)."""
        return Rates(times, np.vstack([slopes[None], self.at(times)[1:]]), self.ends)

    def modes(self, begin: float) -> np.ndarray:
        """Numbers of the modes that are above the noise at the begin of a window."""
        return np.flatnonzero(np.array(self.ends) > begin)

    def exponents(self, middle: float, half: float, degree: int) -> Phasors:
        """Coefficients of ρ (modes, degree + 1) in a window, as a first guess."""
        places = np.linspace(-1, 1, 2 * degree + 3)
        slopes = self.at(middle + half * places)[self.modes(middle - half)] * half
        fits = [polynomial.polyfit(places, part, degree - 1) for part in (slopes.T.real, slopes.T.imag)]
        exponents = np.stack([polynomial.polyint(column) for column in (fits[0] + 1j * fits[1]).T])
        exponents[1:, OTHERS + 1 :] = 0.0
        return exponents


@dataclass(frozen=True)
class WindowEstimates:
    """What the windows of a record say about its first mode.

    ``middles`` (windows,); ``times`` (windows,): at which the estimates hold; ``slopes`` (windows,): −σ + iω, 1/s;
    ``amplitudes`` (windows, channels): complex displacements; ``gains``: by which noise changes −σ and ω, (2, channels,
    samples) each, from the sample ``first`` on.
    """

    middles: np.ndarray
    times: np.ndarray
    slopes: Phasors
    amplitudes: Phasors
    fits: tuple[WindowFit, ...]
    modes: tuple[np.ndarray, ...]
    gains: tuple[np.ndarray, ...]
    first: tuple[int, ...]

    def __len__(self) -> int:
        return len(self.times)

    @cached_property
    def halves(self) -> np.ndarray:
        return np.array([fit.window.half for fit in self.fits])

    def with_mode(self, mode: int) -> list[tuple[int, int]]:
        """Windows that a mode is fitted in, and its row among the modes of each."""
        return [(window, numbers.tolist().index(mode)) for window, numbers in enumerate(self.modes) if mode in numbers]

    def kept(self, rows: np.ndarray) -> "WindowEstimates":
        """The windows of a mask."""
        places = np.flatnonzero(rows)
        return WindowEstimates(
            middles=self.middles[rows],
            times=self.times[rows],
            slopes=self.slopes[rows],
            amplitudes=self.amplitudes[rows],
            fits=tuple(self.fits[place] for place in places),
            modes=tuple(self.modes[place] for place in places),
            gains=tuple(self.gains[place] for place in places),
            first=tuple(self.first[place] for place in places),
        )

    def covariance(self, deviations: np.ndarray) -> np.ndarray:
        """Covariance (windows, 2, windows, 2) of −σ and ω for white noise of these deviations (channels,)."""
        count = len(self)
        result = np.zeros((count, 2, count, 2))
        weighted = [gain * deviations[None, :, None] for gain in self.gains]
        ends = [start + gain.shape[2] for start, gain in zip(self.first, self.gains, strict=True)]
        for row, column in combinations_with_replacement(range(count), 2):
            begin, end = max(self.first[row], self.first[column]), min(ends[row], ends[column])
            if begin < end:
                left, right = (
                    weighted[window][:, :, begin - self.first[window] : end - self.first[window]]
                    for window in (row, column)
                )
                block = np.einsum("aij,bij->ab", left, right)
                result[row, :, column, :] = block
                result[column, :, row, :] = block.T
        return result

    def variances(self, deviations: np.ndarray) -> np.ndarray:
        """Variances (windows, 2) of −σ and ω."""
        return np.stack([np.sum((gain * deviations[None, :, None]) ** 2, axis=(1, 2)) for gain in self.gains])


def estimate(
    record: DecayRecord,
    places: Iterable[Place],
    rates: Rates,
    sensors: Sensors,
    harmonics: tuple[int, ...] = HARMONICS,
) -> WindowEstimates:
    """Fit windows along a record; those in which no decaying oscillation fits are left out."""
    fits, middles, best, firsts = [], [], [], []
    for middle, half, degree in places:
        rows = record.rows(middle - half, middle + half)
        window = Window(record.times[rows] - middle, record.values[rows], half)
        fit = fit_window(window, rates.exponents(middle, half, degree), sensors, harmonics)
        if not fit.converged or not fit.slope(0.0).imag > 0:
            continue
        fits.append(fit)
        middles.append(middle)
        best.append(fit.best_place(sensors.deviations))
        firsts.append(rows.start)
    pairs = list(zip(fits, best, strict=True))
    return WindowEstimates(
        middles=np.array(middles),
        times=np.array([middle + fit.window.half * place for middle, (fit, place) in zip(middles, pairs, strict=True)]),
        slopes=np.array([fit.slope(place) for fit, place in pairs], dtype=complex),
        amplitudes=np.array([fit.at(place) for fit, place in pairs]).reshape(len(fits), len(record.channels)),
        fits=tuple(fits),
        modes=tuple(rates.modes(middle - fit.window.half) for middle, fit in zip(middles, fits, strict=True)),
        gains=tuple(fit.slope_gains(place) for fit, place in pairs),
        first=tuple(firsts),
    )


def even_places(record: DecayRecord, rates: Rates, periods: float, degree: int, apart: float) -> Iterator[Place]:
    """Yield places of windows of equal numbers of periods, ``apart`` of their length from each other."""
    time, end = record.start, record.start + record.duration
    while True:
        half = half_length(rates, time, periods)
        if time + 2 * half > end + 1e-9 * record.step:
            return
        yield Place(time + half, half, degree)
        time += 2 * half * apart


def half_length(rates: Rates, begin: float, periods: float) -> float:
    """Half the length, s, of a window of some periods that begins at a time."""
    return np.pi * periods / float(rates.at(np.array([begin]))[0, 0].imag)
