"""Cost of a step against the length of a chain: 10, 100, 1000 cable elements, beside Exudyn's sparse solver."""

import numpy as np

from benchmarks import cases, ours, timing
from benchmarks.peers import exudyn_models as peers

STEPS = 200


def main() -> list[dict[str, object]]:
    rows: list[dict[str, object]] = []
    for elements in (10, 100, 1000):
        bar, integration = cases.chain(elements, STEPS)
        system, peer = ours.chain(bar), peers.chain(bar, integration)

        def run(system=system, integration=integration) -> np.ndarray:
            return ours.simulated(system, integration, ("C.end.x", "C.end.y"))

        times = timing.interleaved({"ours": run, "theirs": peer.run}, repeats=3)
        row = {
            "elements": elements,
            "dalembert, us a step": times["ours"] / STEPS * 1e6,
            "Exudyn, us a step": times["theirs"] / STEPS * 1e6,
            "ratio": times["theirs"] / times["ours"],
            "difference": float(np.max(np.abs(run() - peer.run()))),
        }
        rows.append(row | _slopes(row, rows))
    timing.report("chains", "Chain pinned at one end; slope 1 = cost in proportion to the elements", rows)
    return rows


def _slopes(row: dict, before: list[dict]) -> dict[str, object]:
    """Slopes of log(cost) over log(elements) since the shorter chain."""
    names = {"slope, dalembert": "dalembert, us a step", "slope, Exudyn": "Exudyn, us a step"}
    if not before:
        return dict.fromkeys(names, "")
    step = np.log(row["elements"] / before[-1]["elements"])
    return {name: float(np.log(row[cost] / before[-1][cost]) / step) for name, cost in names.items()}


if __name__ == "__main__":
    main()
