"""Small vibrations about steady rotations against closed forms and a published table."""

import numpy as np
import pytest

import dalembert as da
from dalembert.multibody.spatial import (
    Bushing,
    Inertia,
    PrescribedMotion,
    RevoluteJoint,
    RigidBody,
    SpatialSystem,
    SphericalJoint,
    Spring,
)

COMMON = {"topic": "Rotating mechanisms", "tolerance": 1e-6, "relative": True, "unit": "Hz"}
LINES = {"x": (2.0, 0.0, 1.0), "y": (0.0, 2.0, 1.0)}


def top(speed, moments=(1.0, 1.0, 1.6), stiffness=(32005.21, 32005.21), mass=1.0, gravity=0.0, centre=0.0):
    """A body on a ball joint, held by horizontal springs at a point of its axis, 1 m above."""
    system = SpatialSystem(gravity=(0.0, 0.0, -gravity))
    inertia = Inertia(mass, moments).moved((0.0, 0.0, centre))
    disc = system.add(RigidBody("disc", inertia, points={"tip": (0.0, 0.0, 1.0)}, angular_velocity=(0.0, 0.0, speed)))
    system.add(SphericalJoint("ball", system.ground, disc.point("origin")))
    for (name, place), rate in zip(LINES.items(), stiffness, strict=True):
        side = system.ground.point(place)
        system.add(Spring(name, side, disc.point("tip"), stiffness=rate, free_length=2.0)) if rate else None
    return system


def hertz(*rates):
    return np.sort(np.abs(rates)) / (2.0 * np.pi)


@pytest.mark.parametrize("speed", [200.0, 1000.0])
def test_a_top_on_springs_whirls_forward_and_backward(record_evidence, speed):
    """I w^2 - I_p W w - k = 0: one root forward, one backward."""
    found = da.modes(top(speed))
    root = np.sqrt((1.6 * speed) ** 2 + 4.0 * 32005.21)
    expected = hertz((1.6 * speed - root) / 2.0, (1.6 * speed + root) / 2.0)
    record_evidence(
        f"Top on springs at {speed:g} rad/s, both frequencies", expected, found.frequencies, kind="closed form",
        source="I ω² − I_p Ω ω − k = 0", **COMMON,
    )  # fmt: skip
    assert found.frame == "fixed"
    assert found.speed == pytest.approx(speed)
    np.testing.assert_allclose(found.whirl, [-1.0, 1.0], atol=1e-6)
    turning = da.modes(top(speed), frame="rotating")
    away = hertz(expected[0] * 2.0 * np.pi + speed, expected[1] * 2.0 * np.pi - speed)
    np.testing.assert_allclose(turning.frequencies, away, rtol=1e-6)


def test_a_rotor_on_supports_that_differ(record_evidence):
    """I^2 w^4 - (I (k1 + k2) + I_p^2 W^2) w^2 + k1 k2 = 0, in the fixed frame."""
    k, spin = np.array([3e4, 6e4]), 1.6 * 200.0
    squares = np.roots([1.0, -(k.sum() + spin**2), k.prod()])
    found = da.modes(top(200.0, stiffness=tuple(k)))
    record_evidence(
        "Rotor on anisotropic supports, both frequencies", hertz(*np.sqrt(squares)), found.frequencies,
        kind="closed form", source="I² ω⁴ − (I (k₁ + k₂) + I_p² Ω²) ω² + k₁ k₂ = 0", **COMMON,
    )  # fmt: skip
    assert found.frame == "fixed"
    assert -1.0 < found.whirl[0] < 0.0 < found.whirl[1] < 1.0


def rotating(speed, moments, k):
    """Roots of a body with three moments on isotropic springs: Euler's equations in the rotating frame."""
    first, second, third = moments
    m, w = np.diag([first, second]), speed
    c = w * (first + second - third) * np.array([[0.0, -1.0], [1.0, 0.0]])
    stiffness = np.diag([k + (third - second) * w**2, k + (third - first) * w**2])
    a = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.linalg.solve(m, np.hstack([stiffness, c]))]])
    return np.linalg.eigvals(a)


def test_a_rotor_with_different_moments_in_the_rotating_frame(record_evidence):
    moments = (1.0, 1.2, 0.5)
    roots = rotating(120.0, moments, 3e4)
    found = da.modes(top(120.0, moments, (3e4, 3e4)))
    record_evidence(
        "Asymmetric rotor, both frequencies in the rotating frame", hertz(*roots.imag[roots.imag > 0.0]),
        found.frequencies, kind="closed form", source="Euler's equations in the rotating frame", **COMMON,
    )  # fmt: skip
    assert found.frame == "rotating"
    # k + (I3 - I2) W^2 < 0 < k + (I3 - I1) W^2: between both critical speeds a motion grows
    unstable = da.modes(top(225.0, moments, (3e4, 3e4)))
    growth = rotating(225.0, moments, 3e4).real.max()
    record_evidence(
        "Asymmetric rotor between its critical speeds, growth rate", growth, unstable.growth, kind="closed form",
        source="Euler's equations in the rotating frame", **{**COMMON, "unit": "1/s"},
    )  # fmt: skip


