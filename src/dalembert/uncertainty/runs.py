"""The runs of a model for a method: counted, reported, and independent of failures of each other."""

from dataclasses import dataclass, field

import numpy as np

from dalembert.errors import InputError, SolveError, StorageError, told
from dalembert.forward import ForwardModel
from dalembert.intervals import Box
from dalembert.uncertainty.events import Event, OnEvent, Ran


@dataclass
class Runs:
    """A model over a box, and the account of its runs."""

    model: ForwardModel
    box: Box  # an interval for each parameter, in the model's order
    method: str  # in whose name events are told
    on_event: OnEvent | None = None
    most: int | None = None  # runs that the method will make, where it knows
    count: int = 0
    failures: list[str] = field(default_factory=list)

    @property
    def free(self) -> np.ndarray:
        """Places of the intervals that have a width."""
        return np.flatnonzero(self.box.lower < self.box.upper)

    @property
    def shape(self) -> tuple[int, int]:
        """(samples, channels)."""
        return len(self.model.coordinate.values), len(self.model.channels)

    def values(self, points: np.ndarray) -> np.ndarray:
        """Values (n, samples, channels) at points (n, parameters); NaN throughout a run that failed."""
        responses = self.model.evaluate(points)
        values = np.array(responses.values, dtype=float)
        for row, (point, reason) in enumerate(zip(points, responses.failures, strict=True)):
            if reason is None and not np.all(np.isfinite(values[row])):
                reason = "the response is not finite"
            if reason is not None:
                values[row] = np.nan
                self._failed(point, reason)
        self._ran(len(points))
        return values

    def repeat(self, runs: int, failures: list[str]) -> None:
        """Count runs of an earlier process, and those of them that failed."""
        self.failures += failures
        self._ran(runs)

    def linearised(self, point: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
        """Response (samples, channels) and jacobian (samples, channels, parameters) at a point; None if it failed."""
        try:
            response, jacobian = self.model.linearise(point)
            if not (np.all(np.isfinite(response)) and np.all(np.isfinite(jacobian))):
                raise SolveError("the response or its jacobian is not finite")
        except (InputError, StorageError):  # no other point will do better
            raise
        except Exception as error:  # whatever a user's function raises is this point's failure
            self._failed(point, told(error))
            return None
        finally:
            self._ran(1 + len(point))
        return response, jacobian

    def place(self, output: int) -> str:
        """Channel and sample of an output, counted through the channels of the first sample, then of the second …"""
        sample, column = divmod(output, self.shape[1])
        along = self.model.coordinate
        at = f"{along.name} {along.values[sample]:.6g} {along.unit}".rstrip()
        return f"channel {self.model.channels[column].name!r}, {at}"

    def tell(self, event: Event) -> None:
        if self.on_event is not None:
            self.on_event(event)

    def none_succeeded(self) -> SolveError:
        """The error of a method of which every run failed."""
        return SolveError(f"{self.method}: all {self.count} runs failed, the first: {self.failures[0]}")

    def _ran(self, runs: int) -> None:
        self.count += runs
        self.tell(Ran(self.method, self.count, len(self.failures), self.most))

    def _failed(self, point: np.ndarray, reason: str) -> None:
        where = ", ".join(f"{name} = {value:.6g}" for name, value in zip(self.box.names, point, strict=True))
        self.failures.append(f"{reason} (at {where})")
