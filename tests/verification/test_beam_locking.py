"""Beams that must not lock: a thin strip that sags, cantilevers of every slenderness, rolling up to a circle."""

import numpy as np
import pytest
from scipy.integrate import solve_bvp

import dalembert as da
import dalembert.multibody.spatial as sp

TOPIC = "Beams without locking"
LENGTH, HEIGHT, WIDTH = 0.52, 1e-3, 0.08
MODULUS, DENSITY, GRAVITY = 2e11, 7870.0, 9.81
STIFFNESS, LINE_MASS = MODULUS * WIDTH * HEIGHT**3 / 12, DENSITY * WIDTH * HEIGHT
STRIP = {"youngs_modulus": MODULUS, "density": DENSITY, "height": HEIGHT, "width": WIDTH}


def elastica() -> tuple[float, float]:
    """Sag (m) and first frequency (Hz) of the strip, clamped level, as an inextensible elastica under its weight.

    Boundary value problems over the arc: the angle and the place at rest; then small motions about them, with the
    frequency as a parameter. Shear and rotatory inertia of a strip 520 times as long as high are below 1e-5.
    """
    weight, arc = LINE_MASS * GRAVITY, np.linspace(0.0, LENGTH, 101)

    def rest(s, state):
        angle, turn, _ = state
        return np.array([turn, weight * (LENGTH - s) * np.cos(angle) / STIFFNESS, np.sin(angle)])

    def clamped(start, end):
        return np.array([start[0], start[2], end[1]])

    bent = solve_bvp(rest, clamped, arc, np.zeros((3, len(arc))), tol=1e-9)

    def moving(s, state, squares):
        angle = bent.sol(s)[0]
        turned, moment, fx, fy, u, v = state
        force = -weight * (LENGTH - s)
        return np.array(
            [
                moment / STIFFNESS,
                np.sin(angle) * (fx + force * turned) - np.cos(angle) * fy,
                -LINE_MASS * squares[0] * u,
                -LINE_MASS * squares[0] * v,
                -np.sin(angle) * turned,
                np.cos(angle) * turned,
            ]
        )

    def ends(start, end, squares):
        return np.array([start[0], start[4], start[5], end[1], end[2], end[3], end[5] - 1e-3])

    guess = np.zeros((6, len(arc)))
    guess[5] = 1e-3 * (arc / LENGTH) ** 2
    guess[0] = 2e-3 * arc / LENGTH**2
    guess[1] = STIFFNESS * 2e-3 / LENGTH**2 * (1 - arc / LENGTH)
    small = solve_bvp(moving, ends, arc, guess, p=[(2 * np.pi * 3.0) ** 2], tol=1e-8)
    assert bent.success
    assert small.success
    return -bent.sol(LENGTH)[2], np.sqrt(small.p[0]) / (2 * np.pi)


def strip(kind: str, elements: int) -> da.System | sp.SpatialSystem:
    if kind == "cable in space":
        space = sp.SpatialSystem(gravity=(0.0, 0.0, -GRAVITY))
        wire = space.add(sp.Cable("bar", LENGTH, elements, MODULUS * HEIGHT * WIDTH, LINE_MASS, STIFFNESS))
        space.add(sp.FixedJoint("clamp", space.ground, wire.start))
        return space
    system = da.System(gravity=(0.0, -GRAVITY))
    if kind == "beam":
        bar = system.add(da.AncfBeam("bar", LENGTH, elements, poisson_ratio=0.3, **STRIP))
    else:
        bar = system.add(da.AncfCable("bar", LENGTH, elements, **STRIP))
    system.add(da.FixedJoint("clamp", system.ground, bar.start))
    return system


