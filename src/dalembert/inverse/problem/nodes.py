"""Where the segments of multiple shooting meet."""

from dataclasses import dataclass, field
from typing import Annotated

import numpy as np

from dalembert.stored_fields import Over


@dataclass(frozen=True, eq=False)
class Nodes:
    """States at which the segments of multiple shooting were made to meet.

    Parameters
    ----------
    states : tuple of str
        Parameters of the initial state, or coordinates and rates of a mechanism, which the columns are.
    samples : array of int, shape (nodes,)
        Where the segments meet: samples of the experiment of each node.
    ends, begins : array, shape (nodes, states)
        State at the end of the segment before, and at the beginning of the one after; NaN for coordinates that a
        mechanism does not begin with there.
    gap : float
        Largest difference of the two, in parts of the states' ranges.
    growth : float
        Factor by which a small change of the initial state grows until the last node, the largest of all motions; both
        changes are relative to the ranges of the states.
    segments : int
        Number of segments of a motion at the end of the fit, the largest of all motions; 1 if they merged into one run.
    units : tuple of str
        Of the states.
    experiments : tuple of str
        Of each node; empty names for a single experiment.
    times : array, shape (nodes,)
        Times of the nodes, in the data's unit (s).
    """

    states: tuple[str, ...]
    samples: Annotated[np.ndarray, Over("node", name="node_samples")]
    ends: Annotated[np.ndarray, Over("node", "state", name="node_ends")]
    begins: Annotated[np.ndarray, Over("node", "state", name="node_begins")]
    gap: float
    growth: float
    segments: int
    units: tuple[str, ...] = ()
    experiments: tuple[str, ...] = ()
    times: Annotated[np.ndarray, Over("node", name="node_times")] = field(default_factory=lambda: np.zeros(0))

    def __str__(self) -> str:
        """How the segments ended, in a sentence."""
        motions = max(1, len(set(self.experiments)))
        which = f" of {motions} experiments" if motions > 1 else ""
        run = "one run of each" if motions > 1 else "one run"
        met = f"{len(self.samples) + motions} segments{which} meet within {self.gap:.1g} of the states' ranges"
        if self.segments == 1:
            return f"The {met}, and merged into {run}."
        return (
            f"The {met}. They did not merge into {run}, since a small change of its beginning grows "
            f"{self.growth:.2g} times: the response is that of {self.segments} segments, and a "
            "simulation from the identified values leaves the data."
        )
