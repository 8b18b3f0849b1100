"""Gear joints and bushings against closed forms, conservation laws and equations of motion written by hand."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import dalembert as da
from momenta import momenta

TOPIC = "Gears and bushings"
CLOSED = {"topic": TOPIC, "kind": "closed form", "source": "closed form"}
PRECISE = da.RadauIIA(tolerance=1e-11)


def unexplained_energy(system: da.System, end: float, step: float) -> float:
    """Largest energy that neither loads nor dampers explain, relative to the kinetic energy."""
    found = []
    for size in (2 * step, step):
        motion = da.simulate(system, end, solver=da.GeneralizedAlpha(step=size, spectral_radius=1.0))
        found.append(np.abs(motion.energies["balance"]).max() / motion.energies["kinetic"].max())
    assert found[1] < 0.3 * found[0], "the balance must close with the square of the step"
    return found[1]


# -- gears -----------------------------------------------------------------------------------------------------------


def gear_train(ratios, inertias, torque: float) -> da.System:
    """Wheels on the ground, each geared to the next; a torque on the first."""
    system = da.System(gravity=(0.0, 0.0))
    wheels = [
        system.add(da.RigidBody(f"wheel{k}", 1.0, inertia, position=(0.5 * k, 0.0), angle=0.3 * k))
        for k, inertia in enumerate(inertias)
    ]
    for k, wheel in enumerate(wheels):
        system.add(da.RevoluteJoint(f"bearing{k}", system.ground, wheel.centre))
    for k, (a, b) in enumerate(pairwise(wheels)):
        system.add(da.GearJoint(f"gear{k}", a.centre, b.centre, ratios[k]))
    system.add(da.Torque("motor", wheels[0].centre, torque))
    return system


@pytest.mark.parametrize(
    ("name", "ratios", "inertias"),
    [
        ("external gear pair", (-1 / 3,), (0.02, 0.9)),
        ("belt, step up", (2.5,), (0.02, 0.9)),
        ("two stages", (-1 / 3, -0.5), (0.02, 0.3, 0.9)),
    ],
    ids=["external", "belt", "two stages"],
)
def test_a_gear_train_accelerates_with_the_equivalent_inertia(record_evidence, name, ratios, inertias) -> None:
    torque, end = 4.0, 2.0
    speeds = np.cumprod([1.0, *ratios])
    acceleration = torque / (speeds**2 @ inertias)
    motion = da.simulate(gear_train(ratios, inertias, torque), end, solver=PRECISE, times=np.linspace(0.0, end, 21))
    last = len(ratios)
    record_evidence(
        f"{name}, angular acceleration of the driven wheel, τ/Σ Jₖ nₖ²",
        acceleration,
        motion.channels(["wheel0.centre.acceleration"])[-1, 0],
        unit="rad/s²",
        tolerance=1e-12,
        relative=True,
        noisy=True,
        **CLOSED,
    )
    record_evidence(
        f"{name}, angle that the last wheel has turned, over 2 s",
        speeds[last] * acceleration * motion.times**2 / 2,
        motion.channels([f"wheel{last}.centre.angle"])[:, 0] - 0.3 * last,
        unit="rad",
        tolerance=1e-11,
        relative=True,
        noisy=True,
        **CLOSED,
    )
    record_evidence(
        f"{name}, torque of the last gear",
        inertias[last] * speeds[last] * acceleration,
        motion.channels([f"gear{last - 1}.torque"])[-1, 0],
        unit="N m",
        tolerance=1e-12,
        relative=True,
        noisy=True,
        **CLOSED,
    )


def test_sensitivities_of_a_gear_pair(record_evidence) -> None:
    """θ = τ t²/2J* with J* = J₁ + r² J₂, so that its derivatives are -τ t²/2J*² times those of J*."""
    ratio, first, second, torque = -0.4, 0.02, 0.9, 4.0
    times = np.linspace(0.0, 2.0, 21)
    model = da.TimeResponse(
        lambda ratio, first, second: gear_train((ratio,), (first, second), torque),
        {"ratio": (-1.0, -0.1), "first": (0.01, 0.1), "second": (0.1, 2.0)},
        ["wheel0.centre.angle"],
        times,
        solver=PRECISE,
    )
    _, jacobian = model.linearise(np.array([ratio, first, second]))
    slope = -torque * times**2 / 2 / (first + ratio**2 * second) ** 2
    for column, (name, own) in enumerate(
        {
            "gear ratio": 2 * ratio * second,
            "inertia of the driver": 1.0,
            "inertia of the driven wheel": ratio**2,
        }.items()
    ):
        record_evidence(
            f"external gear pair, derivative of the driver's angle by the {name}",
            slope * own,
            jacobian[:, 0, column],
            tolerance=1e-11,
            relative=True,
            noisy=True,
            **CLOSED,
        )


# -- bushings --------------------------------------------------------------------------------------------------------

MASS, INERTIA = 2.0, 0.05
STIFFNESS, DAMPING = np.array([800.0, 1800.0, 30.0]), np.array([4.0, 9.0, 0.06])  # along x and y, in torsion


def mounted(
    stiffness=STIFFNESS,
    damping=DAMPING,
    point: tuple[float, float] = (0.0, 0.0),
    velocity=(0.0, 0.0),
    spin: float = 0.0,
) -> da.System:
    """A rigid body on a bushing that holds a point of it."""
    system = da.System(gravity=(0.0, 0.0))
    motion = {"velocity": velocity, "angular_velocity": spin}
    block = system.add(da.RigidBody("block", MASS, INERTIA, points={"grip": point}, **motion))
    system.add(da.Bushing("mount", system.ground.point(*point), block.point("grip"), *stiffness, *damping))
    return system


def test_frequencies_of_a_body_held_at_its_centre(record_evidence) -> None:
    natural = np.sqrt(STIFFNESS / [MASS, MASS, INERTIA])
    ratios = DAMPING / [MASS, MASS, INERTIA] / natural / 2
    found = da.modes(mounted())
    order = np.argsort(natural * np.sqrt(1 - ratios**2))
    common = {"tolerance": 1e-11, "relative": True, "noisy": True, **CLOSED}
    record_evidence(
        "body on a bushing at its centre, damped frequencies",
        (natural * np.sqrt(1 - ratios**2) / (2 * np.pi))[order],
        found.frequencies,
        unit="Hz",
        **common,
    )
    record_evidence("body on a bushing at its centre, damping ratios", ratios[order], found.damping_ratios, **common)


def test_frequencies_of_a_body_held_below_its_centre(record_evidence) -> None:
    """Sway and rocking: (kx - m ω²)(kφ + kx h² - J ω²) = (kx h)²; y is not coupled."""
    height = 0.3
    kx, ky, turning = STIFFNESS
    half = (kx / MASS + (turning + kx * height**2) / INERTIA) / 2
    root = np.sqrt(half**2 - kx * turning / (MASS * INERTIA))
    squares = np.sort([half - root, half + root, ky / MASS])
    record_evidence(
        "body on a bushing 0.3 m below its centre, sway and rocking coupled, natural frequencies",
        np.sqrt(squares) / (2 * np.pi),
        da.modes(mounted(damping=np.zeros(3), point=(0.0, -height))).frequencies,
        unit="Hz",
        tolerance=1e-11,
        relative=True,
        noisy=True,
        **CLOSED,
    )


def test_roots_of_a_damped_body_held_anywhere(record_evidence) -> None:
    """All three motions coupled: the grip moves by G = [1 0 -b; 0 1 a; 0 0 1] times (x, y, φ)."""
    a, b = 0.2, -0.3
    grip = np.array([[1.0, 0.0, -b], [0.0, 1.0, a], [0.0, 0.0, 1.0]])
    stiffness, damping = (grip.T @ np.diag(law) @ grip for law in (STIFFNESS, DAMPING))
    inverse = np.diag(1 / np.array([MASS, MASS, INERTIA]))
    roots = np.linalg.eigvals(np.block([[np.zeros((3, 3)), np.eye(3)], [-inverse @ stiffness, -inverse @ damping]]))
    roots = roots[roots.imag > 0][np.argsort(roots.imag[roots.imag > 0])]
    found = da.modes(mounted(point=(a, b)))
    angular = 2 * np.pi * found.frequencies / np.sqrt(1 - found.damping_ratios**2)
    for part, expected, ours in (
        ("real", roots.real, -found.damping_ratios * angular),
        ("imaginary", roots.imag, 2 * np.pi * found.frequencies),
    ):
        record_evidence(
            f"damped body on a bushing off its centre, {part} parts of the characteristic roots",
            expected,
            ours,
            unit="1/s",
            tolerance=1e-10,
            relative=True,
            noisy=True,
            topic=TOPIC,
            kind="closed form",
            source="eigenvalues of the linear equations, written by hand",
        )


def free_vibration(times, inertia, stiffness, damping, velocity):
    """Displacement from rest at zero with a velocity, and its derivatives by stiffness and by damping."""
    decay = damping / (2 * inertia)
    omega = np.sqrt(stiffness / inertia - decay**2)
    sine, cosine = (velocity * np.exp(-decay * times) * wave(omega * times) for wave in (np.sin, np.cos))
    by_omega = (times * cosine - sine / omega) / omega
    by_stiffness = by_omega / (2 * inertia * omega)
    by_damping = (-times * sine / omega - decay / omega * by_omega) / (2 * inertia)
    return sine / omega, by_stiffness, by_damping


def test_free_vibration_and_its_sensitivities(record_evidence) -> None:
    """A push and a turn at once: at the centre the three motions are not coupled."""
    axes, units, velocities = ("x", "y", "angle"), ("m", "m", "rad"), (0.5, -0.3, 2.0)
    names = [f"{law}_{axis}" for law in ("stiffness", "damping") for axis in axes]
    truth = np.concatenate([STIFFNESS, DAMPING])
    times = np.linspace(0.0, 2.0, 201)

    def build(**laws) -> da.System:
        values = [laws[name] for name in names]
        return mounted(values[:3], values[3:], velocity=velocities[:2], spin=velocities[2])

    model = da.TimeResponse(
        build,
        {name: (value / 2, value * 2) for name, value in zip(names, truth, strict=True)},
        [f"block.centre.{axis}" for axis in axes],
        times,
        solver=PRECISE,
    )
    response, jacobian = model.linearise(truth)
    laws = zip(axes, units, (MASS, MASS, INERTIA), STIFFNESS, DAMPING, velocities, strict=True)
    for k, (axis, unit, *law) in enumerate(laws):
        expected = free_vibration(times, *law)
        what = f"body on a bushing, free damped vibration, {axis}"
        common = {"tolerance": 1e-10, "relative": True, "noisy": True, **CLOSED}
        record_evidence(what, expected[0], response[:, k], unit=unit, **common)
        record_evidence(f"{what}: derivative by its stiffness", expected[1], jacobian[:, k, k], **common)
        record_evidence(f"{what}: derivative by its damping", expected[2], jacobian[:, k, 3 + k], **common)


def floating() -> da.System:
    """Two free bodies, held together by a damped bushing at points off their centres; they turn and move away."""
    system = da.System(gravity=(0.0, 0.0))
    first = system.add(
        da.RigidBody("first", 2.0, 0.1, points={"grip": (0.3, 0.1)}, velocity=(1.0, 0.5), angular_velocity=3.0)
    )
    second = system.add(
        da.RigidBody(
            "second", 1.0, 0.05, position=first.point("grip"), anchor="grip", points={"grip": (-0.2, 0.1)}, angle=0.6,
            velocity=(-1.0, 0.0), angular_velocity=-4.0,
        )
    )  # fmt: skip
    system.add(da.Bushing("rubber", first.point("grip"), second.point("grip"), 200.0, 500.0, 8.0, 2.0, 1.0, 0.05))
    return system


def test_a_bushing_between_free_bodies_keeps_their_momenta(record_evidence) -> None:
    motion = da.simulate(floating(), 3.0, solver=PRECISE, times=np.linspace(0.0, 3.0, 301))
    stretch = motion.channels(["rubber.x", "rubber.y", "rubber.angle"])
    assert (np.abs(stretch).max(axis=0) > [0.05, 0.02, 0.5]).all(), "the bushing must have a lever"
    values = momenta(motion)
    for column, (name, unit) in enumerate({"along x": "N s", "along y": "N s", "about the origin": "N m s"}.items()):
        record_evidence(
            f"two free bodies on a damped bushing, momentum {name}",
            np.full(len(values), values[0, column]),
            values[:, column],
            unit=unit,
            tolerance=1e-10,
            noisy=True,
            topic=TOPIC,
            kind="conservation law",
            source="conservation law",
        )
    record_evidence(
        "two free bodies on a damped bushing: unexplained energy, relative to the kinetic energy (h = 0.5 ms)",
        0.0,
        unexplained_energy(floating(), 3.0, 5e-4),
        tolerance=1e-4,
        topic=TOPIC,
        kind="conservation law",
        source="conservation law",
    )


# -- both: an unbalanced rotor on a bushing, turned through a gear -----------------------------------------------------

ROTOR = {"ratio": -0.3, "inertia": 0.05, "eccentricity": 1e-3, "kx": 2e4, "ky": 3e4, "c": 40.0}
ROTOR_MASS, MOTOR_INERTIA = 5.0, 0.002


def geared_rotor(ratio, inertia, eccentricity, kx, ky, c, speed: float = 0.0) -> da.System:
    """The rotor of studies/geared-rotor, without a torque on its motor, at a first speed of the motor."""
    system = da.System(gravity=(0.0, 0.0))
    motor = system.add(da.RigidBody("motor", 0.5, MOTOR_INERTIA, angular_velocity=speed))
    rotor = system.add(
        da.RigidBody(
            "rotor", ROTOR_MASS, inertia, anchor="shaft", points={"shaft": (-eccentricity, 0.0)},
            angular_velocity=ratio * speed,
        )
    )  # fmt: skip
    system.add(da.RevoluteJoint("bearing", system.ground, motor.centre))
    system.add(da.GearJoint("gearbox", motor.centre, rotor.point("shaft"), ratio))
    system.add(da.Bushing("mount", system.ground, rotor.point("shaft"), kx, ky, damping_x=c, damping_y=c))
    return system


def run_up(times: np.ndarray, torque: float, ratio, inertia, eccentricity, kx, ky, c) -> np.ndarray:
    """Displacements x and y of the shaft and angle of the motor, by Lagrange's equations in these three coordinates."""
    imbalance = ROTOR_MASS * eccentricity
    turning = MOTOR_INERTIA + ratio**2 * (inertia + imbalance * eccentricity)

    def rates(_, state):
        x, y, angle, u, v, speed = state
        s, c_ = np.sin(ratio * angle), np.cos(ratio * angle)
        across, along = -imbalance * ratio * s, imbalance * ratio * c_
        inertias = [[ROTOR_MASS, 0.0, across], [0.0, ROTOR_MASS, along], [across, along, turning]]
        pull = imbalance * (ratio * speed) ** 2
        forces = [pull * c_ - kx * x - c * u, pull * s - ky * y - c * v, torque]
        return [u, v, speed, *np.linalg.solve(inertias, forces)]

    options = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-14, "t_eval": times}
    return solve_ivp(rates, (0.0, times[-1]), np.zeros(6), **options).y[:3].T


