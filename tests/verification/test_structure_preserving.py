"""Integrators that keep structure: order, momenta, energy over long times, constraints, flexible mechanisms."""

import numpy as np
import pytest

import dalembert as da
import dalembert.multibody.spatial as sp
from flexible_pendulum import pendulum
from momenta import momenta
from rigid_mechanisms import andrews, read, two_link_arm
from soft_pendulum import soft

TOPIC = "Structure-preserving integrators"
SOURCE = "Marsden & West, Discrete mechanics and variational integrators (2001)"
SOLVERS = [da.Variational, da.EnergyMomentum]


@pytest.fixture
def arm(reference) -> da.System:
    return two_link_arm(reference("two_link_arm")["model"])


@pytest.fixture(params=["rigid", "soft"])
def links(request, arm) -> tuple[str, da.System, float]:
    """A double pendulum, and the coarsest step for its order."""
    return ("rigid", arm, 5e-3) if request.param == "rigid" else ("soft", soft(), 2.5e-4)


@pytest.mark.parametrize("solver", SOLVERS)
def test_second_order_in_position_velocity_and_forces(record_evidence, links, solver: type) -> None:
    kind, system, coarsest = links
    names = [f"{body}.end.{entry}" for body in ("upper", "lower") for entry in ("x", "y", "vx", "vy")]
    names += ["A.force_x", "A.force_y"]

    def state(step: float) -> np.ndarray:
        return da.simulate(system, 0.4, solver=solver(step=step), times=np.array([0.0, 0.4])).channels(names)[-1]

    coarse, middle, fine = (state(coarsest / factor) for factor in (1, 2, 4))
    for entry, rows in {"position": [0, 1, 4, 5], "velocity": [2, 3, 6, 7], "forces of joints": [8, 9]}.items():
        gaps = np.linalg.norm((coarse - middle)[rows]), np.linalg.norm((middle - fine)[rows])
        record_evidence(
            f"{solver.__name__}: order in {entry}, {kind} double pendulum",
            2.0,
            np.log2(gaps[0] / gaps[1]),
            tolerance=0.1,
            topic=TOPIC,
            kind="published",
            source=SOURCE,
        )


@pytest.mark.parametrize("solver", SOLVERS)
def test_second_order_with_friction_of_the_joints_forces(record_evidence, solver: type) -> None:
    system = da.System()
    upper = system.add(da.RigidBar("upper", 1.0, 1.0, angle=-0.4))
    lower = system.add(da.RigidBar("lower", 1.5, 2.0, angle=0.5, start=upper.end, angular_velocity=3.0))
    rubbing = {"friction_coefficient": 0.3, "pin_radius": 0.2, "slip_rate": 2.0}
    system.add(da.RevoluteJoint("O", system.ground, upper.start, **rubbing))
    system.add(da.RevoluteJoint("A", upper.end, lower.start, **rubbing))
    names = ["upper.end.x", "upper.end.vx", "lower.end.x", "lower.end.vx"]

    def state(step: float) -> np.ndarray:
        return da.simulate(system, 0.5, solver=solver(step=step), times=np.array([0.0, 0.5])).channels(names)[-1]

    coarse, middle, fine = (state(2e-3 / factor) for factor in (1, 2, 4))
    record_evidence(
        f"{solver.__name__}: order with Coulomb friction by the joints' forces",
        2.0,
        np.log2(np.linalg.norm(coarse - middle) / np.linalg.norm(middle - fine)),
        tolerance=0.1,
        topic=TOPIC,
        kind="published",
        source=SOURCE,
    )


def flying() -> da.System:
    """A bar, a cable and a mass that fly freely, joined by a pin, a rod and a spring."""
    system = da.System(gravity=(0.0, 0.0))
    bar = system.add(da.RigidBar("bar", 1.0, 1.0, angle=0.4, velocity=(1.0, 0.3), angular_velocity=4.0))
    rope = system.add(da.AncfCable("rope", 2.0, 4, 2e6, 1000.0, 0.1, 0.1, angle=-0.3, start=bar.end))
    mass = system.add(da.PointMass("mass", 3.0, (0.5, 1.5)))
    system.add(da.RevoluteJoint("pin", bar.end, rope.start))
    system.add(da.DistanceJoint("rod", mass.centre, rope.end))
    system.add(da.Spring("spring", mass.centre, bar.start, 50.0))
    return system


@pytest.mark.parametrize("solver", SOLVERS)
def test_momenta_of_a_free_flight(record_evidence, solver: type) -> None:
    trajectory = da.simulate(flying(), 4.0, solver=solver(step=4e-3))
    found = momenta(trajectory)
    record_evidence(
        f"{solver.__name__}: momenta of a bar, a cable and a mass in free flight over 1000 steps",
        np.zeros_like(found),
        (found - found[0]) / np.abs(found[0]).max(),
        tolerance=1e-12,
        topic=TOPIC,
        kind="conservation law",
        source="conservation law",
        noisy=True,
    )
    moved = np.abs(np.diff(trajectory.energies["potential"])).sum()
    assert moved > 0.1 * trajectory.energies["total"][0], "the flight must exchange energy"


