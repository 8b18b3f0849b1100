"""Where the segments of multiple shooting meet."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Nodes:
    """States at which the segments of multiple shooting were made to meet.

    Parameters
    ----------
    states : tuple of str
        Parameters of the initial state, which the columns are.
    samples : array of int, shape (nodes,)
        Where the segments meet.
    ends, begins : array, shape (nodes, states)
        State at the end of the segment before, and at the beginning of the one after.
    gap : float
        Largest difference of the two, in parts of the states' ranges.
    growth : float
        How much a small change of the initial state has grown by the last node, both in parts of the ranges.
    segments : int
        Those that the fit consists of: 1 where they merged into one run.
    """

    states: tuple[str, ...]
    samples: np.ndarray
    ends: np.ndarray
    begins: np.ndarray
    gap: float
    growth: float
    segments: int

    def __str__(self) -> str:
        """How the segments ended, in a sentence."""
        met = f"{len(self.samples) + 1} segments meet within {self.gap:.1g} of the states' ranges"
        if self.segments == 1:
            return f"The {met}, and merged into one run."
        return (
            f"The {met}. They did not merge into one run, since a small change of its beginning grows "
            f"{self.growth:.2g} times: the response is that of {self.segments} segments, and a "
            "simulation from the identified values leaves the data."
        )
