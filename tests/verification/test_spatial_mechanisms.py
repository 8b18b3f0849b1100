"""Rigid mechanisms in space against closed forms, published values and independent integrations."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import ellipj

from conclusions import only
from dalembert.multibody import EnergyMomentum, GeneralizedAlpha, RadauIIA, RungeKutta4, Variational, simulate
from dalembert.multibody.spatial import (
    DistanceJoint,
    Inertia,
    Orientation,
    PointMass,
    PrismaticJoint,
    RevoluteJoint,
    RigidBody,
    SpatialSystem,
    SphericalJoint,
    Spring,
)

TOPIC = "Mechanisms in space"
EXACT = RadauIIA(tolerance=1e-11)


def heavy_top(spin: float = 150.0) -> SpatialSystem:
    """The box-like heavy top of the benchmarks of Geradin and Cardona."""
    system = SpatialSystem()
    inertia = Inertia(15.0, (0.234375, 0.46875, 0.234375), centre=(0.0, 1.0, 0.0))
    top = system.add(RigidBody("top", inertia, angular_velocity=(0.0, spin, -4.61538)))
    system.add(SphericalJoint("ball", system.ground, top.point("origin")))
    return system


@pytest.mark.parametrize(
    ("time", "position"),
    [(0.2, (0.60555056, 0.59895768, -0.52398303)), (1.0, (0.17334396, 0.64008859, -0.74849079))],
)
def test_heavy_top(time, position, record_evidence):
    """Position of the centre of mass, against an integration by Euler parameters and Exudyn's RK4."""
    motion = simulate(heavy_top(), time, EXACT, times=np.array([0.0, time]))
    record_evidence(
        f"Heavy top, centre of mass at {time} s",
        np.array(position),
        motion.channels([f"top.centre.{axis}" for axis in "xyz"])[-1],
        unit="m",
        tolerance=2e-8,
        topic=TOPIC,
        kind="other code",
        source="Euler parameters with tight tolerances; Exudyn's RK4",
    )


def test_free_rigid_body(record_evidence):
    """Angular velocity of a free body: Jacobi's elliptic functions (Landau and Lifshitz, Mechanics, section 37)."""
    moments = first, second, third = 1.0, 2.0, 2.6
    start = np.array([0.7, 0.2, 1.1])
    system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    system.add(RigidBody("body", Inertia(1.0, moments), angular_velocity=tuple(start)))
    times = np.linspace(0.0, 12.0, 25)
    motion = simulate(system, 12.0, EXACT, times=times)
    vectors = motion.channels([f"body.origin.w{axis}" for axis in "xyz"])
    angles = motion.channels([f"body.origin.rotation_{axis}" for axis in "xyz"])
    turned = [Orientation.by_rotation_vector(row).matrix.T @ own for row, own in zip(angles, vectors, strict=True)]
    energy2, momentum2 = np.sum(moments * start**2), np.sum((moments * start) ** 2)
    assert momentum2 > energy2 * second
    rate = np.sqrt((third - second) * (momentum2 - energy2 * first) / (first * second * third))
    modulus = (second - first) * (energy2 * third - momentum2) / ((third - second) * (momentum2 - energy2 * first))
    sizes = np.sqrt(
        [
            (energy2 * third - momentum2) / (first * (third - first)),
            (energy2 * third - momentum2) / (second * (third - second)),
            (momentum2 - energy2 * first) / (third * (third - first)),
        ]
    )
    phase = brentq(lambda u: sizes[1] * ellipj(u, modulus)[0] - start[1], -1.0, 1.0, xtol=1e-15)

    def exact(t):
        sn, cn, dn, _ = ellipj(rate * t + phase, modulus)
        return sizes[0] * cn, sizes[1] * sn, sizes[2] * dn

    expected = np.array([exact(t) for t in times])
    assert np.allclose(expected[0], start)
    record_evidence(
        "Free rigid body, angular velocity in its axes during 12 s (largest difference)",
        0.0,
        float(np.abs(np.array(turned) - expected).max()),
        unit="rad/s",
        tolerance=1e-9,
        topic=TOPIC,
        kind="closed form",
        source="Landau and Lifshitz, Mechanics, section 37",
    )


