"""The answer of a model to a batch of parameter vectors."""

from dataclasses import dataclass

import numpy as np

from dalembert.errors import SolveError


@dataclass(frozen=True)
class Responses:
    """Responses of a batch, and why some of them are missing.

    Parameters
    ----------
    values : array, shape (batch, samples, channels)
        NaN throughout a failed sample.
    failures : tuple of str or None, length batch
        The reason of each failed sample, None for the others.
    """

    values: np.ndarray
    failures: tuple[str | None, ...]

    @property
    def ok(self) -> np.ndarray:
        """Mask of the samples that succeeded, shape (batch,)."""
        return np.array([reason is None for reason in self.failures], dtype=bool)

    def only(self) -> np.ndarray:
        """The values, shape (batch, samples, channels), of a batch in which nothing failed.

        Raises
        ------
        SolveError
            With the first failure's reason.
        """
        for number, reason in enumerate(self.failures):
            if reason is not None:
                raise SolveError(f"sample {number} of {len(self.failures)}: {reason}")
        return self.values
