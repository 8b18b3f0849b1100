"""What must not change: energy, constraints, and beams that only move rigidly."""

import numpy as np
import pytest

import dalembert as da

SOURCE = "conservation law"
TOPIC = "Conservation"


def bar(kind: str, **placed) -> da.AncfBeam | da.AncfCable:
    section = {"density": 5540.0, "height": 0.1, "width": 0.05}
    if kind == "beam":
        return da.AncfBeam("bar", 2.0, 4, 2e8, poisson_ratio=0.3, **section, **placed)
    return da.AncfCable("bar", 2.0, 4, 2e8, **section, **placed)


MASS = 5540.0 * 0.1 * 0.05 * 2.0


@pytest.mark.parametrize("kind", ["beam", "cable"])
def test_a_beam_that_stands_still_is_not_strained(record_evidence, kind: str) -> None:
    system = da.System(gravity=(0.0, 0.0))
    system.add(bar(kind, angle=1.234, start=(0.7, -0.3)))
    trajectory = da.simulate(system, 0.1, solver=da.GeneralizedAlpha(step=1e-2))
    moved = trajectory.channels(["bar.end.x", "bar.end.y"]) - (0.7 + 2 * np.cos(1.234), -0.3 + 2 * np.sin(1.234))
    record_evidence(
        f"{kind} placed at an angle without load, motion of its end",
        np.zeros_like(moved),
        moved,
        unit="m",
        tolerance=1e-13,
        topic=TOPIC,
        kind="conservation law",
        source=SOURCE,
        noisy=True,
    )


@pytest.mark.parametrize("kind", ["beam", "cable"])
def test_free_fall_does_not_strain(record_evidence, kind: str) -> None:
    system = da.System(gravity=(1.5, -9.81))
    system.add(bar(kind, angle=0.6, velocity=(3.0, 4.0)))
    trajectory = da.simulate(system, 1.0, solver=da.GeneralizedAlpha(step=1e-2))
    t = trajectory.times[:, None]
    fall = np.array([3.0, 4.0]) * t + np.array([1.5, -9.81]) * t**2 / 2
    for point, place in {"start": (0.0, 0.0), "end": (2 * np.cos(0.6), 2 * np.sin(0.6))}.items():
        record_evidence(
            f"{kind} in free fall, its {point} against the parabola",
            fall + place,
            trajectory.channels([f"bar.{point}.x", f"bar.{point}.y"]),
            unit="m",
            tolerance=1e-11,
            topic=TOPIC,
            kind="conservation law",
            source=SOURCE,
            noisy=True,
        )
    centre = np.array([np.cos(0.6), np.sin(0.6)]) + fall
    weight = -MASS * centre @ np.array([1.5, -9.81])
    record_evidence(
        f"{kind} in free fall, strain energy",
        np.zeros(len(weight)),
        trajectory.energies["potential"] - weight,
        unit="J",
        tolerance=1e-9,
        topic=TOPIC,
        kind="conservation law",
        source=SOURCE,
        noisy=True,
    )


@pytest.mark.parametrize("kind", ["beam", "cable"])
def test_rigid_rotation_is_not_strained_and_has_the_kinetic_energy_of_a_rigid_bar(record_evidence, kind: str) -> None:
    system = da.System(gravity=(0.0, 0.0))
    system.add(bar(kind, angle=-0.8, velocity=(0.5, -1.0), angular_velocity=3.0))
    trajectory = da.simulate(system, 1e-6, solver=da.GeneralizedAlpha(step=1e-6))
    along = np.array([np.cos(0.8), -np.sin(0.8)])
    centre = np.array([0.5, -1.0]) + 3.0 * np.array([-along[1], along[0]])
    # The cable's section has no inertia of its own; the beam's has that of the depth in the plane of motion.
    inertia = MASS * (2.0**2 + (0.1**2 if kind == "beam" else 0.0)) / 12
    common = {"topic": TOPIC, "kind": "closed form", "source": "rigid bar"}
    record_evidence(
        f"{kind} turning as a rigid bar, kinetic energy",
        MASS * centre @ centre / 2 + inertia * 3.0**2 / 2,
        trajectory.energies["kinetic"][0],
        unit="J",
        tolerance=1e-13,
        relative=True,
        noisy=True,
        **common,
    )
    record_evidence(
        f"{kind} turned as a rigid bar, strain energy",
        0.0,
        trajectory.energies["potential"][0],
        unit="J",
        tolerance=1e-15,
        noisy=True,
        **common,
    )