def test_regular_precession(record_evidence):
    """A symmetric top that precesses steadily: roots of J1 W^2 cos(t) - J3 w3 W + m g l = 0 (Goldstein, 5.7)."""
    mass, length, axial, across, spin, tilt = 2.0, 0.3, 0.02, 0.05, 120.0, 0.6
    about = across + mass * length**2  # about the fixed point
    # axial angular momentum J3 w3 with w3 = spin + W cos(t); both roots of the quadratic in W
    slow, fast = np.sort(np.roots([(about - axial) * np.cos(tilt), -axial * spin, mass * 9.81 * length]).real)
    for name, rate in (("slow", slow), ("fast", fast)):
        system = SpatialSystem()
        inertia = Inertia(mass, (across, across, axial), centre=(0.0, 0.0, length))
        axes = Orientation.by_angles("y", [tilt])
        velocity = np.array([0.0, 0.0, rate]) + spin * axes.matrix[:, 2]
        top = system.add(RigidBody("top", inertia, orientation=axes, angular_velocity=tuple(velocity)))
        system.add(SphericalJoint("ball", system.ground, top.point("origin")))
        end = np.pi / 3 / rate
        motion = simulate(system, end, EXACT, times=np.array([0.0, end]))
        x, y, z = motion.channels([f"top.centre.{axis}" for axis in "xyz"])[-1]
        record_evidence(
            f"Symmetric top, {name} regular precession: azimuth after 60 degrees",
            np.pi / 3,
            float(np.arctan2(y, x)),
            unit="rad",
            tolerance=1e-9,
            topic=TOPIC,
            kind="closed form",
            source="Goldstein, Classical Mechanics, 5.7",
        )
        assert abs(z - length * np.cos(tilt)) < 1e-9


def test_conical_pendulum(record_evidence):
    """Spherical pendulum on a cone: period 2 pi sqrt(L cos(t) / g)."""
    length, tilt = 1.3, 0.7
    rate = np.sqrt(9.81 / (length * np.cos(tilt)))
    system = SpatialSystem()
    place = (length * np.sin(tilt), 0.0, -length * np.cos(tilt))
    bob = system.add(PointMass("bob", 2.0, position=place, velocity=(0.0, rate * length * np.sin(tilt), 0.0)))
    system.add(DistanceJoint("rod", system.ground.point((0.0, 0.0, 0.0)), bob.point("centre")))
    period = 2 * np.pi * np.sqrt(length * np.cos(tilt) / 9.81)
    motion = simulate(system, period, EXACT, times=np.array([0.0, period]))
    gap = np.abs(motion.channels([f"bob.centre.{axis}" for axis in "xyz"])[-1] - place).max()
    record_evidence(
        "Conical pendulum: distance from the start after one period",
        0.0,
        float(gap),
        unit="m",
        tolerance=1e-9,
        topic=TOPIC,
        kind="closed form",
        source="period 2π √(L cos θ/g)",
    )


def test_bifilar_pendulum(record_evidence):
    """A bar on two wires: small rotations about the vertical have the period 2 pi sqrt(J L / (m g a^2))."""
    mass, length, arm, moment = 1.5, 0.8, 0.25, 0.06
    system = SpatialSystem()
    inertia = Inertia(mass, (0.01, moment, moment))
    turn = 1e-4
    bar = RigidBody(
        "bar",
        inertia,
        position=(0.0, 0.0, -length),
        orientation=Orientation.by_angles("z", [turn]),
        points={"left": (-arm, 0.0, 0.0), "right": (arm, 0.0, 0.0)},
    )
    system.add(bar)
    for name, side in (("left", -arm), ("right", arm)):
        system.add(DistanceJoint(f"wire {name}", system.ground.point((side, 0.0, 0.0)), bar.point(name), length=length))
    period = 2 * np.pi * np.sqrt(moment * length / (mass * 9.81 * arm**2))
    motion = simulate(system, period / 4, EXACT, times=np.linspace(0.0, period / 4, 5))
    yaw = motion.channels(["bar.origin.yaw"])[:, 0]
    record_evidence(
        "Bifilar pendulum, small rotation: angle over the first one after an eighth of the period",
        float(np.cos(np.pi / 4)),
        float(yaw[2] / yaw[0]),
        tolerance=1e-6,
        topic=TOPIC,
        kind="closed form",
        source="period 2π √(J L/(m g a²))",
    )


