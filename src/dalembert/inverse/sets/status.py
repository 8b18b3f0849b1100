"""How a set inversion went, in full sentences with advice."""

import numpy as np

from dalembert.data import Measurements
from dalembert.inverse.problem.matching import place
from dalembert.inverse.sets.inversion import Nearest
from dalembert.inverse.sets.paving import Paving

NOTICED = 0.1
"""Part of the data's error from which that of the surrogate is mentioned."""


def status(
    data: Measurements,
    share: float,
    paving: Paving,
    nearest: Nearest | None,
    at: str,
    believed: bool,
    failures: list[str],
) -> str:
    """Whether the set is empty, whether the paving was finished, what the surrogate adds, what true runs say.

    Parameters
    ----------
    share : float
        Largest error of the surrogate, in units of that of the data.
    at : str
        The nearest run's parameters as text.
    believed : bool
        Whether true runs at the corners of the inner box keep within the error.
    """
    parts = []
    if paving.hull is None:
        parts.append("No consistent parameters: the surrogate leaves the error everywhere within the bounds.")
        if nearest is not None and np.isfinite(nearest.excess):
            parts.append(
                f"The nearest run, at {at}, differs by {nearest.excess:.3g} times the error in "
                f"{place(data, nearest.output)}; raise the error, widen the bounds, or look what the model lacks."
            )
    elif not paving.finished:
        parts.append(
            "The paving ended before its boundary was sharp: it holds the set, but more may be inside; raise "
            "most_boxes or the resolution."
        )
    elif not len(paving.inside):
        parts.append(
            "Paved, but no box lies wholly in the set: it is thinner than the resolution, which may be lowered."
        )
    else:
        parts.append("Paved down to the resolution.")
    if failures:
        parts.append(f"{len(failures)} simulations failed and were passed over, the first: {failures[0]}.")
    if share > NOTICED:
        parts.append(
            f"The surrogate's error is up to {share:.2g} times that of the data, and widens the boundary by as much; "
            "give a scheme with a smaller tolerance."
        )
    if not believed:
        parts.append(
            "True runs at the corners of the inner box leave the error: the surrogate is worse than its estimate; give "
            "a scheme with a smaller tolerance."
        )
    return " ".join(parts)
