"""Armature inertias that exceed the mass matrix, and mechanisms that begin at stated coordinates of their joints."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from dalembert.multibody import EnergyMomentum, Integrator, OdeSolver, RadauIIA, Variational, simulate
from dalembert.multibody.spatial import Armature, Inertia, RevoluteJoint, RigidBody, SpatialSystem

TOPIC = "Mechanisms in space"
MASS, LENGTH, ROTOR, END = 1.2, 0.5, 0.7, 1.0
BODY = Inertia.cylinder(mass=MASS, radius=0.02, length=LENGTH).moved((0.0, 0.0, -LENGTH / 2))
ABOUT_PIN = MASS * (0.02**2 / 4 + LENGTH**2 / 3)


def pendulum(angle: float, rate: float) -> SpatialSystem:
    """A rod on a hinge, which carries a rotor with a gear."""
    system = SpatialSystem(gravity=(0.0, 0.0, -9.81))
    rod = system.add(RigidBody("rod", BODY))
    system.add(RevoluteJoint("pin", system.ground, rod.point("origin"), axis=(0.0, 1.0, 0.0)))
    system.add(Armature("rotor", system.ground, rod.point("origin"), ROTOR, axis=(0.0, 1.0, 0.0)))
    system.pose({"pin": angle}, rates={"pin": rate})
    return system


@pytest.mark.parametrize(
    ("solver", "tolerance"),
    [(RadauIIA(tolerance=1e-10), 1e-9), (Variational(step=5e-4), 1e-5), (EnergyMomentum(step=5e-4), 1e-5),
     (OdeSolver("DOP853", 1e-12, 1e-12), 1e-9)],
    ids=["RadauIIA", "Variational", "EnergyMomentum", "OdeSolver"],
)  # fmt: skip
def test_pendulum_with_an_armature(solver: Integrator, tolerance: float, record_evidence) -> None:
    """The angle of one coordinate: (J + J_rotor) phi'' = -m g l/2 sin(phi), from an angle and a rate of the joint."""
    times = np.linspace(0.0, END, 6)
    found = simulate(pendulum(2.0, -3.0), END, solver, times=times).channels(["pin.angle"])[:, 0]

    def derivatives(t, state):
        return [state[1], -MASS * 9.81 * LENGTH / 2 * np.sin(state[0]) / (ABOUT_PIN + ROTOR)]

    exact = solve_ivp(derivatives, (0.0, END), [2.0, -3.0], "DOP853", times, rtol=1e-12, atol=1e-12).y[0]
    record_evidence(
        f"{type(solver).__name__}, pendulum with an armature from a stated state: angle (largest difference)",
        0.0,
        float(np.abs(found - exact).max()),
        unit="rad",
        tolerance=tolerance,
        noisy=True,
        topic=TOPIC,
        kind="other method",
        source="one coordinate, DOP853 at 1e-12",
    )
