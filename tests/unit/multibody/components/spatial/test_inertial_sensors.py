"""Inertial sensors against closed forms: at rest, at a constant rate, on a pendulum; their numbers as parameters."""

import numpy as np
import pytest
from inline_snapshot import snapshot

import dalembert.multibody as mb
from dalembert.data import Measurements
from dalembert.errors import InputError, ModelError
from dalembert.forward import Sensor, Sensors
from dalembert.inverse import identify
from dalembert.multibody.spatial import (
    FixedJoint,
    Inertia,
    InertialSensor,
    Orientation,
    PointMass,
    Pose,
    RevoluteJoint,
    RigidBody,
    SpatialSystem,
    SphericalJoint,
)
from refusals import refused

GRAVITY = np.array([0.3, -0.5, -9.7])
AXES = Orientation.by_angles("zyx", [0.4, -0.3, 0.7])
SIX = [f"imu.{kind}_{axis}" for kind in ("accelerometer", "gyroscope") for axis in "xyz"]
EXACT = mb.RadauIIA(tolerance=1e-11)


def wheel(rate: float, place=(0.3, 0.1, 0.2), axes: Orientation = AXES, gravity=GRAVITY, **sensor) -> SpatialSystem:
    """A body that turns about z, balanced, with a sensor off the axis."""
    system = SpatialSystem(gravity=tuple(gravity))
    disc = Inertia.cylinder(2.0, 0.2, 0.05)
    body = system.add(RigidBody("wheel", disc, points={"imu": Pose(place, axes)}, angular_velocity=(0.0, 0.0, rate)))
    system.add(RevoluteJoint("bearing", system.ground, body.point("origin")))
    system.add(InertialSensor("imu", body.point("imu"), **sensor))
    return system


def test_a_body_at_rest_reads_minus_gravity() -> None:
    system = SpatialSystem(gravity=tuple(GRAVITY))
    turned = Orientation.by_angles("xyz", [0.2, 0.9, -1.1])
    body = system.add(
        RigidBody(
            "box",
            Inertia.box(1.0, (0.1, 0.2, 0.3)),
            (0.1, 0.2, 0.3),
            turned,
            points={"imu": Pose((0.1, 0.2, 0.3), AXES)},
        )
    )
    system.add(FixedJoint("glue", system.ground.point((0.1, 0.2, 0.3), turned), body.point("origin")))
    system.add(InertialSensor("imu", body.point("imu")))
    read = mb.simulate(system, 0.2, EXACT).channels(SIX)
    np.testing.assert_allclose(
        read[:, :3], np.tile(-(turned.matrix @ AXES.matrix).T @ GRAVITY, (len(read), 1)), rtol=1e-10
    )
    np.testing.assert_allclose(read[:, 3:], 0.0, atol=1e-12)


def test_rotation_at_a_constant_rate() -> None:
    rate, place = 3.0, np.array([0.3, 0.1, 0.2])
    times = np.linspace(0.0, 1.0, 21)
    read = mb.simulate(wheel(rate), 1.0, EXACT, times=times).channels(SIX)
    for t, row in zip(times, read, strict=True):
        down = Orientation.by_angles("z", [rate * t]).matrix.T @ GRAVITY
        inward = -(rate**2) * np.array([place[0], place[1], 0.0])
        np.testing.assert_allclose(row[:3], AXES.matrix.T @ (inward - down), rtol=1e-9)
        np.testing.assert_allclose(row[3:], AXES.matrix.T @ [0.0, 0.0, rate], rtol=1e-9)


