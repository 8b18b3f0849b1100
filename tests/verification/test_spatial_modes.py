"""Equilibria and small vibrations in space against closed forms."""

import numpy as np
import pytest
from scipy.linalg import eigh

from dalembert.multibody import equilibrium, modes
from dalembert.multibody.spatial import Bushing, Inertia, RigidBody, SpatialSystem, SphericalJoint, Spring

TOPIC = "Mechanisms in space"
MASS, LENGTH, G = 2.0, 0.4, 9.81
BOX = Inertia.box(MASS, (0.1, 0.06, LENGTH))


def hanging() -> tuple[SpatialSystem, RigidBody]:
    """A box that hangs below the origin."""
    system = SpatialSystem()
    ends = {"top": (0.0, 0.0, LENGTH / 2), "low": (0.0, 0.0, -LENGTH / 2)}
    return system, system.add(RigidBody("rod", BOX, points=ends, anchor="top"))


def test_pendulum_on_springs(record_evidence):
    """A rod on a ball joint, held at its lower end by springs along x and y: J w^2 = m g l / 2 + k l^2."""
    system, rod = hanging()
    system.add(SphericalJoint("ball", system.ground, rod.point("top")))
    rates = 300.0, 500.0
    for name, rate, place in zip("xy", rates, ((1.0, 0.0, -LENGTH), (0.0, 1.0, -LENGTH)), strict=True):
        system.add(Spring(name, system.ground.point(place), rod.point("low"), stiffness=rate))
    about = np.array(BOX.moments)[[1, 0]] + MASS * (LENGTH / 2) ** 2
    expected = np.sqrt((MASS * G * LENGTH / 2 + np.array(rates) * LENGTH**2) / about) / (2 * np.pi)
    record_evidence(
        "Pendulum on springs, frequencies about x and y", np.sort(expected), modes(system).frequencies, unit="Hz",
        tolerance=1e-9, topic=TOPIC, kind="closed form", source="(m g l/2 + k l²)/(J + m l²/4)",
    )  # fmt: skip


@pytest.mark.slow
def test_body_on_a_bushing(record_evidence):
    """A box below a bushing: two coupled pairs of displacement and rotation, lifting and turning."""
    system, rod = hanging()
    k = np.array([2e4, 3e4, 5e4, 20.0, 30.0, 40.0])
    system.add(Bushing("bushing", system.ground.point((0.0, 0.0, 0.0)), rod.point("top"), stiffness=tuple(k)))
    rest = equilibrium(system)
    record_evidence(
        "Body on a bushing, static displacement", -MASS * G / k[2], rest.channels(["rod.top.z"])[0], unit="m",
        tolerance=1e-13, topic=TOPIC, kind="closed form", source="m g/k",
    )  # fmt: skip
    arm, found = LENGTH / 2, [np.sqrt(k[2] / MASS), np.sqrt(k[5] / BOX.moments[2])]
    for along, about, moment in ((k[0], k[4], BOX.moments[1]), (k[1], k[3], BOX.moments[0])):
        mass = np.array([[MASS, -MASS * arm], [-MASS * arm, moment + MASS * arm**2]])
        found += np.sqrt(eigh(np.diag([along, about + MASS * G * arm]), mass)[0]).tolist()
    record_evidence(
        "Body on a bushing, all six frequencies", np.sort(found) / (2 * np.pi), modes(rest).frequencies, unit="Hz",
        tolerance=1e-7, topic=TOPIC, kind="closed form", source="two degrees of freedom in each vertical plane",
    )  # fmt: skip
