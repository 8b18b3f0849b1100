"""Where the starts of a search ended, as a table of results."""

from collections.abc import Sequence

import numpy as np

from dalembert.inverse.events import StartEnd
from dalembert.tables import Table, cells, unless


def ranked(starts: Sequence[StartEnd]) -> list[int]:
    """Return the numbers of the starts, the lowest final misfit first, those that failed last."""
    return sorted(range(len(starts)), key=lambda number: np.nan_to_num(starts[number].misfit, nan=np.inf))


def starts_table(starts: Sequence[StartEnd], unknowns: Sequence[str]) -> Table:
    """Return where each start ended, the best first."""
    numbers = ranked(starts)
    ends = [starts[number] for number in numbers]
    states = unless([end.success for end in ends], "not converged")
    columns = {
        "start": [number + 1 for number in numbers],
        "misfit": cells([end.misfit for end in ends], 4),
        "simulations": [int(end.simulations) for end in ends],
        "ended": [state if state.text else "converged" for state in states],
        "message": [end.message for end in ends],
        **{f"{name} at end": [end.end[k] for end in ends] for k, name in enumerate(unknowns)},
    }
    return Table.of("starts", "Where each start ended, best first", columns, detail=True)
