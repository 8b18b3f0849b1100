"""Motors and servos against closed forms: rates, time constants, losses of gears, position loops, switching off."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import dalembert.multibody as mb
from dalembert.errors import InputError, ModelError
from support import says

INERTIA, CONSTANT, RESISTANCE = 2e-3, 0.05, 0.8
SOLVER = mb.RadauIIA(tolerance=1e-10)
TIMES = np.linspace(0.0, 2.0, 41)


def disc(kind=mb.Motor, rate=0.0, viscous=None, **fields):
    """A disc on a bearing that a motor turns."""
    system = mb.System(gravity=(0.0, -9.81))
    body = system.add(mb.RigidBody("disc", mass=1.0, inertia=INERTIA, angular_velocity=rate))
    system.add(mb.RevoluteJoint("bearing", system.ground, body.centre, viscous=viscous))
    fields = {"torque_constant": CONSTANT, "resistance": RESISTANCE} | fields
    system.add(kind("motor", system.ground, body.centre, **fields))
    return system


def motion(channels, times=TIMES, **fields):
    run = mb.simulate(disc(**fields), times[-1], SOLVER, times)
    return run, run.channels([f"motor.{name}" for name in channels.split()]).T


def test_a_motor_reaches_its_rate_with_its_time_constant() -> None:
    voltage, ratio, back_emf, armature, viscous = 6.0, 4.0, 0.04, 1e-4, 0.02
    run, (rate, current, torque) = motion(
        "rate current torque",
        voltage=voltage,
        gear_ratio=ratio,
        back_emf=back_emf,
        armature_inertia=armature,
        viscous=viscous,
    )
    braking = ratio**2 * CONSTANT * back_emf / RESISTANCE + viscous
    steady = ratio * CONSTANT * voltage / RESISTANCE / braking
    constant = (INERTIA + ratio**2 * armature) / braking
    np.testing.assert_allclose(rate, steady * (1 - np.exp(-TIMES / constant)), atol=1e-7)
    np.testing.assert_allclose(current, (voltage - back_emf * ratio * rate) / RESISTANCE, rtol=1e-12)
    np.testing.assert_allclose(torque, ratio * CONSTANT * current, rtol=1e-12)
    np.testing.assert_allclose(run.energies["kinetic"], (INERTIA + ratio**2 * armature) / 2 * rate**2, rtol=1e-12)


def test_the_balance_of_energy_includes_armature_gear_and_back_emf() -> None:
    fields = {"voltage": mb.Harmonic(6.0, 5.0), "gear_ratio": 4.0, "armature_inertia": 1e-4, "efficiency": 0.7}
    errors = [
        np.max(np.abs(mb.simulate(disc(**fields), 2.0, mb.GeneralizedAlpha(step)).energies["balance"]))
        for step in (2e-3, 1e-3)
    ]
    assert errors[1] < 0.3 * errors[0]
    assert errors[1] < 2e-4


def test_a_current_gives_its_torque_whatever_the_rate() -> None:
    _, (rate, voltage) = motion("rate voltage", current=0.3, rate=10.0)
    np.testing.assert_allclose(rate, 10 + CONSTANT * 0.3 / INERTIA * TIMES, rtol=1e-9)
    np.testing.assert_allclose(voltage, RESISTANCE * 0.3 + CONSTANT * rate, rtol=1e-9)


@pytest.mark.parametrize(("voltage", "applied"), [(5.0, 5.0), (50.0, 12.0), (-50.0, -12.0), (12.0, 11.91682)])
def test_a_voltage_is_limited(voltage: float, applied: float) -> None:
    _, (seen, rate) = motion("voltage rate", voltage=voltage, voltage_limit=12.0)
    np.testing.assert_allclose(seen, applied, rtol=1e-6)
    assert rate[-1] == pytest.approx(applied / CONSTANT, rel=0.1)


@pytest.mark.parametrize(("rate", "factor"), [(50.0, 0.6), (-50.0, 1 / 0.6), (0.0, 1.0)])
def test_a_gear_loses_what_its_efficiency_says_in_both_directions(rate: float, factor: float) -> None:
    """Driving, e of the motor's power leaves the gear; driven, e of the power that enters reaches the motor."""
    _, (torque,) = motion("torque", current=0.3, rate=rate, gear_ratio=3.0, efficiency=0.6, times=np.array([0.0, 1e-4]))
    assert torque[0] == pytest.approx(3 * CONSTANT * 0.3 * factor, rel=1e-9)


