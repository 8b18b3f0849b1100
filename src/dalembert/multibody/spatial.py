"""Components of mechanisms in space, for :class:`SpatialSystem`."""

from dalembert.multibody.components.points import Point as Point
from dalembert.multibody.components.spatial.body import Body as Body
from dalembert.multibody.components.spatial.cylindrical_joint import CylindricalJoint as CylindricalJoint
from dalembert.multibody.components.spatial.fixed_joint import FixedJoint as FixedJoint
from dalembert.multibody.components.spatial.inertia import Inertia as Inertia
from dalembert.multibody.components.spatial.joint import Joint as Joint
from dalembert.multibody.components.spatial.load import Load as Load
from dalembert.multibody.components.spatial.orientation import Orientation as Orientation
from dalembert.multibody.components.spatial.orientation import Pose as Pose
from dalembert.multibody.components.spatial.planar_joint import PlanarJoint as PlanarJoint
from dalembert.multibody.components.spatial.point_mass import PointMass as PointMass
from dalembert.multibody.components.spatial.point_on_line_joint import PointOnLineJoint as PointOnLineJoint
from dalembert.multibody.components.spatial.points import Ground as Ground
from dalembert.multibody.components.spatial.points import GroundPoint as GroundPoint
from dalembert.multibody.components.spatial.prismatic_joint import PrismaticJoint as PrismaticJoint
from dalembert.multibody.components.spatial.revolute_joint import RevoluteJoint as RevoluteJoint
from dalembert.multibody.components.spatial.rigid_body import RigidBody as RigidBody
from dalembert.multibody.components.spatial.spherical_joint import SphericalJoint as SphericalJoint
from dalembert.multibody.spatial_system import SpatialSystem as SpatialSystem
