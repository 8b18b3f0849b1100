"""Models in lanes: eight samples of one structure, side by side."""

from collections.abc import Iterable, Sequence

import numpy as np

from dalembert.kernels.kernel import Compiled
from dalembert.kernels.lanes import WIDTH, Lanes, lane_zeros
from dalembert.multibody.kernels.block_table import BlockModel
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.nodes import CHANGE, RESTORE
from dalembert.multibody.kernels.reduction import Reduction
from dalembert.multibody.model.lowered import Lowered

FEWEST = 4
"""Samples from which eight lanes cost less than runs one by one."""


def takes_lanes(sample: Lowered) -> bool:
    """Return whether samples of this structure may run side by side: all kinds of components take lanes."""
    return sample.in_duals and all(kind.takes_lanes for kind in sample.data)


def prevents_lanes(sample: Lowered) -> str:
    """Return the first component because of which samples run one by one, by its name; empty if there is none."""
    for kind, names in sample.parts.items():
        if not kind.takes_lanes:
            return names[0]
    return ""


def share_lanes(samples: Sequence[Lowered]) -> bool:
    """Return whether samples of one structure may run side by side, with the bits that each has alone.

    Numbers that decide branches are zero in all or in none; loads jump at the same times.
    """
    first = samples[0]
    return (
        len(samples) >= FEWEST
        and takes_lanes(first)
        and all(entry.jumps == first.jumps and entry.changes == first.changes for entry in samples)
        and all(
            np.array_equal(entry.data[kind][:, kind.switch_columns] == 0.0, data[:, kind.switch_columns] == 0.0)
            for entry in samples
            for kind, data in first.data.items()
            if kind.switch_columns
        )
    )


def lane_kernels(kinds: Iterable[Kind], *roles: str) -> list[Compiled]:
    """Return the kernels of components in these roles that samples side by side need."""
    return [kind.kernel(role, Lanes) for kind in kinds for role in roles if role in kind.roles]


def lane_node_kernels(reduction: Reduction) -> list[Compiled]:
    """Return the kernels by which nodes move in steps of samples side by side."""
    nodes = [kind.kernel(role, Lanes) for kind in reduction.nodes for role in ("change", "restore")]
    return [*nodes, *[CHANGE[Lanes], RESTORE[Lanes]] * bool(nodes)]


def lane_model(samples: Sequence[Lowered], *roles: str) -> BlockModel:
    """Return the model of up to eight samples, with the kernels of these roles; the first one fills the lanes left."""
    filled = [*samples, *[samples[0]] * (WIDTH - len(samples))]

    def lanes(arrays: list[np.ndarray]) -> np.ndarray:
        together = lane_zeros(*arrays[0].shape)
        for lane, array in enumerate(arrays):
            together[..., lane] = np.real(array)
        return together

    # Entry i of all samples side by side: one load fills a vector.
    numbers = {kind: lanes([entry.data[kind] for entry in filled]) for kind in samples[0].data}
    return samples[0].model_of(Lanes, numbers, lanes([entry.signal_data for entry in filled]), *roles)
