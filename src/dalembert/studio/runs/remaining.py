"""About how long the stage of a run still takes, from what it did so far."""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import datetime
from itertools import pairwise
from pathlib import Path

from dalembert.study.run.events import Event
from dalembert.study.run.folder import RunFolder
from dalembert.study.run.progress import duration_text

WINDOW = 200
"""Events that the speed is taken from."""
PARTS = 3
"""Parts of these events whose speeds are compared."""
STEADY = 2.0
"""Ratio of the largest speed of a part to the smallest one, up to which the speed is extrapolated."""


@dataclass
class Remaining:
    """How much of the stage of a run is done, by its events.

    Only a stage whose amount of work is settled beforehand has a remaining time: draws of a sampler, values of a sweep,
    simulations of a swarm. A least-squares method stops where it converges, so nothing is said of it. What follows the
    stage, such as profiles and the report, is not part of the number.

    Parameters
    ----------
    planned : int or None
        Simulations that the search of an identification takes, where they are settled beforehand.
    """

    planned: int | None = None
    _seen: deque[tuple[float, float]] = field(default_factory=lambda: deque(maxlen=WINDOW))
    _stage: tuple[object, ...] = ()
    _total: float | None = None

    def take(self, event: Event, done: int, total: int | None) -> None:
        """Take in an event that shows progress, and how much is done of how much after it."""
        stage = event["event"], event.get("method"), total
        if stage != self._stage:
            self._seen.clear()  # another stage has another speed
            self._stage = stage
        self._total = total
        amount = event.get("simulations") if self._searches else done
        if amount is None or "at" not in event:
            return
        if self._seen and amount < self._seen[-1][1]:
            self._seen.clear()
        self._seen.append((datetime.fromisoformat(event["at"]).timestamp(), float(amount)))

    def begin(self) -> None:
        """Forget the speed, as the run begins or goes on: what is repeated has another one."""
        self._seen.clear()

    def sentence(self) -> str:
        """Return how long the stage still takes; empty if that is not known."""
        goal = self.planned if self._searches else self._total
        if goal is None or len(self._seen) <= PARTS or self._seen[-1][1] >= goal:
            return ""
        speeds = list(self._speeds())
        if not 0 < max(speeds) <= STEADY * min(speeds) < float("inf"):
            return ""
        (begin, first), (end, last) = self._seen[0], self._seen[-1]
        return f"about {duration_text((goal - last) * (end - begin) / (last - first))} left in this stage"

    @property
    def _searches(self) -> bool:
        return self._stage[:1] == ("iteration",)

    def _speeds(self) -> Iterator[float]:
        """Yield the speed of each part of what was seen."""
        seen = list(self._seen)
        places = [part * (len(seen) - 1) // PARTS for part in range(PARTS + 1)]
        for before, after in pairwise(places):
            (begin, first), (end, last) = seen[before], seen[after]
            yield (last - first) / (end - begin) if end > begin else float("inf")


def planned_simulations(run: Path) -> int | None:
    """Return how many simulations the search of a run takes; None where its method decides on the way."""
    from dalembert.study.tasks import TASKS

    study = RunFolder(run).kept()
    return TASKS[study.task].planned(study)
