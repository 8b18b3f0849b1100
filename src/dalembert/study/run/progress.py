"""The progress of a run in words: a live line on a terminal, a line now and then elsewhere."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from time import monotonic
from typing import TYPE_CHECKING, Self

from dalembert.study.run.events import LOST, STORAGE, Event

if TYPE_CHECKING:
    from rich.console import Console
    from rich.progress import Progress

DAY = 86_400.0
"""Seconds."""
_EVERY = 2.0  # s between plain lines
MOST_LISTED = 8
"""Unknowns whose values a line lists."""


@dataclass
class ProgressText:
    """How far a run is, in words, from its events. ``names``: of the unknowns, for the best values; ``last``: the last
    text, and how much is done of how much, None where that is not known; ``units``: in which the unknowns are listed,
    and their sizes in SI units; without a unit for others.
    """

    names: tuple[str, ...] = ()
    last: tuple[str, int, int | None] = ("", 0, None)
    units: Mapping[str, tuple[str, float]] = field(default_factory=dict)
    _best: float = field(default=float("inf"), init=False)
    _values: list[float] = field(default_factory=list, init=False)
    _samples: int | None = field(default=None, init=False)

    def take(self, event: Event) -> bool:
        """Take in an event; return whether it changed the text."""
        text, done, total = self._text(event)
        if text:
            self.last = text, done, total
        return bool(text)

    def _text(self, event: Event) -> tuple[str, int, int | None]:
        match event:
            case {"event": "iteration", "best": best, "values": values, "start": start, "simulations": simulations}:
                said = f"start {start + 1} · {simulations} simulations"
                least = event.get("minimised")
                if least is not None and best is not None:  # it weighs gaps ever more, so that no two compare
                    return f"{said} · {_in_segments(least, best, event['gap'])}{self._listed(values)}", 0, None
                if event.get("samples") != self._samples:  # a misfit over more samples is another one
                    self._samples, self._best = event.get("samples"), float("inf")
                if best is not None and best < self._best:
                    self._best, self._values = best, values
                return f"{said} · {_horizon(event)}{self._best_values}", 0, None
            case {"event": "swept", "parameter": name, "value": value, "done": done, "total": total}:
                return f"{name} = {value:.6g} · {done} of {total}", done, total
            case {"event": "balanced", "parameter": name, "value": value, "points": points}:
                return f"{name} = {value:.6g} · {points} equilibria", 0, None
            case {"event": "ran", "method": method, "runs": runs, "failed": failed, "most": most}:
                return f"{method} · {runs} simulations" + (f", {failed} failed" if failed else ""), runs, most
            case {"event": "sampled", "runs": runs}:
                return f"surrogate · {runs} simulations", 0, None
            case {"event": "checked", "runs": runs, "error": error}:
                return f"check by {runs} simulations" + ("" if error is None else f" · wrong by {error:.2g}"), 0, None
            case {"event": "paved", "inside": inside, "boundary": boundary, "waiting": waiting}:
                return f"{inside} boxes inside, {boundary} on the boundary, {waiting} to look at", 0, None
            case {"event": "profiled", "parameter": name, "simulations": simulations}:
                return f"profile of {name} · {simulations} simulations", 0, None
            case {"event": "drawn", "draws": draws, "of": of}:
                return f"{draws} of {of} draws", draws, of
            case {"event": "penalised", "round": number, "of": most, "weight": weight, "simulations": simulations}:
                return f"round {number} of at most {most} · weight {weight:.3g} · {simulations} simulations", 0, None
            case {"event": "following", "begin": begin, "end": end}:
                return f"following the response from {begin:g} to {end:g} Hz", 0, None
            case {"event": "followed", "frequency": frequency, "amplitude": amplitude, "dof": dof, "done": part}:
                size = "not found" if amplitude is None else f"{dof} {amplitude:.4g} m"
                return f"{frequency:.6g} Hz · {size} · {part:.0%} of the way", round(100 * part), 100
            case {"event": "run-compiling", "done": done, "total": total}:
                return f"compiling kernels, once on this machine · {done} of {total}", done, total
            case {"event": "simulating", "end": end}:
                return f"simulating to {end:g} s", 0, None
        return "", 0, None

    @property
    def _best_values(self) -> str:
        return " · ".join(filter(None, (f"best {self._best:.4g}", self._listed(self._values))))

    def _listed(self, values: list[float]) -> str:
        listed = (
            (name, value, self.units.get(name, ("", 1.0))) for name, value in zip(self.names, values, strict=False)
        )
        texts = [f"{name} = {value / size:.6g} {unit}".rstrip() for name, value, (unit, size) in listed]
        more = [f"and {len(texts) - MOST_LISTED} more"] if len(texts) > MOST_LISTED else []
        return ", ".join([*texts[:MOST_LISTED], *more])


def _in_segments(least: float, misfit: float, gap: float) -> str:
    return f"minimised {least:.4g} = misfit {misfit:.4g} + weighted gaps, largest gap {gap:.2g} · "


def _horizon(event: Event) -> str:
    """The samples that the best misfit is of, while they are not all: more of them make it rise."""
    samples, of = event.get("samples"), event.get("of")
    if samples is None or of is None or samples == of:
        return ""
    return f"first {samples} of {of} samples; the best misfit grows with their number · "


@dataclass
class Watch:
    """Listener of a run's events that prints how far it is; ``names``: of the unknowns, for the best values."""

    console: "Console"
    names: tuple[str, ...] = ()
    _live: "Progress | None" = field(default=None, init=False)
    _next: float = field(default=0.0, init=False)
    _progress: ProgressText = field(init=False)

    def __post_init__(self) -> None:
        self._progress = ProgressText(self.names)

    def __enter__(self) -> Self:
        if self.console.is_terminal:
            from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

            columns = SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn()
            self._live = Progress(*columns, console=self.console, transient=True)
            self._live.start()
            self._live.add_task("starting", total=None)
        return self

    def __exit__(self, *error: object) -> None:
        if self._live is not None:
            self._live.stop()

    def __call__(self, event: Event) -> None:
        if event["event"] in (LOST, STORAGE):
            self.console.print(event["message"], markup=False, highlight=False)
        if not self._progress.take(event):
            return
        text, done, total = self._progress.last
        if self._live is not None:
            self._live.update(self._live.task_ids[0], description=text, completed=done, total=total)
        elif monotonic() >= self._next:
            self._next = monotonic() + _EVERY
            self.console.print(text, markup=False, highlight=False)