def test_a_motor_turns_b_against_a_and_acts_on_both() -> None:
    system = mb.System(gravity=(0.0, 0.0))
    stator = system.add(mb.RigidBody("stator", mass=2.0, inertia=0.03))
    rotor = system.add(mb.RigidBody("rotor", mass=1.0, inertia=0.01))
    system.add(mb.RevoluteJoint("bearing", stator.centre, rotor.centre))
    own = {"torque_constant": CONSTANT, "armature_inertia": 1e-3, "gear_ratio": 2.0}
    system.add(mb.Motor("motor", stator.centre, rotor.centre, current=1.0, **own))
    a, b = mb.simulate(system, 1.0, SOLVER).channels(["stator.centre.acceleration", "rotor.centre.acceleration"])[-1]
    assert 0.03 * a + 0.01 * b == pytest.approx(0.0, abs=1e-9)
    assert 0.01 * b + 4e-3 * (b - a) == pytest.approx(2 * CONSTANT, rel=1e-9)


def test_switched_off_it_coasts() -> None:
    off = 0.7
    _, (rate, current) = motion("rate current", voltage=6.0, enabled=mb.Step(1.0, -1.0, off))
    constant = INERTIA * RESISTANCE / CONSTANT**2
    on = np.minimum(TIMES, off)
    np.testing.assert_allclose(rate, 6 / CONSTANT * (1 - np.exp(-on / constant)), atol=1e-6)
    assert np.all(current[off + 1e-6 < TIMES] == 0.0)
    assert np.all(current[off - 1e-6 > TIMES] > 0.1)


@pytest.mark.parametrize(("kp", "kd"), [(0.1, 0.0), (2.0, 0.1), (20.0, 0.3)], ids=["creeping", "damped", "swinging"])
def test_the_loop_answers_a_step_as_a_system_of_second_order(kp: float, kd: float) -> None:
    goal, ratio = 0.4, 3.0
    _, (angle, voltage) = motion("angle voltage", kind=mb.Servo, goal=goal, kp=kp, kd=kd, gear_ratio=ratio)
    drive = ratio * CONSTANT / RESISTANCE
    roots = np.roots([INERTIA, drive * (kd + CONSTANT * ratio), drive * kp])
    weights = np.linalg.solve([[1, 1], roots], [-goal, 0.0])
    known = goal + (np.exp(np.outer(TIMES, roots)) @ weights).real
    np.testing.assert_allclose(angle, known, atol=1e-7)
    rates = (np.exp(np.outer(TIMES, roots)) @ (weights * roots)).real
    np.testing.assert_allclose(voltage, kp * (goal - known) - kd * rates, atol=1e-5)


def test_a_loop_rests_within_its_dead_band() -> None:
    _, (angle, voltage) = motion("angle voltage", kind=mb.Servo, goal=0.05, kp=20.0, kd=1.0, dead_band=0.1)
    np.testing.assert_allclose(angle, 0.0, atol=1e-9)
    _, (angle, voltage) = motion("angle voltage", kind=mb.Servo, goal=1.0, kp=20.0, kd=3.0, dead_band=0.1)
    assert angle[-1] == pytest.approx(0.9, abs=2e-3)
    assert voltage[0] == pytest.approx(20 * 0.9, rel=1e-9)


