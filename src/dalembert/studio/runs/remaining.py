"""About how long a run still takes, from what it did so far."""

from collections import deque
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path

from dalembert.study.events import Event
from dalembert.study.folder import RunFolder
from dalembert.study.spoken import spoken

WINDOW = 200
"""Events that the speed is taken from."""


@dataclass
class Remaining:
    """How much of a run is done, by its events.

    Parameters
    ----------
    most : int or None
        Simulations that the run takes at most, where that is known.
    """

    most: int | None = None
    _seen: deque[tuple[float, float]] = field(default_factory=lambda: deque(maxlen=WINDOW))
    _total: float | None = None

    def take(self, event: Event, done: int, total: int | None) -> None:
        """Take in an event, and how much is done of how much after it."""
        if event["event"] in ("run-started", "run-resumed", "run-compiling"):
            self._seen.clear()  # what is compiled or repeated has another speed
            return
        amount = done if total else event.get("simulations")
        if amount is None or "at" not in event:
            return
        if self._seen and (amount < self._seen[-1][1] or (self._total is None) != (total is None)):
            self._seen.clear()
        self._total = total
        self._seen.append((datetime.fromisoformat(event["at"]).timestamp(), float(amount)))

    def sentence(self) -> str:
        """Return how long it still takes; empty if that is not known.

        Where a method decides on its number of simulations, this is an upper limit.
        """
        goal = self._total or self.most
        if goal is None or len(self._seen) < 2:
            return ""
        (begin, first), (end, last) = self._seen[0], self._seen[-1]
        if end <= begin or last <= first or last >= goal:
            return ""
        seconds = (goal - last) * (end - begin) / (last - first)
        return f"{'about' if self._total else 'at most'} {spoken(seconds)} left"


def most_simulations(run: Path) -> int | None:
    """Return how many simulations a run takes at most; None where its method decides on the way."""
    from dalembert.study.tasks import TASKS

    study = RunFolder(run).kept()
    return TASKS[study.task].effort(study).most
