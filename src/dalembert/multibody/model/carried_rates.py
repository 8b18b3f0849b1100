"""Rates of bodies that are placed at points of others: a velocity that is not stated is that of the point."""

from collections.abc import Sequence

import numpy as np

from dalembert.multibody.components.base_body import BaseBody
from dalembert.multibody.components.points import Point


def carried_rates(
    bodies: Sequence[BaseBody], coordinates: Sequence[np.ndarray], modes: Sequence[np.ndarray], chosen: np.ndarray
) -> np.ndarray:
    """Return the rates of the frames in the order of the bodies, from ``chosen`` ones, both (bodies, rates, k).
    ``coordinates`` (size,): of each undeformed body; ``modes`` (size, rates): their derivatives by the frames.
    """
    number = {body.name: k for k, body in enumerate(bodies)}
    rates = chosen.astype(np.result_type(chosen, *modes))
    for k, body in enumerate(bodies):
        if isinstance(body.place, Point) and body.motion[0] is None:
            carrier = bodies[number[body.place.body.name]]
            own = number[carrier.name]
            marker = carrier.marker(body.place.name)
            rates[k, : body.dimension] += carrier.point_rates(marker, coordinates[own], modes[own]) @ rates[own]
    return rates
