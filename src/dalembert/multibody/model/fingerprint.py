"""Hash by which mechanisms are distinguished."""

import hashlib

import numpy as np

from dalembert.multibody.model.lowered import Lowered


def fingerprint(lowered: Lowered, times: np.ndarray, *more: object) -> str:
    """Hash of a mechanism's arrays, of the times at which it is observed, and of what else there is."""
    digest = hashlib.sha256(repr(more).encode())
    for array in (times, lowered.x, lowered.v, lowered.signal_data, lowered.knots, *lowered.data.values()):
        digest.update(np.ascontiguousarray(array).tobytes())
    for kind in lowered.structure.index:
        digest.update(kind.name.encode())
        digest.update(lowered.structure.index[kind].tobytes() + lowered.structure.meta[kind].tobytes())
    return digest.hexdigest()
