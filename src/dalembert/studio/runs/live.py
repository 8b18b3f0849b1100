"""A run's events while it goes on: what came since the last look, and what all of them come to."""

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from dalembert.studio.runs.remaining import Remaining
from dalembert.study.run.events import OF_THE_RUN, Event, event_of
from dalembert.study.run.progress import Told

SHOWN = 200
"""Events in the list of a page."""
POINTS = 1000
"""Points of a curve that grows: beyond them every other one is left out."""


@dataclass
class Live:
    """Events of a run, read as they come.

    Parameters
    ----------
    path : Path
        ``events.jsonl``.

    Attributes
    ----------
    followed, axes : list of (float, float), (str, str)
        Amplitudes along what is followed so far, in its order, and what the axes are called.
    visited : list of (float, int, list of float)
        Simulations, number of the start, and values of the unknowns, of each iteration.
    remaining : Remaining
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
    _told: Told = field(default_factory=Told)
    _place: int = 0
    _samples: int | None = None
    _every: int = 1
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
        if self.count % self._every == 0:
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