@pytest.mark.parametrize("solver", SOLVERS)
def test_angular_momentum_about_a_fixed_pin(record_evidence, solver: type) -> None:
    system = da.System(gravity=(0.0, 0.0))
    upper = system.add(da.RigidBar("upper", 1.0, 1.0, angle=0.4, angular_velocity=2.0))
    lower = system.add(da.RigidBar("lower", 1.5, 2.0, angle=1.9, start=upper.end, angular_velocity=-5.0))
    system.add(da.RevoluteJoint("O", system.ground.point(0.0, 0.0), upper.start))
    system.add(da.RevoluteJoint("A", upper.end, lower.start))
    found = momenta(da.simulate(system, 10.0, solver=solver(step=1e-2)))[:, 2]
    record_evidence(
        f"{solver.__name__}: angular momentum of two links about a fixed pin over 1000 steps",
        np.zeros_like(found),
        found / found[0] - 1,
        tolerance=1e-12,
        topic=TOPIC,
        kind="conservation law",
        source="conservation law",
        noisy=True,
    )


def test_the_energy_does_not_drift(record_evidence, arm) -> None:
    """The largest deviation of the last tenth of a long motion is that of the first one."""
    end, step = 200.0, 5e-3
    trajectory = da.simulate(arm, end, solver=da.Variational(step=step))
    total, kinetic = trajectory.energies["total"], trajectory.energies["kinetic"].max()
    deviations = np.abs(total - total[0]).reshape(-1)[1:].reshape(10, -1).max(axis=1) / kinetic
    record_evidence(
        "Variational: growth of the energy's deviation over 40 000 steps of the two-link arm, last tenth by largest",
        1.0,
        deviations[-1] / deviations.max(),
        tolerance=0.5,
        topic=TOPIC,
        kind="published",
        source=SOURCE,
    )
    means = total.reshape(-1)[1:].reshape(10, -1).mean(axis=1)
    record_evidence(
        "Variational: drift of the mean energy over 40 000 steps of the two-link arm, by the largest kinetic energy",
        0.0,
        (means[-1] - means[0]) / kinetic,
        tolerance=2e-4,
        topic=TOPIC,
        kind="published",
        source=SOURCE,
    )


def falling() -> da.System:
    """The free flight under gravity."""
    system = flying()
    system.gravity = (0.0, -9.81)
    return system


@pytest.mark.parametrize(
    ("name", "builder", "end", "step"),
    [
        ("free flight", flying, 8.0, 4e-3),
        ("free fall", falling, 2.0, 4e-3),
        ("flexible pendulum", lambda: pendulum(np.pi / 4, np.pi / 6), 2.0, 5e-4),
        ("soft pendulum", soft, 2.0, 2e-3),
    ],
)
def test_energy_to_rounding(record_evidence, name: str, builder, end: float, step: float) -> None:
    trajectory = da.simulate(builder(), end, solver=da.EnergyMomentum(step=step))
    total, kinetic = trajectory.energies["total"], trajectory.energies["kinetic"].max()
    record_evidence(
        f"EnergyMomentum: energy of the {name} over {len(total) - 1} steps, by the largest kinetic energy",
        np.zeros(len(total)),
        (total - total[0]) / kinetic,
        tolerance=1e-12,
        topic=TOPIC,
        kind="conservation law",
        source="conservation law",
        noisy=True,
    )


def test_energy_of_the_two_link_arm_to_rounding(record_evidence, arm) -> None:
    trajectory = da.simulate(arm, 100.0, solver=da.EnergyMomentum(step=2e-3))
    total, kinetic = trajectory.energies["total"], trajectory.energies["kinetic"].max()
    record_evidence(
        "EnergyMomentum: energy of the two-link arm over 50 000 steps, by the largest kinetic energy",
        np.zeros(len(total)),
        (total - total[0]) / kinetic,
        tolerance=1e-12,
        topic=TOPIC,
        kind="conservation law",
        source="conservation law",
        noisy=True,
    )


def test_the_momentum_across_gravity_stays_in_free_fall(record_evidence) -> None:
    found = momenta(da.simulate(falling(), 2.0, solver=da.EnergyMomentum(step=4e-3)))[:, 0]
    record_evidence(
        "EnergyMomentum: momentum across gravity in free fall",
        np.zeros_like(found),
        found / found[0] - 1,
        tolerance=1e-12,
        topic=TOPIC,
        kind="conservation law",
        source="conservation law",
        noisy=True,
    )