CRANK, ROD, OFFSET = 0.08, 0.3, np.array([0.0, 0.1, 0.12])
CRANK_MOMENT, ROD_MASS, SLIDER_MASS = 1e-3, 0.5, 2.0


def slider_crank(rate: float) -> SpatialSystem:
    """A crank that turns about x at (0, 0.1, 0.12), a slider along x, and a slender rod between ball joints."""
    system = SpatialSystem()
    pin = tuple(OFFSET)
    crank = system.add(
        RigidBody(
            "crank",
            Inertia(0.12, (CRANK_MOMENT, CRANK_MOMENT, CRANK_MOMENT)),
            position=pin,
            points={"end": (0.0, 0.0, CRANK)},
            angular_velocity=(rate, 0.0, 0.0),
        )
    )
    system.add(RevoluteJoint("bearing", system.ground.point(pin), crank.point("origin"), axis=(1.0, 0.0, 0.0)))
    end = OFFSET + np.array([0.0, 0.0, CRANK])
    slider_x = np.sqrt(ROD**2 - end[1] ** 2 - end[2] ** 2)
    along = Orientation.by_axes(np.array([slider_x, 0.0, 0.0]) - end)
    across = ROD_MASS * ROD**2 / 12
    rod = system.add(
        RigidBody(
            "rod",
            Inertia(ROD_MASS, (across, across, 1e-6), centre=(0.0, 0.0, ROD / 2)),
            position=tuple(end),
            orientation=along,
            points={"end": (0.0, 0.0, ROD)},
        )
    )
    slider = system.add(
        RigidBody("slider", Inertia.box(SLIDER_MASS, (0.05, 0.05, 0.05)), position=(slider_x, 0.0, 0.0))
    )
    system.add(
        PrismaticJoint("slide", system.ground.point((0.0, 0.0, 0.0)), slider.point("origin"), axis=(1.0, 0.0, 0.0))
    )
    system.add(SphericalJoint("crank pin", crank.point("end"), rod.point("origin")))
    system.add(SphericalJoint("slider pin", rod.point("end"), slider.point("origin")))
    return system


def crank_coefficients(angle):
    """Inertia A and potential V of the mechanism with T = A rate^2 / 2, for a complex angle too.

    A slender rod with the end velocities a and b has T = m (a^2 + a b + b^2) / 6, whatever its spin.
    """
    s, c = np.sin(angle), np.cos(angle)
    y, z = OFFSET[1] - CRANK * s, OFFSET[2] + CRANK * c
    y_rate, z_rate = -CRANK * c, -CRANK * s
    x = np.sqrt(ROD**2 - y * y - z * z)
    x_rate = -(y * y_rate + z * z_rate) / x
    ends = y_rate**2 + z_rate**2 + x_rate**2  # the velocities of the ends are perpendicular
    inertia = CRANK_MOMENT + ROD_MASS * ends / 3 + SLIDER_MASS * x_rate**2
    return inertia, ROD_MASS * 9.81 * z / 2


def test_spatial_slider_crank(record_evidence):
    """Crank angle against an integration in one coordinate (Haug 1989 has the mechanism)."""
    rate, end = 6.0, 1.0

    def motion(t, state):
        inertia, _ = crank_coefficients(state[0])
        step = 1e-30
        slope, force = (np.imag(value) / step for value in crank_coefficients(state[0] + 1j * step))
        return state[1], -(0.5 * slope * state[1] ** 2 + force) / inertia

    independent = solve_ivp(motion, (0.0, end), (0.0, rate), method="DOP853", rtol=1e-12, atol=1e-12)
    ours = simulate(slider_crank(rate), end, EXACT, times=np.array([0.0, 0.5, end]))
    record_evidence(
        "Spatial slider-crank, crank angle after 1 s",
        float((independent.y[0, -1] + np.pi) % (2 * np.pi) - np.pi),
        float((ours.channels(["bearing.angle"])[-1, 0] + np.pi) % (2 * np.pi) - np.pi),
        unit="rad",
        tolerance=1e-8,
        topic=TOPIC,
        kind="other method",
        source="minimal coordinate, SciPy's DOP853; mechanism after Haug (1989)",
    )
    assert np.abs(ours.energies["balance"]).max() < 1e-8


