"""Couplings, screws and limits of joints in space: counted turns, channels, other integrators, wrong input."""

import numpy as np
import pytest

import dalembert as da
import dalembert.multibody as mb
import dalembert.multibody.spatial as sp
from dalembert.errors import InputError
from dalembert.multibody.model.lowering import lower

STILL = (0.0, 0.0, 0.0)
DISC = sp.Inertia.cylinder(mass=2.0, radius=0.1, length=0.02)  # moment 0.01 about its axis
WHEEL = sp.Inertia.cylinder(mass=1.0, radius=0.4, length=0.02)  # 0.08


def geared(ratio: float = -0.37, torque: float = 0.06, **options) -> sp.SpatialSystem:
    """Two discs on bearings; a torque turns the first."""
    system = sp.SpatialSystem(gravity=STILL)
    first = system.add(sp.RigidBody("first", DISC, angular_velocity=(0.0, 0.0, 3.0)))
    second = system.add(sp.RigidBody("second", WHEEL, (0.5, 0.0, 0.0)))
    joints = [
        system.add(sp.RevoluteJoint(f"{body.name} bearing", system.ground, body.point("origin")))
        for body in (first, second)
    ]
    system.add(sp.GearJoint("gear", *joints, ratio=ratio, **options))
    system.add(sp.Torque("drive", first.point("origin"), z=torque))
    return system


@pytest.mark.parametrize(
    ("solver", "tolerance"),
    [
        (mb.RadauIIA(tolerance=1e-9), 1e-9),
        (mb.RungeKutta4(step=1e-3), 1e-6),
        (mb.OdeSolver("DOP853", 1e-9, 1e-9), 1e-6),
        (mb.OdeSolver("DOP853", 1e-9, 1e-9, mb.Partitioning()), 1e-9),
        (mb.GeneralizedAlpha(step=1e-3), 1e-2),
        (mb.Variational(step=1e-3), 1e-2),
        (mb.EnergyMomentum(step=1e-3), 1e-2),
    ],
    ids=lambda value: type(value).__name__,
)
def test_integrators_count_the_turns_of_gears(solver: mb.Integrator, tolerance: float) -> None:
    ratio, torque, end = -0.37, 0.06, 4.0
    acceleration = torque / (0.01 + ratio**2 * 0.08)
    angle = 3.0 * end + acceleration * end**2 / 2
    assert angle > 4 * 2 * np.pi
    motion = mb.simulate(geared(), end, solver)
    names = ["angle_a", "rate_a", "torque_a", "angle_b", "rate_b", "torque_b"]
    found = motion.channels([f"gear.{name}" for name in names])[-1]
    rate, on_b = 3.0 + acceleration * end, 0.08 * ratio * acceleration
    expected = [angle, rate, -ratio * on_b, ratio * angle, ratio * rate, on_b]
    np.testing.assert_allclose(found, expected, atol=tolerance)


def test_angles_of_joints_are_counted_between_samples_that_are_turns_apart() -> None:
    motion = mb.simulate(geared(), 6.0, mb.RadauIIA(tolerance=1e-9), times=np.array([0.0, 2.5, 6.0]))
    found = motion.channels(["gear.angle_a", "first bearing.angle", "gear.angle_b", "second bearing.angle"])
    assert np.abs(np.diff(found[:, 0])).min() > 4 * np.pi
    np.testing.assert_allclose(found[:, [1, 3]], found[:, [0, 2]], atol=1e-9)


def test_the_offset_is_that_of_the_placement_or_a_number() -> None:
    at = mb.simulate(geared(torque=0.0), 0.1, "auto").channels(["gear.angle_a", "gear.angle_b"])
    np.testing.assert_allclose(at[0], 0.0, atol=1e-12)
    first, second = mb.simulate(geared(torque=0.0, offset=0.2), 0.1, "auto").channels(["gear.angle_a", "gear.angle_b"])[
        0
    ]
    assert second == pytest.approx(-0.37 * first + 0.2, abs=1e-12)
    assert abs(second) > 0.05


