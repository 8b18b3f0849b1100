"""Bushings in space: torque, energy and equilibrium at large rotations against closed forms and SciPy's rotations."""

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.spatial.transform import Rotation

from dalembert.multibody import Polynomial, RadauIIA, TimeResponse, Trajectory, equilibrium, simulate
from dalembert.multibody.spatial import (
    Bushing,
    Inertia,
    Orientation,
    PrescribedMotion,
    RelativeSensor,
    RevoluteJoint,
    RigidBody,
    SpatialSystem,
    Torque,
)

TOPIC = "Mechanisms in space"
EXACT = RadauIIA(tolerance=1e-11)
ONE = Inertia.sphere(mass=1.0, radius=0.1)


def coupled(seed: int, least: float) -> np.ndarray:
    """A symmetric positive definite matrix (6, 6) with all entries."""
    rows = np.random.default_rng(seed).normal(size=(6, 6))
    return 3.0 * rows @ rows.T + least * np.eye(6)


STIFFNESS, DAMPING = coupled(1, 20.0), 0.03 * coupled(2, 1.0)


def tumbling(damping) -> Trajectory:
    """Two free bodies with a bushing between them, which turn against each other by more than a right angle."""
    system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    first = RigidBody(
        "first", Inertia(2.0, (0.3, 0.2, 0.25)), orientation=Orientation.by_rotation_vector((0.3, 0.5, -0.2)),
        angular_velocity=(0.3, -1.0, 0.2),
    )  # fmt: skip
    second = RigidBody(
        "second", Inertia(1.0, (0.1, 0.12, 0.15)), (0.2, 0.1, 0.0), Orientation.by_rotation_vector((-0.3, 0.2, 0.7)),
        velocity=(0.3, 0.0, 0.0), angular_velocity=(24.0, -48.0, 36.0),
    )  # fmt: skip
    sides = [system.add(body).point("origin") for body in (first, second)]
    system.add(Bushing("bush", *sides, stiffness=STIFFNESS, damping=damping))
    system.add(RelativeSensor("seen", *sides))
    return simulate(system, 0.2, EXACT, times=np.linspace(0.0, 0.2, 401))


def vectors(motion: Trajectory, name: str) -> np.ndarray:
    """Three channels along the axes of the first body, (samples, 3)."""
    return motion.channels([f"{name}{axis}" for axis in "xyz"])


def deflections(motion: Trajectory) -> tuple[np.ndarray, Rotation]:
    """Displacement and rotation vector (samples, 6), by SciPy from the quaternion of the sensor; and the rotations."""
    turned = Rotation.from_quat(np.roll(motion.channels([f"seen.q{k}" for k in range(4)]), -1, axis=1))
    turned = turned * turned[0].inv()
    return np.hstack([vectors(motion, "bush."), turned.as_rotvec()]), turned


def test_torque_and_energy_about_one_axis(record_evidence):
    """A drive turns a body on a bushing at 1 rad/s, so the torque of the drive is that of the bushing."""
    system, angles, stiffness = SpatialSystem(gravity=(0.0, 0.0, 0.0)), np.linspace(0.0, 3.1, 32), 1.7
    body = system.add(RigidBody("body", ONE, angular_velocity=(0.0, 0.0, 1.0)))
    sides = system.ground, body.point("origin")
    system.add(RevoluteJoint("pin", *sides))
    system.add(Bushing("bush", *sides, stiffness=(0.0, 0.0, 0.0, 5.0, 6.0, stiffness)))
    system.add(PrescribedMotion("drive", *sides, motion=Polynomial([0.0, 1.0])))
    motion = simulate(system, 3.1, EXACT, times=angles)
    drive, torque, rotation = motion.channels(["drive.torque_z", "bush.torque_z", "bush.rotation_z"]).T
    for quantity, expected, ours, unit in (
        ("torque of the drive", stiffness * angles, drive, "N*m"),
        ("torque of the bushing", stiffness * angles, torque, "N*m"),
        ("rotation", angles, rotation, "rad"),
        ("energy", stiffness * angles**2 / 2, motion.energies["potential"], "J"),
    ):
        record_evidence(
            f"Bushing that turns by 178° about one axis, {quantity}", expected, ours, unit=unit, tolerance=1e-8,
            topic=TOPIC, kind="closed form", source="k θ and k θ²/2",
        )  # fmt: skip


def test_equilibrium_beyond_a_right_angle(record_evidence):
    system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    body = system.add(RigidBody("body", ONE))
    system.add(Bushing("bush", system.ground, body.point("origin"), stiffness=(1e3, 1e3, 1e3, 1.0, 1.0, 1.0)))
    torque = np.array([1.0, -1.2, 1.9])
    system.add(Torque("load", body.point("origin"), *torque))
    record_evidence(
        "Bushing under a torque, rotation vector of 141°", torque,
        equilibrium(system).channels([f"body.origin.rotation_{axis}" for axis in "xyz"]), unit="rad",
        tolerance=1e-9, topic=TOPIC, kind="closed form", source="M/k for equal stiffness about all axes",
    )  # fmt: skip


