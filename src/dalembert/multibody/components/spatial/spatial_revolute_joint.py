"""The revolute joint in space."""

__all__ = ["RevoluteJoint"]

from dataclasses import dataclass

from dalembert.multibody.components.spatial.conditions import MEETS, perpendicular
from dalembert.multibody.components.spatial.friction import RubbingJoint, friction_kind
from dalembert.multibody.components.spatial.spatial_joint import joint_kind

KIND = joint_kind("revolute_in_space", __name__, MEETS, perpendicular(1, 3), perpendicular(2, 3), angle=True)

FRICTION = friction_kind("revolute_friction_in_space", __name__, 5, (0, 1, 2), True)


@dataclass(frozen=True)
class RevoluteJoint(RubbingJoint):
    """A hinge: both points coincide, and b turns about the axis.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    axis : (float, float, float)
        Direction of the axis, the same in the axes of both markers.
    friction : Friction, optional

    Examples
    --------
    >>> import numpy as np
    >>> from dalembert.multibody import simulate
    >>> from dalembert.multibody.spatial import Inertia, RigidBody, SpatialSystem
    >>> system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    >>> disc = Inertia.cylinder(mass=1.0, radius=0.1, length=0.02)
    >>> wheel = system.add(RigidBody("wheel", disc, angular_velocity=(0.0, 0.0, 2.0)))
    >>> _ = system.add(RevoluteJoint("pin", system.ground, wheel.point("origin")))
    >>> simulate(system, end=1.0).channels(["pin.angle"])[-1].round(4)
    array([2.])
    """

    kind = KIND
    friction_kind = FRICTION
    aligned = (3,)