def test_a_sleeping_top(record_evidence):
    """I w^2 - I_p W w + m g l = 0: stable from I_p^2 W^2 = 4 I m g l on."""
    mass, arm, moments = 2.0, 0.1, np.array([0.004, 0.004, 0.006])
    across, along, load = moments[0] + mass * arm**2, moments[2], mass * 9.81 * arm
    limit = np.sqrt(4.0 * across * load) / along

    def sleeping(speed):
        return da.modes(top(speed, tuple(moments), (0.0, 0.0), mass, 9.81, arm))

    speed, below = 1.5 * limit, 0.6 * limit
    root = np.sqrt((along * speed) ** 2 - 4.0 * across * load)
    expected = hertz((along * speed - root) / (2.0 * across), (along * speed + root) / (2.0 * across))
    record_evidence(
        "Sleeping top, slow and fast precession", expected, sleeping(speed).frequencies, kind="closed form",
        source="I ω² − I_p Ω ω + m g l = 0", **COMMON,
    )  # fmt: skip
    assert sleeping(speed).growth == 0.0
    growth = np.sqrt(4.0 * across * load - (along * below) ** 2) / (2.0 * across)
    record_evidence(
        "Top too slow to sleep, growth rate", growth, sleeping(below).growth, kind="closed form",
        source="I ω² − I_p Ω ω + m g l = 0", **{**COMMON, "unit": "1/s"},
    )  # fmt: skip


def test_a_free_body(record_evidence):
    """Rotation about principal axes: W^2 (I3 - I1) (I3 - I2) / (I1 I2) is the square of the frequency."""
    moments = np.array([1.0, 2.0, 3.0])

    def free(axis):
        system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
        body = system.add(
            RigidBody("body", Inertia(1.0, tuple(moments)), angular_velocity=tuple(3.0 * np.eye(3)[axis]))
        )
        system.add(SphericalJoint("centre", system.ground, body.point("origin")))
        return da.modes(system)

    expected = 3.0 * np.sqrt((3.0 - 1.0) * (3.0 - 2.0) / (1.0 * 2.0)), 3.0 * np.sqrt(2.0 * 1.0 / (2.0 * 3.0))
    found = free(2).frequencies[0], free(0).frequencies[0]
    record_evidence(
        "Free body about its largest and its smallest moment", np.array(expected) / (2.0 * np.pi), np.array(found),
        kind="closed form", source="Ω √((I₃ − I₁)(I₃ − I₂)/(I₁ I₂))", **COMMON,
    )  # fmt: skip
    record_evidence(
        "Free body about its middle moment, growth rate", 3.0 * np.sqrt(1.0 * 1.0 / (1.0 * 3.0)), free(1).growth,
        kind="closed form", source="Ω √((I₂ − I₁)(I₃ − I₂)/(I₁ I₃))", **{**COMMON, "unit": "1/s"},
    )  # fmt: skip


def test_an_overhung_rotor(record_evidence):
    """A disc at the end of a shaft, whose stiffness 12 EI/l^3 and EI/l acts in the middle of the shaft."""
    bending, length, speed = 4000.0, 0.5, 300.0
    disc, sleeve = Inertia(5.0, (0.05, 0.05, 0.09)), Inertia(0.4, (0.002, 0.002, 0.002))
    system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    ring = system.add(RigidBody("sleeve", sleeve, points={"middle": (0.0, 0.0, -length / 2)}))
    rotor = system.add(RigidBody("rotor", disc, angular_velocity=(0.0, 0.0, speed)))
    system.add(RevoluteJoint("spin", ring.point("origin"), rotor.point("origin")))
    across, about = 12.0 * bending / length**3, bending / length
    springs = (across, across, 1e7, about, about, 1e4)
    system.add(Bushing("shaft", system.ground.point((0.0, 0.0, -length / 2)), ring.point("middle"), stiffness=springs))
    k = bending * np.array([[12.0 / length**3, -6.0 / length**2], [-6.0 / length**2, 4.0 / length]])
    m, moment = 5.4, 0.052
    # (k11 - m w^2) (k22 + I_p W w - I w^2) - k12^2 = 0
    bent = np.polymul([-m, 0.0, k[0, 0]], [-moment, 0.09 * speed, k[1, 1]])
    expected = np.real(np.roots(np.polysub(bent, [k[0, 1] ** 2])))
    found = da.modes(system)
    whirling = np.flatnonzero(np.abs(found.whirl) > 0.5)  # others: along and about the axis
    signed = np.sign(found.whirl[whirling]) * found.frequencies[whirling]
    record_evidence(
        "Overhung rotor, two frequencies forward and two backward", np.sort(expected) / (2.0 * np.pi), np.sort(signed),
        kind="closed form", source="(k₁₁ − m ω²)(k₂₂ + I_p Ω ω − I ω²) = k₁₂²", **COMMON,
    )  # fmt: skip
    assert found.frame == "fixed"


