r"""The balance with all coordinates as unknowns, for stability and nonlinear modes.

With y = (q, l) the retained coordinates of the elements and the interior ones side by side, and L(Y) the linear part of
the balance, the derivative of the residual is :math:`W\,\mathrm{d}L + B\,\mathrm{d}U` in the rows of q, and
:math:`\mathrm{d}L` in those of l. Elastic elements have W = 1 and B their stiffness; a rigid contact with the local
Jacobian G and the penalty ε has :math:`W = 1 - G/\varepsilon` and B = G.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.sparse import issparse

from dalembert.errors import InputError
from dalembert.vibration.balance.balance import Balance, Evaluation
from dalembert.vibration.balance.tangents import DenseTangent
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.interface.condensation import Condensation
from dalembert.vibration.interface.lowering import ELASTIC, Lowered
from dalembert.vibration.system.requirements import require_viscous

REMEMBERING = "displacement"


class Local(NamedTuple):
    """The elements at a point: forces, and W (None for 1) and B, (q · coefficients, q · coefficients).

    ``slope`` (q, coefficients): the derivative of their forces by ω.
    """

    evaluation: Evaluation
    weight: np.ndarray | None
    stiffness: np.ndarray
    slope: np.ndarray


@dataclass(frozen=True)
class Uncondensed:
    """A system in its retained and interior coordinates. ``lowered``: real. Rigid contacts of the velocity kind are
    taken as such of the displacement kind, which say the same of a solution and also of its mean; ``condensation``:
    which splits the structure; ``events``: as :class:`Balance` takes it; ``speed``: of a rotor, rad/s.
    """

    lowered: Lowered
    condensation: Condensation
    series: Fourier
    events: bool = True
    speed: float = 0.0

    def __post_init__(self) -> None:
        if not all(block.memory for block in self.lowered.blocks):
            blocks = (block if block.memory else replace(block, kind=REMEMBERING) for block in self.lowered.blocks)
            object.__setattr__(self, "lowered", replace(self.lowered, blocks=tuple(blocks)))

    @cached_property
    def balance(self) -> Balance:
        """The elements."""
        return Balance(self.lowered, self.series, self.events)

    @property
    def retained(self) -> int:
        """Number of retained coordinates, which are the first."""
        return self.balance.shape[0]

    @cached_property
    def matrices(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """K + Ω N, M and C + Ω G in these coordinates, (n, n) each."""
        condensation = self.condensation
        require_viscous(self.lowered.structure, "stability and nonlinear modes")
        if any(map(issparse, condensation.inner)):
            raise InputError(
                f"stability and nonlinear modes take dense matrices of all {self.lowered.structure.size} degrees of "
                "freedom; reduce the structure first (craig_bampton)"
            )
        blocks = (
            np.block([[outer, across], [below, np.diag(inner) if inner.ndim == 1 else inner]])
            for outer, across, below, inner in zip(
                condensation.outer, condensation.across, condensation.below, condensation.inner, strict=True
            )
        )
        # Forces of a rotor, Ω (G ẋ + N x), add to damping and stiffness: disturbances leave its speed as it is.
        matrices = dict(zip(condensation.kinds, blocks, strict=True))
        stiffness, damping = (
            matrices[name] + self.speed * matrices.get(turning, 0.0)
            for name, turning in (("stiffness", "circulatory"), ("damping", "gyroscopic"))
        )
        return stiffness, matrices["mass"], damping

    def elements(self, linear: np.ndarray, unknowns: np.ndarray, omega: float) -> Local:
        """The elements where the linear part and the retained coordinates, (q, coefficients), are these."""
        rigid = [block.numbers[:, :2].max() for block in self.lowered.blocks if block.kind != ELASTIC]
        evaluation, tangent = self._tangent(0.0, linear, unknowns, omega)
        if not rigid:
            return Local(evaluation, None, tangent.matrix, tangent.slope)
        scale = float(max(rigid))
        # The Jacobian is W ∂L/∂U + B, linear in ∂L/∂U: with 0 in its place it is B, and with a multiple of the unit
        # matrix W follows. The multiple is of the size of a penalty, so that W keeps its digits.
        other = self._tangent(scale, linear, unknowns, omega)[1]
        return Local(evaluation, (other.matrix - tangent.matrix) / scale, tangent.matrix, tangent.slope)

    def _tangent(
        self, scale: float, linear: np.ndarray, unknowns: np.ndarray, omega: float
    ) -> tuple[Evaluation, DenseTangent]:
        """Residual, and its Jacobian where that of the linear part is a multiple of the unit matrix."""
        jacobian = scale * np.eye(unknowns.size).reshape(*unknowns.shape, *unknowns.shape)
        tangent = DenseTangent(jacobian, np.zeros_like(unknowns))
        return self.balance.residual(linear, unknowns, omega, tangent), tangent