def two_links(viscous: float = 0.0) -> da.System:
    system = da.System()
    upper = system.add(da.RigidBar("upper", 1.0, 1.0, angle=np.pi / 3))
    lower = system.add(da.RigidBar("lower", 3.0, 2.0, angle=-np.pi / 6, start=upper.end))
    system.add(da.RevoluteJoint("O", system.ground, upper.start, viscous=viscous))
    system.add(da.RevoluteJoint("A", upper.end, lower.start))
    return system


def flexible_pendulum() -> da.System:
    section = {"poisson_ratio": 0.3, "density": 5540.0, "height": 0.4, "width": 0.2}
    system = da.System()
    oa = system.add(da.AncfBeam("OA", 1.0, 2, 2e8, angle=-np.pi / 4, **section))
    ab = system.add(da.AncfBeam("AB", 2.0, 4, 2e7, angle=-np.pi / 6, start=oa.end, **section))
    system.add(da.RevoluteJoint("O", system.ground, oa.start))
    system.add(da.RevoluteJoint("A", oa.end, ab.start))
    return system


@pytest.mark.parametrize(
    ("name", "builder", "end", "step", "radius", "tolerance"),
    [
        ("two-link arm", two_links, 20.0, 2e-4, 1.0, 1e-5),
        ("two-link arm with numerical damping", two_links, 20.0, 2e-4, 0.9, 1e-5),
        ("flexible double pendulum", flexible_pendulum, 2.0, 2.5e-4, 1.0, 1e-5),
    ],
    ids=["two-link arm", "two-link arm with damping", "flexible pendulum"],
)
def test_energy_and_constraints(
    record_evidence, name: str, builder, end: float, step: float, radius: float, tolerance: float
) -> None:
    trajectory = da.simulate(builder(), end, solver=da.GeneralizedAlpha(step=step, spectral_radius=radius))
    total, kinetic = trajectory.energies["total"], trajectory.energies["kinetic"]
    record_evidence(
        f"{name}, drift of the energy over {end:g} s, as a part of the largest kinetic energy "
        f"(spectral radius {radius:g}, h = {step * 1e3:g} ms)",
        np.zeros(len(total)),
        (total - total[0]) / kinetic.max(),
        tolerance=tolerance,
        topic=TOPIC,
        kind="conservation law",
        source=SOURCE,
    )
    violation = trajectory.violations["position"]
    record_evidence(
        f"{name}, constraint violation over {end:g} s",
        np.zeros(len(violation)),
        violation,
        unit="m",
        tolerance=1e-11,
        topic=TOPIC,
        kind="conservation law",
        source=SOURCE,
        noisy=True,
    )


def test_work_of_loads_dampers_and_friction_balances_the_energy(record_evidence) -> None:
    system = two_links(viscous=0.3)
    upper, lower = system.bodies
    system.add(da.Torque("motor", upper.centre, da.signals.Harmonic(5.0, 3.0)))
    system.add(da.Spring("spring", system.ground.point(2.0, 0.0), lower.centre, 20.0, damping=1.0, free_length=1.0))
    drifts = []
    for step in (2e-3, 1e-3):
        trajectory = da.simulate(system, 3.0, solver=da.GeneralizedAlpha(step=step, spectral_radius=1.0))
        drifts.append(np.max(np.abs(trajectory.energies["balance"])) / trajectory.energies["kinetic"].max())
    assert drifts[1] < 0.3 * drifts[0], "the balance must close with the square of the step"
    record_evidence(
        "driven, damped two-link arm: unexplained energy, as a part of the largest kinetic energy (h = 1 ms)",
        0.0,
        drifts[1],
        tolerance=1e-4,
        topic=TOPIC,
        kind="conservation law",
        source=SOURCE,
    )
