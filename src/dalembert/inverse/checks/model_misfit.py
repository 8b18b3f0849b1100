"""Where a model cannot follow the data."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtri

from dalembert.findings import Finding
from dalembert.inverse.identification.assess import Optimum
from dalembert.inverse.misfit.residuals import Residuals
from dalembert.inverse.noise.correlation.correlated_residuals import CLEAR, NoiseProcess
from dalembert.inverse.noise.correlation.series import Series

FAR = 2.0
"""Residuals in deviations of the noise from which they are far above it."""

LEVEL = 0.001
"""Probability with which noise leaves its band in any window."""

LEAST = 10
"""Fewest values of a window."""

DETERMINED = 1e-6
"""Part of the largest singular value of a part of the record from which that part determines a combination."""

OUTSIDE = 3.0
"""Residual in deviations of the noise that is outside of its band."""


@dataclass(frozen=True)
class ModelMisfit:
    """A channel of an experiment whose residuals are far above the noise."""

    experiment: str  # empty for a single one
    channel: str
    at: float  # coordinate at which the residuals first leave the band of the noise
    followed: float  # coordinate up to which the model follows the record, if the record up to there alone is fitted
    unit: str  # of the coordinate
    ratio: float  # largest root mean square of the residuals in a window, in deviations of the noise
    known: bool  # whether the noise follows from given deviations, not from the differences of neighbouring residuals


def _shown(value: float, unit: str) -> str:
    return f"{value:.4g} {unit}".rstrip()


def model_misfit(optimum: Optimum) -> Iterator[Finding]:
    """Yield a finding for each experiment that the model does not follow."""
    residuals = optimum.causes.residuals
    for item in () if residuals is None else _misfits(residuals):
        record = f" of experiment {item.experiment!r}" if item.experiment else ""
        noise = "given deviation" if item.known else "noise (estimated from neighbouring residuals)"
        names = ("experiment", "channel", "at", "followed", "ratio")
        values = {name: getattr(item, name) for name in names}
        yield Finding(
            "model-misfit",
            "warning",
            values,
            f"The model does not follow the data{record} from {_shown(item.at, item.unit)} on, first in "
            f"{item.channel!r}: the residuals reach {item.ratio:.3g} times the {noise}. Fitted alone, the data up to "
            f"{_shown(item.followed, item.unit)} can be followed.",
            "Look there in the figure of residuals. Add what the model lacks, widen the bounds, or increase `starts`.",
        )


def _misfits(residuals: Residuals) -> tuple[ModelMisfit, ...]:
    """Return the channel of each experiment in which the model leaves the data first. Only residuals that stay
    correlated as long as the motion takes to change are those of a model, or correlated ones that are far above given
    deviations: the size alone may be that of noise.
    """
    misfits: dict[str, ModelMisfit] = {}
    for signal in residuals.series:
        process = residuals.processes.get(signal.name)
        misfit = _misfit(residuals, signal, process) if process is not None and _model(residuals, process) else None
        if misfit is not None and misfit.at < getattr(misfits.get(misfit.experiment), "at", np.inf):
            misfits[misfit.experiment] = misfit
    return tuple(misfits.values())


def _model(residuals: Residuals, process: NoiseProcess) -> bool:
    """Whether correlated residuals are those of a model, not of noise."""
    return process.systematic or (residuals.known and process.p_value < CLEAR and process.variance > FAR**2)


def _misfit(residuals: Residuals, signal: Series, process: NoiseProcess) -> ModelMisfit | None:
    values, noise = residuals.values[signal.rows], residuals.noise(signal)
    size = max(LEAST, min(int(process.period / 2 / signal.step), len(values) // 8))
    windows = np.array_split(np.arange(len(values)), max(1, len(values) // size))
    least = min(len(rows) for rows in windows)
    limit = max(FAR, np.sqrt(chdtri(least, LEVEL / len(windows)) / least)) * noise
    sizes = _sizes(values, windows)
    outside = np.flatnonzero(sizes > limit)
    if not len(outside):
        return None
    rows = windows[outside[0]]
    first = rows[np.argmax(np.abs(values[rows]) > OUTSIDE * noise)]
    return ModelMisfit(
        signal.experiment,
        signal.channel,
        float(signal.along[first]),
        _followed(residuals, signal, windows, limit),
        signal.unit,
        float(sizes.max()) / noise,
        residuals.known,
    )


def _sizes(values: np.ndarray, windows: Sequence[np.ndarray]) -> np.ndarray:
    """Root mean square of values in each window."""
    return np.array([np.sqrt(np.mean(values[rows] ** 2)) for rows in windows])


def _followed(residuals: Residuals, signal: Series, windows: Sequence[np.ndarray], limit: float) -> float:
    """Coordinate up to which one Gauss–Newton step of the record's first windows alone leaves at most ``limit``."""
    followed = float(signal.along[0])
    shares = {other: (other.along - other.along[0]) / (other.length or 1.0) for other in residuals.series}
    for count, window in enumerate(windows, start=1):
        end = shares[signal][window[-1]]
        rows = np.concatenate([other.rows[share <= end] for other, share in shares.items()])
        basis, singular, _ = np.linalg.svd(residuals.basis[rows], full_matrices=False)
        basis = basis[:, singular > DETERMINED * singular[0]]
        values = np.zeros(len(residuals.values))
        values[rows] = residuals.values[rows] - basis @ (basis.T @ residuals.values[rows])
        if np.any(_sizes(values[signal.rows], windows[:count]) > limit):
            break
        followed = float(signal.along[window[-1]])
    return followed
