"""A free decay with what a first look at it says: rates, noise, harmonics and other modes."""

from dataclasses import dataclass, replace

import numpy as np

from dalembert.errors import DataError
from dalembert.inverse.decays.band_pass import AnalyticSignal, analytic_signal
from dalembert.inverse.decays.decay_record import PERIODS, DecayRecord
from dalembert.inverse.decays.record_windows import Place, Rates, WindowEstimates, estimate, even_places, half_length
from dalembert.inverse.decays.sensors import Sensors
from dalembert.inverse.decays.window_fit import HARMONICS

SHORT = (4.0, 4)
"""Periods and degree of windows of the first look at a record."""
STARTS = 24
"""Half periods behind the largest amplitude within which the free decay begins."""
CLEAN = 5e-3
"""Residual of a window, as part of the amplitude, that is no sign of the hammer's contact or of other modes."""
END = 3.0
"""Amplitude in deviations of the noise of the band at which a decay ends."""
NEAR = 0.2
"""Relative distance from an expected frequency within which the mode is looked for."""
SEPARATE = 1.5
"""Periods of the beat of two modes that a window must have."""


@dataclass(frozen=True)
class FreeDecay:
    """A free decay with what a first look at it says.

    ``rates``: of all modes; ``sensors``: with the deviations of the noise; ``signal``: of the first mode's band;
    ``harmonics`` of the first mode that show; ``clean``: whether the first window fits like the others.
    """

    record: DecayRecord
    rates: Rates
    sensors: Sensors
    signal: AnalyticSignal
    harmonics: tuple[int, ...] = HARMONICS
    clean: bool = True

    @property
    def frequency(self) -> float:
        """Mean frequency of the first mode, Hz."""
        return float(np.median(self.rates.slopes[0].imag)) / (2 * np.pi)

    @property
    def shortest(self) -> float:
        """Least length of a window, in periods, that separates the modes."""
        others = self.rates.slopes[1:, 0].imag / (2 * np.pi)
        return max([SEPARATE * self.frequency / abs(other - self.frequency) for other in others], default=0.0)

    @property
    def periods(self) -> float:
        """Length of the decay in periods."""
        return self.record.duration * self.frequency

    def windows(self, periods: float, degree: int) -> WindowEstimates:
        """Windows of a number of periods, half of each in the next."""
        places = even_places(self.record, self.rates, periods, degree, 0.5)
        return estimate(self.record, places, self.rates, self.sensors, self.harmonics)

    def with_noise(self) -> "FreeDecay":
        """The same with the deviations of the noise, from the residuals of short windows."""
        decay = self
        for _ in range(2):
            fits = decay.windows(max(SHORT[0], decay.shortest), SHORT[1])
            if not len(fits):
                raise DataError(
                    "ring_down: no decaying oscillation fits the record. Look whether the frequency is right"
                )
            squares = np.array([np.sum(fit.residuals**2, axis=0) / fit.freedom for fit in fits.fits])
            # The lower quartile: modes that decay faster leave residuals in the first windows.
            levels = np.sqrt(np.quantile(squares, 0.25, axis=0))
            floor = 1e-9 * np.sqrt(np.mean(decay.record.values**2, axis=0)) + np.finfo(float).tiny
            decay = replace(decay, sensors=Sensors(decay.record.orders, np.maximum(levels, floor)))
        return decay

    def beginning_with(self, expected: float) -> "FreeDecay":
        """The same with the mode near an expected frequency, Hz, as the first.

        Raises
        ------
        DataError
            Where no mode of the decay is near it.
        """
        frequencies = self.rates.slopes[:, 0].imag / (2 * np.pi)
        frequencies[0] = self.frequency
        away = np.abs(frequencies / expected - 1)
        nearest = int(np.argmin(away))
        if away[nearest] > NEAR:
            raise DataError(
                f"ring_down: no mode is near {expected:.6g} Hz; the decay is that of {self.frequency:.6g} Hz. Give "
                "another frequency, or measure where this mode moves more"
            )
        if not nearest:
            return self
        order = [nearest, *(mode for mode in range(len(frequencies)) if mode != nearest)]
        ends = (np.inf, *(self.rates.ends[mode] for mode in order[1:]))
        rates = Rates(self.rates.times, self.rates.slopes[order], ends)
        decay = replace(self, rates=rates, harmonics=HARMONICS)
        return replace(decay, signal=analytic_signal(self.record, expected, 1 / max(decay.shortest, 2.0)))

    def ended(self) -> "FreeDecay":
        """The decay to where its amplitude leaves the noise of the band."""
        signal, record = self.signal, self.record
        # The level to which the amplitude falls at last: the noise of the band, or the end of the decay itself. Of
        # several sensors, that which falls most.
        levels = np.exp(signal.logarithms.real)
        tails = np.sqrt(np.mean(levels[-max(len(levels) // 10, 1) :] ** 2, axis=0))
        most = int(np.argmax(levels[0] / tails))
        sizes, noise = levels[:, most], float(tails[most])
        above = np.flatnonzero(sizes > END * noise)
        if not len(above) or noise > sizes[0] / (END * END):
            return self
        end = float(signal.times[above[-1]]) if above[-1] < len(sizes) - 1 else float(record.times[-1])
        if end - record.start < PERIODS / self.frequency:
            return self
        times = self.rates.times
        return replace(
            self,
            record=record.between(record.start, end),
            rates=replace(self.rates, times=times[times <= end], slopes=self.rates.slopes[:, times <= end]),
        )

    def begun(self) -> "FreeDecay":
        """The decay from where windows fit: behind the contact of the hammer, and modes that die out soon."""
        record, half_period = self.record, 0.5 / self.frequency
        ratios = []
        for number in range(STARTS):
            begin = record.start + number * half_period
            half = half_length(self.rates, begin, max(SHORT[0], self.shortest))
            if number and record.times[-1] - begin < max(2 * half, PERIODS / self.frequency):
                break
            place = Place(begin + half, half, SHORT[1])
            fits = estimate(record, [place], self.rates, self.sensors, self.harmonics)
            ratios.append(np.inf)
            for fit in fits.fits:
                sizes = np.sqrt(2 * np.mean(fit.window.values**2, axis=0))
                squares = np.sum(fit.residuals**2, axis=0) / fit.freedom
                # The mean square over that of the noise and of a small part of the amplitude.
                ratios[-1] = float(np.max(squares / (self.sensors.deviations**2 + (CLEAN * sizes) ** 2)))
            if ratios[-1] <= 2.0:
                break
        number = int(np.argmin(ratios))
        begin = record.start + number * half_period
        return replace(self, record=record.between(begin, record.times[-1]), clean=ratios[number] <= 2.0)
