"""Springs, bushings and servos on nodes of beams count whole turns, by every integrator, at rest and at a restart."""

import numpy as np
import pytest

import dalembert.multibody as mb

RATE, LENGTH, SIDE, DENSITY = 40.0, 0.4, 0.02, 1000.0
MOMENT = DENSITY * SIDE * SIDE * LENGTH**3 / 3
STIFFNESS = 0.05
OMEGA = np.sqrt(STIFFNESS / MOMENT)
TIMES = np.linspace(0.0, 2.0, 9)
NEAR = 0.03  # rad: a cable is not quite a rod


def rod(rate=0.0, angle=0.0, torque=0.0) -> tuple[mb.System, mb.AncfCable]:
    """A stiff cable that turns about its start like a rod."""
    system = mb.System(gravity=(0.0, 0.0))
    section = 1e9, DENSITY, SIDE, SIDE
    cable = system.add(mb.AncfCable("rod", LENGTH, 1, *section, angle=angle, angular_velocity=rate))
    system.add(mb.RevoluteJoint("pin", system.ground, cable.start))
    system.add(mb.Torque("load", cable.start, torque))
    return system, cable


def sprung(stiffness=STIFFNESS, rate=RATE, torque=0.0, angle=0.0, **fields) -> mb.System:
    """The rod winds a spring by rate / OMEGA, more than two turns."""
    system, cable = rod(rate, angle, torque)
    system.add(mb.TorsionSpring("coil", system.ground, cable.start, stiffness, **fields))
    return system


def swing(times: np.ndarray, omega: float = OMEGA) -> np.ndarray:
    return RATE / omega * np.sin(omega * times)


@pytest.mark.parametrize(
    "solver",
    [
        mb.RadauIIA(tolerance=1e-8),
        mb.GeneralizedAlpha(2e-4),
        mb.GeneralizedAlpha(1e-3, adaptive=True),
        mb.OdeSolver(),
        mb.EnergyMomentum(2e-4),
        mb.Variational(2e-4),
    ],
    ids=str,
)
def test_integrators_count_the_turns(solver: mb.Integrator) -> None:
    times = np.array([0.0, 0.05, 0.12])
    motion = mb.simulate(sprung(), times[-1], solver, times)
    twist, torque, angle = motion.channels(["coil.elongation", "coil.force", "pin.angle"]).T
    assert swing(times).max() > np.pi
    np.testing.assert_allclose(twist, swing(times), atol=NEAR)
    np.testing.assert_allclose(torque, STIFFNESS * twist, rtol=1e-12)
    np.testing.assert_allclose(angle, twist, atol=1e-6)


def test_a_bushing_counts_the_turns() -> None:
    system, cable = rod(RATE)
    system.add(mb.Bushing("rubber", system.ground, cable.start, 0.0, 0.0, STIFFNESS))
    angle, torque = mb.simulate(system, 2.0, "auto", TIMES).channels(["rubber.angle", "rubber.torque"]).T
    np.testing.assert_allclose(angle, swing(TIMES), atol=NEAR)
    np.testing.assert_allclose(torque, STIFFNESS * angle, rtol=1e-12)


def test_a_servo_turns_a_beam_by_turns() -> None:
    """It goes to two turns; a rigid bar follows the same way."""
    drive = {"torque_constant": 1.0, "resistance": 1.0, "back_emf": 0.0, "goal": 4 * np.pi, "kp": 1.0, "kd": 0.1}
    system, cable = rod()
    system.add(mb.Servo("servo", system.ground, cable.start, **drive))
    found = mb.simulate(system, 1.0, "auto", TIMES / 2).channels(["servo.angle", "servo.rate"])
    system = mb.System(gravity=(0.0, 0.0))
    bar = system.add(mb.RigidBar("rod", LENGTH, DENSITY * SIDE * SIDE * LENGTH))
    system.add(mb.RevoluteJoint("pin", system.ground, bar.start))
    system.add(mb.Servo("servo", system.ground, bar.start, **drive))
    expected = mb.simulate(system, 1.0, "auto", TIMES / 2).channels(["servo.angle", "servo.rate"])
    assert expected[-1, 0] == pytest.approx(4 * np.pi, abs=0.1)
    np.testing.assert_allclose(found[:, 0], expected[:, 0], atol=0.05)


def test_an_equilibrium_winds_the_spring_by_turns() -> None:
    rest = mb.equilibrium(sprung(rate=0.0, torque=0.5))
    np.testing.assert_allclose(rest.channels(["coil.elongation", "coil.force"]), (10.0, 0.5), rtol=1e-9)
    assert mb.modes(rest).frequencies[0] == pytest.approx(OMEGA / (2 * np.pi), rel=2e-3)


