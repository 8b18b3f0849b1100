"""Couplings, screws and limits of joints in space against closed forms and an integration in minimal coordinates."""

import numpy as np
from scipy.integrate import solve_ivp

from dalembert.multibody import OdeSolver, RadauIIA, equilibrium, modes, simulate
from dalembert.multibody.spatial import (
    AngleLimit,
    DisplacementLimit,
    GearJoint,
    Inertia,
    Orientation,
    Pose,
    PrismaticJoint,
    RackJoint,
    RevoluteJoint,
    RigidBody,
    ScrewJoint,
    SpatialSystem,
    Spring,
    Torque,
    TorsionSpring,
)
from dalembert.multibody.trees import inverse_dynamics, mass_matrix, read_urdf
from robot_files import ARM

TOPIC = "Mechanisms in space"
EXACT = RadauIIA(tolerance=1e-11)
G = 9.81


def test_screw(record_evidence):
    """A nut on a vertical screw falls with g/(1 + J (2 pi/lead)^2/m), through many turns."""
    mass, moment, lead, end = 2.0, 1e-4, 0.02, 2.0
    system = SpatialSystem()
    nut = system.add(RigidBody("nut", Inertia(mass, (2e-4, 3e-4, moment))))
    system.add(ScrewJoint("thread", system.ground.point((0.0, 0.0, 0.0)), nut.point("origin"), lead))
    motion = simulate(system, end, EXACT, times=np.array([0.0, end]))
    fall = G / (1 + moment * (2 * np.pi / lead) ** 2 / mass)
    assert fall / 2 * end**2 / lead > 100
    down, angle, torque = motion.channels(["thread.displacement", "thread.angle", "thread.torque_3"])[-1]
    for quantity, expected, found, unit in (
        ("displacement", -fall / 2 * end**2, down, "m"),
        ("angle", -fall / 2 * end**2 * 2 * np.pi / lead, angle, "rad"),
        ("torque of the thread", -moment * fall * 2 * np.pi / lead, torque, "N*m"),
    ):
        record_evidence(
            f"Nut that falls along a screw, {quantity} after {abs(down) / lead:.0f} turns",
            expected,
            found,
            unit=unit,
            relative=True,
            tolerance=1e-9,
            topic=TOPIC,
            kind="closed form",
            source="acceleration g/(1 + J (2π/lead)²/m)",
        )


def test_bevel_gears(record_evidence):
    """Two discs with crossed axes, geared: acceleration torque/(J1 + ratio^2 J2), counted over many turns."""
    ratio, torque, first, second, end = -0.37, 0.06, 0.01, 0.08, 8.0
    system = SpatialSystem()
    one = system.add(RigidBody("one", Inertia(1.0, (0.02, 0.02, first)), angular_velocity=(0.0, 0.0, 3.0)))
    two = system.add(RigidBody("two", Inertia(1.0, (second, 0.05, 0.05)), (0.3, 0.0, 0.2)))
    joints = [
        system.add(RevoluteJoint(f"{body.name} bearing", system.ground, body.point("origin"), axis))
        for body, axis in ((one, (0.0, 0.0, 1.0)), (two, (1.0, 0.0, 0.0)))
    ]
    system.add(GearJoint("gear", *joints, ratio=ratio))
    system.add(Torque("drive", one.point("origin"), z=torque))
    motion = simulate(system, end, EXACT, times=np.array([0.0, end]))
    acceleration = torque / (first + ratio**2 * second)
    angle = 3.0 * end + acceleration * end**2 / 2
    names = ("angle_a", "angle_b", "torque_a", "torque_b")
    expected = [angle, ratio * angle, -second * ratio**2 * acceleration, second * ratio * acceleration]
    record_evidence(
        f"Bevel gears under a constant torque: angles and torques after {angle / 2 / np.pi:.0f} turns",
        np.array(expected),
        motion.channels([f"gear.{name}" for name in names])[-1],
        relative=True,
        tolerance=1e-9,
        topic=TOPIC,
        kind="closed form",
        source="torque/(J₁ + ratio² J₂)",
    )