def duration_text(seconds: float) -> str:
    """Return a duration with two digits.
    >>> [duration_text(value) for value in (2.345e-4, 0.1234, 41.7, 250.0, 7400.0, 9e5, 1.33e9, 1e15)]
    ['0.23 ms', '0.12 s', '42 s', '4.2 min', '2.1 h', '10 days', '42 years', '3.2e+07 years']
    """
    units = ((365.25 * DAY, " years"), (DAY, " days"), (3600.0, " h"), (60.0, " min"), (1.0, " s"))
    for size, unit in units:
        if seconds >= 2 * size:
            number = seconds / size
            return f"{number:.0f}{unit}" if 9.95 <= number < 1e4 else f"{number:.2g}{unit}"
    return f"{seconds:.2g} s" if seconds >= 0.01 else f"{1e3 * seconds:.2g} ms"


def size_text(size: float) -> str:
    """Return a size in bytes with two digits.
    >>> [size_text(value) for value in (512, 48_000, 2.4e8, 3.1e12)]
    ['0.51 kB', '48 kB', '240 MB', '3.1 TB']
    """
    for unit in ("kB", "MB", "GB", "TB"):
        size /= 1000
        if size < 999.5 or unit == "TB":
            break
    return f"{float(f'{size:.2g}'):g} {unit}"
