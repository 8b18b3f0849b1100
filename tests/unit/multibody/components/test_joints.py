"""Each kind of joint between each two kinds of sides: it holds, and its reactions carry the loads."""

from itertools import product
from typing import NamedTuple

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.multibody.model.evaluate import constraint_rates, residual

SIDES = ("ground", "body", "mass", "beam", "cable")
ANGLES = {"ground": 0.2, "body": 0.4, "mass": 0.0, "beam": -0.5, "cable": 0.8}
ORIENTED = ("fixed", "prismatic", "angle")
KINDS = ("revolute", "distance", "x", "y", *ORIENTED)
LINE = 0.7  # angle of the line from a to b where the two do not coincide
TURN = 0.85  # first angle of a prescribed one, which the assembly turns the sides to
MOTION = (0.2, 1.5, -2.0)  # of a prescribed motion, but for its first value

PAIRS = [
    (kind, a, b)
    for kind, a, b in product(KINDS, SIDES, SIDES)
    if (a, b) != ("ground", "ground") and not (kind in ORIENTED and "mass" in (a, b))
]


class Mechanism(NamedTuple):
    system: mb.System
    sides: tuple[mb.Point | mb.GroundPoint, mb.Point | mb.GroundPoint]


def first_motion(joint: str, kind: str, other: str, first: bool) -> dict:
    """What a body states of its velocity: all where the other side is free to follow, else what the joint permits."""
    spins = {"body": 1.3, "beam": 0.7, "cable": -0.8}
    spin = {"angular_velocity": spins[kind]} if kind in spins else {}
    if other != "ground":
        velocity = {"body": (-0.1, 0.4), "mass": (0.3, -0.2)}
        return spin | ({"velocity": velocity[kind]} if kind in velocity else {}) if first else {}
    if joint == "prismatic":
        return {"velocity": (0.2 * np.cos(LINE), 0.2 * np.sin(LINE))}
    if joint == "angle":
        return {"velocity": (-0.1, 0.4)}
    return {} if joint == "fixed" else spin


def side(
    system: mb.System, kind: str, name: str, place: tuple[float, float], motion: dict
) -> mb.Point | mb.GroundPoint:
    """A point of a moving body of a kind, or of the ground."""
    angle = ANGLES[kind]
    section = {"density": 900.0, "height": 0.1, "width": 0.05}
    if kind == "ground":
        return system.ground.point(*place, angle)
    if kind == "mass":
        return system.add(mb.PointMass(name, 1.5, place, **motion)).centre
    if kind == "body":
        body = mb.RigidBody(name, 2.0, 0.3, place, angle, "grip", {"grip": (0.3, -0.2)}, **motion)
        return system.add(body).point("grip")
    if kind == "cable":
        cable = mb.AncfCable(name, 1.0, 2, 3e6, **section, angle=angle, start=place, **motion)
        return system.add(cable).start
    start = place[0] - 0.5 * np.cos(angle), place[1] - 0.5 * np.sin(angle)
    beam = mb.AncfBeam(name, 1.0, 2, 2e6, poisson_ratio=0.3, **section, angle=angle, start=start, **motion)
    return system.add(beam).node(1)


def joint(kind: str, a: mb.Point | mb.GroundPoint, b: mb.Point | mb.GroundPoint, turn: float) -> mb.Joint:
    if kind == "revolute":
        return mb.RevoluteJoint("joint", a, b)
    if kind == "fixed":
        return mb.FixedJoint("joint", a, b)
    if kind == "prismatic":
        return mb.PrismaticJoint("joint", a, b, angle=LINE - turn)
    if kind == "distance":
        return mb.DistanceJoint("joint", a, b)
    first = {"x": 0.4 * np.cos(LINE), "y": 0.4 * np.sin(LINE)}
    return mb.PrescribedMotion("joint", a, b, kind, mb.Polynomial([first.get(kind, TURN), *MOTION]))


