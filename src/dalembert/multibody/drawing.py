"""Lines and points that show a mechanism in motion."""

from dataclasses import dataclass

import numpy as np

from dalembert.multibody.components.planar import markers
from dalembert.multibody.components.planar.pairs import INTEGERS
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.lowered import Lowered
from dalembert.multibody.system import System


@dataclass(frozen=True)
class Drawing:
    """What to draw at each time.

    Parameters
    ----------
    times : array (frames,)
        s.
    lines : mapping of body to array (frames, points, 2)
        m.
    joints : mapping of joint to array (frames, 2)
        m.
    """

    times: np.ndarray
    lines: dict[str, np.ndarray]
    joints: dict[str, np.ndarray]


def draw(system: System, lowered: Lowered, times: np.ndarray, x: np.ndarray, points: int) -> Drawing:
    """Drawing from unknowns (frames, N + 1)."""
    lines = {}
    for body in system.bodies:
        first = lowered.structure.first[body.name]
        lines[body.name] = body.outline(x[:, first : first + body.size], points)
    joints = {}
    for joint in system.joints:
        kind, row = lowered.structure.rows[joint.name]
        if kind.integers[:2] == INTEGERS[:2]:  # a joint of another form has no position to draw
            joints[joint.name] = _place(lowered, kind, row, x)
    return Drawing(times, lines, joints)


def _place(lowered: Lowered, kind: Kind, row: int, x: np.ndarray) -> np.ndarray:
    """Position of the second side of a joint, or of the first one if the second is the ground, (frames, 2)."""
    index, markers_of = lowered.structure.index[kind][row], lowered.structure.meta[kind][row][:2]
    side = 0 if markers_of[0] == markers.GROUND else 1
    sx, sy = lowered.data[kind][row].real[3 * side : 3 * side + 2]
    own = x[:, index[4 * side : 4 * side + 4]]
    if markers_of[side] == markers.GROUND:
        return np.tile([sx, sy], (len(x), 1))
    if markers_of[side] == markers.RIGID:
        c, s = np.cos(own[:, 2]), np.sin(own[:, 2])
        return own[:, :2] + np.column_stack([c * sx - s * sy, s * sx + c * sy])
    return own[:, :2]
