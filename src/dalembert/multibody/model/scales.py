"""Typical sizes of a mechanism's unknowns."""

import numpy as np

from dalembert.multibody.components.laws.friction_law import FORCE, NUMBERS
from dalembert.multibody.model.lowered import Lowered


def scales(lowered: Lowered) -> np.ndarray:
    """Typical size of each unknown, (N + 1,): the mechanism's extent for positions, one for angles and gradients."""
    n, kinds, extent = lowered.structure.n, np.array(lowered.structure.kinds), _extent(lowered)
    scale = np.ones(lowered.structure.size + 1)
    scale[:n][np.isin(kinds, ("position", "displacement"))] = extent
    return scale


def slip_scale(lowered: Lowered) -> float:
    """Smallest rate over which dry friction changes, in parts of the scales, 1/s; infinity without dry friction."""
    least = np.inf
    for kind, data in lowered.data.items():
        if set(NUMBERS) <= set(kind.numbers):
            own = dict(zip(kind.numbers, np.real(data.T), strict=True))
            dry = own["coulomb"] + own["per_reaction"] + own["stribeck"] > 0
            scale = _extent(lowered) if kind.outputs == FORCE else 1.0
            least = min(least, np.min(own["slip"], where=dry, initial=np.inf) / scale)
    return float(least)


def _extent(lowered: Lowered) -> float:
    """Largest distance of positions, or length of a component, m; 1 for a point."""
    n, kinds = lowered.structure.n, np.array(lowered.structure.kinds)
    places = np.real(lowered.x)[:n][kinds == "position"].reshape(-1, lowered.dimension)
    lengths = (np.real(data[:, kind.columns(kind.lengths)]) for kind, data in lowered.data.items())
    extent = max(np.ptp(places, axis=0).max(initial=0.0), *(np.abs(entry).max(initial=0.0) for entry in lengths))
    return float(extent) if extent > 0 else 1.0
