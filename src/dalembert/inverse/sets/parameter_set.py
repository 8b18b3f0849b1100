"""The result of a set inversion: all parameters that are consistent with measurements of bounded error."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.fit.stored_data import StoredData
from dalembert.results import EndedResult, fact_lines, fixed_lines, text_table
from dalembert.stored_fields import Over, StoredParameters, StoredSides, Table


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
        inside, boundary = (np.array([_in_any(boxes, point) for point in points], dtype=bool) for boxes in self._paved)
        return np.where(inside, 1.0, np.where(boundary, np.nan, 0.0))

    def summary(self) -> str:
        """Return a table of outer and inner intervals with unit and bounds, then volume, effort and findings."""
        rows: list[tuple[str, ...]] = [("parameter", "outer", "inner", "unit", "bounds")]
        for item in self.parameters:
            outer, inner = ("none" if box is None else str(box[item.name]) for box in (self.outer, self.inner))
            rows.append((item.name, outer, inner, item.unit, f"{item.lower:.6g} to {item.upper:.6g}"))
        smallest, largest = self.volume
        facts = [
            *fact_lines(
                volume=f"{smallest:.6g} to {largest:.6g}",
                boxes=f"{len(self.inside)} inside, {len(self.boundary)} on the boundary",
                simulations=self.runs,
                seconds=f"{self.seconds:.2g}",
            ),
            *fixed_lines(self),
        ]
        return "\n".join([*text_table(rows), "", *facts, "", self.status, *map(str, self.findings)])


def _in_any(boxes: np.ndarray, point: np.ndarray) -> bool:
    return bool(np.any(np.all((boxes[:, 0] <= point) & (point <= boxes[:, 1]), axis=1)))