def test_a_planetary_gear_turns_by_willis_equation() -> None:
    """Rates of a planetary gear with a fixed ring: carrier = sun / (1 + ring/sun)."""
    system = sp.SpatialSystem(gravity=STILL)
    sun, ring, planet = 0.2, 0.6, 0.2  # radii
    bodies = {
        "sun": system.add(sp.RigidBody("sun", DISC, angular_velocity=(0.0, 0.0, 12.0))),
        "carrier": system.add(sp.RigidBody("carrier", DISC, points={"pin": (sun + planet, 0.0, 0.0)})),
    }
    carrier = bodies["carrier"]
    moon = system.add(sp.RigidBody("planet", DISC, carrier.point("pin")))
    system.add(sp.RevoluteJoint("frame", system.ground, carrier.point("origin")))
    on_sun = system.add(sp.RevoluteJoint("shaft", carrier.point("origin"), bodies["sun"].point("origin")))
    on_planet = system.add(sp.RevoluteJoint("pin", carrier.point("pin"), moon.point("origin")))
    on_ring = sp.RevoluteJoint("casing", carrier.point("origin"), system.ground.point(STILL))  # for its angle only
    system.add(sp.GearJoint("inner", on_sun, on_planet, ratio=-sun / planet))
    system.add(sp.GearJoint("outer", on_planet, on_ring, ratio=planet / ring))
    rates = mb.simulate(system, 2.0, "auto").channels(["carrier.origin.wz", "planet.origin.wz"])[-1]
    slow = 12.0 / (1 + ring / sun)
    np.testing.assert_allclose(rates, [slow, slow - ring / planet * slow], atol=1e-8)


def test_a_screw_counts_its_turns_and_couples_force_and_torque() -> None:
    lead, mass = 0.01, 2.0
    system = sp.SpatialSystem()
    nut = system.add(
        sp.RigidBody("nut", sp.Inertia(mass, (1e-4, 1e-4, 1e-4)), orientation=sp.Orientation.by_angles("z", [0.4]))
    )
    system.add(sp.ScrewJoint("thread", system.ground.point(STILL), nut.point("origin"), lead))
    motion = mb.simulate(system, 1.0, "auto")
    names = ["displacement", "angle", "rate", "force_3", "torque_3"]
    down, angle, rate, force, torque = motion.channels([f"thread.{name}" for name in names])[-1]
    pitch = 2 * np.pi / lead
    fall = 9.81 / (1 + 1e-4 * pitch**2 / mass)
    np.testing.assert_allclose([down, angle], [-fall / 2, 0.4 - fall / 2 * pitch], rtol=1e-7)
    assert angle < -10 * 2 * np.pi
    np.testing.assert_allclose(rate, -fall * pitch, rtol=1e-7)
    np.testing.assert_allclose([force, torque], [mass * (9.81 - fall), -1e-4 * fall * pitch], rtol=1e-7)
    np.testing.assert_allclose(torque, -force / pitch, rtol=1e-9)


@pytest.mark.parametrize("turns", [-7.4, -0.4, -0.2, 0.3, 0.45, 3.2])
def test_a_screw_closes_at_the_nearest_turn_of_its_thread(turns: float) -> None:
    """A nut that cannot turn: a displacement of ``turns`` leads becomes the nearest whole number of them."""
    lead = 0.02
    system = sp.SpatialSystem(gravity=STILL, driving=["nut.rotation_z"])
    nut = system.add(sp.RigidBody("nut", DISC, (0.0, 0.0, turns * lead)))
    system.add(sp.ScrewJoint("thread", system.ground.point(STILL), nut.point("origin"), lead, offset=0.0))
    placed = mb.simulate(system, 0.01, mb.RungeKutta4(step=1e-2)).channels(["thread.displacement", "thread.angle"])[0]
    np.testing.assert_allclose(placed, [round(turns) * lead, 2 * np.pi * round(turns)], atol=1e-12)


@pytest.mark.parametrize("angle", [0.3, 1.7, -2.9])
def test_a_prescribed_angle_is_met_from_any_placement(angle: float) -> None:
    system = sp.SpatialSystem(gravity=STILL)
    disc = system.add(sp.RigidBody("disc", DISC, orientation=sp.Orientation.by_angles("z", [angle])))
    system.add(sp.RevoluteJoint("pin", system.ground.point(STILL), disc.point("origin")))
    system.add(sp.PrescribedMotion("motion", system.ground.point(STILL), disc.point("origin"), "angle", 0.1))
    assert mb.simulate(system, 0.01, "auto").channels(["pin.angle"])[0, 0] == pytest.approx(0.1, abs=1e-12)


