"""Reduced finite element bodies: full finite element models, beams, closed forms and conservation laws."""

from functools import cache

import numpy as np
from scipy.linalg import eigh

import dalembert.multibody as mb
import dalembert.multibody.spatial as sp
from dalembert.structure import (
    Dofs,
    FreeBodyModes,
    Material,
    Nodes,
    Structure,
    box,
    eigenmodes,
    free_body_modes,
    solid,
)

TOPIC = "Reduced bodies in space"
FULL = "full finite element model with rigid interfaces"
STEEL = Material(210e9, 0.3, 7800.0)
LENGTH, SIDE, MODULUS, DENSITY = 1.0, 0.02, 2e9, 1200.0
AREA, MOMENT = SIDE**2, SIDE**4 / 12


def chain(count: int) -> Structure:
    """A straight beam along x, of elements with the exact flexibility of Timoshenko's theory and lumped masses."""
    h, shear = LENGTH / count, MODULUS / 2.6
    axial, bend, turn = h / (MODULUS * AREA), h / (MODULUS * MOMENT), h / (shear * 0.1406 * SIDE**4)
    flexibility = np.diag([axial, 0.0, 0.0, turn, bend, bend])
    for across, about, sign in ((1, 5, 1.0), (2, 4, -1.0)):
        flexibility[across, across] = h * h * bend / 3 + h / (5 / 6 * shear * AREA)
        flexibility[across, about] = flexibility[about, across] = sign * h * bend / 2
    carry = np.eye(6)
    carry[1, 5], carry[2, 4] = h, -h
    part = np.hstack([-carry, np.eye(6)])
    stiffness, mass = np.zeros((2, 6 * count + 6, 6 * count + 6))
    for first in range(0, 6 * count, 6):
        stiffness[first : first + 12, first : first + 12] += part.T @ np.linalg.solve(flexibility, part)
        for end in (first, first + 6):
            own = 0.5 * DENSITY * h * np.array([*(AREA,) * 3, 2 * MOMENT, MOMENT, MOMENT])
            mass[end : end + 6, end : end + 6] += np.diag(own)
    names = tuple(f"{node}.{axis}" for node in range(count + 1) for axis in ("x", "y", "z", "rx", "ry", "rz"))
    places = np.linspace(0.0, 1.0, count + 1)[:, None] * np.array([LENGTH, 0.0, 0.0])
    return Structure(
        mass, (stiffness + stiffness.T) / 2, Dofs(names), nodes=Nodes(tuple(map(str, range(count + 1))), places)
    )


@cache
def bar() -> FreeBodyModes:
    """The chain with nodes at both ends."""
    return free_body_modes(chain(60), {"foot": "0", "tip": "60"}, modes=12)


def held(modes: FreeBodyModes, **options) -> sp.SpatialSystem:
    """A reduced body that is clamped at its foot."""
    system = sp.SpatialSystem(gravity=options.pop("gravity", (0.0, 0.0, 0.0)))
    body = system.add(sp.ReducedBody("body", modes, anchor="foot", **options))
    system.add(sp.FixedJoint("clamp", system.ground, body.point("foot")))
    return system


def test_a_clamped_plate_has_the_frequencies_of_the_full_model(record_evidence) -> None:
    plate = solid(box((0.5, 0.4, 0.01), (6, 5, 2)), STEEL)
    modes = free_body_modes(plate, {"foot": "left"}, modes=12)
    ours = mb.modes(held(modes)).frequencies[:6]
    full = eigenmodes(plate.fixed("left"), 6).frequencies
    record_evidence(
        "Clamped plate, 12 modes: first six frequencies", full, ours, unit="Hz", tolerance=1e-4, relative=True,
        topic=TOPIC, kind="other method", source=FULL,
    )  # fmt: skip


def crank() -> Structure:
    """An arm of solid elements that is bent in its plane."""
    mesh = box((0.3, 0.04, 0.03), (10, 3, 2))
    points = mesh.p.copy()
    points[1] += 0.06 * np.sin(np.pi * points[0] / 0.3)
    return solid(type(mesh)(points, mesh.t).with_boundaries({
        "left": lambda x: np.isclose(x[0], 0.0), "right": lambda x: np.isclose(x[0], 0.3),
    }), STEEL)  # fmt: skip


