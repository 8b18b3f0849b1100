"""The spherical joint."""

__all__ = ["SphericalJoint"]

from dataclasses import dataclass

from dalembert.multibody.components.spatial.conditions import MEETS
from dalembert.multibody.components.spatial.spatial_joint import Joint, joint_kind

KIND = joint_kind("spherical", __name__, MEETS, holds_frame=False)


@dataclass(frozen=True)
class SphericalJoint(Joint):
    """A ball and socket: both points coincide.

    Parameters
    ----------
    name : str
    a, b : Point or ground

    Notes
    -----
    An initial state may state ``rotation_x``, ``rotation_y`` and ``rotation_z``, the rotation vector of b relative to a
    in the axes of a (rad). Their rates are the angular velocity of b relative to a in these axes.
    """

    kind = KIND

    @property
    def stated_coordinates(self) -> tuple[str, ...]:
        return self._rotations