@pytest.mark.parametrize("hinge", ["flap", "lag"])
def test_a_hinged_blade(record_evidence, hinge):
    """Flap: W sqrt(1 + m e c/J), lag: W sqrt(m e c/J), with the hinge at e and the centre at c from it."""
    speed, offset, length, mass = 25.0, 0.3, 2.0, 3.0
    system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    hub = system.add(RigidBody("hub", Inertia(1.0, (0.1, 0.1, 0.1)), points={"hinge": (offset, 0.0, 0.0)}))
    about = mass * length**2 / 12.0
    rod = Inertia(mass, (1e-9, about, about)).moved((length / 2, 0.0, 0.0))
    blade = system.add(RigidBody("blade", rod, hub.point("hinge")))
    mast = system.add(RevoluteJoint("mast", system.ground, hub.point("origin")))
    axis = (0.0, 1.0, 0.0) if hinge == "flap" else (0.0, 0.0, 1.0)
    system.add(RevoluteJoint("hinge", hub.point("hinge"), blade.point("origin"), axis=axis))
    system.add(PrescribedMotion("drive", mast.a, mast.b, motion=da.signals.Polynomial((0.0, speed))))
    system.pose({}, rates={"hinge": 0.0})
    found = da.modes(system)
    ratio = mass * offset * length / 2 / (mass * length**2 / 3.0)
    record_evidence(
        f"Hinged blade, {hinge} frequency", speed * np.sqrt(ratio + (hinge == "flap")) / (2.0 * np.pi),
        found.frequencies[0], kind="closed form", source="Ω √(1 + m e c/J), Ω √(m e c/J)", **COMMON,
    )  # fmt: skip
    assert found.frame == "rotating"


@pytest.mark.slow
def test_a_rotating_beam(record_evidence):
    """A thin beam, clamped to the axis, that bends in the plane of rotation at W = 2 sqrt(EI/(rho A L^4))."""
    thickness = 2e-3
    unit = np.sqrt(thickness**2 / 12.0)  # length, modulus and density are 1
    turning = {"angular_velocity": 2.0 * unit}
    system = da.System(gravity=(0.0, 0.0))
    hub = system.add(da.RigidBody("hub", mass=1.0, inertia=1.0, **turning))
    shape = {"density": 1.0, "height": thickness, "width": 1.0}
    beam = system.add(da.AncfCable("beam", 1.0, 12, 1.0, start=hub.centre, **shape, **turning))
    pin = system.add(da.RevoluteJoint("pin", system.ground, hub.centre))
    system.add(da.FixedJoint("clamp", hub.centre, beam.start))
    system.add(da.PrescribedMotion("drive", pin.a, pin.b, motion=da.signals.Polynomial((0.0, 2.0 * unit))))
    found = da.modes(system, 1)
    flap = 4.1373  # dimensionless flapping frequency; in the plane of rotation it is lower: w^2 = flap^2 - W^2
    record_evidence(
        "Rotating beam, first dimensionless frequency in the plane", np.sqrt(flap**2 - 4.0),
        found.frequencies[0] * 2.0 * np.pi / unit, kind="published",
        source="Wright, Smith, Thresher and Wang 1982, table 1", **{**COMMON, "unit": "", "tolerance": 1e-3},
    )  # fmt: skip
    assert found.frame == "rotating"


def test_critical_speeds(record_evidence):
    """I w^2 - I_p W w = k with w = W forward, and w = -W backward."""
    diagram = da.multibody.campbell(lambda speed: top(speed, (1.0, 1.0, 0.6), (3e4, 3e4)), np.linspace(0.0, 400.0, 21))
    forward, backward = np.sqrt(3e4 / 0.4), np.sqrt(3e4 / 1.6)
    found = diagram.critical_speeds
    assert [own.direction for own in found] == ["backward", "forward"]
    record_evidence(
        "Critical speeds of a rotor, backward and forward", np.array([backward, forward]),
        np.array([own.speed for own in found]), kind="closed form", source="√(k/(I ± I_p))",
        **{**COMMON, "unit": "rad/s", "tolerance": 1e-4},
    )  # fmt: skip
