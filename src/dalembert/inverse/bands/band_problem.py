"""The misfit between given bands and those of a candidate box."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from dalembert.data import Bands
from dalembert.forward import ForwardModel
from dalembert.inverse.bands.unknowns import Unknowns
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.matching import check_samples, columns_of, weights_of
from dalembert.inverse.problem.simulated import simulated


@dataclass(frozen=True, eq=False)
class BandProblem:
    """Misfit F = Σ W ((lower − given lower)² + (upper − given upper)²) over samples and channels.

    Outputs are samples × channels, flat.
    """

    model: ForwardModel
    bands: Bands
    columns: np.ndarray  # (channels,): where the bands' channels stand among the model's
    weights: np.ndarray  # (samples, channels): W
    unknowns: Unknowns
    journal: Journal

    @property
    def shape(self) -> tuple[int, int]:
        """Samples and channels."""
        return self.bands.lower.shape[0], self.bands.lower.shape[1]

    def run(self, points: np.ndarray) -> np.ndarray:
        """Outputs (n, outputs) of true runs at search points (n, parameters); NaN where a run failed."""
        vectors = self.unknowns.search.vectors(points)
        return simulated(self.model, self.columns, self.journal, vectors).reshape(len(points), -1)

    def residual(self, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
        """W^½ (bounds − given), shape (..., 2 × outputs), of bounds (..., outputs)."""
        apart = np.stack([lower - self.bands.lower.ravel(), upper - self.bands.upper.ravel()], axis=-2)
        return (np.sqrt(self.weights.ravel()) * apart).reshape(*lower.shape[:-1], -1)

    def misfit(self, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
        """F, shape (...), of bounds (..., outputs)."""
        return np.sum(self.residual(lower, upper) ** 2, axis=-1)


def pose(
    model: ForwardModel, bands: Bands, weights: ArrayLike | None, unknowns: Unknowns, journal: Journal
) -> BandProblem:
    """The problem of explaining bands by a box, after checking that they fit to the model."""
    columns = columns_of(model, bands)
    check_samples(model, bands)
    return BandProblem(model, bands, columns, weights_of(weights, bands.lower.shape), unknowns, journal)
