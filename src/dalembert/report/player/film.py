"""The motion of a mechanism as a browser plays it: few frames, all positions in one block of numbers."""

from base64 import b64encode
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from dalembert.report.charts.motion.film import Playback
from dalembert.report.scene.motion import motion_scene

if TYPE_CHECKING:
    from dalembert.multibody import Drawing

FINE = 6001


def frames(end: float) -> np.ndarray:
    """Times of the frames of a motion until ``end`` (s), as the films of reports have them."""
    return Playback.of(np.linspace(0.0, end, FINE)).times


@dataclass(frozen=True)
class Film:
    """A motion.

    Parameters
    ----------
    times : list of float
        s.
    seconds : float
        Duration of one pass.
    pace : str
        Its speed, in words.
    bodies : dict of str to int
        Points of the line of each body.
    joints : dict of str to bool
        Whether each stays where it is.
    measured : dict of str to list
        Measured positions of points, m.
    across : int
        2 in the plane, 3 in space.
    positions : str
        Single precision numbers (frames, points of bodies and joints, across), m, in base64.
    """

    times: list[float]
    seconds: float
    pace: str
    bodies: dict[str, int]
    joints: dict[str, bool]
    measured: dict[str, list[list[float]]]
    across: int
    positions: str


def film_of(drawing: "Drawing", measured: Mapping[str, np.ndarray], rows: np.ndarray | None = None) -> Film:
    """Return a drawing at the times of :func:`frames` as a film, with measured positions (samples, 2 or 3).

    ``rows`` are the numbers of these times among those of the drawing; all if not given.
    """
    rows = np.arange(len(drawing.times)) if rows is None else rows
    scene = motion_scene(replace(drawing, surfaces={}, ground=None), rows, paths={}, measured=measured)
    bodies = {shape.name: shape.points for shape in scene.primitives if shape.role == "body"}
    joints = [shape for shape in scene.primitives if shape.role == "joint"]
    at = (np.repeat(shape.points, 1 if len(shape.points) == len(rows) else len(rows), axis=0) for shape in joints)
    block = np.ascontiguousarray(np.concatenate([*bodies.values(), *at], axis=1), dtype="<f4")
    playback = Playback.of(scene.times)
    return Film(
        times=[round(time, 9) for time in scene.times.tolist()],
        seconds=playback.seconds,
        pace=playback.pace,
        bodies={name: line.shape[1] for name, line in bodies.items()},
        joints={shape.name: shape.kind == "ground" for shape in joints},
        measured={shape.name: shape.points[0].tolist() for shape in scene.primitives if shape.role == "measured"},
        across=scene.dimensions,
        positions=b64encode(block.tobytes()).decode(),
    )
