"""The nodes of multiple shooting as variables of a dataset, and back."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from dalembert.inverse.shooting.nodes import Nodes


def stored_nodes(nodes: Nodes | None) -> dict[str, Any]:
    """Variables over ``node`` and ``state``; none without multiple shooting."""
    if nodes is None:
        return {}
    return {
        "node_samples": ("node", nodes.samples.astype(np.int64)),
        "node_ends": (("node", "state"), nodes.ends),
        "node_begins": (("node", "state"), nodes.begins),
        "node_times": ("node", nodes.times),
    }


def told_nodes(nodes: Nodes | None) -> dict[str, Any] | None:
    """What of the nodes is no array, for JSON."""
    if nodes is None:
        return None
    return {
        "states": list(nodes.states),
        "gap": nodes.gap,
        "growth": nodes.growth,
        "segments": nodes.segments,
        "units": list(nodes.units),
        "experiments": list(nodes.experiments),
    }


def nodes_of(arrays: Mapping[str, np.ndarray], told: Mapping[str, Any] | None) -> Nodes | None:
    """The nodes again."""
    if told is None:
        return None
    samples, ends, begins, times = (arrays[f"node_{name}"] for name in ("samples", "ends", "begins", "times"))
    units, experiments = tuple(told["units"]), tuple(told["experiments"])
    found = told["gap"], told["growth"], told["segments"]
    return Nodes(tuple(told["states"]), samples, ends, begins, *found, units, experiments, times)
