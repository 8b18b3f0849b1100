"""Rates of bodies that are placed at points of others: a velocity that is not stated is that of the point."""

from collections.abc import Sequence

import numpy as np

from dalembert.multibody.components.planar import markers
from dalembert.multibody.components.planar.body import Body, Marker
from dalembert.multibody.components.points import Point


def carried_rates(
    bodies: Sequence[Body], coordinates: Sequence[np.ndarray], modes: Sequence[np.ndarray], chosen: np.ndarray
) -> np.ndarray:
    """Rates of the frames (bodies, 3, k) from chosen ones (bodies, 3, k), in the order of the bodies.

    The chosen velocity of a body that states none is relative to the point that the body is placed at.

    Parameters
    ----------
    bodies : sequence of Body
    coordinates : sequence of array (size,)
        Of each undeformed body.
    modes : sequence of array (size, 3)
        Their derivatives by the frames.
    chosen : array, shape (bodies, 3, k)
    """
    number = {body.name: k for k, body in enumerate(bodies)}
    rates = chosen.astype(np.result_type(chosen, *modes))
    for k, body in enumerate(bodies):
        if isinstance(body.place, Point) and body.motion[0] is None:
            carrier = number[body.place.body.name]
            marker = body.place.body.marker(body.place.name)
            rates[k, :2] += _velocity(marker, coordinates[carrier], modes[carrier]) @ rates[carrier]
    return rates


def _velocity(marker: Marker, coordinates: np.ndarray, modes: np.ndarray) -> np.ndarray:
    """Derivative of a marker's position by the frame of its body, (2, 3)."""
    first, second = (modes[slot] for slot in marker.slots[:2] if slot is not None)
    if marker.kind != markers.RIGID:
        return np.array([first, second])
    sx, sy, _ = marker.data
    c, s = np.cos(coordinates[2]), np.sin(coordinates[2])
    return np.array([first - (s * sx + c * sy) * modes[2], second + (c * sx - s * sy) * modes[2]])