def test_a_servo_holds_a_weight_at_its_equilibrium() -> None:
    system = mb.System(gravity=(0.0, -9.81), start="equilibrium")
    bar = system.add(mb.RigidBar("bar", length=0.2, mass=0.1))
    system.add(mb.RevoluteJoint("pin", system.ground, bar.start))
    own = {"torque_constant": 1.0, "resistance": 4.0, "kp": 30.0}
    system.add(mb.Servo("servo", system.ground, bar.start, goal=mb.Harmonic(0.1, 3.0, offset=0.5), **own))
    run = mb.simulate(system, 0.1, SOLVER, [0.0, 0.1])
    angle, torque = run.channels(["servo.angle", "servo.torque"])[0]
    assert torque == pytest.approx(0.1 * 9.81 * 0.1 * np.cos(angle), rel=1e-9)
    assert torque == pytest.approx(30 * (0.5 - angle) / 4, rel=1e-9)


def test_outputs_are_read_at_the_times_of_the_signals() -> None:
    """At a later start, and differentiated by a number of a signal."""

    def build(amplitude):
        return disc(voltage=mb.Harmonic(amplitude, 5.0))

    model = mb.TimeResponse(build, {"amplitude": (1.0, 9.0)}, ["motor.voltage", "motor.rate"], TIMES)
    np.testing.assert_allclose(model.evaluate([[6.0]]).values[0, :, 0], 6 * np.sin(5 * TIMES), atol=1e-9)
    np.testing.assert_allclose(model.jacobian(np.array([6.0]))[:, 0, 0], np.sin(5 * TIMES), atol=1e-9)
    later = model.later(0.5, TIMES).evaluate([[6.0]]).values[0, :, 0]
    np.testing.assert_allclose(later, 6 * np.sin(5 * (TIMES + 0.5)), atol=1e-9)


def rubbing(kind: str, rate: float, exponent: float) -> tuple[mb.System, str]:
    """A body that slides at a rate against Stribeck's friction."""
    system = mb.System(gravity=(0.0, -10.0))
    law = {"coulomb": 0.3, "stribeck": 0.2, "stribeck_exponent": exponent, "viscous": 0.05}
    if kind == "pin":
        body = system.add(mb.RigidBody("body", mass=2.0, inertia=0.1))
        law |= {"friction_coefficient": 0.1, "pin_radius": 0.2, "slip_rate": 0.01, "stribeck_rate": 0.5}
        system.add(mb.RevoluteJoint("joint", system.ground, body.centre, **law))
        turns = {"coordinate": "angle"}
    else:
        body = system.add(mb.RigidBody("body", mass=2.0, inertia=0.1))
        law |= {"friction_coefficient": 0.02, "slip_velocity": 0.01, "stribeck_velocity": 0.5}
        system.add(mb.PrismaticJoint("joint", system.ground, body.centre, **law))
        turns = {"coordinate": "x"}
    system.add(mb.PrescribedMotion("drive", system.ground, body.centre, motion=mb.Polynomial([0.0, rate]), **turns))
    return system, "drive.torque" if kind == "pin" else "drive.force_x"


@pytest.mark.parametrize("kind", ["pin", "slide"])
@pytest.mark.parametrize("exponent", [1.0, 2.0])
@pytest.mark.parametrize("rate", [-3.0, 0.005, 0.2, 0.5, 2.0])
def test_steady_sliding_needs_the_force_of_stribecks_law(kind: str, exponent: float, rate: float) -> None:
    system, channel = rubbing(kind, rate, exponent)
    force = mb.simulate(system, 0.1, SOLVER).channels([channel])[-1, 0]
    dry = 0.3 + 0.02 * 20.0 + 0.2 * np.exp(-(abs(rate / 0.5) ** exponent))
    assert force == pytest.approx(dry * np.tanh(rate / 0.01) + 0.05 * rate, rel=1e-7)


