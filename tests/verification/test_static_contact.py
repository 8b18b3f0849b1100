"""Static contact of a rigid sphere with an elastic half-space: Hertz, and Cattaneo and Mindlin."""

import numpy as np
import pytest

from dalembert.structure import Dofs, Structure
from dalembert.vibration import ElasticSlider, FrictionContact, StaticForce, VibrationSystem, static_contact
from lap_joint import bars, lap_joint

TOPIC = "Interfaces of many contacts"
MODULUS, RADIUS, PRESS, FRICTION = 70e9, 0.1, 400.0, 0.4  # Pa, m, N; Poisson's ratio 0
CONTACT = (3 * PRESS * RADIUS / (4 * MODULUS)) ** (1 / 3)  # m
PRESSURE = 3 * PRESS / (2 * np.pi * CONTACT**2)  # Pa
SIDE, COUNT = 2.5 * CONTACT, 24
HERTZ = "Hertz: a³ = 3 P R / (4 E), p0 = 3 P / (2 π a²)"
MINDLIN = "Cattaneo, Mindlin: c³/a³ = 1-Q/(μP), δ = 3μP(2-ν)/(16Ga)·(1-(1-Q/(μP))^(2/3))"


def over_a_square(x: np.ndarray, y: np.ndarray, half: float) -> np.ndarray:
    """The integral of 1/r over a square with its centre at the origin, seen from a point of the plane."""
    total = np.zeros_like(x)
    for sx in (1.0, -1.0):
        for sy in (1.0, -1.0):
            u, v = x + sx * half, y + sy * half
            r = np.hypot(u, v)
            total += sx * sy * (u * np.log(v + r) + v * np.log(u + r))
    return total


def half_space(push: float) -> tuple[VibrationSystem, np.ndarray, float]:
    """Square patches of the surface of a half-space under a sphere: the system, their radii, and their area.

    The body of the half-space, ``base``, is pressed on the sphere and pushed aside.
    """
    step = SIDE / COUNT
    places = (np.arange(COUNT) + 0.5) * step - SIDE / 2
    x, y = (axis.ravel() for axis in np.meshgrid(places, places))
    # Boussinesq: w = (1 - ν²) / (π E) ∫ p / r; Cerruti with ν = 0: u = 1 / (2 π G) ∫ q / r, G = E / 2: the same.
    kernel = over_a_square(x[:, None] - x, y[:, None] - y, step / 2) / (np.pi * MODULUS * step**2)
    names, blocks = [], []
    for axis in "xz":
        stiffness = np.linalg.inv((kernel + kernel.T) / 2)
        sums = stiffness.sum(axis=1)
        blocks.append(np.block([[stiffness, -sums[:, None]], [-sums[None], np.full((1, 1), sums.sum())]]))
        names += [f"p{k}.{axis}" for k in range(len(x))] + [f"base.{axis}"]
    zero = np.zeros_like(blocks[0])
    stiffness = np.block([[blocks[0], zero], [zero, blocks[1]]])
    system = VibrationSystem(Structure(np.eye(len(names)), (stiffness + stiffness.T) / 2, Dofs(tuple(names))))
    system.add(StaticForce("base.z", PRESS))
    if push:
        system.add(StaticForce("base.x", push))
    radii = np.hypot(x, y)
    stiff = 50 * MODULUS * step
    for k, radius in enumerate(radii):
        law = ElasticSlider(stiff, stiff, gap=float(radius**2 / (2 * RADIUS)))
        system.add(FrictionContact(f"c{k}", f"p{k}", normal="z", friction=FRICTION, law=law))
    return system, radii, step**2


def radius_of(area: float, count: int) -> float:
    """Radius of a circle with the area of some patches."""
    return float(np.sqrt(count * area / np.pi))


def test_a_sphere_that_is_pressed_on_a_half_space(record_evidence):
    system, radii, area = half_space(0.0)
    joint = static_contact(system)
    record_evidence(
        "sphere on a half-space of 576 patches: sum of the normal forces", PRESS, float(joint.normal.sum()),
        tolerance=1e-10, relative=True, topic=TOPIC, unit="N", kind="conservation law", source="the force that presses",
    )  # fmt: skip
    closed = int(np.sum(joint.states > 0))
    record_evidence(
        "sphere on a half-space of 576 patches: radius of contact", CONTACT, radius_of(area, closed),
        tolerance=0.03, relative=True, topic=TOPIC, unit="m", kind="closed form", source=HERTZ,
    )  # fmt: skip
    middle = float(np.mean(joint.normal[radii < 0.15 * CONTACT]) / area)
    record_evidence(
        "sphere on a half-space of 576 patches: pressure in the middle", PRESSURE, middle,
        tolerance=0.03, relative=True, topic=TOPIC, unit="Pa", kind="closed form", source=HERTZ,
    )  # fmt: skip


@pytest.mark.parametrize("part", [0.3, 0.7])
def test_the_rim_slips_where_the_sphere_is_pushed_aside(record_evidence, part: float):
    push = part * FRICTION * PRESS
    system, _, area = half_space(push)
    joint = static_contact(system)
    stuck = radius_of(area, int(np.sum(joint.states == 1)))
    record_evidence(
        f"sphere pushed aside by {part:g} of the limit: radius that sticks", CONTACT * (1 - part) ** (1 / 3), stuck,
        tolerance=0.05, relative=True, topic=TOPIC, unit="m", kind="closed form", source=MINDLIN,
    )  # fmt: skip
    exact = 3 * FRICTION * PRESS * 2 / (16 * MODULUS / 2 * CONTACT) * (1 - (1 - part) ** (2 / 3))
    record_evidence(
        f"sphere pushed aside by {part:g} of the limit: displacement of the body", exact, joint.displacement("base.x"),
        tolerance=0.03, relative=True, topic=TOPIC, unit="m", kind="closed form", source=MINDLIN,
    )  # fmt: skip
    np.testing.assert_allclose(joint.friction.sum(), push, rtol=1e-10)


def test_bolts_press_the_faces_of_a_lap_joint(record_evidence):
    mesh, between = bars(4, 2)
    joint = static_contact(lap_joint(mesh, mesh, between, force=0.0, bolt=10_000.0))
    record_evidence(
        "lap joint: sum of the normal forces on the bar that contacts alone hold", 20_000.0 + len(between),
        float(joint.normal.sum()), tolerance=1e-10, relative=True, topic=TOPIC, unit="N", kind="conservation law",
        source="the force of two bolts, and 1 N of each contact",
    )  # fmt: skip
