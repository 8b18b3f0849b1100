"""Events of an unfinished run, and the estimated time left of its stage."""

from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from itertools import pairwise
from pathlib import Path

from dalembert.study.run.events import OF_THE_RUN, Event, event_of
from dalembert.study.run.folder import RunFolder
from dalembert.study.run.progress import ProgressText, duration_text

WINDOW = 200
"""Events that the speed is taken from."""
PARTS = 3
"""Parts of these events whose speeds are compared."""
STEADY = 2.0
"""Ratio of the largest speed of a part to the smallest one, up to which the speed is extrapolated."""


@dataclass
class Remaining:
    """How much of the stage of a run is done, by its events. Only a stage whose amount of work is settled beforehand
    has a remaining time: draws of a sampler, values of a sweep, simulations of a swarm. A least-squares method stops
    where it converges, so nothing is said of it. What follows the stage, such as profiles and the report, is not part
    of the number. ``planned`` are the simulations that the search of an identification takes; None if not settled.
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
        """Forget the speed when a run begins or resumes: repeated work is faster."""
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


SHOWN = 200
"""Events in the list of a page."""
POINTS = 1000
"""Points of a curve that grows: beyond them every other one is left out."""


@dataclass
class Live:
    """Events of a run (``events.jsonl``), read as they come. ``followed`` has the points (along, amplitude) of a path
    so far, in its order, ``axes`` the names of both. ``visited`` has simulations, number of the start, and values of
    the unknowns, of each iteration.
    """

    path: Path
    count: int = 0
    best: float = float("inf")
    values: list[float] = field(default_factory=list)
    convergence: list[tuple[float, float]] = field(default_factory=list)
    followed: list[tuple[float, float]] = field(default_factory=list)
    axes: tuple[str, str] = ("", "")
    visited: list[tuple[float, int, list[float]]] = field(default_factory=list)
    remaining: Remaining = field(default_factory=Remaining)
    recent: deque[Event] = field(default_factory=lambda: deque(maxlen=SHOWN))
    _told: ProgressText = field(default_factory=ProgressText)
    _place: int = 0
    _samples: int | None = None
    _every: int = 1
    _rated: int = 0  # events with a misfit
    _passed: int = 0
    _stride: int = 1
    _harmonics: int = 0

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the unknowns, once they are known."""
        return self._told.names

    @property
    def units(self) -> Mapping[str, tuple[str, float]]:
        """Units of the unknowns, and their sizes in SI units."""
        return self._told.units

    def name(self, names: tuple[str, ...], units: Mapping[str, tuple[str, float]] | None = None) -> None:
        """Say what the unknowns are called, and in which units they are shown."""
        self._told.names, self._told.units = names, units or {}

    def advance(self) -> bool:
        """Take in what was written since the last look; whether there was anything."""
        if not self.path.is_file():
            return False
        with self.path.open("rb") as file:
            file.seek(self._place)
            content = file.read()
        whole = content[: content.rfind(b"\n") + 1]
        self._place += len(whole)
        for line in whole.splitlines(keepends=True):
            event = event_of(line)
            if event is not None:
                self._take(event)
        return bool(whole)

    @property
    def progress(self) -> tuple[str, int, int | None]:
        """How far the run is in words, and how much is done of how much."""
        return self._told.last

    def _take(self, event: Event) -> None:
        self.count += 1
        self.recent.append(event)
        if event["event"].startswith(OF_THE_RUN):
            self.remaining.begin()
        if self._told.take(event):
            self.remaining.take(event, *self.progress[1:])
        self._follow(event)
        best = event.get("best")
        if best is None:
            return
        if event.get("samples") != self._samples:  # a misfit over more samples is another one
            self._samples, self.best = event.get("samples"), float("inf")
            self.convergence, self._every = [], 1
        if best < self.best:
            self.best, self.values = best, event.get("values") or self.values
        self._rated += 1
        if self._rated % self._every == 0:
            self.convergence.append((event.get("simulations", self.count), self.best))
            if event.get("values"):
                self.visited.append((event.get("simulations", self.count), event.get("start", 0), event["values"]))
        if len(self.convergence) > POINTS:
            self.convergence, self._every = self.convergence[::2], 2 * self._every
        if len(self.visited) > POINTS:
            self.visited = self.visited[::2]

    def _follow(self, event: Event) -> None:
        """Amplitudes along a path that grows: over frequency, or the peaks of whole curves over a parameter."""
        match event:
            case {"event": "followed", "frequency": place, "amplitude": size, "dof": dof}:
                self.axes = "frequency (Hz)", f"{dof} (m)"
                if event.get("harmonics", self._harmonics) != self._harmonics:  # the curve is followed again
                    self.followed, self._passed, self._stride = [], 0, 1
                    self._harmonics = event["harmonics"]
            case {"event": "swept", "value": place, "amplitude": size, "dof": dof, "parameter": parameter}:
                self.axes = parameter, f"peak of {dof} (m)"
            case _:
                return
        if size is None:
            return
        if self._passed % self._stride == 0:
            self.followed.append((place, size))
        self._passed += 1
        if len(self.followed) > POINTS:
            self.followed, self._stride = self.followed[::2], 2 * self._stride
