"""What bands can tell about intervals, in plain sentences."""

import numpy as np

from dalembert.inverse.bands.band_fit import BandFit
from dalembert.inverse.fit.sentences import untold
from dalembert.parameters import Parameter

NOTHING = 1e-6
"""Lengths below this part of the bounds' width are zero."""


def sentences(fit: BandFit) -> tuple[str, ...]:
    """Sentences on ends at a bound, on radii that are zero or may be, and on unknowns that the bands do not tell."""
    found = [sentence for k, item in enumerate(fit.parameters) for sentence in _of_one(fit, k, item)]
    width, scale = fit.parameters.upper - fit.parameters.lower, fit.parameters.scale
    is_interval = np.array([name in fit.intervals for name in fit.parameters.names], dtype=bool)
    widths, scales = np.concatenate([width, width[is_interval] / 2]), np.concatenate([scale, scale[is_interval]])
    return untold(fit.unknowns, widths, scales, fit.told, found)


def _of_one(fit: BandFit, k: int, item: Parameter) -> list[str]:
    small = NOTHING * (item.upper - item.lower)
    radius, deviation = fit.radius[k], fit.radius_deviations[k]
    found = []
    for side, end in (("lower", fit.box.lower[k]), ("upper", fit.box.upper[k])):
        bound = getattr(item, side)
        if abs(end - bound) <= small:
            found.append(
                f"The {side} end of {item.name!r} sits on its bound {bound:.6g}; widen the bound if the true interval "
                "may reach beyond."
            )
    if item.name in fit.intervals:
        if radius <= small:
            found.append(f"The radius of {item.name!r} is zero: the bands ask for one value of it, not an interval.")
        elif radius <= 2 * deviation < np.inf:
            found.append(
                f"The radius of {item.name!r}, {radius:.2g} ± {deviation:.2g}, cannot be told from zero: the bands do "
                "not show that it varies."
            )
    return found
