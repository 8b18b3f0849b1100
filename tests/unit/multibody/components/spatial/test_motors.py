"""Motors in space against closed forms and against motors in the plane."""

import numpy as np
import pytest

import dalembert.multibody as mb
import dalembert.multibody.spatial as sp
from dalembert.errors import InputError
from support import says

INERTIA, CONSTANT, RESISTANCE = 2e-3, 0.05, 0.8
SOLVER = mb.RungeKutta4(1e-3)
TIMES = np.linspace(0.0, 1.0, 21)
CHANNELS = [f"motor.{name}" for name in ("angle", "rate", "torque", "current", "voltage")]


def disc(axis=(0.0, 0.0, 1.0), viscous=None, **fields) -> sp.SpatialSystem:
    """A disc on a bearing that a motor turns about an axis."""
    system = sp.SpatialSystem()
    body = system.add(sp.RigidBody("disc", sp.Inertia(1.0, (INERTIA,) * 3)))
    sides = system.ground, body.point("origin")
    friction = None if viscous is None else sp.Friction(viscous=viscous)
    system.add(sp.RevoluteJoint("bearing", *sides, axis=axis, friction=friction))
    fields = {"torque_constant": CONSTANT, "resistance": RESISTANCE} | fields
    system.add(sp.Motor("motor", *sides, axis=axis, **fields))
    return system


def flat_disc(**fields) -> mb.System:
    """The same in the plane."""
    system = mb.System()
    body = system.add(mb.RigidBody("disc", mass=1.0, inertia=INERTIA))
    system.add(mb.RevoluteJoint("bearing", system.ground, body.centre))
    system.add(mb.Motor("motor", system.ground, body.centre, torque_constant=CONSTANT, resistance=RESISTANCE, **fields))
    return system


def test_a_motor_reaches_its_rate_with_its_time_constant() -> None:
    voltage, ratio, back_emf, armature, viscous = 2.0, 4.0, 0.04, 1e-4, 0.02
    fields = {"voltage": voltage, "gear_ratio": ratio, "back_emf": back_emf, "armature_inertia": armature}
    run = mb.simulate(disc((0.3, -0.5, 0.8), viscous, **fields), TIMES[-1], SOLVER, TIMES)
    angle, rate, torque, current, _ = run.channels(CHANNELS).T
    braking = ratio**2 * CONSTANT * back_emf / RESISTANCE + viscous
    steady = ratio * CONSTANT * voltage / RESISTANCE / braking
    constant = (INERTIA + ratio**2 * armature) / braking
    np.testing.assert_allclose(rate, steady * (1 - np.exp(-TIMES / constant)), atol=1e-7)
    np.testing.assert_allclose(angle, steady * (TIMES - constant * (1 - np.exp(-TIMES / constant))), atol=1e-6)
    np.testing.assert_allclose(current, (voltage - back_emf * ratio * rate) / RESISTANCE, rtol=1e-9)
    np.testing.assert_allclose(torque, ratio * CONSTANT * current, rtol=1e-9)
    kinetic = (INERTIA + ratio**2 * armature) / 2 * rate**2
    np.testing.assert_allclose(run.energies["kinetic"], kinetic, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize(
    "fields",
    [
        {"voltage": mb.Harmonic(2.0, 5.0), "gear_ratio": 4.0, "armature_inertia": 1e-4, "efficiency": 0.7},
        {
            "voltage": mb.Harmonic(6.0, 5.0),
            "voltage_limit": 4.0,
            "gear_ratio": -3.0,
            "slip_rate": 0.9,
            "efficiency": 0.8,
        },
        {"current": mb.Harmonic(0.3, 4.0), "enabled": mb.Step(1.0, 0.0, 0.5)},
    ],
)
def test_it_is_the_motor_of_the_plane(fields: dict) -> None:
    space, plane = (
        mb.simulate(system, 1.0, SOLVER, TIMES).channels(CHANNELS) for system in (disc(**fields), flat_disc(**fields))
    )
    np.testing.assert_allclose(space, plane, atol=1e-6 * np.abs(plane).max())


def test_the_armature_turns_with_the_output_relative_to_a_free_stator() -> None:
    """Without other torques: J_a w_a + J_b w_b = 0, and n^2 J (w_b - w_a) is the momentum of the armature on each."""
    ratio, armature, stator, torque, end = 3.0, 4e-4, 5e-3, 0.02, 0.5
    system = sp.SpatialSystem(gravity=(0.0, 0.0, 0.0))
    first = system.add(sp.RigidBody("stator", sp.Inertia(1.0, (stator,) * 3)))
    second = system.add(sp.RigidBody("rotor", sp.Inertia(1.0, (INERTIA,) * 3)))
    sides, axis = (first.point("origin"), second.point("origin")), (0.2, 0.5, 1.0)
    system.add(sp.RevoluteJoint("bearing", *sides, axis=axis))
    current = torque / (ratio * CONSTANT)
    system.add(
        sp.Motor(
            "motor",
            *sides,
            axis=axis,
            torque_constant=CONSTANT,
            current=current,
            gear_ratio=ratio,
            armature_inertia=armature,
        )
    )
    rate = mb.simulate(system, end, SOLVER, np.array([0.0, end])).channels(["motor.rate"])[-1, 0]
    reduced = 1 / (1 / stator + 1 / INERTIA)
    assert rate == pytest.approx(torque * end / (reduced + ratio**2 * armature), rel=1e-8)


def test_wrong_inputs() -> None:
    with pytest.raises(InputError, match=says("motor 'motor': both voltage and current was given; give one of them")):
        disc(voltage=1.0, current=1.0)
    with pytest.raises(InputError, match=says("motor 'motor': gear_ratio is 0; expected a number other than zero")):
        disc(voltage=1.0, gear_ratio=0.0)