@pytest.mark.parametrize("kind", ["beam", "cable", "cable in space"])
def test_a_thin_strip_sags_and_swings_as_an_elastica(record_evidence, kind: str) -> None:
    sag, frequency = elastica()
    assert frequency == pytest.approx(3.0234, abs=2e-4)
    assert sag == pytest.approx(0.042115, abs=1e-6)
    system = strip(kind, 2)
    common = {"relative": True, "topic": TOPIC, "kind": "other code", "source": "elastica by SciPy's solve_bvp"}
    name = f"steel strip of 520 × 80 × 1 mm, level under its weight (2 elements: {kind})"
    up, mode = ("y", 0) if isinstance(system, da.System) else ("z", 1)  # in space the first mode is sideways
    ours = -np.ravel(da.equilibrium(system).channels([f"bar.end.{up}"]))[0]
    record_evidence(f"{name}, sag", sag, ours, unit="m", tolerance=2e-3, **common)
    record_evidence(
        f"{name}, first frequency", frequency, da.modes(system).frequencies[mode], unit="Hz", tolerance=2e-3, **common
    )


@pytest.mark.parametrize("law", ["plane-stress", "plane-strain", "uncoupled"])
def test_cantilevers_of_every_slenderness_with_one_element(record_evidence, law: str) -> None:
    """Loads so small that deflections are proportional to them."""
    modulus, ratio, length, width = 2e8, 0.3, 2.0, 0.2
    slenderness, ours, exact = (2.0, 5.0, 20.0, 200.0), [], []
    for part in slenderness:
        height = length / part
        area, second = height * width, height**3 * width / 12
        gravity = 1e-5 / part**2
        system = da.System(gravity=(0.0, -gravity))
        section = {"density": 5540.0, "height": height, "width": width, "law": law}
        bar = system.add(da.AncfBeam("bar", length, 1, modulus, poisson_ratio=ratio, **section))
        system.add(da.FixedJoint("clamp", system.ground, bar.start))
        ours.append(-np.ravel(da.equilibrium(system).channels(["bar.end.y"]))[0] / gravity)
        effective, nu = (modulus / (1 - ratio**2), ratio / (1 - ratio)) if law == "plane-strain" else (modulus, ratio)
        stiff = 10 * (1 + nu) / (12 + 11 * nu) * modulus / (2 * (1 + ratio)) * area
        exact.append(5540.0 * area * (length**4 / (8 * effective * second) + length**2 / (2 * stiff)))
    record_evidence(
        f"cantilevers of length/height 2, 5, 20, 200 under their weight, {law}: deflection over Timoshenko's (1 beam)",
        np.ones(4),
        np.array(ours) / exact,
        tolerance=1e-4,
        topic=TOPIC,
        kind="closed form",
        source="Timoshenko beam, shear factor of Cowper (1966)",
    )


def circle(slenderness: float, elements: int) -> np.ndarray:
    """Errors (m) of the nodes of a cantilever of length 1 m that a moment rolls up to a circle."""
    height = 1 / slenderness
    system = da.System(gravity=(0.0, 0.0))
    section = {"density": 1.0, "height": height, "width": 1.0, "poisson_ratio": 0.3}
    bar = system.add(da.AncfBeam("bar", 1.0, elements, 12 / height**3, **section))
    system.add(da.FixedJoint("clamp", system.ground, bar.start))
    system.add(da.Torque("moment", bar.end, 2 * np.pi))
    names = [f"bar.node{k}.{axis}" for k in range(1, elements + 1) for axis in "xy"]
    turn = 2 * np.pi * np.arange(1, elements + 1) / elements
    exact = np.column_stack([np.sin(turn), 1 - np.cos(turn)]).ravel() / (2 * np.pi)
    return np.ravel(da.equilibrium(system).channels(names)) - exact


@pytest.mark.parametrize("slenderness", [10.0, 1000.0], ids=["thick", "thin"])
def test_a_beam_rolls_up_to_a_circle(record_evidence, slenderness: float) -> None:
    coarse, fine = circle(slenderness, 8), circle(slenderness, 16)
    common = {"topic": TOPIC, "kind": "closed form", "source": "circle of radius E I / M"}
    name = f"cantilever of length/height {slenderness:g} rolled up to a circle by a moment"
    record_evidence(f"{name}, x and y of its nodes (16 beams)", 0 * fine, fine, unit="m", tolerance=1e-4, **common)
    order = np.log2(np.abs(coarse).max() / np.abs(fine).max())
    record_evidence(f"{name}, order in the length of a beam (8 and 16)", 4.0, order, tolerance=0.15, **common)
