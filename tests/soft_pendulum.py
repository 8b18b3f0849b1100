"""A rigid and a very soft link, whose vibrations steps resolve: the orders of integrators are tested on it."""

import numpy as np

import dalembert as da


def soft() -> da.System:
    system = da.System()
    upper = system.add(da.RigidBar("upper", 1.0, 1.0, angle=-np.pi / 4))
    lower = system.add(da.AncfCable("lower", 2.0, 2, 2e5, 1000.0, 0.1, 0.1, angle=-np.pi / 6, start=upper.end))
    system.add(da.RevoluteJoint("O", system.ground, upper.start))
    system.add(da.RevoluteJoint("A", upper.end, lower.start))
    return system
