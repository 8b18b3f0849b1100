"""A rope at a bar in a pin with friction, under a force for some time: derivatives of integrators are tested on it."""

import numpy as np

import dalembert.multibody as mb
from dalembert.multibody.integrators.shared.integrator import Integrator
from mechanisms import SECTION

TIMES = np.array([0.0, 0.02, 0.05, 0.08])
CHANNELS = ("rope.end.x", "rope.end.ay", "pin.force_x", "system.total_energy")
BOUNDS = {
    "stiffness": (2e5, 6e5),
    "rate": (0.5, 2.0),
    "friction": (0.2, 0.6),
    "force": (10.0, 50.0),
    "mass": (1.0, 3.0),
}


def rope(stiffness: float, rate: float, friction: float, force: float, mass: float) -> mb.System:
    """A bar in a pin with friction, with a soft damped cable at its end and a force for some time."""
    system = mb.System()
    bar = system.add(mb.RigidBar("bar", 1.0, mass, angle=0.2, angular_velocity=rate))
    soft = system.add(mb.AncfCable("rope", 1.0, 2, stiffness, density=1000.0, **SECTION, start=bar.end, damping=0.01))
    pin = {"viscous": 0.4, "friction_coefficient": friction, "pin_radius": 0.1, "slip_rate": 0.8}
    system.add(mb.RevoluteJoint("pin", system.ground, bar.start, **pin))
    system.add(mb.RevoluteJoint("knot", bar.end, soft.start))
    system.add(mb.Force("push", soft.end, x=mb.Step(force, 0.013, 0.06)))
    return system


def response(solver: Integrator, workers: int = 1) -> mb.TimeResponse:
    return mb.TimeResponse(rope, BOUNDS, CHANNELS, TIMES, solver, workers)
