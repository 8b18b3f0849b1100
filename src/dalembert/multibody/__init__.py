"""Flexible and rigid planar mechanisms in time."""

from dalembert.multibody.components.planar.ancf_beam import AncfBeam
from dalembert.multibody.components.planar.ancf_cable import AncfCable
from dalembert.multibody.components.planar.body import Body
from dalembert.multibody.components.planar.bushing import Bushing
from dalembert.multibody.components.planar.distance_joint import DistanceJoint
from dalembert.multibody.components.planar.fixed_joint import FixedJoint
from dalembert.multibody.components.planar.force import Force
from dalembert.multibody.components.planar.gear_joint import GearJoint
from dalembert.multibody.components.planar.joint import Joint
from dalembert.multibody.components.planar.load import Load
from dalembert.multibody.components.planar.point_mass import PointMass
from dalembert.multibody.components.planar.prescribed_motion import PrescribedMotion
from dalembert.multibody.components.planar.prismatic_joint import PrismaticJoint
from dalembert.multibody.components.planar.revolute_joint import RevoluteJoint
from dalembert.multibody.components.planar.rigid_bar import RigidBar
from dalembert.multibody.components.planar.rigid_body import RigidBody
from dalembert.multibody.components.planar.spring import Spring
from dalembert.multibody.components.planar.torque import Torque
from dalembert.multibody.components.planar.torsion_spring import TorsionSpring
from dalembert.multibody.components.planar.user_force import UserForce
from dalembert.multibody.components.points import Ground, GroundPoint, Point
from dalembert.multibody.components.signals import Constant, Custom, Harmonic, Polynomial, Signal, Step, Table
from dalembert.multibody.drawing import Drawing
from dalembert.multibody.integrators.automatic import Automatic
from dalembert.multibody.integrators.collocation import Collocation, GaussNewton
from dalembert.multibody.integrators.energy_momentum import EnergyMomentum
from dalembert.multibody.integrators.generalized_alpha import GeneralizedAlpha
from dalembert.multibody.integrators.integrator import Integrator
from dalembert.multibody.integrators.ode_solver import OdeSolver
from dalembert.multibody.integrators.radau_iia import RadauIIA
from dalembert.multibody.integrators.runge_kutta import RungeKutta4
from dalembert.multibody.integrators.stabilisation import Augmented, Baumgarte, Partitioning, Projection
from dalembert.multibody.integrators.variational import Variational
from dalembert.multibody.kernels.debugging import in_python
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.simulate import simulate
from dalembert.multibody.statics import Equilibrium, Modes, equilibrium, modes
from dalembert.multibody.system import System
from dalembert.multibody.time_response import TimeResponse
from dalembert.multibody.trajectory import Trajectory
from dalembert.multibody.work_precision import WorkPrecision, work_precision

__all__ = [
    "AncfBeam",
    "AncfCable",
    "Augmented",
    "Automatic",
    "Baumgarte",
    "Body",
    "Bushing",
    "Collocation",
    "Constant",
    "Custom",
    "DistanceJoint",
    "Drawing",
    "EnergyMomentum",
    "Equilibrium",
    "FixedJoint",
    "Force",
    "GaussNewton",
    "GearJoint",
    "GeneralizedAlpha",
    "Ground",
    "GroundPoint",
    "Harmonic",
    "Integrator",
    "Joint",
    "Kind",
    "Load",
    "Modes",
    "OdeSolver",
    "Partitioning",
    "Point",
    "PointMass",
    "Polynomial",
    "PrescribedMotion",
    "PrismaticJoint",
    "Projection",
    "RadauIIA",
    "RevoluteJoint",
    "RigidBar",
    "RigidBody",
    "RungeKutta4",
    "Signal",
    "Spring",
    "Step",
    "System",
    "Table",
    "TimeResponse",
    "Torque",
    "TorsionSpring",
    "Trajectory",
    "UserForce",
    "Variational",
    "WorkPrecision",
    "equilibrium",
    "in_python",
    "modes",
    "simulate",
    "work_precision",
]