SOLVERS = {
    "generalized-alpha": (mb.GeneralizedAlpha(5e-4), 1e-4),
    "Radau IIA": (mb.RadauIIA(tolerance=1e-8), 1e-6),
    "Runge-Kutta 4": (mb.RungeKutta4(5e-4), 1e-5),
    "DOP853": (mb.OdeSolver("DOP853"), 1e-5),
    "variational": (mb.Variational(5e-4), 1e-4),
    "energy-momentum": (mb.EnergyMomentum(5e-4), 1e-4),
    "collocation": (mb.Collocation(2e-3, degree=4, gauss_points=3), 1e-4),
    "automatic": (mb.Automatic(), 1e-4),
}
LOOP = {"kp": 30.0, "kd": 0.2, "voltage_limit": 8.0, "armature_inertia": 2e-6, "gear_ratio": 50.0, "efficiency": 0.8}


def pendulum(kp: float = 30.0) -> mb.System:
    """A servo that swings a bar by a moving goal, with friction of all kinds in the joint."""
    system = mb.System(gravity=(0.0, -9.81))
    bar = system.add(mb.RigidBar("bar", length=0.3, mass=0.4, angle=-1.2))
    law = {"coulomb": 0.02, "stribeck": 0.01, "stribeck_rate": 1.0, "slip_rate": 0.2, "viscous": 0.004}
    law |= {"friction_coefficient": 0.1, "pin_radius": 0.01}
    system.add(mb.RevoluteJoint("pin", system.ground, bar.start, **law))
    own = {"torque_constant": 0.01, "resistance": 3.0} | LOOP | {"kp": kp}
    goal = mb.Harmonic(0.8, 6.0, offset=-1.2)
    system.add(mb.Servo("servo", system.ground, bar.start, goal=goal, slip_rate=0.2, **own))
    return system


def by_hand(times: np.ndarray) -> np.ndarray:
    """Angle of the pendulum by its own equation of motion."""
    mass, length, ratio = 0.4, 0.3, 50.0
    inertia = mass * length**2 / 3

    def voltage(angle: float, rate: float, t: float) -> float:
        wanted, width = 30 * (0.8 * np.sin(6 * t) - 1.2 - angle) - 0.2 * rate, 0.16
        return width / 2 * (np.logaddexp(0, 2 * (wanted + 8) / width) - np.logaddexp(0, 2 * (wanted - 8) / width)) - 8

    def acceleration(t: float, state: np.ndarray) -> float:
        angle, rate = state
        torque = ratio * 0.01 / 3 * (voltage(angle, rate, t) - 0.01 * ratio * rate)
        torque *= 0.8 ** (np.tanh(rate / 0.2) * np.sign(torque))
        weight = -mass * 9.81 * length / 2 * np.cos(angle)
        dry = 0.02 + 0.01 * np.exp(-(rate**2))

        def left(alpha: float) -> float:
            along = mass * (9.81 * np.sin(angle) - rate**2 * length / 2)
            across = mass * (9.81 * np.cos(angle) + alpha * length / 2)
            load = 1e-3 * np.hypot(along, across)
            friction = (dry + load) * np.tanh(rate / 0.2) + 0.004 * rate
            return (torque + weight - friction) / (inertia + 2500 * 2e-6)

        alpha = 0.0
        for _ in range(40):
            alpha = left(alpha)
        return alpha

    def slope(t: float, state: np.ndarray) -> list[float]:
        return [state[1], acceleration(t, state)]

    own = solve_ivp(slope, (0.0, times[-1]), [-1.2, 0.0], "LSODA", times, rtol=1e-9, atol=1e-10)
    return own.y[0]


@pytest.mark.parametrize("name", SOLVERS)
def test_all_integrators_agree_with_the_equation_of_motion(name: str) -> None:
    solver, tolerance = SOLVERS[name]
    times = np.linspace(0.0, 1.0, 21)
    angle = mb.simulate(pendulum(), 1.0, solver, times).channels(["servo.angle"])[:, 0]
    np.testing.assert_allclose(angle, by_hand(times), atol=tolerance)


