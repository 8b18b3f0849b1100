"""Springs on nodes of beams that turn by more than one turn, against closed forms."""

import numpy as np

from dalembert.multibody import AncfCable, RadauIIA, RevoluteJoint, System, Torque, TorsionSpring, equilibrium, simulate

TOPIC = "Gears and bushings"
STIFFNESS, RATE, LENGTH, SIDE, DENSITY = 0.05, 40.0, 0.4, 0.02, 1000.0


def rod(rate: float, torque: float) -> System:
    """A stiff cable of one element, which turns about its start like a rod."""
    system = System(gravity=(0.0, 0.0))
    cable = system.add(AncfCable("rod", LENGTH, 1, 1e9, DENSITY, SIDE, SIDE, angular_velocity=rate))
    system.add(RevoluteJoint("pin", system.ground, cable.start))
    system.add(TorsionSpring("coil", system.ground, cable.start, STIFFNESS))
    system.add(Torque("moment", cable.start, torque))
    return system


def test_cable_on_a_coil_spring(record_evidence):
    """It stretches by some 1e-4, and bends by less than the tolerance."""
    omega = np.sqrt(STIFFNESS / (DENSITY * SIDE**2 * LENGTH**3 / 3))
    times = np.linspace(0.0, np.pi / omega, 5)
    motion = simulate(rod(RATE, 0.0), times[-1], RadauIIA(tolerance=1e-6), times)
    record_evidence(
        "Stiff cable that winds a coil spring by two and a half turns, twist", RATE / omega * np.sin(omega * times),
        motion.channels(["coil.elongation"])[:, 0], unit="rad", tolerance=3e-2, topic=TOPIC, kind="closed form",
        source="Ω sin(√(k/J) t)/√(k/J) of a rod",
    )  # fmt: skip
    total = motion.energies["total"]
    record_evidence(
        "Stiff cable that winds a coil spring by two and a half turns, energy", np.full_like(total, total[0]), total,
        unit="J", relative=True, tolerance=1e-6, noisy=True, topic=TOPIC, kind="conservation law", source="no damping",
    )  # fmt: skip


def test_moment_on_a_coil_spring(record_evidence):
    record_evidence(
        "Coil spring on a cable, twist by a moment of 0.5 N m", 0.5 / STIFFNESS,
        equilibrium(rod(0.0, 0.5)).channels(["coil.elongation"])[0], unit="rad", tolerance=1e-9, topic=TOPIC,
        kind="closed form", source="M/k",
    )  # fmt: skip
