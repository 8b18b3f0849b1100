"""What tells a lowered system from others."""

import hashlib

import numpy as np

from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.system.lowering import Lowered


def fingerprint(lowered: Lowered, method: HarmonicBalance, *more: object) -> str:
    """Hash of a system's matrices, forces and elements, of the method, and of what else there is.

    Laws of the user's are told by some of their values.
    """
    own = lowered.structure
    digest = hashlib.sha256(repr((*more, method)).encode())
    digest.update(repr((own.dofs.names, lowered.row_names, lowered.contacts, lowered.forces)).encode())
    optional = [matrix for matrix in (own.damping, own.loss) if matrix is not None]
    for matrix in (own.mass, own.stiffness, *optional, lowered.matrix):
        digest.update(np.asarray(matrix @ np.linspace(0.5, 1.5, own.size)).tobytes())
    for block in lowered.blocks:
        digest.update(repr((block.kind, block.tangents, block.normal)).encode() + block.numbers.tobytes())
    for block in lowered.laws:
        digest.update(repr((block.law.digest, block.states, block.names)).encode() + block.numbers.tobytes())
    for rows, element in lowered.functions:
        probe = np.linspace(-1.0, 1.0, 7 * len(rows)).reshape(len(rows), 7)
        digest.update(np.asarray(element.law(probe)[0]).tobytes())
    return digest.hexdigest()
