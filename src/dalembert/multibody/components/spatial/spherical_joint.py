"""The spherical joint."""

__all__ = ["SphericalJoint"]

from dataclasses import dataclass

from dalembert.multibody.components.spatial.conditions import MEETS
from dalembert.multibody.components.spatial.joint import Joint, joint_kind

KIND = joint_kind("spherical", __name__, MEETS, holds_frame=False)


@dataclass(frozen=True)
class SphericalJoint(Joint):
    """A ball and socket: both points coincide.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    """

    kind = KIND