def test_a_free_crank_has_the_frequencies_of_the_full_model(record_evidence) -> None:
    arm = crank()
    modes = free_body_modes(arm, {"pin": "left", "rod": "right"}, modes=12)
    # The full model with both sides rigid, by all of its degrees of freedom.
    places = arm.nodes.places[arm.nodes.rows([name.partition(".")[0] for name in arm.dofs.names])]
    motions = np.zeros((2, arm.size, 6))
    for motion, side in zip(motions, ("left", "right"), strict=True):
        for row in arm.rows(side):
            axis = "xyz".index(arm.dofs.names[row][-1])
            motion[row] = [*np.eye(3)[axis], *(np.cross(unit, places[row])[axis] for unit in np.eye(3))]
    free = np.eye(arm.size)[:, np.setdiff1d(np.arange(arm.size), arm.rows(["left", "right"]))]
    basis = np.hstack([free, *motions])
    squares = eigh(*(basis.T @ (matrix @ basis) for matrix in (arm.stiffness, arm.mass)), eigvals_only=True)
    full = np.sqrt(np.clip(squares, 0.0, None))[6:12] / (2 * np.pi)
    system = sp.SpatialSystem(gravity=(0.0, 0.0, 0.0))
    system.add(sp.ReducedBody("crank", modes))
    frequencies = mb.modes(system).frequencies
    ours = frequencies[frequencies > 1e-3 * full[0]][:6]
    record_evidence(
        "Free crank, 12 modes: first six frequencies", full, ours, unit="Hz", tolerance=1e-4, relative=True,
        topic=TOPIC, kind="other method", source=FULL,
    )  # fmt: skip


def test_statics_are_those_of_beam_theory(record_evidence) -> None:
    system = held(bar())
    system.add(sp.Force("pull", system.bodies[0].point("tip"), y=0.02, z=-0.05))
    tip = mb.equilibrium(system).channels(["body.tip.y", "body.tip.z"])
    flexibility = LENGTH**3 / (3 * MODULUS * MOMENT) + LENGTH / (5 / 6 * MODULUS / 2.6 * AREA)
    record_evidence(
        "Small deflections of a clamped bar", flexibility * np.array([0.02, -0.05]), tip, unit="m", tolerance=1e-4,
        relative=True, topic=TOPIC, kind="closed form", source="Timoshenko's theory",
    )  # fmt: skip


def turning(reduced: bool, rate: float) -> tuple[sp.SpatialSystem, sp.Point, str]:
    """A system with a bar that turns about z, of the reduced body or of beam elements: its foot, and its tip's name."""
    system, spin = sp.SpatialSystem(gravity=(0.0, 0.0, 0.0)), (0.0, 0.0, rate)
    if reduced:
        body = system.add(sp.ReducedBody("body", bar(), anchor="foot", angular_velocity=spin))
        return system, body.point("foot"), "body.tip"
    shear = MODULUS / 2.6
    stiffness = (MODULUS * AREA, *(5 / 6 * shear * AREA,) * 2, shear * 0.1406 * SIDE**4, *(MODULUS * MOMENT,) * 2)
    section = sp.Section(stiffness, DENSITY * AREA, (DENSITY * MOMENT,) * 2)
    body = system.add(sp.Beam("body", section, LENGTH, elements=4, degree=3, angular_velocity=spin))
    return system, body.start, "body.end"


def spun(reduced: bool, rate: float) -> np.ndarray:
    """Places of the tip of a bar that is turned about its foot, from rest to a rate over a turn, then for two more."""
    system, foot, tip = turning(reduced, 0.0)
    rise = 2 * np.pi / rate
    motion = mb.Custom(
        lambda t: rate * ((t * t / 2 - (1 - np.cos(rate * t)) / rate**2) / rise if t < rise else t - rise / 2),
        lambda t: rate * ((t - np.sin(rate * t) / rate) / rise if t < rise else 1.0),
        lambda t: rate * ((1 - np.cos(rate * t)) / rise if t < rise else 0.0),
    )
    system.add(sp.RevoluteJoint("axis", system.ground, foot))
    system.add(sp.PrescribedMotion("drive", system.ground, foot, "angle", motion))
    motion = mb.simulate(system, 3 * rise, mb.GeneralizedAlpha(step=rise / 3000, spectral_radius=0.8))
    return motion.channels([f"{tip}.{axis}" for axis in "xyz"])


def test_a_bar_that_turns_is_that_of_beam_elements(record_evidence) -> None:
    rate = 0.1 * 2 * np.pi * bar().clamped_frequency
    ours, theirs = spun(True, rate), spun(False, rate)
    assert np.abs(theirs[:, 2]).max() < 1e-9
    record_evidence(
        "Bar that turns at a tenth of its first frequency, two turns: its tip", theirs, ours, unit="m",
        tolerance=1e-3 * LENGTH, topic=TOPIC, kind="other method", source="beam elements of degree 3",
    )  # fmt: skip


