r"""A structure whose contacts stick, with a spring on one of its modes.

At the frequency of a mode the receptances have no bound, and free motions are found there. A spring of stiffness κ on
the coordinate :math:`\eta = w^T x` of the mode, with :math:`w = K_r v` and :math:`v^T K_r v = 1`, moves its frequency
to :math:`\omega\sqrt{1 + \kappa}`. It is a row of the reference on which no element acts, so that the equations take
it away again. Other modes do not feel it, as they are orthogonal to w.
"""

from dataclasses import replace

import numpy as np
from scipy.sparse import csc_array, vstack

from dalembert.vibration.interface.stuck_structure import StuckStructure

SPRING = 1.0
"""κ: the moved frequency is 1.4 times that of the mode."""


def with_stiffened_mode(stuck: StuckStructure, mode: int, covector: np.ndarray) -> StuckStructure:
    """Return the structure with a spring on a mode, whose coordinate is the last row. ``covector`` (n,): w."""
    shape, moved = stuck.shapes[:, mode].copy(), stuck.row_shapes[:, mode]
    softer = 1 / (1 + SPRING)

    def solve(right: np.ndarray) -> np.ndarray:
        # Sherman and Morrison: (K_r + κ w wᵀ)⁻¹ = K_r⁻¹ - κ/(1 + κ) v vᵀ
        return stuck.solve(right) - SPRING * softer * np.multiply.outer(shape, shape @ right)

    # Vᵀ (K_r + κ w wᵀ) V = 1 again with v/√(1 + κ).
    size = np.ones(len(stuck.inertias))
    size[mode] = np.sqrt(softer)
    damping = {
        name: part * (size**2 if part.ndim == 1 else np.multiply.outer(size, size))
        for name, part in stuck.damping.items()
    }
    rows = len(stuck.reference)
    compliance = np.empty((rows + 1, rows + 1))
    compliance[:-1, :-1] = stuck.compliance - SPRING * softer * np.multiply.outer(moved, moved)
    compliance[-1, :-1] = compliance[:-1, -1] = softer * moved
    compliance[-1, -1] = softer
    # wᵀ φ = vᵀ K_r φ = vᵀ Bᵀ r B φ of a motion φ that the structure does not resist.
    free = np.vstack([stuck.free, (stuck.reference * moved) @ stuck.free])
    return replace(
        stuck, rows=csc_array(vstack([stuck.rows, csc_array(covector[None])])), solve=solve,
        reference=np.append(stuck.reference, SPRING), shapes=stuck.shapes * size, inertias=stuck.inertias * size**2,
        damping=damping, free=free, _kept={"compliance": compliance},
    )  # fmt: skip