def test_a_geared_rotor_runs_up_through_its_critical_speeds(record_evidence) -> None:
    times = np.linspace(0.0, 2.0, 201)
    system = geared_rotor(**ROTOR)
    system.add(da.Torque("drive", system.bodies[0].centre, 1.0))
    motion = da.simulate(system, 2.0, solver=PRECISE, times=times)
    expected, ours = run_up(times, 1.0, **ROTOR), motion.channels(["mount.x", "mount.y", "motor.centre.angle"])
    for column, (name, unit) in enumerate(
        {"x of the shaft": "m", "y of the shaft": "m", "motor's angle": "rad"}.items()
    ):
        record_evidence(
            f"unbalanced rotor, geared to a motor, run up on a bushing: {name}",
            expected[:, column],
            ours[:, column],
            unit=unit,
            tolerance=1e-10,
            relative=True,
            noisy=True,
            topic=TOPIC,
            kind="other code",
            source="equations of motion in displacements and motor angle, integrated by SciPy to 1e-12",
        )
    record_evidence(
        "unbalanced rotor, geared to a motor, run up on a bushing: unexplained energy, relative to the kinetic "
        "energy (h = 0.2 ms)",
        0.0,
        unexplained_energy(system, 2.0, 2e-4),
        tolerance=1e-5,
        topic=TOPIC,
        kind="conservation law",
        source="conservation law",
    )