def mechanism(kind: str, a: str, b: str) -> Mechanism:
    """Two sides under loads, joined."""
    system = mb.System(gravity=(0.7, -9.81))
    apart = 0.0 if kind in ("revolute", "fixed") else 0.4
    sides = (
        side(system, a, "a", (0.5, 0.3), first_motion(kind, a, b, True)),
        side(system, b, "b", (0.5 + apart * np.cos(LINE), 0.3 + apart * np.sin(LINE)), first_motion(kind, b, a, False)),
    )
    system.add(joint(kind, *sides, ANGLES[a]))
    for number, point in enumerate(sides):
        if isinstance(point, mb.Point):
            system.add(mb.Force(f"force {number}", point, x=mb.Harmonic(20.0, 90.0), y=-7.0))
            if point.body.turns:
                system.add(mb.Torque(f"torque {number}", point, 1.5 - 4 * number))
    return Mechanism(system, sides)


def place(trajectory: mb.Trajectory, point: mb.Point | mb.GroundPoint) -> np.ndarray:
    """Position and angle of a side over time, (3, samples)."""
    if isinstance(point, mb.GroundPoint):
        return np.array([point.x, point.y, point.angle])[:, None] * np.ones(len(trajectory.times))
    names = [f"{point}.{entry}" for entry in (("x", "y", "angle") if point.body.turns else ("x", "y"))]
    return np.vstack([trajectory.channels(names).T, np.zeros((3 - len(names), len(trajectory.times)))])


def gaps(kind: str, trajectory: mb.Trajectory, sides: tuple) -> list[np.ndarray]:
    """What a joint keeps at zero, from the channels of its sides."""
    a, b = (place(trajectory, point) for point in sides)
    dx, dy, turn = b - a
    t = trajectory.times
    course = t * (MOTION[0] + t * (MOTION[1] + t * MOTION[2]))
    if kind == "revolute":
        return [dx, dy]
    if kind == "fixed":
        return [dx, dy, turn - turn[0]]
    if kind == "distance":
        return [np.hypot(dx, dy) - 0.4]
    if kind == "prismatic":
        line = LINE + a[2] - a[2, 0]
        return [np.cos(line) * dy - np.sin(line) * dx, turn - turn[0]]
    return {
        "x": [dx - 0.4 * np.cos(LINE) - course],
        "y": [dy - 0.4 * np.sin(LINE) - course],
        "angle": [turn - TURN - course],
    }[kind]


def moved(kind: str, a: str, b: str) -> tuple[Mechanism, mb.Trajectory]:
    made = mechanism(kind, a, b)
    return made, mb.simulate(made.system, 0.02, mb.GeneralizedAlpha(step=1e-3))


@pytest.mark.parametrize(("kind", "a", "b"), PAIRS)
def test_it_holds_and_its_reactions_carry_the_loads(kind: str, a: str, b: str) -> None:
    made, trajectory = moved(kind, a, b)
    for gap in gaps(kind, trajectory, made.sides):
        np.testing.assert_allclose(gap, 0, atol=1e-10)
    assert trajectory.violations["velocity"][0] < 1e-12
    assert trajectory.violations["acceleration"][0] < 1e-10
    forces = trajectory.reactions("joint")
    places = [place(trajectory, point) for point in made.sides]
    states, n = trajectory.run.states, trajectory.lowered.structure.n
    for s in (0, 7, len(trajectory.times) - 1):
        free = states.x[s].copy()
        free[n:] = 0.0
        # Inertia, strain and loads without the joint, summed over the rigid motions of each body: force along x and y,
        # and moment about the origin.
        lowered = trajectory.lowered
        terms = residual(lowered, lowered.real, free, states.v[s], states.a[s], trajectory.times[s])
        for sign, point, own in zip((-1, 1), made.sides, places, strict=True):
            if isinstance(point, mb.GroundPoint):
                continue
            fx, fy, torque = sign * forces[s]
            # The two forces of a prescribed position act at each point; those of all others along one line, through b.
            x, y, _ = own[:, s] if kind in ("x", "y") else places[1][:, s]
            first = lowered.structure.first[point.body.name]
            mine = slice(first, first + point.body.size)
            modes = point.body.rigid_modes(free[mine], np.zeros(3))
            carried = np.array([fx, fy, x * fy - y * fx + torque])
            if not point.body.turns:
                modes[:, 2] = [-free[first + 1], free[first]]
            np.testing.assert_allclose(modes.T @ terms[mine], carried, rtol=0, atol=1e-8 * max(100, *np.abs(forces[s])))


