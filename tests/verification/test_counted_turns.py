"""Angles of joints whose samples are many turns apart, against a closed form."""

import numpy as np

from dalembert.multibody import Harmonic, RadauIIA, simulate
from dalembert.multibody.spatial import Inertia, Motor, RevoluteJoint, RigidBody, SpatialSystem, Torque


def test_a_wheel_that_swings_by_ten_turns(record_evidence):
    """A torque -A w^2 J sin(w t) turns a wheel with the rate A w at the start by A sin(w t)."""
    amplitude, omega, times = 20 * np.pi, 2 * np.pi, np.array([0.0, 0.25, 0.75, 1.6])
    system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    wheel = system.add(
        RigidBody("wheel", Inertia(1.0, (1.0, 1.0, 1.0)), angular_velocity=(0.0, 0.0, amplitude * omega))
    )
    sides = system.ground, wheel.point("origin")
    system.add(RevoluteJoint("pin", *sides))
    system.add(Motor("motor", *sides, torque_constant=1.0, current=0.0))
    system.add(Torque("load", wheel.point("origin"), z=Harmonic(-amplitude * omega**2, omega)))
    angles = simulate(system, 1.6, RadauIIA(tolerance=1e-10), times).channels(["pin.angle", "motor.angle"])
    for name, values in zip(("joint", "motor"), angles.T, strict=True):
        record_evidence(
            f"Wheel that swings by 10 turns, angle of its {name} in samples up to 20 turns apart",
            amplitude * np.sin(omega * times), values, unit="rad", tolerance=1e-5, topic="Mechanisms in space",
            kind="closed form", source="A sin ωt",
        )  # fmt: skip
