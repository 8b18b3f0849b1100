"""Lines and points that show a mechanism in motion."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.system import BaseSystem


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
    axes : mapping of body to array (frames, 4, 3)
        Origin in m and axes of bodies in space.
    surfaces : mapping of body to Surface
        In the axes of bodies that have shapes; of beams with the section's outline and of reduced bodies in the fixed
        axes, with corners (frames, corners, 3), and with strains.
    ground : Surface, optional
        Of the ground, in the fixed axes.
    """

    times: np.ndarray
    lines: dict[str, np.ndarray]
    joints: dict[str, np.ndarray]
    axes: dict[str, np.ndarray] = field(default_factory=dict)
    surfaces: Mapping[str, Any] = field(default_factory=dict)
    ground: Any = None

    def corners(self, body: str) -> np.ndarray:
        """Corners of the surface of a body in the fixed axes, (frames, corners, 3), m."""
        corners = self.surfaces[body].corners
        if corners.ndim == 3:
            return corners
        own = self.axes[body]
        return own[:, :1] + corners @ own[:, 1:]


def draw(system: BaseSystem, lowered: Lowered, times: np.ndarray, x: np.ndarray, points: int) -> Drawing:
    """Drawing from unknowns (frames, N + 1)."""
    lines, axes, surfaces = {}, {}, {}
    for body in system.bodies:
        first = lowered.structure.first[body.name]
        own = x[:, first : first + body.size]
        lines[body.name] = body.outline(own, points)
        moving, surface = body.moving_axes(own), body.surface
        if (skin := body.skin(own)) is not None:
            surfaces[body.name] = skin
        if moving is not None:
            axes[body.name] = moving
            if surface is not None:
                surfaces[body.name] = surface
    joints = {}
    for joint in system.joints:
        kind, row = lowered.structure.rows[joint.name]
        index, integers = lowered.structure.index[kind][row], lowered.structure.meta[kind][row]
        position = joint.position(kind, lowered.data[kind][row].real, integers, x[:, index])
        if position is not None:
            joints[joint.name] = position
    return Drawing(times, lines, joints, axes, surfaces, system.ground_surface)