@pytest.mark.parametrize(("kind", "a", "b"), PAIRS)
def test_its_rates_are_those_of_its_constraints(kind: str, a: str, b: str) -> None:
    made = mechanism(kind, a, b)
    lowered = mb.simulate(made.system, 1e-3, mb.GeneralizedAlpha(step=1e-3)).lowered
    n = lowered.structure.n
    noise = np.random.default_rng(3).normal(size=(3, n + 1))
    q, v, w = lowered.x.copy(), np.zeros_like(lowered.x), np.zeros_like(lowered.x)
    q[:n] += 0.05 * noise[0, :n]
    v[:n], w[:n] = noise[1, :n], 4 * noise[2, :n]
    still, at = np.zeros_like(q), 0.3

    def moving(t: float) -> tuple[np.ndarray, np.ndarray]:
        return q + v * t + w * t * t / 2, v + w * t

    def gap(t: float) -> np.ndarray:
        return residual(lowered, lowered.real, moving(t)[0], still, still, at + t)[n:]

    def rate(t: float) -> np.ndarray:
        return constraint_rates(lowered, lowered.real, *moving(t), w, at + t)[0]

    def slope(function, h: float = 5e-4) -> np.ndarray:
        return (8 * (function(h) - function(-h)) - function(2 * h) + function(-2 * h)) / (12 * h)

    first, second = constraint_rates(lowered, lowered.real, q, v, w, at)
    assert np.all(np.abs(first) > 1e-3)
    np.testing.assert_allclose(first, slope(gap), rtol=1e-8, atol=1e-9)
    np.testing.assert_allclose(second, slope(rate), rtol=1e-8, atol=1e-8)


def test_a_bare_ground_stands_where_the_other_side_does() -> None:
    system = mb.System()
    bar = system.add(mb.RigidBar("bar", 1.0, 2.0, start=(0.3, 0.4), angle=0.5))
    system.add(mb.RevoluteJoint("pin", system.ground, bar.end))
    trajectory = mb.simulate(system, 0.1)
    end = trajectory.channels(["bar.end.x", "bar.end.y"])
    np.testing.assert_allclose(end, np.full_like(end, 1) * (0.3 + np.cos(0.5), 0.4 + np.sin(0.5)), atol=1e-13)


def test_a_bar_that_spins_pulls_at_its_pin() -> None:
    system = mb.System(gravity=(0.0, 0.0))
    bar = system.add(mb.RigidBar("bar", 0.8, 3.0, angle=0.5, angular_velocity=4.0))
    system.add(mb.RevoluteJoint("pin", system.ground, bar.start))
    trajectory = mb.simulate(system, 0.2)
    angle = 0.5 + 4.0 * trajectory.times
    pull = 3.0 * 0.4 * 4.0**2
    given = np.stack([-pull * np.cos(angle), -pull * np.sin(angle), 0 * angle], axis=1)
    # The angle of this motion is exact; the acceleration is that of the angle, not of a discrete path.
    np.testing.assert_allclose(trajectory.reactions("pin"), given, atol=1e-3 * pull)
    np.testing.assert_allclose(trajectory.reactions("pin")[0], given[0], atol=1e-10)


def test_a_console_carries_weight_and_moment() -> None:
    system = mb.System()
    plate = system.add(mb.RigidBody("plate", 2.0, 0.1, points={"edge": (-0.3, 0.1)}))
    system.add(mb.FixedJoint("weld", system.ground, plate.point("edge")))
    weight = 2.0 * 9.81
    reactions = mb.simulate(system, 0.01).reactions("weld")
    np.testing.assert_allclose(reactions, np.tile([0, weight, 0.3 * weight], (1001, 1)), atol=1e-9)


def test_a_slide_carries_what_is_across_it() -> None:
    system = mb.System()
    slider = system.add(mb.RigidBody("slider", 2.0, 0.1))
    system.add(mb.PrismaticJoint("slide", system.ground, slider.centre, angle=-np.pi / 6))
    trajectory = mb.simulate(system, 0.3)
    along = 9.81 / 2 * trajectory.times**2 / 2
    np.testing.assert_allclose(trajectory.channels(["slider.centre.x"])[:, 0], along * np.cos(np.pi / 6), atol=1e-12)
    normal = 2.0 * 9.81 * np.cos(np.pi / 6)
    given = normal * np.array([np.sin(np.pi / 6), np.cos(np.pi / 6), 0.0])
    np.testing.assert_allclose(trajectory.reactions("slide"), np.tile(given, (1001, 1)), atol=1e-9)