STEADY = {
    "Radau IIA": mb.RadauIIA(tolerance=1e-8),
    "automatic": mb.Automatic(),
    "Runge-Kutta 4": mb.RungeKutta4(1e-3),
    "DOP853": mb.OdeSolver("DOP853", 1e-8, 1e-10, most_steps=20_000),
}


@pytest.mark.parametrize("name", STEADY)
def test_a_steady_rate_against_two_dampers_is_kept(name: str) -> None:
    """The accelerations are the rounding of forces in balance."""
    system = mb.System(gravity=(0.0, 0.0))
    body = system.add(mb.RigidBody("disc", mass=1.0, inertia=INERTIA))
    system.add(mb.RevoluteJoint("bearing", system.ground, body.centre, viscous=0.04))
    system.add(mb.TorsionSpring("grease", system.ground, body.centre, stiffness=0.0, damping=0.02))
    system.add(mb.Torque("belt", body.centre, 1.51))
    rate = mb.simulate(system, 2.0, STEADY[name]).channels(["bearing.rate"])[-1, 0]
    assert rate == pytest.approx(1.51 / 0.06, rel=1e-6)


def bar_on_a_beam(**fields):
    system = mb.System()
    beam = system.add(mb.AncfCable("beam", 1.0, 2, youngs_modulus=1e9, density=1e3, height=0.01, width=0.01))
    rotor = system.add(mb.RigidBar("rotor", 0.2, 1.0, start=beam.end))
    system.add(mb.Motor("motor", beam.end, rotor.start, torque_constant=1.0, current=1.0, **fields))
    mb.simulate(system, 0.01)


@pytest.mark.parametrize(
    ("make", "error", "sentence"),
    [
        (disc, InputError, "motor 'motor': neither voltage nor current was given; give one of them"),
        (
            lambda: disc(voltage=1.0, current=1.0),
            InputError,
            "motor 'motor': both voltage and current was given; give one of them",
        ),
        (
            lambda: disc(voltage=1.0, resistance=None),
            InputError,
            "motor 'motor': a voltage was given without a resistance; give the resistance in ohm",
        ),
        (
            lambda: disc(voltage=1.0, efficiency=1.2),
            InputError,
            "Motor 'motor': efficiency is 1.2; expected a number above 0 and at most 1",
        ),
        (
            lambda: disc(voltage=1.0, gear_ratio=0.0),
            InputError,
            "motor 'motor': gear_ratio is 0; expected a number other than zero",
        ),
        (
            lambda: disc(voltage=1.0, voltage_limit=-2.0),
            InputError,
            "Motor 'motor': voltage_limit is -2 V; expected a positive number",
        ),
        (lambda: disc(mb.Servo, goal=1.0), InputError, "servo 'motor': kp is missing; give it"),
        (
            lambda: disc(mb.Servo, goal=1.0, kp=1.0, dead_band=0.0),
            InputError,
            "Servo 'motor': dead_band is 0 rad; expected a positive number",
        ),
        (
            lambda: bar_on_a_beam(armature_inertia=1e-4),
            ModelError,
            "motor 'motor': beam.end or rotor.start is a node of a beam, which cannot carry an armature_inertia. Fix a "
            "rigid body to the node, and give the motor that body",
        ),
        (
            lambda: mb.RevoluteJoint("pin", mb.Ground(), mb.RigidBar("bar", 1.0, 1.0).start, stribeck=0.1),
            InputError,
            "revolute joint 'pin': stribeck was given without a stribeck_rate. Give the rate at which Stribeck's "
            "friction has decreased to 1/e",
        ),
    ],
)
def test_what_no_motor_has_is_refused(make, error, sentence) -> None:
    with pytest.raises(error, match=says(sentence)):
        make()