ORDERS = [
    (GeneralizedAlpha(step=1.0, spectral_radius=0.9), 2, 4e-3),
    (Variational(step=1.0), 2, 4e-3),
    (EnergyMomentum(step=1.0), 2, 4e-3),
    (RungeKutta4(step=1.0), 4, 8e-3),
]


def double_pendulum() -> SpatialSystem:
    """Two bodies, a spherical and a skew revolute joint."""
    system = SpatialSystem()
    rod = Inertia.box(1.0, (0.05, 0.08, 1.0)).moved((0.0, 0.0, -0.5))
    upper = system.add(
        RigidBody(
            "upper",
            rod,
            points={"end": (0.0, 0.0, -1.0)},
            orientation=Orientation.by_angles("xy", [0.5, 0.3]),
            angular_velocity=(1.0, 0.2, 0.0),
        )
    )
    lower = system.add(RigidBody("lower", rod, position=upper.point("end")))
    system.add(SphericalJoint("ball", system.ground, upper.point("origin")))
    system.add(RevoluteJoint("pin", upper.point("end"), lower.point("origin"), axis=(1.0, 0.2, 0.1)))
    return system


@pytest.mark.parametrize(("solver", "order", "step"), ORDERS, ids=lambda value: type(value).__name__)
def test_orders_in_space(solver, order, step, record_evidence):
    """Convergence of the position of a spatial double pendulum after 0.8 s."""
    times = np.array([0.0, 0.8])
    names = [f"lower.centre.{axis}" for axis in "xyz"]
    exact = simulate(double_pendulum(), 0.8, EXACT, times=times).channels(names)[-1]
    errors = []
    for factor in (1.0, 0.5, 0.25):
        motion = simulate(double_pendulum(), 0.8, replace(solver, step=step * factor), times=times)
        errors.append(np.linalg.norm(motion.channels(names)[-1] - exact))
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    record_evidence(
        f"{type(solver).__name__}, spatial double pendulum: order of convergence",
        float(order),
        float(rates[-1]),
        tolerance=0.15,
        topic=TOPIC,
        kind="closed form",
        source="order of the method",
    )


BRICARD = np.array([(0, 0, 0), (1, 0, 0), (1, -1, 0), (1, -1, 1), (0, -1, 1), (0, 0, 1)], dtype=float)
AXES = ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)) * 2


def bricard() -> SpatialSystem:
    """Five rods along edges of a cube, the ground as the sixth link, and six revolute joints (IFToMM library, A04)."""
    system = SpatialSystem(gravity=(0.0, -9.81, 0.0))
    last = system.ground.point(tuple(BRICARD[0]))
    for number in range(5):
        edge = BRICARD[number + 1] - BRICARD[number]
        moments = tuple((1.0 - np.abs(edge)) / 12 + 1e-5)
        rod = RigidBody(
            f"rod {number + 1}",
            Inertia(1.0, moments, centre=tuple(edge / 2)),
            position=tuple(BRICARD[number]),
            points={"end": tuple(edge)},
        )
        system.add(rod)
        system.add(RevoluteJoint(f"joint {number + 1}", last, rod.point("origin"), axis=AXES[number]))
        last = rod.point("end")
    system.add(RevoluteJoint("joint 6", last, system.ground.point(tuple(BRICARD[5])), axis=AXES[5]))
    return system


