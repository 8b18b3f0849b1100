"""Flexible and rigid planar mechanisms in time."""

from dalembert.multibody.beams import AncfBeam, AncfCable
from dalembert.multibody.bodies import PointMass, RigidBar, RigidBody
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
from dalembert.multibody.joints import DistanceJoint, FixedJoint, PrescribedMotion, PrismaticJoint, RevoluteJoint
from dalembert.multibody.loads import Force, Spring, Torque, TorsionSpring, UserForce
from dalembert.multibody.points import Ground, GroundPoint, Point
from dalembert.multibody.signals import Constant, Custom, Harmonic, Polynomial, Step, Table
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
    "GeneralizedAlpha",
    "Ground",
    "GroundPoint",
    "Harmonic",
    "Integrator",
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
    "modes",
    "simulate",
    "work_precision",
]
