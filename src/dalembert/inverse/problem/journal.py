"""The running account of an identification: what was simulated, and what each start did."""

from dataclasses import dataclass, field

import numpy as np

from dalembert.inverse.events import Event, OnEvent, Screened, SearchIteration, StartBegan, StartEnd
from dalembert.optimize import RegularisedStep


@dataclass(frozen=True, eq=False)
class First:
    """The first response that was computed, shape (samples, channels), perhaps of fewer samples, and its vector."""

    vector: np.ndarray
    response: np.ndarray


@dataclass
class Journal:
    """Counts simulations, keeps the steps of the search and the result of each start, and passes on every event.
    ``_iteration`` counts the steps of the current start; ``_before`` is the number of simulations before it.
    """

    samples: int  # samples of the whole data; only steps that compare all of them enter the history
    # on_event: called as ``on_event(event)`` with each event, see :mod:`dalembert.inverse.events`
    on_event: OnEvent | None = None
    simulations: int = 0  # simulations so far
    failures: list[str] = field(default_factory=list)  # reason of each failed simulation
    history: list[SearchIteration] = field(default_factory=list)  # steps of all starts
    # starts: start point, end point and misfit of each start that has ended
    starts: list[StartEnd] = field(default_factory=list)
    first: First | None = None  # the first response without NaN
    _iteration: int = 0
    _before: int = 0

    def tell(self, event: Event) -> None:
        if self.on_event is not None:
            self.on_event(event)

    def began(self, values: np.ndarray | None) -> None:
        self._iteration, self._before = 0, self.simulations
        self.tell(StartBegan(len(self.starts), self.simulations, values))

    def computed(self, vector: np.ndarray, response: np.ndarray) -> None:
        """Keep the first response without NaN."""
        if self.first is None and np.all(np.isfinite(response)):
            self.first = First(vector, response)

    def step(
        self,
        best: float,
        values: np.ndarray,
        samples: int,
        regularised: RegularisedStep | None = None,
        gap: float | None = None,
        minimised: float | None = None,
    ) -> None:
        number, spent = self._iteration, self.simulations
        step = SearchIteration(
            len(self.starts), number, spent, best, values, samples, regularised, gap, minimised, self.samples
        )
        self._iteration += 1
        if samples == self.samples:
            self.history.append(step)
        self.tell(step)

    def ended(self, start: np.ndarray, end: np.ndarray, misfit: float, success: bool, message: str) -> None:
        self.starts.append(StartEnd(start, end, misfit, success, message, self.simulations - self._before))
        self.tell(self.starts[-1])

    def screened(self, misfit: np.ndarray) -> None:
        failed = int(np.sum(~np.isfinite(misfit)))
        self.tell(Screened(len(misfit), failed, self.simulations, float(np.min(misfit))))
