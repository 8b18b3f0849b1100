"""Bounds of one method, where they are taken, and how far they can be trusted."""

from dataclasses import dataclass
from typing import ClassVar, Protocol, Self

import numpy as np

from dalembert.findings import Finding
from dalembert.uncertainty.runs import Runs


@dataclass(frozen=True, eq=False)
class MethodBounds:
    """Bounds (samples, channels), where they are taken (samples, channels, parameters), and their estimated error.
    ``kind``: "inner bound", "estimate" or "enclosure of the surrogate"; ``outcome``: their reliability, and which
    method is better; ``error``: None if unknown, a finding then has the reason; ``success``: whether it came to its
    end.
    """

    kind: str
    lower: np.ndarray
    upper: np.ndarray
    at_lower: np.ndarray | None
    at_upper: np.ndarray | None
    outcome: Finding
    findings: tuple[Finding, ...]
    error: np.ndarray | None = None
    success: bool = True


class Method(Protocol):
    """A way to bound a model over a box; its settings are its fields."""

    name: ClassVar[str]

    def most(self, runs: Runs) -> int | None:
        """Runs that it will make, None where it finds out by itself."""
        ...

    def bound(self, runs: Runs, seed: int) -> MethodBounds: ...


@dataclass(frozen=True, eq=False)
class Extremes:
    """Smallest and largest values seen so far, (samples, channels), and the points where they were seen."""

    lower: np.ndarray
    upper: np.ndarray
    at_lower: np.ndarray
    at_upper: np.ndarray

    @classmethod
    def none(cls, runs: Runs) -> Self:
        """Before the first run."""
        nowhere = np.full((*runs.shape, len(runs.box)), np.nan)
        return cls(np.full(runs.shape, np.inf), np.full(runs.shape, -np.inf), nowhere, nowhere)

    @property
    def arrays(self) -> tuple[np.ndarray, ...]:
        """The values and the points, as the arguments of the class."""
        return self.lower, self.upper, self.at_lower, self.at_upper

    def __bool__(self) -> bool:
        return bool(np.all(self.lower <= self.upper))

    def with_runs(self, points: np.ndarray, values: np.ndarray) -> "Extremes":
        """The same with more runs: points (n, parameters), values (n, samples, channels)."""
        if not len(points):
            return self
        low, high = np.argmin(values, axis=0), np.argmax(values, axis=0)
        lower = np.take_along_axis(values, low[None], axis=0)[0]
        upper = np.take_along_axis(values, high[None], axis=0)[0]
        below, above = lower < self.lower, upper > self.upper
        return Extremes(
            np.where(below, lower, self.lower),
            np.where(above, upper, self.upper),
            np.where(below[..., None], points[low], self.at_lower),
            np.where(above[..., None], points[high], self.at_upper),
        )

    def inner_bounds(self, outcome: Finding, finding: Finding, *, success: bool = True) -> MethodBounds:
        """Return the bounds of a method that runs the model where they are taken."""
        return MethodBounds("inner bound", **vars(self), outcome=outcome, findings=(finding,), success=success)

    def beyond(self, other: "Extremes") -> np.ndarray:
        """By how much these bounds are wider than others on their wider side, (samples, channels)."""
        return np.maximum(other.lower - self.lower, self.upper - other.upper)