@pytest.mark.slow
def test_bricard_mechanism(record_evidence):
    """A mechanism that moves although its constraints say that it cannot: energy and rank (IFToMM library, A04)."""
    motion = simulate(bricard(), 2.0, RungeKutta4(step=1e-3), times=np.linspace(0.0, 2.0, 21))
    energies = motion.energies
    record_evidence(
        "Bricard mechanism, change of the energy over the range of the kinetic energy in 2 s",
        0.0,
        float(np.abs(energies["balance"]).max() / np.ptp(energies["kinetic"])),
        tolerance=1e-7,
        topic=TOPIC,
        kind="conservation law",
        source="energy; mechanism of the IFToMM library, A04",
    )
    found = only(motion, "redundant-constraints")
    record_evidence(
        "Bricard mechanism, independent constraints of its six revolute joints",
        29,
        found.values["independent"],
        tolerance=0,
        topic=TOPIC,
        kind="published",
        source="IFToMM library, A04: one degree of freedom",
    )
    assert np.ptp(energies["kinetic"]) > 4.0


ARM, BALL, ARM_MOMENT, ARM_AXIAL, SPINDLE = 0.5, 1.2, 0.35, 0.004, 0.08
COLLAR_SPRING, HEIGHT = 400.0, 0.3


def governor(speed: float) -> SpatialSystem:
    """A spindle about z and two arms that are hinged to it, each held by a spring to a point of the spindle below."""
    system = SpatialSystem()
    spindle = system.add(
        RigidBody(
            "spindle",
            Inertia(1.0, (SPINDLE, SPINDLE, SPINDLE)),
            points={"seat": (0.0, 0.0, -HEIGHT)},
            angular_velocity=(0.0, 0.0, speed),
        )
    )
    system.add(RevoluteJoint("bearing", system.ground, spindle.point("origin")))
    central = ARM_MOMENT - BALL * ARM**2
    for name, side in (("left", -1.0), ("right", 1.0)):
        tilt = Orientation.by_angles("y", [-side * 0.4])  # the arm hangs along -z of its axes
        arm = system.add(
            RigidBody(
                f"{name} arm",
                Inertia(BALL, (central, central, ARM_AXIAL), centre=(0.0, 0.0, -ARM)),
                orientation=tilt,
                points={"middle": (0.0, 0.0, -ARM / 2)},
                angular_velocity=(0.0, 0.0, speed),
            )
        )
        system.add(RevoluteJoint(f"{name} hinge", spindle.point("origin"), arm.point("origin"), axis=(0.0, 1.0, 0.0)))
        system.add(Spring(f"{name} spring", spindle.point("seat"), arm.point("middle"), COLLAR_SPRING, free_length=0.1))
    return system


def test_flyball_governor(record_evidence):
    """Angle of the arms against an integration of two coordinates (IFToMM library, A05, has such a mechanism)."""
    speed, end = 7.0, 1.0
    lever = ARM / 2

    def lagrangian(tilt):
        """Inertia about the spindle's axis and potential energy."""
        s, c = np.sin(tilt), np.cos(tilt)
        inertia = SPINDLE + 2 * (ARM_MOMENT * s * s + ARM_AXIAL * c * c)
        stretch = np.sqrt((lever * s) ** 2 + (HEIGHT - lever * c) ** 2) - 0.1
        return inertia, -2 * BALL * 9.81 * ARM * c + COLLAR_SPRING * stretch**2

    momentum = lagrangian(0.4)[0] * speed

    def motion(t, state):
        step = 1e-30
        inertia, _ = lagrangian(state[0])
        slope, force = (np.imag(value) / step for value in lagrangian(state[0] + 1j * step))
        return state[1], (0.5 * slope * (momentum / inertia) ** 2 - force) / (2 * ARM_MOMENT)

    independent = solve_ivp(motion, (0.0, end), (0.4, 0.0), method="DOP853", rtol=1e-12, atol=1e-12)
    ours = simulate(governor(speed), end, EXACT, times=np.array([0.0, end]))
    record_evidence(
        "Flyball governor, angle of the arms after 1 s",
        float(independent.y[0, -1]),
        float(-ours.channels(["right hinge.angle"])[-1, 0] + 0.0),
        unit="rad",
        tolerance=1e-8,
        topic=TOPIC,
        kind="other method",
        source="two coordinates, SciPy's DOP853; mechanism after the IFToMM library, A05",
    )
