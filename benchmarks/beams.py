"""Flexible elements: error against time of a thin strip that swings, for ours and Exudyn's.

All candidates have the same step, so that the error is that of the elements. The reference is our cable with 64
elements.
"""

import numpy as np

from benchmarks import ours, timing
from benchmarks.cases import strip
from benchmarks.log_plot import log_plot
from benchmarks.page import PAGE
from benchmarks.peers import exudyn_models as peers

TIP = ("C.end.x", "C.end.y")
OURS = {"AncfBeam": "structural", "AncfBeam, continuum": "continuum", "AncfCable": "cable"}
THEIRS = {"Exudyn cable": "cable", "Exudyn cable, Lobatto": "cable, Lobatto", "Exudyn beam": "beam"}
COUNTS = (1, 2, 4, 8, 16, 32)
FIGURE = "beams-work-precision.svg"


def main() -> list[dict[str, object]]:
    reference = _ours("cable", 64)()
    rows = [row for count in COUNTS for row in _rows(count, reference)]
    timing.report("beams", "Thin strip that swings, 2,000 steps: error of its tip against time", rows, FIGURE)
    lines = {}
    for name in (*OURS, *THEIRS):
        own = [row for row in rows if row["element"] == name]
        lines[name] = [row["milliseconds"] for row in own], [row["error, m"] for row in own]
    text = log_plot("Thin strip that swings", "milliseconds", "largest error of the tip, m", lines)
    (PAGE.parent / "pictures" / FIGURE).write_text(text, encoding="utf-8")
    return rows


def _rows(count: int, reference: np.ndarray) -> list[dict[str, object]]:
    """One row for each element, all with ``count`` of them."""
    runs = {name: _ours(kind, count) for name, kind in OURS.items()}
    runs |= {name: peers.strip(*strip(count), kind).run for name, kind in THEIRS.items()}
    times = timing.interleaved(runs)
    return [
        {
            "element": name,
            "elements": count,
            "milliseconds": times[name] * 1e3,
            "error, m": float(np.abs(run() - reference).max()),
        }
        for name, run in runs.items()
    ]


def _ours(kind: str, count: int):
    bar, integration = strip(count)
    return ours.response(lambda: ours.strip(bar, kind), integration, TIP)


if __name__ == "__main__":
    main()