def test_frequencies_of_a_bar_that_turns(record_evidence) -> None:
    # The floating axes tilt with the deflection, which stiffens the bar by three quarters of what it should.
    still = 2 * np.pi * bar().clamped_frequency
    answers = []
    for reduced in (False, True):
        system, foot, _ = turning(reduced, 0.1 * still)
        hub = sp.Inertia.box(1e6, (1.0, 1.0, 1.0))
        hub = system.add(sp.RigidBody("hub", hub, angular_velocity=(0.0, 0.0, 0.1 * still)))
        system.add(sp.RevoluteJoint("axis", system.ground, hub.point("origin")))
        system.add(sp.FixedJoint("root", hub.point("origin"), foot))
        frequencies = 2 * np.pi * mb.modes(system, frame="rotating").frequencies
        answers.append(frequencies[frequencies > 0.2 * still][:2])
    record_evidence(
        "Frequencies of a bar that turns at a tenth of its first frequency", *answers, unit="rad/s", tolerance=2e-3,
        relative=True, topic=TOPIC, kind="other method", source="beam elements of degree 3",
    )  # fmt: skip


def test_a_free_tumbling_body_keeps_its_energy_and_momenta(record_evidence) -> None:
    # Soft enough that it vibrates by a part of its size: momenta of the masses themselves.
    rng = np.random.default_rng(3)
    places, masses = rng.uniform(-0.3, 0.3, (6, 3)), rng.uniform(0.1, 0.3, 6)
    places -= masses @ places / masses.sum()
    shapes = rng.uniform(-0.5, 0.5, (6, 3, 4))
    z = np.c_[np.ones(6), places]
    second = np.einsum("p,pia,pjb->ijab", masses, shapes, shapes)
    modes = FreeBodyModes(
        np.einsum("p,pi,pj->ij", masses, z, z), np.einsum("p,pi,pja->ija", masses, z, shapes), second,
        np.einsum("iiab->ab", second), np.diag([15.0, 25.0, 40.0, 60.0]), np.zeros((4, 4)), ("foot",), places[:1],
        np.concatenate([shapes[:1], rng.uniform(-1.0, 1.0, (1, 3, 4))], axis=1), np.zeros(3), places, shapes,
        np.zeros((0, 3), dtype=int),
    )  # fmt: skip
    system = sp.SpatialSystem(gravity=(0.0, 0.0, 0.0))
    body = system.add(sp.ReducedBody("body", modes, velocity=(0.1, -0.2, 0.3), angular_velocity=(3.0, -2.0, 4.0)))
    motion = mb.simulate(system, 3.0, mb.RadauIIA(tolerance=1e-11))
    energies, states = motion.energies, motion.states
    total = energies["kinetic"] + energies["potential"]
    axes, rates = (body.moving_axes(array[:, : body.size]) for array in (states.x, states.v))
    eta, speed = states.x[:, body.size - 4 : body.size], states.v[:, body.size - 4 : body.size]
    local = places + np.einsum("pja,fa->fpj", shapes, eta)
    points = axes[:, :1] + np.einsum("fpj,fjx->fpx", local, axes[:, 1:])
    moving = rates[:, :1] + np.einsum("fpj,fjx->fpx", local, rates[:, 1:])
    moving += np.einsum("pja,fa,fjx->fpx", shapes, speed, axes[:, 1:])
    momentum = np.einsum("p,fpx->fx", masses, moving)
    spin = np.einsum("p,fpx->fx", masses, np.cross(points, moving))
    assert np.abs(eta).max() > 0.05
    for name, unit, values in (("energy", "J", total), ("momentum", "kg m/s", momentum), ("spin", "kg m²/s", spin)):
        record_evidence(
            f"Tumbling body of six masses: {name}", values[0], values[-1], unit=unit,
            tolerance=1e-9 * np.abs(values).max(), topic=TOPIC, kind="conservation law", source="no force acts",
        )  # fmt: skip
        assert np.ptp(values, axis=0).max() < 1e-9 * np.abs(values).max()


def test_sensitivities_are_slopes(record_evidence) -> None:
    unit = bar()

    def build(modulus, density, ratio) -> sp.SpatialSystem:
        return held(unit.scaled(modulus, density), gravity=(0.0, 0.0, -9.81), damping_ratio=ratio)

    limits = {"modulus": (0.5, 2.0), "density": (0.5, 2.0), "ratio": (0.0, 0.1)}
    times, channels = np.linspace(0.0, 0.3, 7), ["body.tip.z", "body.tip.rotation_y"]
    model = mb.TimeResponse(build, limits, channels, times, mb.GeneralizedAlpha(step=1e-3))
    point, steps = np.array([1.0, 1.1, 0.02]), np.diag([1e-4, 1e-4, 1e-5])
    jacobian = model.jacobian(point)
    high, low = (model.evaluate(np.array([point + sign * step for step in steps])).only() for sign in (1.0, -1.0))
    slopes = np.moveaxis((high - low) / (2 * steps.sum(axis=1)[:, None, None]), 0, -1)
    record_evidence(
        "Derivatives by modulus, density and damping, over the largest", slopes / np.abs(slopes).max(),
        jacobian / np.abs(slopes).max(), tolerance=1e-6, topic=TOPIC, kind="other method", source="central differences",
    )  # fmt: skip
