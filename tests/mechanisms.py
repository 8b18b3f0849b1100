"""Mechanisms that several test files share: one piece a kind of component, and all pieces together."""

from collections.abc import Callable

import numba
import numpy as np

import dalembert.multibody as mb

SECTION = {"height": 0.1, "width": 0.05}


def beam(name: str, law: str = "plane-stress", damping: float = 0.0, **other) -> mb.AncfBeam:
    """A soft beam of two elements."""
    material = {"poisson_ratio": 0.3, "density": 900.0, "law": law, "damping": damping}
    return mb.AncfBeam(name, 1.0, 2, 2e5, **material, **SECTION, **other)


def cable(name: str, damping: float = 0.0, **placed) -> mb.AncfCable:
    """A soft cable of two elements."""
    return mb.AncfCable(name, 1.2, 2, 3e5, density=1100.0, **SECTION, damping=damping, **placed)


def plate(name: str = "plate", **placed) -> mb.RigidBody:
    """A rigid body with a point off its centre."""
    return mb.RigidBody(name, 2.0, 0.3, anchor="grip", points={"grip": (0.3, -0.2)}, **placed)


def wind(t, at, against):
    """A force and a torque by time, place, velocity, angle and angular velocity of both points; no potential."""
    fx = 2.0 * np.cos(3.0 * t) - at[2] * at[1] + against[0] * at[4]
    fy = at[0] * at[0] - 0.5 * at[3] + against[3] * at[5]
    return fx, fy, 0.3 * at[4] * at[0] - 0.1 * at[5] * t + 0.2 * against[5] * against[1] - against[2] * against[4]


#: The same function compiled.
compiled_wind = numba.njit(wind)


def _bodies(*bodies: mb.AncfBeam | mb.AncfCable | mb.RigidBody | mb.RigidBar | mb.PointMass) -> Callable:
    def add(system: mb.System) -> None:
        for body in bodies:
            system.add(body)

    return add


def _between(make: Callable) -> Callable:
    """Piece of the components that ``make`` gives for two sides: of bodies of all kinds and of the ground."""

    def add(system: mb.System) -> None:
        number = len(system.bodies)
        sides = (
            system.add(plate(f"{number}a", position=(0.1, 0.2), angle=0.3)).point("grip"),
            system.add(beam(f"{number}b", start=(1.0, -0.2), angle=0.5)).node(1),
            system.add(cable(f"{number}c", start=(0.4, 1.2), angle=-0.4)).end,
            system.ground.point(-0.3, 0.6, 0.2),
        )
        for a, b in ((0, 1), (2, 0), (1, 2), (3, 1), (2, 3)):
            system.add(make(f"{number}-{a}{b}", sides[a], sides[b]))

    return add


def _loads(make: Callable) -> Callable:
    """Piece of a load that ``make`` gives for a point of each kind of body."""

    def add(system: mb.System) -> None:
        number = len(system.bodies)
        points = (
            system.add(plate(f"{number}p", position=(0.1, 0.2), angle=0.3)).point("grip"),
            system.add(beam(f"{number}q", start=(1.0, -0.2), angle=0.5)).end,
            system.add(cable(f"{number}r", start=(0.4, 1.2), angle=-0.4)).node(1),
        )
        for place, point in enumerate(points):
            system.add(make(f"{number}-{place}", point))

    return add


def _on_wheels(make: Callable) -> Callable:
    """Piece of the components that ``make`` gives for two sides, of rigid bodies and of the ground."""

    def add(system: mb.System) -> None:
        number = len(system.bodies)
        wheels = [system.add(plate(f"{number}{k}", position=(0.3 * k, 0.2), angle=0.3 * k)) for k in range(2)]
        system.add(make(f"{number}-0", wheels[0].centre, wheels[1].centre))
        system.add(make(f"{number}-1", system.ground, wheels[1].centre))

    return add


def _gears(system: mb.System) -> None:
    """Gears between rigid bodies, and between one and the ground."""
    number = len(system.bodies)
    wheels = [system.add(plate(f"{number}{k}", position=(0.3 * k, 0.2), angle=0.3 * k)) for k in range(3)]
    for k in range(2):
        system.add(mb.GearJoint(f"{number}-{k}", wheels[k].centre, wheels[k + 1].centre, -0.4 - k))


WAVE = mb.Harmonic(2.0, 3.0, phase=0.4, offset=1.0)
RAMP = mb.Polynomial([0.1, -0.5, 2.0])

