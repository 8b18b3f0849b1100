"""Where a model cannot follow the data."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtri

from dalembert.findings import Finding
from dalembert.inverse.correlation import NoiseProcess
from dalembert.inverse.correlation.correlated import CLEAR
from dalembert.inverse.correlation.series import Series
from dalembert.inverse.misfit.residuals import Residuals

FAR = 2.0
"""Residuals in deviations of the noise from which they are far above it."""

LEVEL = 0.001
"""Probability with which noise leaves its band in any window."""

LEAST = 10
"""Fewest values of a window."""

OUTSIDE = 3.0
"""Residual in deviations of the noise that is outside of its band."""


@dataclass(frozen=True)
class ModelMisfit:
    """A channel of an experiment whose residuals are far above the noise.

    Parameters
    ----------
    experiment : str
        Empty for a single one.
    channel : str
    at : float
        Coordinate at which the residuals first leave the band of the noise.
    unit : str
        Of the coordinate.
    ratio : float
        Largest root mean square of the residuals in a window, in deviations of the noise.
    known : bool
        Whether the noise follows from given deviations, not from the differences of neighbouring residuals.
    """

    experiment: str
    channel: str
    at: float
    unit: str
    ratio: float
    known: bool


def model_misfits(residuals: Residuals) -> tuple[ModelMisfit, ...]:
    """Return the channel of each experiment in which the model leaves the data first.

    Only residuals that stay correlated as long as the motion takes to change are those of a model, or correlated ones
    that are far above given deviations: the size alone may be that of noise.
    """
    found: dict[str, ModelMisfit] = {}
    for own in residuals.series:
        process = residuals.processes.get(own.name)
        misfit = _misfit(residuals, own, process) if process is not None and _model(residuals, process) else None
        if misfit is not None and misfit.at < getattr(found.get(misfit.experiment), "at", np.inf):
            found[misfit.experiment] = misfit
    return tuple(found.values())


def misfit_findings(misfits: Sequence[ModelMisfit]) -> Iterator[Finding]:
    """Yield a finding for each experiment that the model does not follow."""
    for item in misfits:
        record = f" of experiment {item.experiment!r}" if item.experiment else ""
        noise = "given deviation" if item.known else "noise (estimated from neighbouring residuals)"
        yield Finding(
            "model-misfit",
            "warning",
            {"experiment": item.experiment, "channel": item.channel, "at": item.at, "ratio": item.ratio},
            f"The model does not follow the data{record} from {f'{item.at:.4g} {item.unit}'.rstrip()} on, first in "
            f"{item.channel!r}: the residuals reach {item.ratio:.3g} times the {noise}.",
            "Look there in the figure of residuals. Add what the model lacks, widen the bounds, or increase `starts`.",
        )


def _model(residuals: Residuals, process: NoiseProcess) -> bool:
    """Whether correlated residuals are those of a model, not of noise."""
    return process.systematic or (residuals.known and process.p_value < CLEAR and process.variance > FAR**2)


def _misfit(residuals: Residuals, own: Series, process: NoiseProcess) -> ModelMisfit | None:
    values, noise = residuals.values[own.rows], residuals.noise(own)
    size = max(LEAST, min(int(process.period / 2 / own.step), len(values) // 8))
    windows = np.array_split(np.arange(len(values)), max(1, len(values) // size))
    ratios = np.array([np.sqrt(np.mean(values[rows] ** 2)) for rows in windows]) / noise
    least = min(len(rows) for rows in windows)
    limit = max(FAR, np.sqrt(chdtri(least, LEVEL / len(windows)) / least))
    outside = np.flatnonzero(ratios > limit)
    if not len(outside):
        return None
    rows = windows[outside[0]]
    first = rows[np.argmax(np.abs(values[rows]) > OUTSIDE * noise)]
    experiment, channel = residuals.records[own.name]
    return ModelMisfit(experiment, channel, float(own.along[first]), own.unit, float(ratios.max()), residuals.known)
