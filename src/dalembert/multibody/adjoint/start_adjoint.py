"""Adjoint of accelerations and multipliers that satisfy the equations of motion, at a start or behind a jump.

They solve F(q, v, a, lambda; numbers) = 0: the equations of motion, and the second derivatives of the constraints. With
mu of F_(a, lambda)^T mu = adjoint of (a, lambda), the adjoints of q, v and the numbers lose F_q^T mu, F_v^T mu and
F_numbers^T mu.
"""

from typing import Any

import numpy as np
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

from dalembert.multibody.adjoint.numbers import NumberGradient, readers
from dalembert.multibody.kernels.block_table import BlockModel, Call
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.states import MotionState
from dalembert.multibody.model.evaluate import tangent
from dalembert.multibody.model.lowered import Lowered


def accelerations_back(lowered: Lowered, state: MotionState, t: float, within: float, bar: MotionState) -> np.ndarray:
    """Take the adjoint of a state with consistent accelerations to that of its positions and velocities alone. Return
    mu (N + 1,), whose last part belongs to the second derivatives of the constraints. ``state``: unknowns, velocities
    and accelerations, (N + 1,), as they were solved for; ``t``, ``within``: time, s, and a time that says on which side
    of a jump it lies; ``bar``: adjoint of the state; those of accelerations and multipliers become zero.
    """
    n, last = lowered.structure.n, lowered.structure.size
    x, v, a = state.x, state.v, state.a
    masses = tangent(lowered, x, v, (0.0, 0.0, 1.0), (1.0, 0.0), t, a, within)
    joints = tangent(lowered, x, v, (1.0, 0.0, 0.0), (0.0, 1.0), t, a, within)
    right = np.concatenate([bar.a[:n] + bar.w[:n], bar.x[n:last]])
    mu = np.append(splu(csc_matrix((masses + joints).T)).solve(right), 0.0)
    for by, part in (((1.0, 0.0, 0.0), bar.x), ((0.0, 1.0, 0.0), bar.v)):
        part[:n] -= (mu[:n] @ tangent(lowered, x, v, by, (1.0, 0.0), t, a, within)[:n])[:n]
    bar.a[:], bar.w[:], bar.x[n:] = 0.0, 0.0, 0.0
    return mu


class SecondRates:
    """mu^T times the second derivatives of the constraints, differentiated by complex steps."""

    def __init__(
        self, lowered: Lowered, model: BlockModel, state: MotionState, t: float, within: float, mu: np.ndarray
    ) -> None:
        self._lowered, self._model, self._mu = lowered, model.need("rates"), mu
        self._state = [part.astype(complex) for part in state[:3]]
        self._rate, self._second = np.zeros((2, len(mu)), complex)
        x, v, a = self._state
        self._call: Call = model.call().set(x=x, v=v, a=a, rate=self._rate, second=self._second)
        model.evaluate(self._call, t, within)
        self._kinds = [kind for kind in lowered.data if "rates" in kind.roles]

    def pull(self, bar: MotionState, gradient: NumberGradient, bars: np.ndarray) -> None:
        """Take the derivatives off the adjoints of positions and velocities, the gradient and the signals' adjoints."""
        structure = self._lowered.structure
        for kind in self._kinds:
            touched = np.unique(structure.index[kind])
            for number in touched[touched < structure.n]:
                for part, own in ((self._state[0], bar.x), (self._state[1], bar.v)):
                    own[number] -= self._slope(kind, part, number)
            numbers = self._model.blocks.numbers[kind]
            for place in np.argwhere(gradient.active_kind(kind)):
                gradient.kind(kind)[tuple(place)] -= self._slope(kind, numbers, tuple(place))
            reads = readers(structure.meta[kind] if kind.integers else None, gradient.active_signals)
            for s in np.unique(reads[:, 1]):
                for rate in range(3):
                    bars[s, rate] -= self._slope(kind, self._call.signals, (s, rate))

    def _slope(self, kind: Kind, array: np.ndarray, place: int | tuple[int, ...]) -> float:
        """Derivative of mu^T (second derivatives) of one kind by an entry of an array."""
        n = self._lowered.structure.n
        array[place] += 1j * STEP
        self._second[:] = 0.0
        kernel: Any = kind.kernel("rates", complex)
        kernel(self._call.address, self._model.block(list(self._lowered.data).index(kind)))
        array[place] = array[place].real
        return float(self._mu[n:] @ np.imag(self._second[n:])) / STEP
