"""The reduced system of a model: which of its rows belong to each component, each node and each unknown."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from dalembert.errors import ModelError
from dalembert.multibody.kernels.charts import Chart
from dalembert.multibody.kernels.kind import Kind

_NODAL = -1  # row of an unknown of a node, which has none


class Reduction(NamedTuple):
    """Rows of the reduced system: increments, then multipliers of all but internal constraints. ``size``: number of
    rows; ``index``: those of each kind's components (count, width), without kinds of internal constraints; ``nodes``:
    those of the kinds that have a chart (count, increments); ``rows`` (N + 1,): of each unknown, ``size`` where there
    is none. Without nodes these are the rows of the full system, by the same arrays.
    """

    increments: int
    size: int
    index: Mapping[Kind, np.ndarray]
    nodes: Mapping[Kind, np.ndarray]
    rows: np.ndarray


def reduction(index: Mapping[Kind, np.ndarray], n: int, size: int) -> Reduction:
    """The reduced system of components with unknowns ``index``, for ``n`` coordinates and ``size`` unknowns."""
    nodal = [kind for kind in index if kind.chart is not None]
    rows = np.arange(size + 1, dtype=np.int64)
    if not nodal:
        return Reduction(n, size, index, {}, rows)
    # Unknowns of nodes have no rows of their own: their coordinates become increments, their multipliers vanish.
    free = np.ones(size, dtype=bool)
    for kind in nodal:
        free[index[kind]] = False
    flat, others = np.flatnonzero(free[:n]), n + np.flatnonzero(free[n:])
    counts = [len(index[kind]) * kind.increments for kind in nodal]
    increments = len(flat) + sum(counts)
    own = increments + len(others)
    rows[:-1], rows[-1] = _NODAL, own
    # Order: flat coordinates, increments of the nodes kind by kind, multipliers of joints.
    rows[flat], rows[others] = np.arange(len(flat)), increments + np.arange(len(others))
    nodes: dict[Kind, np.ndarray] = {}
    places: dict[tuple[Chart | None, int], np.ndarray] = {}  # rows of the node with this first coordinate
    first = len(flat)
    for kind, count in zip(nodal, counts, strict=True):
        # Rows of a node are contiguous, and nodes of a kind follow each other.
        nodes[kind] = first + np.arange(count).reshape(len(index[kind]), kind.increments)
        first += count
        for coordinates, node in zip(index[kind], nodes[kind], strict=True):
            places[kind.chart, int(coordinates[0])] = node
    components = {
        kind: _rows_of(kind, unknowns, rows, places, size) for kind, unknowns in index.items() if kind.chart is None
    }
    return Reduction(increments, own, components, nodes, np.where(rows == _NODAL, own, rows))


def _rows_of(
    kind: Kind, index: np.ndarray, rows: np.ndarray, places: Mapping[tuple[Chart | None, int], np.ndarray], absent: int
) -> np.ndarray:
    """Rows of the components of a kind, (count, reduced width)."""
    parts, at = [], 0
    for chart in kind.parts:
        own = index[:, at : at + chart.size]
        # A component finds a node by the first of its coordinates; the ground has none.
        known = {**places, (chart, absent): np.full(chart.increments, rows[-1])}
        none = np.full(chart.increments, _NODAL)
        nodal = [known.get((chart, int(first)), none) for first in own[:, 0]]
        parts.append(rows[own] if chart.is_flat else np.array(nodal))
        at += chart.size
    found = np.ascontiguousarray(np.concatenate([*parts, rows[index[:, at:]]], axis=1))
    if np.any(found == _NODAL):
        raise ModelError(
            f"kind {kind.name!r}: a component depends on coordinates that internal constraints hold, or on their "
            "multipliers, but the kind does not declare their charts. Add them to its 'charts'"
        )
    return found