def test_a_pendulum() -> None:
    """At the distance s from the pin of a pendulum: s rate^2 + g cos(angle) along it, g sin(angle) (1 - s / L) across.

    L is the length of the simple pendulum with the same period.
    """
    place, mass, centre, inertia = 0.3, 1.5, 0.4, 0.1
    length = (inertia + mass * centre**2) / (mass * centre)
    system = SpatialSystem(gravity=(0.0, 0.0, -9.81))
    rod = Inertia(mass, (inertia, inertia, 0.02), centre=(0.0, 0.0, -centre))
    start = Orientation.by_angles("x", [1.2])
    body = system.add(RigidBody("rod", rod, orientation=start, points={"imu": (0.0, 0.0, -place)}))
    system.add(RevoluteJoint("pin", system.ground.point((0.0, 0.0, 0.0)), body.point("origin"), axis=(1.0, 0.0, 0.0)))
    system.add(InertialSensor("imu", body.point("imu")))
    motion = mb.simulate(system, 1.0, EXACT, times=np.linspace(0.0, 1.0, 21))
    angle, rate = motion.channels(["pin.angle", "pin.rate"]).T
    read = motion.channels(SIX)
    expected = 9.81 * np.sin(angle) * (1 - place / length)
    np.testing.assert_allclose(read[:, 1], expected, atol=1e-9)
    np.testing.assert_allclose(read[:, 2], place * rate**2 + 9.81 * np.cos(angle), atol=1e-9)
    np.testing.assert_allclose(read[:, 3], rate, atol=1e-9)
    np.testing.assert_allclose(read[:, [0, 4, 5]], 0.0, atol=1e-9)
    assert np.abs(rate).max() > 2.0
    # energy gives the rate: (I + m c^2) rate^2 / 2 = m g c (cos(angle) - cos(start))
    np.testing.assert_allclose(rate**2, 2 * 9.81 / length * (np.cos(angle) - np.cos(1.2)), atol=1e-8)


def test_gains_and_biases() -> None:
    gain = np.array([[1.1, 0.02, -0.03], [0.01, 0.95, 0.04], [-0.05, 0.03, 1.2]])
    bias = np.array([0.1, -0.2, 0.3])
    plain = mb.simulate(wheel(3.0), 0.3).channels(SIX)
    full = wheel(
        3.0, acceleration_gain=gain, acceleration_bias=tuple(bias), rate_gain=(1.1, 0.9, 1.3), rate_bias=(0.2, 0.1, 0.0)
    )
    read = mb.simulate(full, 0.3).channels(SIX)
    np.testing.assert_allclose(read[:, :3], plain[:, :3] @ gain.T + bias, rtol=1e-12)
    np.testing.assert_allclose(read[:, 3:], plain[:, 3:] * (1.1, 0.9, 1.3) + (0.2, 0.1, 0.0), rtol=1e-12)


def test_a_sensor_does_not_change_the_motion() -> None:
    system = wheel(3.0)
    channels = ["wheel.imu.x", "wheel.imu.ay"]
    with_sensor = mb.simulate(system, 0.3, mb.GeneralizedAlpha(1e-3)).channels(channels)
    system.loads.clear()
    np.testing.assert_array_equal(with_sensor, mb.simulate(system, 0.3, mb.GeneralizedAlpha(1e-3)).channels(channels))


NUMBERS = {
    "place": (0.3, 0.1, 0.2), "angles": (0.4, -0.3, 0.7), "acceleration_bias": (0.1, -0.2, 0.3),
    "acceleration_gain": (1.1, 0.9, 1.2), "rate_bias": (0.02, -0.01, 0.03), "rate_gain": (1.05, 0.95, 1.1),
}  # fmt: skip
SOLVERS = [
    mb.GeneralizedAlpha(5e-3, newton_tolerance=1e-18),
    *(pytest.param(own, marks=pytest.mark.slow) for own in (mb.EnergyMomentum(5e-3), mb.RungeKutta4(5e-3))),
]


def tumbling(place, angles, **sensor) -> SpatialSystem:
    """A body that swings and turns in all directions about a point."""
    system = SpatialSystem()
    inertia = Inertia(2.0, (0.02, 0.03, 0.04), centre=(0.1, 0.0, -0.2))
    imu = Pose(place, Orientation.by_angles("zyx", angles))
    body = system.add(RigidBody("body", inertia, points={"imu": imu}, angular_velocity=(4.0, -3.0, 5.0)))
    system.add(SphericalJoint("ball", system.ground, body.point("origin")))
    system.add(InertialSensor("imu", body.point("imu"), **sensor))
    return system


