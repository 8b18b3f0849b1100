"""How a set inversion ended, what it cannot exclude, and what contradicts it, as findings."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from dalembert.data import Measurements
from dalembert.findings import Finding
from dalembert.inverse.problem.matching import place
from dalembert.inverse.problem.search_findings import failed_simulations
from dalembert.inverse.sets.inversion import Inversion, Nearest
from dalembert.inverse.sets.paving import Paving
from dalembert.surrogate import Surrogate
from dalembert.surrogate.unseen import unseen

NOTICED = 0.1  # part of the data's error from which that of the surrogate is mentioned
TIGHTER = "Use a scheme with a smaller tolerance."


def outcome(
    data: Measurements,
    share: float,
    paving: Paving,
    nearest: Nearest | None,
    at: str,
    believed: bool,
    failures: list[str],
) -> Iterator[Finding]:
    """Yield whether the set is empty, whether the paving was finished, and what the surrogate's error does. ``share``:
    largest error of the surrogate, in units of that of the data; ``at``: the nearest run's parameters as text;
    ``believed``: whether true runs at the corners of the inner box keep within the error; ``failures``: reasons of
    failed simulations.
    """
    yield from _paved(data, paving, nearest, at)
    yield from failed_simulations(failures)
    if share > NOTICED:
        message = (
            f"The surrogate's error is up to {share:.2g} times that of the data and widens the boundary by as much."
        )
        yield Finding("surrogate-error", "note", {"share": share}, message, TIGHTER)
    if not believed:
        message = (
            "At corners of the inner box, runs of the model differ from the data by more than their error: the error "
            "of the surrogate is larger than its estimate."
        )
        yield Finding("inner-box-contradicted", "error", {}, message, TIGHTER)


def _paved(data: Measurements, paving: Paving, nearest: Nearest | None, at: str) -> Iterator[Finding]:
    if paving.hull is None:
        message = (
            "No parameters within the bounds are consistent with the data: everywhere, the surrogate differs from the "
            "data by more than their error."
        )
        yield Finding("empty-set", "note", {}, message)
        if nearest is not None and np.isfinite(nearest.excess):
            where = place(data, nearest.output)
            message = f"The nearest run, at {at}, differs by {nearest.excess:.3g} times the error in {where}."
            advice = "Increase the error, widen the bounds, or check the model structure."
            yield Finding("nearest-run", "note", {"ratio": float(nearest.excess)}, message, advice)
    elif not paving.finished:
        message = (
            "The paving stopped before all boxes at the boundary of the set were as small as the resolution: it "
            "contains the set, but more boxes may lie inside."
        )
        advice = "Increase most_boxes, or choose a coarser resolution (a larger number)."
        yield Finding("paving-unfinished", "error", {}, message, advice)
    elif not len(paving.inside):
        message = "Paved, but no box lies completely in the set: it is thinner than the smallest boxes."
        yield Finding("thin-set", "note", {}, message, "Choose a finer resolution (a smaller number).")
    else:
        yield Finding(
            "paved", "note", {}, "Paved: all boxes at the boundary of the set are as small as the resolution."
        )


def conclusions(
    inversion: Inversion, surrogate: Surrogate, paving: Paving, left_out: np.ndarray, names: Sequence[str]
) -> Iterator[Finding]:
    """Yield the findings of an inversion, with its last ``surrogate``. ``left_out`` (n, d): consistent runs that lie in
    no box of the paving. ``names`` (d,).
    """
    narrow = unseen(inversion.first or surrogate, names)
    another = "a" if paving.hull is None else "another"
    message = f"The set may have {another} component where the response has a narrow feature. {narrow.message}"
    yield replace(narrow, message=message, advice="Search again within narrower bounds.")
    share = float(np.max(surrogate.error / inversion.error))
    if share > 1:
        yield _coarse(surrogate, inversion, share, names)
    if len(left_out):
        message = f"{len(left_out)} consistent runs lie outside of the set: the surrogate misses a component."
        advice = "Give a scheme with a smaller tolerance, or bounds close around the component."
        yield Finding("missed-component", "error", {"runs": len(left_out)}, message, advice)


def _coarse(surrogate: Surrogate, inversion: Inversion, share: float, names: Sequence[str]) -> Finding:
    slow = [names[k] for k in surrogate.slow_directions(inversion.error)]
    where = f" along {', '.join(map(repr, slow))}, as at a kink or a step" if slow else ""
    return Finding(
        "coarse-surrogate",
        "warning",
        {"share": share, "directions": ", ".join(slow)},
        f"The surrogate's error is {share:.2g} times that of the data, so that the set is much too large. "
        + (f"The coefficients do not decay{where}." if slow else ""),
        "If the response jumps over a parameter, search on each side of the jump with separate, narrower bounds. Else "
        "use a scheme with a smaller tolerance.",
    )