def test_rack(record_evidence):
    """A rack that falls and turns its pinion: acceleration g/(1 + J/(m r^2))."""
    mass, moment, radius, end = 1.5, 0.02, 0.08, 1.2
    system = SpatialSystem()
    pinion = system.add(RigidBody("pinion", Inertia(1.0, (moment, 0.05, 0.05))))
    rack = system.add(RigidBody("rack", Inertia(mass, (0.1, 0.1, 0.01)), (0.0, radius, 0.0)))
    bearing = system.add(RevoluteJoint("bearing", system.ground, pinion.point("origin"), (1.0, 0.0, 0.0)))
    slide = system.add(PrismaticJoint("slide", system.ground, rack.point("origin")))
    system.add(RackJoint("teeth", bearing, slide, radius=radius))
    motion = simulate(system, end, EXACT, times=np.array([0.0, end]))
    fall = G / (1 + moment / (mass * radius**2))
    record_evidence(
        "Rack that falls and turns its pinion: displacement, angle, force of the teeth",
        np.array([-fall / 2 * end**2, -fall / 2 * end**2 / radius, mass * (G - fall)]),
        motion.channels(["teeth.displacement_b", "teeth.angle_a", "teeth.force_b"])[-1],
        relative=True,
        tolerance=1e-9,
        topic=TOPIC,
        kind="closed form",
        source="acceleration g/(1 + J/(m r²))",
    )


def test_impact_on_a_limit(record_evidence):
    """Speed after an impact with the damping d: d v - ln(1 + d v) before is -d w - ln(1 - d w) after it."""
    damping, speed = 0.4, 2.0
    system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    block = system.add(RigidBody("block", Inertia(3.0, (0.1, 0.1, 0.1)), velocity=(0.0, 0.0, speed)))
    slide = system.add(PrismaticJoint("slide", system.ground.point((0.0, 0.0, 0.0)), block.point("origin")))
    system.add(DisplacementLimit("stop", slide, 1e5, upper_limit=0.1, damping=damping))
    motion = simulate(system, 0.25, EXACT, times=np.array([0.0, 0.25]))
    after = -motion.channels(["stop.speed"])[-1, 0]
    low, high = 0.0, speed
    for _ in range(60):  # bisection
        middle = (low + high) / 2
        lost = -damping * middle - np.log(1 - damping * middle) - (damping * speed - np.log(1 + damping * speed))
        low, high = (middle, high) if lost < 0 else (low, middle)
    record_evidence(
        "Impact on a limit of a slide: speed after it",
        low,
        after,
        unit="m/s",
        tolerance=1e-7,
        topic=TOPIC,
        kind="closed form",
        source="first integral of the law of Hunt and Crossley (1975)",
    )


def test_pendulum_on_a_limit(record_evidence):
    """A pendulum about an inclined axis that bounces on a stop at 3 rad, against DOP853 in its angle."""
    mass, moment, arm, tilt = 1.2, 0.05, 0.3, 0.5
    stiffness, damping, limit, start = 4000.0, 0.15, 3.0, 0.4
    system = SpatialSystem()
    seat = system.ground.point((0.1, 0.0, 0.3), Orientation.by_angles("y", [tilt]))
    inertia = Inertia(mass, (0.04, 0.03, moment), centre=(arm, 0.0, 0.0))
    turned = Orientation.of(Orientation.by_angles("yz", [tilt, start]).matrix)
    points = {"seat": Pose((0.0, 0.0, 0.0))}
    rod = system.add(RigidBody("rod", inertia, (0.1, 0.0, 0.3), turned, points=points, angular_velocity=None))
    pin = system.add(RevoluteJoint("pin", seat, rod.point("seat")))
    system.add(Torque("drive", rod.point("seat"), z=3.0, follower=True))
    system.add(AngleLimit("stop", pin, stiffness, lower_limit=-1.0, upper_limit=limit, damping=damping))
    times = np.linspace(0.0, 2.0, 21)
    motion = simulate(system, 2.0, RadauIIA(tolerance=1e-12), times=times)

    def rates(t, state):
        angle, rate = state
        beyond = max(angle - limit, 0.0)
        stop = stiffness * beyond**1.5 * (1 + damping * rate)
        weight = mass * G * arm * np.sin(tilt) * -np.sin(angle)  # the axis x of the seat points down by sin(tilt)
        return rate, (3.0 + weight - stop) / (moment + mass * arm**2)

    exact = solve_ivp(rates, (0.0, 2.0), (start, 0.0), "DOP853", times, rtol=1e-13, atol=1e-13, max_step=1e-3).y
    found = motion.channels(["stop.angle", "stop.rate"])
    assert exact[0].max() > limit
    assert np.sum(np.diff(np.sign(exact[1])) != 0) >= 2
    record_evidence(
        "Pendulum that bounces on a limit: angle during 2 s (largest difference)",
        0.0,
        float(np.abs(found[:, 0] - exact[0]).max()),
        unit="rad",
        tolerance=1e-9,
        noisy=True,
        topic=TOPIC,
        kind="other method",
        source="minimal coordinate, DOP853 at 1e-13",
    )