def test_torque_is_the_gradient_of_the_energy(record_evidence):
    motion = tumbling((0.0,) * 6)
    deflected, turned = deflections(motion)
    largest = np.degrees(np.linalg.norm(deflected[:, 3:], axis=1).max())
    assert 120 < largest < 170
    assert motion.findings == ()
    record_evidence(
        "Two bodies on a bushing, rotation vector", deflected[:, 3:], vectors(motion, "bush.rotation_"), unit="rad",
        tolerance=1e-12, noisy=True, topic=TOPIC, kind="other code", source="SciPy's Rotation.as_rotvec",
    )  # fmt: skip

    def stored(sample: int, turn: np.ndarray) -> float:
        u = np.append(deflected[sample, :3], (Rotation.from_rotvec(turn) * turned[sample]).as_rotvec())
        return 0.5 * u @ STIFFNESS @ u

    small, samples = 1e-5, range(0, 401, 20)
    slopes = [[(stored(k, e) - stored(k, -e)) / (2 * small) for e in small * np.eye(3)] for k in samples]
    record_evidence(
        "Two bodies on a bushing, torque up to a rotation of 120° and more", np.array(slopes),
        vectors(motion, "bush.torque_")[samples], unit="N*m", tolerance=2e-8, topic=TOPIC, kind="other code",
        source="central differences of u·K·u/2 over rotations of SciPy",
    )  # fmt: skip
    total = motion.energies["total"]
    record_evidence(
        "Two bodies on a bushing, energy", np.full_like(total, total[0]), total, unit="J", relative=True,
        tolerance=1e-11, noisy=True, topic=TOPIC, kind="conservation law", source="no damping",
    )  # fmt: skip


def test_damping_is_conjugate_to_the_rotation_vector(record_evidence):
    """The energy falls by u'·D u', with the rates of the deflection from a spline through the rotation vectors."""
    motion = tumbling(DAMPING)
    deflected, _ = deflections(motion)
    rates = make_interp_spline(motion.times, deflected, k=7).derivative()(motion.times)
    power = make_interp_spline(motion.times, motion.energies["total"], k=7).derivative()(motion.times)
    inside = slice(40, -40)  # splines are less exact at their ends
    record_evidence(
        "Two bodies on a damped bushing, power", -np.einsum("si,ij,sj->s", rates, DAMPING, rates)[inside],
        power[inside], unit="W", relative=True, tolerance=1e-7, topic=TOPIC, kind="conservation law",
        source="-u'·D u'",
    )  # fmt: skip
    forces = deflected @ STIFFNESS + rates @ DAMPING
    work = np.sum(vectors(motion, "bush.torque_") * vectors(motion, "seen.w"), axis=1)
    record_evidence(
        "Two bodies on a damped bushing, power of the torque", np.sum(forces[:, 3:] * rates[:, 3:], axis=1)[inside],
        work[inside], unit="W", relative=True, tolerance=1e-7, topic=TOPIC, kind="closed form",
        source="torque·ω = (K u + D u')·p'",
    )  # fmt: skip


def test_sensitivities_at_no_rotation(record_evidence):
    """Derivatives by torques that are zero: the body rests where the rotation vector is zero."""
    stiffness, moments, times = np.array([2.0, 3.0, 5.0]), np.array([0.02, 0.03, 0.025]), np.linspace(0.0, 1.0, 11)

    def build(mx, my, mz):
        system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
        body = system.add(RigidBody("body", Inertia(1.0, tuple(moments))))
        system.add(Bushing("bush", system.ground, body.point("origin"), stiffness=(1e3, 1e3, 1e3, *stiffness)))
        system.add(Torque("load", body.point("origin"), mx, my, mz))
        return system

    channels = [f"bush.rotation_{axis}" for axis in "xyz"]
    model = TimeResponse(build, dict.fromkeys(("mx", "my", "mz"), (-1.0, 1.0)), channels, times, RadauIIA(step=5e-3))
    response, jacobian = model.linearise(np.zeros(3))
    assert not np.any(response)
    swings = (1.0 - np.cos(np.sqrt(stiffness / moments) * times[:, None])) / stiffness
    record_evidence(
        "Body at rest on a bushing, derivatives of its rotation by torques", swings[:, :, None] * np.eye(3), jacobian,
        unit="1/(N*m)", tolerance=1e-9, topic=TOPIC, kind="closed form", source="(1 - cos ωt)/k",
    )  # fmt: skip
