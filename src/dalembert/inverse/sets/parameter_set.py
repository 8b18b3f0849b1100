"""The result of a set inversion: all parameters that are consistent with measurements of bounded error."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.fit.stored_data import StoredData
from dalembert.results import EndedResult
from dalembert.stored_fields import Over, StoredParameters, StoredSides, Table
from dalembert.tables import Table as ResultTable
from dalembert.tables import box_table, counted, few_values, interval, shown


@dataclass(frozen=True, eq=False)
class ParameterSet(EndedResult):
    """The set ``{p : |R(p) − data| ≤ error everywhere}`` within the parameters' bounds, paved with boxes.

    Parameters
    ----------
    parameters : Parameters
    data : Measurements
    error : array, shape (samples, channels)
        Largest error that the measurements may have.
    inside, boundary : array, shape (boxes, 2, parameters)
        Boxes, lower and upper corner, that lie wholly in the set, and those of which it is not known. No box is in
        both, and they meet only in their faces.
    outer : Box
        The smallest box around all of them: it holds the set, as far as the runs see it. None for an empty set.
    inner : Box
        The largest box found in the set; None if there is none.
    surrogate_error : array, shape (samples, channels)
        Estimate of the surrogate's largest error, by which the conditions are widened.
    resolution : float
        Boxes are divided down to this part of the bounds' width.
    runs : int
        Simulations.
    seconds : float
        Spent on the whole inversion.
    success : bool
        Whether the paving was finished; it is right, but coarser, where not.
    outcome : tuple of Finding
        How the inversion ended; ``status`` is their text.
    provenance : mapping
        Versions, seed, hashes of model and data, scheme and settings.
    findings : tuple of Finding
        What the method concludes about the result.
    """

    FORMAT: ClassVar[str] = "dalembert parameterset 1"
    TITLE: ClassVar[str] = "Consistent parameters"
    VERDICTS: ClassVar[tuple[str, str]] = ("found", "not settled")

    parameters: StoredParameters
    data: StoredData
    error: Table
    inside: Annotated[np.ndarray, Over("inside_box", "side", "parameter")]
    boundary: Annotated[np.ndarray, Over("boundary_box", "side", "parameter")]
    outer: StoredSides
    inner: StoredSides
    surrogate_error: Table
    resolution: float
    runs: int
    seconds: float
    success: bool
    outcome: tuple[Finding, ...]
    provenance: Mapping[str, Any]
    findings: tuple[Finding, ...] = ()

    @property
    def empty(self) -> bool:
        """Return True if no box is left; the finding "unseen-features" has what the runs cannot exclude."""
        return self.outer is None

    @property
    def volume(self) -> tuple[float, float]:
        """Bounds of the set's volume, in the product of the parameters' units."""
        inside, boundary = (float(np.sum(np.prod(boxes[:, 1] - boxes[:, 0], axis=1))) for boxes in self._paved)
        return inside, inside + boundary

    @property
    def _paved(self) -> tuple[np.ndarray, np.ndarray]:
        return self.inside, self.boundary

    def contains(self, points: np.ndarray) -> np.ndarray:
        """For points (n, parameters): 1.0 where one lies in the set, 0.0 where not, NaN where it is not known."""
        inside, boundary = (
            np.array(
                [np.any(np.all((boxes[:, 0] <= point) & (point <= boxes[:, 1]), axis=1)) for point in points], bool
            )
            for boxes in self._paved
        )
        return np.where(inside, 1.0, np.where(boundary, np.nan, 0.0))

    @property
    def verdict(self) -> str:
        return "empty" if self.empty else super().verdict

    def key_values(self) -> dict[str, str]:
        box = self.outer
        ends = [] if box is None else [f"in {interval(*pair)}" for pair in zip(box.lower, box.upper, strict=True)]
        return few_values(self.parameters, ends) if ends else {}

    def facts(self) -> dict[str, str]:
        searched = float(np.prod(self.parameters.upper - self.parameters.lower))
        least, most = (shown(100 * volume / searched, digits=3) for volume in self.volume)
        return {
            "part of what was searched": f"{least} to {most} %",
            "boxes": f"{counted(len(self.inside))} inside, {counted(len(self.boundary))} on the boundary",
            "runs of the model": counted(self.runs),
            "time": f"{shown(self.seconds, digits=3)} s",
        }

    def tables(self) -> tuple[ResultTable, ...]:
        """Return the outer and the inner box."""
        boxes = {
            "Outer box: all consistent parameters lie in it": self.outer,
            "Inner box: all parameters in it are consistent": self.inner,
        }
        return tuple(
            box_table(box, caption, f"{caption[:5].lower()}-box", units=self.parameters.units(box.names))
            for caption, box in boxes.items()
            if box is not None
        )