def test_a_geared_rotor_whirls_at_constant_speed(record_evidence) -> None:
    """Whirl of the shaft, m e ω² exp(iωt)/(k - m ω² + i c ω) in each direction, and the torque that it costs."""
    speed, c, e = -250.0, 200.0, ROTOR["eccentricity"]
    system = geared_rotor(**ROTOR | {"c": c}, speed=speed)
    motor = system.bodies[0].centre
    system.add(da.PrescribedMotion("drive", system.ground, motor, "angle", da.signals.Polynomial([0.0, speed])))
    omega = ROTOR["ratio"] * speed
    times = 2.0 + np.arange(40) / 40 * 2 * np.pi / omega  # what is free has decayed by exp(-c t/2m) = 4e-18
    motion = da.simulate(system, times[-1], solver=PRECISE, times=np.array([0.0, *times]))
    x, y, torque = motion.channels(["mount.x", "mount.y", "drive.torque"])[1:].T
    whirl = ROTOR_MASS * e * omega**2 * np.exp(1j * omega * times)
    stiffness = np.array([ROTOR["kx"], ROTOR["ky"]])
    answer = 1 / (stiffness - ROTOR_MASS * omega**2 + 1j * c * omega)
    common = {"tolerance": 1e-10, "relative": True, "noisy": True, **CLOSED}
    name = "unbalanced rotor on a bushing, geared to a motor of constant speed"
    record_evidence(f"{name}: whirl along x", (answer[0] * whirl).real, x, unit="m", **common)
    record_evidence(f"{name}: whirl along y", (answer[1] * whirl).imag, y, unit="m", **common)
    lost = c * omega**2 * (np.abs(answer * np.abs(whirl[0])) ** 2).sum() / 2  # mean power of the dampers
    record_evidence(f"{name}: mean torque of the motor", lost / speed, torque.mean(), unit="N m", **common)
