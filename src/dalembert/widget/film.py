"""A motion as the widget plays it: all positions in one block of numbers."""

from base64 import b64encode
from typing import Any

import numpy as np

from dalembert.multibody import Trajectory
from dalembert.report.charts.motion.outlines import bodies_of
from dalembert.report.charts.motion.playback import Playback


def film_of(motion: Trajectory) -> dict[str, Any]:
    """Return a motion as JSON can hold it.

    ``times`` in s, ``seconds`` of one pass, numbers of points of ``bodies``, whether ``joints`` stay where they are,
    ``across`` (2 or 3), and ``positions``: single precision (frames, points of bodies and joints, across), m, in
    base64.
    """
    drawing = motion.drawing()
    lines = bodies_of(drawing.lines)
    joints = {name: np.asarray(at, dtype=np.float32)[:, None] for name, at in drawing.joints.items()}
    block = np.ascontiguousarray(np.concatenate([*lines.values(), *joints.values()], axis=1), dtype="<f4")
    size = float((np.nanmax(block, axis=(0, 1)) - np.nanmin(block, axis=(0, 1))).max())
    return {
        "times": np.round(drawing.times, 9).tolist(),
        "seconds": Playback.of(np.asarray(drawing.times, dtype=float)).seconds,
        "bodies": {name: line.shape[1] for name, line in lines.items()},
        "joints": {name: bool(np.ptp(at, axis=0).max() <= 1e-6 * size) for name, at in joints.items()},
        "across": block.shape[2],
        "positions": b64encode(block.tobytes()).decode(),
    }
