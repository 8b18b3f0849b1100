"""What a set inversion cannot exclude, and what contradicts it, as findings."""

from collections.abc import Iterator, Sequence

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.sets.inversion import Inversion
from dalembert.inverse.sets.paving import Paving
from dalembert.surrogate import Surrogate
from dalembert.surrogate.unseen import unseen


def conclusions(
    inversion: Inversion, surrogate: Surrogate, paving: Paving, left_out: np.ndarray, names: Sequence[str]
) -> Iterator[Finding]:
    """Yield the findings of an inversion.

    ``surrogate``: the last one.
    ``left_out`` (n, d): consistent runs that lie in no box of the paving.
    ``names`` sequence of str, of length d.
    """
    yield _unseen(inversion.first or surrogate, paving, names)
    share = float(np.max(surrogate.error / inversion.error))
    if share > 1:
        yield _coarse(surrogate, inversion, share, names)
    if len(left_out):
        message = f"{len(left_out)} consistent runs lie outside of the set: the surrogate misses a component."
        advice = "Give a scheme with a smaller tolerance, or bounds close around the component."
        yield Finding("missed-component", "error", {"runs": len(left_out)}, message, advice)


def _unseen(first: Surrogate, paving: Paving, names: Sequence[str]) -> Finding:
    seen = unseen(first, names)
    another = "a" if paving.hull is None else "another"
    message = f"The set may have {another} component where the response has a narrow feature. {seen.message}"
    return Finding(seen.code, seen.severity, seen.values, message, "Search again within narrower bounds.")


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
