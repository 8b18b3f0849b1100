"""Models in dual numbers: one sample with up to eight directions of differentiation at once."""

from collections.abc import Sequence

import numpy as np

from dalembert.kernels.duals import DIRECTIONS, Dual, as_duals
from dalembert.kernels.kernel import Compiled
from dalembert.multibody.kernels.block_table import BlockModel
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.nodes import RESTORE
from dalembert.multibody.model.lowered import Lowered

FEWEST = 3
"""Directions from which eight at once cost less than complex steps one by one. Two cost a tenth less, but their kernels
would take a third of the time of a first fit on a new machine.
"""


def are_many(sample: Lowered, directions: int) -> bool:
    """Return whether directions are worth dual numbers, and whether the components of the sample can take them."""
    return directions >= FEWEST and sample.in_duals


def dual_kernels(sample: Lowered) -> list[Compiled]:
    """Return the kernels of components for derivatives in dual numbers, and what differentiates steps by them."""
    nodes = [kind.kernel("restore", Dual) for kind in sample.structure.reduction.nodes]
    return [*sample.kernels(Dual), *nodes, *[RESTORE[Dual]] * bool(nodes)]


def is_dual(models: Sequence[BlockModel]) -> bool:
    """Return whether models along directions are in dual numbers."""
    return bool(models) and models[0].dtype is Dual


def widest(tangents: BlockModel, models: Sequence[BlockModel]) -> BlockModel:
    """Return that of the model with tangents and those along directions whose calls serve all."""
    return models[0] if is_dual(models) else tangents


def dual_models(sample: Lowered, perturbed: Sequence[Lowered]) -> list[BlockModel]:
    """Return models of a sample along its directions, eight in each, in their order."""
    firsts = range(0, len(perturbed), DIRECTIONS)
    return [_dual_model(sample, perturbed[first : first + DIRECTIONS]) for first in firsts]


def _dual_model(sample: Lowered, group: Sequence[Lowered]) -> BlockModel:
    def duals(value: np.ndarray, moved: list[np.ndarray]) -> np.ndarray:
        return as_duals(np.real(value), [np.imag(entry) / STEP for entry in moved])

    numbers = {kind: duals(data, [entry.data[kind] for entry in group]) for kind, data in sample.data.items()}
    return sample.model_of(Dual, numbers, duals(sample.signal_data, [entry.signal_data for entry in group]))
