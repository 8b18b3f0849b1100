"""Lines and points that show a mechanism in motion."""

from dataclasses import dataclass

import numpy as np

from dalembert.multibody.lowered import Lowered
from dalembert.multibody.system import Mechanism


@dataclass(frozen=True)
class Drawing:
    """What to draw at each time.

    Parameters
    ----------
    times : array (frames,)
        s.
    lines : mapping of body to array (frames, points, 2 or 3)
        m.
    joints : mapping of joint to array (frames, 2 or 3)
        m.
    """

    times: np.ndarray
    lines: dict[str, np.ndarray]
    joints: dict[str, np.ndarray]


def draw(system: Mechanism, lowered: Lowered, times: np.ndarray, x: np.ndarray, points: int) -> Drawing:
    """Drawing from unknowns (frames, N + 1)."""
    lines = {}
    for body in system.bodies:
        first = lowered.structure.first[body.name]
        lines[body.name] = body.outline(x[:, first : first + body.size], points)
    joints = {}
    for joint in system.joints:
        kind, row = lowered.structure.rows[joint.name]
        index, integers = lowered.structure.index[kind][row], lowered.structure.meta[kind][row]
        position = joint.position(kind, lowered.data[kind][row].real, integers, x[:, index])
        if position is not None:
            joints[joint.name] = position
    return Drawing(times, lines, joints)