def test_reactions_of_a_rack_move_the_rack() -> None:
    """Forces of slide and teeth on the rack: m (a - g). The torque of the teeth on the pinion turns it."""
    system = sp.SpatialSystem()
    tilted = sp.Orientation.by_angles("x", [0.4])
    pinion = system.add(sp.RigidBody("pinion", DISC, angular_velocity=(0.0, 0.0, 2.0)))
    rack = system.add(sp.RigidBody("rack", WHEEL, (0.0, 0.1, 0.0), tilted))
    bearing = system.add(sp.RevoluteJoint("bearing", system.ground, pinion.point("origin")))
    place = system.ground.point((0.0, 0.1, 0.0), tilted)
    slide = system.add(sp.PrismaticJoint("slide", place, rack.point("origin")))
    system.add(sp.RackJoint("teeth", bearing, slide, radius=0.1))
    motion = mb.simulate(system, 0.3, mb.RadauIIA(tolerance=1e-10))
    acceleration = motion.channels([f"rack.origin.a{axis}" for axis in "xyz"]) - [0.0, 0.0, -9.81]
    teeth = motion.reactions("teeth")
    assert teeth.shape == (len(motion.times), 6)
    np.testing.assert_allclose(teeth[:, :3] + motion.reactions("slide")[:, :3], 1.0 * acceleration, atol=1e-9)
    np.testing.assert_allclose(teeth[:, 3:], 0.0, atol=1e-12)
    direction = np.array([0.0, -np.sin(0.4), np.cos(0.4)])
    np.testing.assert_allclose(teeth[:, :3], motion.channels(["teeth.force_b"]) * direction, atol=1e-12)


def test_reactions_of_a_gear_on_a_carrier_that_turns() -> None:
    """About the axis of its joint, which turns with its side a."""
    system = sp.SpatialSystem(gravity=STILL)
    arm = system.add(sp.RigidBody("arm", DISC, points={"pin": (0.5, 0.0, 0.0)}, angular_velocity=(0.0, 0.0, 3.0)))
    moon = system.add(sp.RigidBody("moon", WHEEL, arm.point("pin")))
    frame = system.add(sp.RevoluteJoint("frame", system.ground, arm.point("origin")))
    pin = system.add(sp.RevoluteJoint("pin", arm.point("pin"), moon.point("origin"), axis=(1.0, 0.0, 0.0)))
    system.add(sp.GearJoint("gear", frame, pin, ratio=-2.0))
    system.add(sp.Torque("drive", arm.point("origin"), z=0.4))
    motion = mb.simulate(system, 0.4, mb.RadauIIA(tolerance=1e-10))
    torque, angle = motion.channels(["gear.torque_b", "frame.angle"]).T
    assert np.abs(torque).max() > 0.1
    directions = np.column_stack([np.cos(angle), np.sin(angle), 0.0 * angle])
    np.testing.assert_allclose(motion.reactions("gear")[:, 3:], torque[:, None] * directions, atol=1e-12)
    with pytest.raises(InputError, match="unknown joint 'gaer'; did you mean 'gear'"):
        motion.reactions("gaer")


def pendulum(angle: float, **limits) -> sp.SpatialSystem:
    system = sp.SpatialSystem(gravity=STILL)
    turned = sp.Orientation.by_angles("z", [angle])
    disc = system.add(sp.RigidBody("disc", DISC, orientation=turned))
    pin = system.add(sp.RevoluteJoint("pin", system.ground.point(STILL), disc.point("origin")))
    system.add(sp.AngleLimit("stop", pin, stiffness=100.0, **limits))
    return system


@pytest.mark.parametrize(
    ("angle", "limits", "counted"),
    [
        (0.5, {"lower_limit": -1.0, "upper_limit": 1.0}, 0.5),
        (1.2, {"lower_limit": -1.0, "upper_limit": 1.0}, 1.2),
        (-2.2, {"lower_limit": 2.0, "upper_limit": 5.0}, 2 * np.pi - 2.2),
        (-0.5, {"lower_limit": 0.0, "upper_limit": 100.0}, 2 * np.pi - 0.5),
        (2.0, {"upper_limit": 1.0}, 2.0),
        (2.0, {"lower_limit": 3.0}, 2.0),
    ],
)
def test_where_a_limit_counts_from(angle: float, limits: dict, counted: float) -> None:
    start = mb.simulate(pendulum(angle, **limits), 0.01, mb.RungeKutta4(step=1e-3)).channels(
        ["stop.angle", "stop.torque"]
    )
    below = max(limits.get("lower_limit", -np.inf) - counted, 0.0)
    above = max(counted - limits.get("upper_limit", np.inf), 0.0)
    np.testing.assert_allclose(start[0], [counted, 100.0 * (below**1.5 - above**1.5)], atol=1e-9)


