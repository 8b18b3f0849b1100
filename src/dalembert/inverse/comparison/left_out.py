"""Which values are left out together, to be predicted from all others."""

import numpy as np

from dalembert.errors import InputError, require_known
from dalembert.inverse.experiments.blocks import USUAL, blocks_of_records
from dalembert.inverse.fit.fit import Fit
from dalembert.inverse.noise.correlation.series import Series, series_of_record
from dalembert.inverse.noise.likelihood.estimated_noise import EstimatedNoise

# What is left out together, in words.
WAYS = {"values": "single values", "blocks": "blocks of neighbouring samples", "experiments": "experiments"}
# Length of a block in correlation times of the residuals, so that blocks are nearly independent.
CORRELATION_TIMES = 4.0
FEWEST = 5  # fewest blocks of a record


def groups(fit: Fit, leave_out: str, blocks: int | None = None) -> np.ndarray:
    """Return the number of the group of each value, from 0, shape (samples, channels); −1 where it was not fitted.
    ``leave_out``: single ``"values"``; ``"blocks"`` of neighbouring samples with all their channels; whole
    ``"experiments"``. ``blocks``: blocks of each record; without it as many as are longer than four correlation times
    of the residuals.
    """
    require_known("way", leave_out, WAYS, "leave_out")
    fitted = fit.weights > 0
    if leave_out == "values":
        numbers = np.full(fitted.shape, -1)
        numbers[fitted] = np.arange(np.count_nonzero(fitted))
        return numbers
    if leave_out == "experiments" and len(fit.experiments) < 2:
        raise InputError("leave_out is 'experiments', but the fit has one experiment; use 'blocks'")
    together = leave_out == "experiments"
    return blocks_of_records(fitted, fit.parts, lambda samples: 1 if together else _count(fit, samples, blocks))


def _count(fit: Fit, samples: int, blocks: int | None) -> int:
    """Blocks of a record of samples."""
    if blocks is not None:
        if not 2 <= blocks <= samples:
            raise InputError(f"blocks is {blocks}; expected at least 2, and at most the {samples} samples of a record")
        return blocks
    time = correlation_time(fit)
    if not time > 0:
        return min(USUAL, samples)
    along = fit.data.coordinate.values if not fit.parts else fit.parts[0].coordinate.values
    length = CORRELATION_TIMES * time / max(float(np.median(np.diff(along))), 1e-300)
    return int(np.clip(samples // max(length, 1.0), min(FEWEST, samples), samples))


def correlation_time(fit: Fit) -> float:
    """Return the longest correlation time of the residuals, or of an estimated noise model; 0 where there is none."""
    if fit.noise is not None:
        series = series_of_record(fit.data, fit.weights, fit.parts, fewest=1)
        return max((_time_of(fit.noise, series_item) for series_item in series), default=0.0)
    return max((item.time for item in fit.correlated.processes), default=0.0) if fit.correlated is not None else 0.0


def _time_of(noise: EstimatedNoise, series: Series) -> float:
    """The lag up to which a value depends on one before: the first at which their correlation is below 1/e."""
    process = noise.models[series.name].whitening(series)
    if process is None or len(series.rows) < 2:
        return 0.0
    from scipy.sparse.linalg import splu

    matrix = process.matrix(noise.of_channel(series.name, noise.estimates)).tocsc()
    first = np.zeros(len(series.rows))
    first[0] = 1.0
    # the first column of the correlation C = (AᵀA)⁻¹
    column = splu(matrix).solve(splu(matrix.T.tocsc()).solve(first))
    below = np.flatnonzero(np.abs(column) < np.exp(-1))
    return float(series.along[below[0] if len(below) else -1] - series.along[0])


def counted_groups(numbers: np.ndarray) -> list[np.ndarray]:
    """Return the flat places of the values of each group of :func:`groups`."""
    flat = numbers.ravel()
    order = np.argsort(flat, kind="stable")
    order = order[flat[order] >= 0]
    return np.split(order, np.flatnonzero(np.diff(flat[order])) + 1) if len(order) else []
