"""Typical sizes of a mechanism's unknowns."""

import numpy as np

from dalembert.multibody.lowered import Lowered


def scales(lowered: Lowered) -> np.ndarray:
    """Typical size of each unknown, (N + 1,): the mechanism's extent for positions, one for angles and gradients."""
    n, kinds = lowered.structure.n, np.array(lowered.structure.kinds)
    places = np.real(lowered.x)[:n][kinds == "position"].reshape(-1, lowered.dimension)
    lengths = (np.real(data[:, kind.columns(kind.lengths)]) for kind, data in lowered.data.items())
    extent = max(np.ptp(places, axis=0).max(initial=0.0), *(np.abs(entry).max(initial=0.0) for entry in lengths))
    scale = np.ones(lowered.structure.size + 1)
    scale[:n][np.isin(kinds, ("position", "displacement"))] = extent if extent > 0 else 1.0
    return scale