@pytest.mark.parametrize(
    ("fields", "twist"),
    [
        ({}, 0.0),
        ({"free_angle": 1.0}, -1.0),
        ({"free_angle": 6.0}, 2 * np.pi - 6.0),
        ({"angle": 7.0, "free_angle": 1.0}, 6.0 - 2 * np.pi),
        ({"near": 12.0}, 0.0),
        ({"near": 12.0, "free_angle": 0.5}, 4 * np.pi - 0.5),
        ({"near": -6.0, "free_angle": 6.0}, -2 * np.pi - 6.0),
    ],
)
def test_where_the_twist_begins(fields: dict, twist: float) -> None:
    motion = mb.simulate(sprung(rate=0.0, **fields), 1e-4)
    assert motion.channels(["coil.elongation"])[0, 0] == pytest.approx(twist, abs=1e-6)


@pytest.mark.parametrize(("fields", "twist"), [({}, 6.0), ({"near": 1.0}, 6.0 - 2 * np.pi), ({"near": 13.0}, 12.28319)])
def test_rigid_bodies_state_their_turns(fields: dict, twist: float) -> None:
    system = mb.System(gravity=(0.0, 0.0))
    bar = system.add(mb.RigidBar("bar", 1.0, 1.0, angle=7.0))
    system.add(mb.TorsionSpring("coil", system.ground, bar.start, 0.1, free_angle=1.0, **fields))
    assert mb.simulate(system, 1e-4).channels(["coil.elongation"])[0, 0] == pytest.approx(twist, abs=1e-5)


def test_a_servo_counts_from_the_angle_that_the_beam_states() -> None:
    system, cable = rod(angle=4.0)
    drive = {"torque_constant": 1.0, "resistance": 1.0, "goal": 4.0, "kp": 1.0}
    system.add(mb.Servo("servo", system.ground, cable.start, **drive))
    angle, torque = mb.simulate(system, 1e-3, "auto").channels(["servo.angle", "servo.torque"])[0]
    assert (angle, torque) == pytest.approx((4.0, 0.0), abs=1e-6)


MODEL = mb.TimeResponse(
    sprung,
    {"stiffness": (0.01, 0.1), "rate": (10.0, 60.0)},
    ["coil.elongation"],
    TIMES / 2,
    mb.RadauIIA(tolerance=1e-6),
)
AT = np.array([STIFFNESS, RATE])


def test_a_segment_continues_the_count() -> None:
    first = MODEL.restarted(0.0, TIMES[:5] / 2, None, MODEL.state_chart(AT, whole=True))
    chart = MODEL.state_chart(AT, first.evaluate(AT[None]).values[0, -1, 1:])
    rest = MODEL.restarted(TIMES[4] / 2, (TIMES[4:] - TIMES[4]) / 2, chart, None)
    twist = rest.evaluate(np.append(AT, chart.values)[None]).only()[0, :, 0]
    assert twist[0] > 3 * np.pi
    np.testing.assert_allclose(twist, swing(TIMES[4:] / 2), atol=NEAR)


def test_derivatives_count_too() -> None:
    response, jacobian = MODEL.linearise(AT)
    np.testing.assert_allclose(response[:, 0], swing(TIMES / 2), atol=NEAR)
    np.testing.assert_allclose(jacobian[:, 0, 1], swing(TIMES / 2) / RATE, atol=NEAR / RATE)


def test_the_adjoint_agrees_with_the_complex_step() -> None:
    channels, box = ["coil.elongation", "coil.force"], {"stiffness": (0.01, 0.1), "rate": (10.0, 60.0)}
    model = mb.TimeResponse(sprung, box, channels, TIMES[:3], mb.GeneralizedAlpha(1e-3))
    response, jacobian = model.linearise(AT)
    weights = np.cos(np.arange(response.size)).reshape(response.shape)
    values, pull = model.pullback(AT)
    np.testing.assert_allclose(values, response, rtol=1e-12)
    assert np.abs(response).max() > np.pi
    np.testing.assert_allclose(np.ravel(pull(weights)), np.tensordot(weights, jacobian, 2), rtol=1e-8)


def test_bodies_are_placed_as_without_the_spring() -> None:
    """Where the joints leave a choice, the angle of the spring does not change where bodies go."""

    def placed(stiffness: float | None) -> np.ndarray:
        system = mb.System(driving=["crank.angle"])
        crank = system.add(mb.RigidBar("crank", 0.4, 1.0, angle=0.9))
        beam = system.add(mb.AncfCable("beam", 1.0, 1, 1e8, 900.0, 0.02, 0.02, start=crank.end, angle=0.2))
        rocker = system.add(mb.RigidBar("rocker", 0.8, 1.0, start=(1.3, -0.1), angle=1.4))
        system.add(mb.RevoluteJoint("A", system.ground, crank.start))
        system.add(mb.RevoluteJoint("B", crank.end, beam.start))
        system.add(mb.RevoluteJoint("C", beam.end, rocker.end))
        if stiffness is not None:
            system.add(mb.TorsionSpring("coil", crank.end, beam.start, stiffness))
        return mb.simulate(system, 1e-4, "auto").channels(["beam.end.x", "beam.end.y", "rocker.start.angle"])[0]

    np.testing.assert_allclose(placed(0.0), placed(None), atol=1e-4)
