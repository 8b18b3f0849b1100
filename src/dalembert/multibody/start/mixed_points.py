"""Newton's method with mixed points: stresses are separate unknowns, in its matrix alone.

A slender beam that bends by a large step of Newton's method is stretched by the linear step, and its axial stiffness,
much larger than that of bending, dominates all that follows. With the stresses f as unknowns beside the coordinates,
f - C (e(x) - e0) = 0, a step x - d gives f = C (e(x) - B d - e0), without the stretch of second order. Eliminated at
each point, they leave Newton's matrix as it is but for the stresses in it (Magisano, Leonetti and Garcea 2017). These
stresses are those of other reference strains, e0 + e(x - d) - e(x) + B d, so the kernels stay as they are.
"""

from dataclasses import replace

import numpy as np

from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.model.lowered import Lowered


class MixedPoints:
    """The reference strains by which the matrix of Newton's method has separate stresses."""

    def __init__(self, lowered: Lowered) -> None:
        self.lowered = lowered
        """The model whose tangent is the matrix."""
        self._first = {kind: data for kind, data in lowered.data.items() if kind.strains is not None}

    def step(self, x: np.ndarray, change: np.ndarray) -> None:
        """Take a step of Newton's method from unknowns ``x`` (N + 1,) by a change (N,)."""
        if not self._first:
            return
        moved = np.append(change, 0.0)
        data = dict(self.lowered.data)
        for kind, numbers in self._first.items():
            index = self.lowered.structure.index[kind][:, : kind.coordinates]
            before, after = _strains(kind, numbers, x[index]), _strains(kind, numbers, (x + moved)[index])
            linear = np.imag(_strains(kind, numbers, x[index] + 1j * STEP * moved[index])) / STEP
            data[kind] = numbers.copy()
            data[kind][:, kind.columns(kind.references)] += after - before - linear
        self.lowered = replace(self.lowered, data=data)


def _strains(kind: Kind, data: np.ndarray, x: np.ndarray) -> np.ndarray:
    assert kind.strains is not None
    return kind.strains(x, np.real(data[:, kind.length_columns[0]]))