@pytest.mark.slow
def test_energy_and_vertical_momentum_of_a_beam_on_a_ball_joint(record_evidence) -> None:
    """Under gravity, about the vertical through the ball joint, which alone holds the beam."""
    place = (0.2, 0.1, 0.0)
    system = sp.SpatialSystem()
    section = sp.Section.rectangle(0.02, 0.01, youngs_modulus=2e9, poisson_ratio=0.3, density=1200.0)
    beam = system.add(sp.Beam("beam", section, 1.0, 2, 2, place, angular_velocity=(0.5, 1.0, 3.0)))
    system.add(sp.SphericalJoint("ball", system.ground.point(place), beam.start))
    motion = da.simulate(system, 20.0, solver=da.EnergyMomentum(step=1e-3))
    total, kinetic = motion.energies["total"], motion.energies["kinetic"].max()
    conserved = momenta(motion)
    vertical = conserved[:, 5] - 0.2 * conserved[:, 1] + 0.1 * conserved[:, 0]
    common = {"topic": TOPIC, "kind": "conservation law", "source": "conservation law", "noisy": True}
    record_evidence(
        "EnergyMomentum: energy of a beam on a ball joint over 20 000 steps, by the largest kinetic energy",
        np.zeros(len(total)), (total - total[0]) / kinetic, tolerance=1e-11, **common,
    )  # fmt: skip
    record_evidence(
        "EnergyMomentum: vertical angular momentum of a beam on a ball joint over 20 000 steps",
        np.zeros(len(total)), vertical / vertical[0] - 1.0, tolerance=1e-8, **common,
    )  # fmt: skip


def test_work_of_loads_dampers_and_friction_balances_the_energy(record_evidence, arm) -> None:
    """The work is a trapezoidal sum over the steps; the integrator's own is that of their middles."""
    upper, lower = arm.bodies
    arm.add(da.Torque("motor", upper.centre, da.signals.Harmonic(5.0, 3.0)))
    arm.add(da.Spring("spring", arm.ground.point(2.0, 0.0), lower.centre, 20.0, damping=1.0, free_length=1.0))
    gaps = []
    for step in (4e-3, 2e-3, 1e-3):
        trajectory = da.simulate(arm, 2.0, solver=da.EnergyMomentum(step=step))
        gaps.append(np.abs(trajectory.energies["balance"]).max() / trajectory.energies["kinetic"].max())
    record_evidence(
        "EnergyMomentum: order of the driven, damped arm unexplained energy",
        2.0,
        np.log2(gaps[1] / gaps[2]),
        tolerance=0.2,
        topic=TOPIC,
        kind="conservation law",
        source="conservation law",
    )


@pytest.mark.parametrize("solver", SOLVERS)
def test_constraints_hold_between_the_steps(record_evidence, arm, solver: type) -> None:
    trajectory = da.simulate(arm, 20.0, solver=solver(step=1e-2), times=np.linspace(0.0, 20.0, 3001))
    for level, violation in trajectory.violations.items():
        record_evidence(
            f"{solver.__name__}: constraints at the level of {level}, two-link arm over 20 s at h = 10 ms",
            np.zeros(len(violation)),
            violation,
            tolerance=1e-12,
            topic=TOPIC,
            kind="conservation law",
            source="constraints",
            noisy=True,
        )


@pytest.mark.parametrize("solver", SOLVERS)
def test_andrews_mechanism(reference, record_evidence, solver: type) -> None:
    data = reference("andrews")
    end = data["end"]
    system, times = andrews(data, data["initial"]["q"]), np.array([0.0, end["time"]])
    ours = read(data, da.simulate(system, end["time"], solver=solver(step=1e-5), times=times), -1)
    record_evidence(
        f"Andrews' mechanism, coordinates at 0.03 s by {solver.__name__} (h = 0.01 ms)",
        end["q"],
        ours["q"],
        tolerance=1e-4,
        relative=True,
        topic=TOPIC,
        kind=data["kind"],
        source=data["source"],
    )


@pytest.mark.parametrize("solver", SOLVERS)
def test_flexible_pendulum_agrees_with_radau(record_evidence, solver: type) -> None:
    system, times = pendulum(np.pi / 4, np.pi / 6), np.linspace(0.0, 0.5, 11)
    names = ["AB.end.x", "AB.end.y"]
    ours = da.simulate(system, 0.5, solver=solver(step=2e-4), times=times).channels(names)
    other = da.simulate(system, 0.5, solver=da.RadauIIA(tolerance=1e-7), times=times).channels(names)
    record_evidence(
        f"flexible double pendulum, tip over 0.5 s, {solver.__name__} (h = 0.2 ms) against Radau IIA",
        other,
        ours,
        unit="m",
        tolerance=1e-5,
        topic=TOPIC,
        kind="other method",
        source="Radau IIA of order 5",
    )
