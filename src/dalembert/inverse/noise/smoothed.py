"""Measurements smoothed by local polynomials: initial states of segments, and noise levels."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dalembert.data import Measurements, derivative
from dalembert.errors import DataError
from dalembert.inverse.experiments.experiment import ExperimentPart


@dataclass(frozen=True, eq=False)
class Smoothed:
    """What was measured of a motion, and how fast it changed."""

    # values, rates: (samples, channels): without jumps of wrapping channels; interpolated over missing samples. Rates
    # are NaN where there are too few samples for them.
    values: np.ndarray
    rates: np.ndarray
    # deviations, errors: (channels,): standard deviation of the noise of both
    deviations: np.ndarray
    errors: np.ndarray


def smoothed(data: Measurements) -> Smoothed:
    """Return measured values, their rates by local polynomials, and the noise of both."""
    along, values = data.coordinate.values, data.continuous
    rates, deviations, errors = np.full(values.shape, np.nan), np.zeros(values.shape[1]), np.ones(values.shape[1])
    for column, name in enumerate(data.channels):
        present = data.present[:, column]
        values[:, column] = np.interp(along, along[present], values[present, column])
        try:
            rate = derivative(data, name)
        except DataError:  # too few samples beside each other
            continue
        known = np.isfinite(rate.values)
        rates[:, column] = np.interp(along, along[known], rate.values[known])
        deviations[column], errors[column] = rate.deviation, max(rate.error, 1e-12)
    return Smoothed(values, rates, deviations, errors)


LEAST = 1e-6
"""Least noise of a channel, in parts of its spread: local polynomials leave almost none of a smooth one."""


def smooth_noise(data: Measurements, parts: Sequence[ExperimentPart]) -> np.ndarray:
    """Return the standard deviation of each channel's noise, shape (channels,): what local polynomials leave. Channels
    of several experiments are smoothed each over its own samples. Where samples are too few it is the spread of the
    channel.
    """
    found = np.zeros(len(data.channels))
    for part_data, columns in [(part.data(data), part.columns) for part in parts] or [(data, np.arange(len(found)))]:
        seen = smoothed(part_data)
        spread = np.std(seen.values, axis=0)
        noise = np.where(seen.deviations > 0, np.maximum(seen.deviations, LEAST * spread), spread)
        found[columns] = np.where(noise > 0, noise, 1.0)
    return found
