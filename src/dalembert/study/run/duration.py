"""About how long a study takes: the time of a short part of a simulation, extrapolated to the whole."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from queue import Empty, Queue
from threading import Thread
from time import monotonic, perf_counter
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from dalembert.errors import SolveError
from dalembert.findings import Finding
from dalembert.forward import ForwardModel, Sensors
from dalembert.forward.wrapped import Wrapped
from dalembert.study.run.progress import DAY, duration_text, size_text

ENOUGH = 0.3
"""Seconds of simulation that are extrapolated, at least, where the whole takes longer."""

SHORTEST = 1e-3
"""Share of a motion that is simulated first where the integrator chooses its steps."""

STEPS = 100
"""Steps that are simulated first where their length is given."""

SMALL = 10_000_000
"""Bytes of a checkpoint that are not worth a sentence."""

TOGETHER = 4
"""Simulations timed at once where a method runs them in batches, over all cores."""


class StartFailed(SolveError):
    """A simulation at the first guesses that fails. A run may succeed all the same: other starts may not fail."""


@dataclass(frozen=True)
class Effort:
    """What a study spends its time with. ``part(share)`` computes a share, between 0 and 1, of what ``source`` says in
    words, and returns the share that it computed; 1 where that cannot be cut. ``shortest``: share to begin with;
    ``simulations``: number that the whole of it stands for; ``least``, ``most``: expected numbers of simulations, None
    where the method decides on the way; ``response``: size of the response of a simulation, bytes, 0 if the checkpoint
    keeps none; ``kept``: number of responses that it keeps at once, all if None.
    """

    part: Callable[[float], float]
    simulations: float
    least: int | None
    most: int | None
    source: str
    shortest: float = 1.0
    response: int = 0
    kept: int | None = None


@dataclass(frozen=True)
class Timing:
    """Seconds of a simulation, and the share of it that was computed to know them."""

    each: float
    share: float


def repeatedly(once: Callable[[], object]) -> Callable[[float], float]:
    """Return a computation that cannot be cut, as the part of an effort; it runs once beforehand, to compile."""
    once()

    def part(share: float) -> float:
        once()
        return 1.0

    return part


def evaluated(
    model: ForwardModel,
    vector: ArrayLike,
    least: int | None,
    most: int | None,
    batch: int = 1,
    kept: int | None = None,
) -> Effort:
    """Return the effort of evaluations at a parameter vector (parameters,), ``batch`` of them at once."""
    runs = list(_simulated(model, np.asarray(vector, dtype=float)))

    def part(share: float) -> float:
        done = [_evaluate(model_part, vector_here, share, batch) for model_part, vector_here in runs]
        return float(np.mean(done))

    source = "one at the first guesses" if batch == 1 else f"{batch} at once at the first guesses"
    response = 8 * len(model.coordinate.values) * len(model.channels)
    return Effort(
        part, batch, least, most, source, max(_shortest(model_part) for model_part, _ in runs), response, kept
    )


def shortest_of(solver: Any, end: float) -> float:
    """Return the share of a motion until ``end`` (s) that is simulated first."""
    step = solver.fixed_step
    return SHORTEST if step is None else min(1.0, STEPS * step / end)


def timed(effort: Effort) -> Timing:
    """Return the time of a simulation. Parts grow until the simulation itself takes long enough to be extrapolated."""
    done, first = _clocked(effort, effort.shortest)
    if done < 1 or first < ENOUGH:
        done, first = _clocked(effort, effort.shortest)  # without what happens only once
    begin, share, seconds = done, done, first
    while share < 1 and seconds - first < ENOUGH:
        known = seconds - first if share > begin else first  # at first all may be the simulation
        more = min(50.0, 1.5 * ENOUGH / max(known, 1e-9)) * (share - begin or begin)
        share, seconds = _clocked(effort, min(1.0, share + max(share, more)))
    if share < 1:
        seconds = first + (seconds - first) * (1 - begin) / (share - begin)
    return Timing(seconds / effort.simulations, share)


def duration(effort: Effort, timing: Timing) -> str:
    """Return a sentence on how long a study takes."""
    each, part = timing.each, ""
    if timing.share < 1:
        part = f", extrapolated from its first {100 * timing.share:.2g} %"
    source = f"{effort.source}{part}"
    if effort.least is None or effort.most is None:
        return f"A simulation takes about {duration_text(each)} ({source}); how many there will be shows on the way."
    if effort.most == 1:
        return f"This takes about {duration_text(each)} ({source})."
    times = [duration_text(count * each) for count in dict.fromkeys((effort.least, effort.most))]
    counts = " to ".join(str(count) for count in dict.fromkeys((effort.least, effort.most)))
    return f"This takes about {' to '.join(times)}: {counts} simulations of {duration_text(each)} ({source})."


def storage(effort: Effort) -> str:
    """Return a sentence on the size of the checkpoint of a run; an empty text if it is small."""
    number = effort.kept if effort.kept is not None else effort.most
    if number is None:
        if effort.response < SMALL / 1000:
            return ""
        return f"Each simulation adds {size_text(effort.response)} to the checkpoint, which the run removes at its end."
    if number * effort.response < SMALL:
        return ""
    return f"The checkpoint takes up to {size_text(number * effort.response)} until the run ends."


def too_long(effort: Effort, timing: Timing) -> Finding | None:
    """Return a finding about a study that takes more than a day."""
    seconds = timing.each * (effort.most or 1)
    if seconds <= DAY:
        return None
    return Finding(
        "long-run",
        "warning",
        {"seconds": seconds, "simulation": timing.each},
        f"The study may take {duration_text(seconds)}, more than a day.",
        "Check the step of the solver and the number of samples, simulate a shorter motion, or use a cluster.",
    )


def within(limit: float, sentences: Callable[[], Iterator[str]]) -> Iterator[str]:
    """Yield sentences as they come, for at most ``limit`` seconds; their thread is left behind after that."""
    answers: Queue[str | BaseException | None] = Queue()

    def work() -> None:
        try:
            for sentence in sentences():
                answers.put(sentence)
            answers.put(None)
        except BaseException as error:  # it is raised where the sentences are read
            answers.put(error)

    Thread(target=work, daemon=True).start()
    end = monotonic() + limit
    while True:
        try:
            answer = answers.get(timeout=max(0.0, end - monotonic()))
        except Empty:
            raise TimeoutError from None
        if answer is None:
            return
        if isinstance(answer, BaseException):
            raise answer
        yield answer


def _clocked(effort: Effort, share: float) -> tuple[float, float]:
    began = perf_counter()
    done = effort.part(share)
    return done, perf_counter() - began


def _simulated(model: Any, vector: np.ndarray) -> Iterator[tuple[Any, np.ndarray]]:
    """Models that simulate in the place of a model, and their parameter vectors."""
    if hasattr(model, "wiring"):
        for part, wiring in zip(model.models, model.wiring, strict=True):
            yield from _simulated(part, vector[wiring])
    elif isinstance(model, Wrapped | Sensors):
        yield from _simulated(model.model, vector[: len(model.model.parameters)])
    else:
        yield model, vector


def _shortest(model: Any) -> float:
    if not hasattr(model, "part"):
        return 1.0
    return shortest_of(model.solver, float(model.times[-1])) if hasattr(model, "times") else 0.0


def _evaluate(model: Any, vector: np.ndarray, share: float, batch: int) -> float:
    part, done = model.part(share) if hasattr(model, "part") and share < 1 else (model, 1.0)
    failure = part.evaluate(np.tile(vector, (batch, 1))).failures[0]
    if failure is not None:
        raise StartFailed(failure)
    return done
