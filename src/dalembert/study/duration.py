"""About how long a study takes, from one timed evaluation."""

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter

import numpy as np
from numpy.typing import ArrayLike

from dalembert.forward import ForwardModel


@dataclass(frozen=True)
class Effort:
    """What a study spends its time with.

    Parameters
    ----------
    once : callable
        A small part of it.
    simulations : float
        How many simulations that part stands for.
    least, most : int or None
        Expected number of simulations; None where the method decides on the way.
    source : str
        What the part is, in words.
    """

    once: Callable[[], object]
    simulations: float
    least: int | None
    most: int | None
    source: str


TOGETHER = 4
"""Simulations timed at once where a method runs them in batches, over all cores."""


def evaluated(model: ForwardModel, vector: ArrayLike, least: int | None, most: int | None, batch: int = 1) -> Effort:
    """Effort of evaluations at a parameter vector (parameters,), ``batch`` of them at once."""
    vectors = np.tile(np.asarray(vector, dtype=float), (batch, 1))
    source = "one at the first guesses" if batch == 1 else f"{batch} at once at the first guesses"
    return Effort(lambda: model.evaluate(vectors), batch, least, most, source)


def duration(effort: Effort) -> str:
    """About how long it takes, in a sentence; the part is run for it."""
    began = perf_counter()
    effort.once()
    each = (perf_counter() - began) / effort.simulations
    if effort.least is None or effort.most is None:
        return f"A simulation takes about {spoken(each)} ({effort.source}); how many there will be shows on the way."
    if effort.most == 1:
        return f"This takes about {spoken(each)} ({effort.source})."
    times = [spoken(count * each) for count in dict.fromkeys((effort.least, effort.most))]
    counts = " to ".join(str(count) for count in dict.fromkeys((effort.least, effort.most)))
    return f"This takes about {' to '.join(times)}: {counts} simulations of {spoken(each)} ({effort.source})."


def spoken(seconds: float) -> str:
    """A duration as people say it, to two digits.

    >>> [spoken(value) for value in (2.345e-4, 0.1234, 41.7, 250.0, 7400.0)]
    ['0.23 ms', '0.12 s', '42 s', '4.2 min', '2.1 h']
    """
    for size, unit in ((3600.0, "h"), (60.0, "min"), (1.0, "s")):
        if seconds >= 2 * size:
            return f"{seconds / size:.2g} {unit}" if seconds < 100 * size else f"{seconds / size:.0f} {unit}"
    return f"{seconds:.2g} s" if seconds >= 0.01 else f"{1e3 * seconds:.2g} ms"