def test_modes(record_evidence):
    """Frequencies of a nut on a spring, k/(m + J (2 pi/lead)^2), and of geared discs, one of them on a spring."""
    mass, moment, lead, stiffness = 2.0, 1e-3, 0.1, 500.0
    system = SpatialSystem()
    nut = system.add(RigidBody("nut", Inertia(mass, (2e-3, 2e-3, moment))))
    system.add(ScrewJoint("thread", system.ground.point((0.0, 0.0, 0.0)), nut.point("origin"), lead))
    system.add(Spring("spring", system.ground.point((0.0, 0.0, 1.0)), nut.point("origin"), stiffness, free_length=1.0))
    rest = equilibrium(system)
    system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    one = system.add(RigidBody("one", Inertia(1.0, (0.02, 0.02, 0.01))))
    two = system.add(RigidBody("two", Inertia(1.0, (0.08, 0.05, 0.05)), (0.3, 0.0, 0.0)))
    joints = [
        system.add(RevoluteJoint(f"{body.name} bearing", system.ground, body.point("origin"), axis))
        for body, axis in ((one, (0.0, 0.0, 1.0)), (two, (1.0, 0.0, 0.0)))
    ]
    system.add(GearJoint("gear", *joints, ratio=-0.37))
    system.add(TorsionSpring("spring", system.ground, two.point("origin"), 3.0, axis=(1.0, 0.0, 0.0)))
    for quantity, state, expected in (
        ("a nut on its screw and a spring", rest, stiffness / (mass + moment * (2 * np.pi / lead) ** 2)),
        ("bevel gears on a torsion spring", system, 3.0 / (0.08 + 0.01 / 0.37**2)),
    ):
        record_evidence(
            f"Frequency of {quantity}",
            np.array([np.sqrt(expected) / (2 * np.pi)]),
            modes(state).frequencies,
            unit="Hz",
            relative=True,
            tolerance=1e-10,
            topic=TOPIC,
            kind="closed form",
            source="stiffness/reduced mass",
        )


def test_arm_with_a_joint_that_follows_another_one(tmp_path, record_evidence):
    """Robot arm whose wrist follows its column: DOP853 in the remaining coordinates, with mass matrix and torques."""
    file = tmp_path / "arm.urdf"
    file.write_text(
        ARM.replace(
            '<parent link="slider"/>', '<mimic joint="turn" multiplier="-0.8" offset="0.3"/><parent link="slider"/>'
        )
    )
    tree = read_urdf(file)
    tree = tree.with_numbers({"turn.friction": 0.0})
    assert [joint.name for joint in tree.moving] == ["turn", "slide"]
    times, start, rates = np.linspace(0.0, 0.6, 7), [0.4, 0.1], [2.5, 0.8]
    motion = simulate(tree.system(start, rates), 0.6, OdeSolver("DOP853", 1e-12, 1e-12), times=times)

    def derivatives(t, state):
        q, v = state[None, :2], state[None, 2:]
        loads = inverse_dynamics(tree, q, v, np.zeros((1, 2)))[0]
        return np.concatenate([state[2:], -np.linalg.solve(mass_matrix(tree, q)[0], loads)])

    exact = solve_ivp(derivatives, (0.0, 0.6), [*start, *rates], "DOP853", times, rtol=1e-12, atol=1e-12).y
    found = motion.channels(["turn.angle", "slide.displacement", "bend.angle"]).T
    record_evidence(
        "Robot arm with a mimic joint: positions of its joints during 0.6 s (largest difference)",
        0.0,
        float(np.abs(found - [exact[0], exact[1], 0.3 - 0.8 * exact[0]]).max()),
        tolerance=1e-8,
        noisy=True,
        topic=TOPIC,
        kind="other method",
        source="minimal coordinates, DOP853 at 1e-12",
    )