def test_a_displacement_limit_gives_back_the_energy_that_hunt_and_crossley_say() -> None:
    """d v - ln(1 + d v) before the impact is -d w - ln(1 - d w) after it, with the damping d."""
    damping, speed = 0.4, 2.0
    system = sp.SpatialSystem(gravity=STILL)
    block = system.add(sp.RigidBody("block", DISC, velocity=(0.0, 0.0, speed)))
    slide = system.add(sp.PrismaticJoint("slide", system.ground.point(STILL), block.point("origin")))
    limits = {"lower_limit": -1.0, "upper_limit": 0.1}
    system.add(sp.DisplacementLimit("stop", slide, stiffness=1e5, damping=damping, **limits))
    motion = mb.simulate(system, 0.25, mb.RadauIIA(tolerance=1e-11))
    after = -motion.channels(["stop.speed"])[-1, 0]
    assert motion.channels(["stop.force"])[-1, 0] == 0.0
    before = damping * speed - np.log(1 + damping * speed)
    assert -damping * after - np.log(1 - damping * after) == pytest.approx(before, rel=1e-7)
    assert motion.channels(["stop.force"]).max() <= 0.0


def test_lead_and_ratio_are_identified() -> None:
    times = np.linspace(0.0, 1.0, 21)

    def built(ratio, lead) -> sp.SpatialSystem:
        system = geared(ratio)
        nut = system.add(sp.RigidBody("nut", sp.Inertia(0.5, (1e-3, 1e-3, 1e-3)), (1.0, 0.0, 0.0)))
        system.add(sp.ScrewJoint("thread", system.bodies[1].point("origin"), nut.point("origin"), lead))
        system.add(
            sp.Spring("spring", system.ground.point((1.0, 0.0, -0.5)), nut.point("origin"), 200.0, free_length=0.4)
        )
        return system

    channels = ["gear.angle_a", "nut.origin.z"]
    model = mb.TimeResponse(built, {"ratio": (-0.6, -0.2), "lead": (0.05, 0.3)}, channels, times)
    measured = model.evaluate(np.array([-0.37, 0.12])).only()[0]
    data = da.Measurements.of(times, dict(zip(channels, measured.T, strict=True)))
    fit = da.identify(model, data, starts=1, seed=0)
    np.testing.assert_allclose(fit.values, [-0.37, 0.12], rtol=1e-7)


def test_wrong_input_is_refused_with_a_sentence() -> None:
    system = geared()
    first, second, _ = system.joints
    ball = sp.SphericalJoint("ball", system.ground, system.bodies[0].point("origin"))
    slide = sp.PrismaticJoint("slide", system.ground, system.bodies[0].point("origin"))
    with pytest.raises(InputError, match="gear joint 'g': ratio is 0"):
        sp.GearJoint("g", first, second, ratio=0.0)
    with pytest.raises(InputError, match="rack joint 'r': radius is 0"):
        sp.RackJoint("r", first, slide, radius=0.0)
    with pytest.raises(InputError, match="screw joint 's': lead is 0"):
        sp.ScrewJoint("s", first.a, first.b, lead=0.0)
    with pytest.raises(InputError, match="GearJoint 'g', b: SphericalJoint 'ball' was given as a joint with"):
        lower_with(sp.GearJoint("g", first, ball, ratio=1.0))
    with pytest.raises(InputError, match="it has 'displacement'"):
        lower_with(sp.GearJoint("g", slide, first, ratio=1.0))
    with pytest.raises(InputError, match="AngleLimit 'l': neither lower_limit nor upper_limit was given"):
        sp.AngleLimit("l", first, stiffness=1.0)
    with pytest.raises(InputError, match="lower_limit is 2 and upper_limit 1; expected a lower limit below"):
        sp.AngleLimit("l", first, stiffness=1.0, lower_limit=2.0, upper_limit=1.0)
    with pytest.raises(InputError, match="DisplacementLimit 'l': RevoluteJoint"):
        sp.DisplacementLimit("l", first, stiffness=1.0, lower_limit=0.0)


def lower_with(joint: sp.Joint) -> None:
    system = geared()
    system.add(joint)
    lower(system)
