"""The motion of a mechanism as a browser plays it: few frames, all positions in one block of numbers."""

from base64 import b64encode
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from dalembert.report.charts.motion.outlines import bodies_of
from dalembert.report.charts.motion.playback import Playback

if TYPE_CHECKING:
    from dalembert.multibody import Drawing

FINE = 6001
STILL = 1e-6
"""Way of a joint, as a part of the size of the picture, up to which it stays where it is."""


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


def film_of(drawing: "Drawing", measured: Mapping[str, np.ndarray]) -> Film:
    """Return a drawing at the times of :func:`frames` as a film, with measured positions (samples, 2 or 3)."""
    playback = Playback.of(np.asarray(drawing.times, dtype=float))
    lines = bodies_of(drawing.lines)
    joints = {name: np.asarray(at, dtype=np.float32)[:, None] for name, at in drawing.joints.items()}
    block = np.ascontiguousarray(np.concatenate([*lines.values(), *joints.values()], axis=1), dtype="<f4")
    size = float((np.nanmax(block, axis=(0, 1)) - np.nanmin(block, axis=(0, 1))).max())
    finite = {name: points[np.all(np.isfinite(points), axis=1)] for name, points in measured.items()}
    return Film(
        times=[round(time, 9) for time in drawing.times.tolist()],
        seconds=playback.seconds,
        pace=playback.pace,
        bodies={name: line.shape[1] for name, line in lines.items()},
        joints={name: bool(np.ptp(at, axis=0).max() <= STILL * size) for name, at in joints.items()},
        measured={name: points[:: max(1, len(points) // 150)].tolist() for name, points in finite.items()},
        across=block.shape[2],
        positions=b64encode(block.tobytes()).decode(),
    )