CONSERVATIVE = {
    "rigid bodies": _bodies(plate(), mb.RigidBar("bar", 1.3, 0.7, centre=0.3), mb.PointMass("mass", 1.5, (0.4, 2.0))),
    "beam, plane stress": _bodies(beam("stress")),
    "beam, plane strain": _bodies(beam("strain", "plane-strain", angle=0.7)),
    "beam, uncoupled": _bodies(beam("plain", "uncoupled", angle=-0.7)),
    "beam, continuum": _bodies(beam("published", formulation="continuum", angle=0.4)),
    "beam, continuum, plane strain": _bodies(beam("published strain", "plane-strain", formulation="continuum")),
    "cable": _bodies(cable("rope")),
    "revolute": _between(mb.RevoluteJoint),
    "fixed": _between(mb.FixedJoint),
    "prismatic": _between(lambda *sides: mb.PrismaticJoint(*sides, angle=0.6)),
    "distance": _between(mb.DistanceJoint),
    "prescribed x": _between(lambda *sides: mb.PrescribedMotion(*sides, coordinate="x", motion=RAMP)),
    "prescribed y": _between(lambda *sides: mb.PrescribedMotion(*sides, coordinate="y", motion=WAVE)),
    "prescribed angle": _between(lambda *sides: mb.PrescribedMotion(*sides, coordinate="angle", motion=WAVE)),
    "spring": _between(lambda *sides: mb.Spring(*sides, 30.0, free_length=0.7, cubic=50.0)),
    "torsion spring": _between(lambda *sides: mb.TorsionSpring(*sides, 20.0, free_angle=0.1, cubic=9.0)),
    "bushing": _between(lambda *sides: mb.Bushing(*sides, 30.0, 40.0, 6.0)),
    "gear": _gears,
    "force": _loads(lambda name, at: mb.Force(name, at, x=WAVE, y=3.0)),
}
DISSIPATIVE = {
    "damped beam, plane stress": _bodies(beam("damped stress", damping=0.02)),
    "damped beam, plane strain": _bodies(beam("damped strain", "plane-strain", damping=0.02, angle=0.7)),
    "damped beam, uncoupled": _bodies(beam("damped plain", "uncoupled", damping=0.02, angle=-0.7)),
    "damped beam, continuum": _bodies(beam("damped published", damping=0.02, formulation="continuum", angle=0.4)),
    "damped cable": _bodies(cable("damped rope", damping=0.03)),
    "pin friction": _between(
        lambda *sides: mb.RevoluteJoint(
            *sides, viscous=0.4, coulomb=0.3, friction_coefficient=0.2, pin_radius=0.1, slip_rate=0.8
        )
    ),
    "pin friction, Stribeck": _between(
        lambda *sides: mb.RevoluteJoint(
            *sides,
            coulomb=0.3,
            friction_coefficient=0.2,
            pin_radius=0.1,
            slip_rate=0.8,
            stribeck=0.5,
            stribeck_rate=0.9,
            stribeck_exponent=1.3,
        )
    ),
    "slide friction, Stribeck": _between(
        lambda *sides: mb.PrismaticJoint(*sides, viscous=0.4, slip_velocity=0.7, stribeck=0.5, stribeck_velocity=0.9)
    ),
    "slide friction": _between(
        lambda *sides: mb.PrismaticJoint(
            *sides, angle=0.6, viscous=0.4, coulomb=0.3, friction_coefficient=0.2, slip_velocity=0.7
        )
    ),
    "damped bushing": _between(lambda *sides: mb.Bushing(*sides, 30.0, 40.0, 6.0, 2.0, 3.0, 0.4)),
    "damped spring": _between(lambda *sides: mb.Spring(*sides, 30.0, damping=2.0)),
    "damped torsion spring": _between(lambda *sides: mb.TorsionSpring(*sides, 20.0, damping=1.5)),
    "follower force": _loads(lambda name, at: mb.Force(name, at, x=2.0, y=WAVE, follower=True)),
    "torque": _loads(lambda name, at: mb.Torque(name, at, WAVE)),
    "torque between": _between(lambda name, a, b: mb.Torque(name, a, RAMP, against=b)),
    "motor": _between(
        lambda *sides: mb.Motor(*sides, torque_constant=0.4, resistance=0.8, gear_ratio=-3.0, voltage=WAVE)
    ),
    "motor with a current": _between(lambda *sides: mb.Motor(*sides, torque_constant=0.4, current=WAVE, enabled=0.7)),
    "geared motor": _on_wheels(
        lambda *sides: mb.Motor(
            *sides,
            torque_constant=0.4,
            resistance=0.8,
            back_emf=0.3,
            voltage_limit=2.0,
            gear_ratio=3.0,
            efficiency=0.7,
            slip_rate=0.9,
            armature_inertia=0.05,
            voltage=WAVE,
        )
    ),
    "servo": _between(
        lambda *sides: mb.Servo(
            *sides, torque_constant=0.4, resistance=0.8, voltage_limit=3.0, goal=WAVE, kp=5.0, kd=0.2, dead_band=0.1
        )
    ),
    "user force": _loads(lambda name, at: mb.UserForce(name, at, compiled_wind)),
    "user force between": _between(lambda name, a, b: mb.UserForce(name, a, compiled_wind, against=b)),
}
PIECES = CONSERVATIVE | DISSIPATIVE


def mechanism(*pieces: str) -> mb.System:
    """A system of some of the pieces; its joints are not closed."""
    system = mb.System(gravity=(0.7, -9.81))
    for piece in pieces:
        PIECES[piece](system)
    return system
