"""Surrogates of a model's outputs over a box of search coordinates."""

import numpy as np

from dalembert.errors import SolveError
from dalembert.inverse.events import Sampled
from dalembert.inverse.problem.journal import Journal
from dalembert.surrogate import Surrogate, fit
from dalembert.surrogate.runs import Function
from dalembert.surrogate.scheme import Scheme


def surrogate_of(
    run: Function,
    lower: np.ndarray,
    upper: np.ndarray,
    scheme: Scheme,
    journal: Journal,
    *,
    shape: tuple[int, int],
    seed: int,
    held_out: int | None = None,
    groups: np.ndarray | None = None,
) -> Surrogate:
    """Surrogate of (samples, channels) = ``shape`` outputs, recorded in the journal.

    Each channel has a separate scale, or the outputs that have one number in ``groups`` (outputs,).
    """
    samples, channels = shape
    before = len(journal.failures)
    try:
        return fit(
            run,
            lower,
            upper,
            scheme,
            seed=seed,
            held_out=held_out,
            groups=np.tile(np.arange(channels), samples) if groups is None else groups,
            on_runs=lambda runs: journal.tell(Sampled(runs, journal.simulations)),
        )
    except SolveError as error:
        if len(journal.failures) == before:
            raise
        raise SolveError(f"{error}; the model's first failure: {journal.failures[before]}") from error