@pytest.mark.parametrize("solver", SOLVERS, ids=lambda own: type(own).__name__)
def test_numbers_are_identifiable(solver) -> None:
    """Biases, gains and pose have exact sensitivities, and change the signals independently of each other."""
    names = [f"{name}_{axis}" for name in NUMBERS for axis in "xyz"]
    point = np.concatenate([*NUMBERS.values()])

    def build(**own) -> SpatialSystem:
        return tumbling(**{name: tuple(own[f"{name}_{axis}"] for axis in "xyz") for name in NUMBERS})

    times = np.linspace(0.0, 0.5, 11)
    model = mb.TimeResponse(build, dict.fromkeys(names, (-2.0, 2.0)), SIX, times, solver)
    jacobian = model.jacobian(point)
    h = 1e-3
    steps = h * np.eye(len(point))
    far, near, back, behind = (
        model.evaluate(np.concatenate([point + k * steps for k in (2, 1, -1, -2)]))
        .only()
        .reshape(4, len(point), len(times), 6)
    )
    slopes = (8 * (near - back) - (far - behind)) / (12 * h)
    np.testing.assert_allclose(np.moveaxis(jacobian, -1, 0), slopes, atol=1e-9 * np.abs(slopes).max(), rtol=1e-9)
    singular = np.linalg.svd(jacobian.reshape(-1, len(point)), compute_uv=False)
    assert singular[-1] > 1e-3 * singular[0]


def test_wrong_inputs() -> None:
    system = SpatialSystem()
    mass = system.add(PointMass("mass", 1.0))
    system.add(InertialSensor("imu", mass.point("centre")))
    with refused(
        ModelError,
        snapshot(
            "InertialSensor 'imu': mass.centre has no direction; use the channels ax, ay and az of the point, or a rigid body"
        ),
    ):
        mb.simulate(system, 0.1)
    with refused(
        InputError,
        snapshot("InertialSensor 'imu': rate_gain is (1.0, 2.0); expected three numbers, or a matrix (3, 3)"),
    ):
        InertialSensor("imu", mass.point("centre"), rate_gain=(1.0, 2.0))


FINE = np.linspace(0.0, 1.0, 401)
STAMPS = np.linspace(0.1, 0.95, 60)


def swinging(length: float) -> SpatialSystem:
    """A body on a ball joint, with a sensor off its axes."""
    system = SpatialSystem(gravity=tuple(GRAVITY))
    inertia = Inertia.box(1.0, (0.1, 0.06, 0.3)).moved((0.0, 0.0, -length))
    points = {"imu": Pose((0.1, 0.05, -length), AXES)}
    body = system.add(RigidBody("bob", inertia, points=points, angular_velocity=(3.0, 1.0, 2.0)))
    system.add(SphericalJoint("ball", system.ground, body.point("origin")))
    system.add(InertialSensor("imu", body.point("imu")))
    return system


def test_a_delay_of_all_outputs_is_a_parameter() -> None:
    """Readings and their derivatives by the delay against motions that are sampled at t - delay."""
    model = mb.TimeResponse(swinging, {"length": (0.2, 0.5)}, SIX, FINE, EXACT)
    seen = Sensors(model, {"imu": Sensor(delay=(0.0, 0.05))}, STAMPS)
    assert seen.parameters.names == ("length", "imu delay")

    def exact(delay: float) -> np.ndarray:
        own = mb.TimeResponse(swinging, {"length": (0.2, 0.5)}, SIX, STAMPS - delay, EXACT)
        return own.evaluate([[0.3]]).only()[0]

    values, jacobian = seen.linearise(np.array([0.3, 0.02]))
    size = np.abs(values).max()
    assert np.abs(values - exact(0.02)).max() < 1e-7 * size
    step = 1e-3
    runs = [exact(0.02 + k * step) for k in (-2, -1, 1, 2)]
    differences = (runs[0] - 8 * runs[1] + 8 * runs[2] - runs[3]) / (12 * step)
    assert np.abs(jacobian[:, :, 1] - differences).max() < 1e-6 * np.abs(differences).max()

    noisy = exact(0.02) + 1e-2 * np.random.default_rng(0).standard_normal(values.shape)
    data = Measurements.of(STAMPS, dict(zip(SIX, noisy.T, strict=True)), deviations=1e-2)
    fit = identify(seen, data, start=[0.35, 0.0])
    assert np.all(np.abs(fit.values - [0.3, 0.02]) < 4 * fit.deviations)
    assert fit.deviations[1] < 2e-4
