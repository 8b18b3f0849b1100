"""Torsion springs in space against the closed form of a torsional pendulum of two turns, and energy without an axis."""

import numpy as np

from dalembert.multibody import RadauIIA, TimeResponse, simulate
from dalembert.multibody.spatial import Inertia, RevoluteJoint, RigidBody, SpatialSystem, SphericalJoint, TorsionSpring

TOPIC = "Mechanisms in space"
EXACT = RadauIIA(tolerance=1e-11)
MOMENT = 0.02


def wheel(stiffness, rate) -> SpatialSystem:
    system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    disc = system.add(RigidBody("disc", Inertia(1.0, (MOMENT,) * 3), angular_velocity=(0.0, 0.0, rate)))
    sides = system.ground, disc.point("origin")
    system.add(RevoluteJoint("pin", *sides))
    system.add(TorsionSpring("coil", *sides, stiffness=stiffness))
    return system


def test_wheel_on_a_coil_spring(record_evidence):
    stiffness, rate, times = 0.05, 20.0, np.linspace(0.0, 4.0, 9)
    model = TimeResponse(wheel, {"stiffness": (0.01, 0.1), "rate": (10, 30)}, ["coil.twist", "pin.angle"], times, EXACT)
    response, jacobian = model.linearise(np.array([stiffness, rate]))
    omega = np.sqrt(stiffness / MOMENT)
    swing = np.sin(omega * times) / omega
    by_stiffness = rate * (times * np.cos(omega * times) - swing) / (2 * stiffness)
    for quantity, expected, ours, unit, tolerance in (
        ("twist", rate * swing, response[:, 0], "rad", 1e-9),
        ("angle of its joint", rate * swing, response[:, 1], "rad", 1e-9),
        ("derivative of the twist by the rate", swing, jacobian[:, 0, 1], "s", 1e-9),
        ("derivative of the twist by the stiffness", by_stiffness, jacobian[:, 0, 0], "1/(N*m)", 1e-7),
    ):
        record_evidence(
            f"Wheel that winds a coil spring by two turns, {quantity}", expected, ours, unit=unit, tolerance=tolerance,
            topic=TOPIC, kind="closed form", source="ω sin(√(k/J) t)/√(k/J)",
        )  # fmt: skip


def test_energy_of_a_body_on_a_ball_joint(record_evidence):
    """No joint has the axis of the spring, so its torque must do work on the angle that is measured about the axis."""
    system = SpatialSystem()
    inertia = Inertia(1.0, (0.02, 0.03, 0.04), centre=(0.1, 0.05, -0.2))
    body = system.add(RigidBody("body", inertia, angular_velocity=(3.0, 2.0, 4.0)))
    sides = system.ground, body.point("origin")
    system.add(SphericalJoint("ball", *sides))
    system.add(TorsionSpring("coil", *sides, stiffness=2.0))
    total = simulate(system, 1.0, EXACT).energies["total"]
    record_evidence(
        "Body on a ball joint with a torsion spring, energy", np.full_like(total, total[0]), total, unit="J",
        relative=True, tolerance=1e-10, noisy=True, topic=TOPIC, kind="conservation law", source="no damping",
    )  # fmt: skip
