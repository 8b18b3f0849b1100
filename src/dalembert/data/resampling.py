"""Measurements at other samples."""

from dataclasses import replace

import numpy as np

from dalembert.data.labels import check_labels
from dalembert.data.record import TURN, Recorded
from dalembert.data.stretches import stretches
from dalembert.errors import DataError
from dalembert.forward import Coordinate

CLOSE = 1e-9
"""Samples as close as this part of the coordinate's span are the same."""


def resampled(data: Recorded, samples: np.ndarray, gap: float | None = None) -> Recorded:
    """Measurements at other samples (new samples,), by splines between the gaps of each channel."""
    along = data.coordinate
    target = Coordinate(along.name, along.unit, np.atleast_1d(samples))
    check_labels(target, data.channels)
    first, last = along.values[[0, -1]]
    close = CLOSE * max(float(last - first), np.finfo(float).tiny)
    outside = (target.values < first - close) | (target.values > last + close)
    if np.any(outside):
        raise DataError(
            f"{along.name} {target.values[np.argmax(outside)]:.10g} {along.unit} lies outside the data, which run from "
            f"{first:.10g} to {last:.10g} {along.unit}; expected samples within; nothing is known beyond"
        )
    values = np.column_stack(
        [
            _channel(along.values[rows], column[rows], present[rows], target.values, close, gap)
            for column, present, rows in zip(data.continuous.T, data.present.T, data.taken.T, strict=True)
        ]
    )
    turned = (values + TURN / 2) % TURN - TURN / 2
    return replace(data, coordinate=target, values=np.where(data.wrapping, turned, values), sampled=None)


def _channel(
    along: np.ndarray, values: np.ndarray, present: np.ndarray, samples: np.ndarray, close: float, gap: float | None
) -> np.ndarray:
    """A channel at new samples; NaN in gaps."""
    from scipy.interpolate import make_interp_spline

    result = np.full(len(samples), np.nan)
    for run in stretches(present, along, gap):
        x, y = along[run], values[run]
        inside = (samples >= x[0] - close) & (samples <= x[-1] + close)
        spline = make_interp_spline(x, y, k=min(3, len(x) - 1))
        result[inside] = spline(samples[inside])
    return result
