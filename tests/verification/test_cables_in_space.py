"""Cables in space: catenaries, strings, hanging chains, the planar cable, and a free flight."""

import numpy as np
from scipy.optimize import brentq, fsolve
from scipy.special import j0, y0

import dalembert.multibody as mb
import dalembert.multibody.spatial as sp

TOPIC = "Cables in space"
GRAVITY = 9.81


def hung(length: float, elements: int, end: tuple[float, float, float], **fields) -> sp.SpatialSystem:
    """A cable between the origin and another point."""
    span = float(np.linalg.norm(end))
    azimuth, elevation = np.arctan2(end[1], end[0]), np.arcsin(end[2] / span)
    turn = sp.Orientation.by_angles("zy", [azimuth, -elevation])
    system = sp.SpatialSystem(gravity=(0.0, 0.0, fields.pop("gravity", -GRAVITY)))
    cable = system.add(sp.Cable("rope", length, elements, span=span, orientation=turn, **fields))
    system.add(sp.SphericalJoint("left", system.ground, cable.start))
    system.add(sp.SphericalJoint("right", system.ground.point(end), cable.end))
    system.add(sp.CableSensor("load", cable.start))
    return system


def catenary(length: float, stiffness: float, weight: float, across: float, up: float, s: np.ndarray) -> np.ndarray:
    """Place (2, points) of material points of an elastic catenary (Irvine 1981), and its force at the start."""

    def place(h, v, s):
        first, second = v / h, (v - weight * s) / h
        x = h * s / stiffness + h / weight * (np.arcsinh(first) - np.arcsinh(second))
        lift = weight * s / stiffness * (v / weight - s / 2) + h / weight * (np.hypot(1, first) - np.hypot(1, second))
        return np.array([x, -lift])

    h, v = fsolve(lambda hv: place(*hv, length) - [across, up], [weight * length, 0.5 * weight * length], xtol=1e-13)
    return place(h, v, s), np.array([h, v])


def test_a_slack_cable_is_an_elastic_catenary(record_evidence):
    """Between points of different height, in an oblique vertical plane; stretched by its weight by a percent."""
    length, stiffness, mass, end = 3.0, 1500.0, 1.0, np.array([1.2, 1.6, 0.5])
    across = float(np.hypot(*end[:2]))
    exact, force = catenary(length, stiffness, mass * GRAVITY, across, end[2], length * np.arange(9) / 8)
    counts, errors = (8, 16, 32), []
    for elements in counts:
        system = hung(length, elements, tuple(end), axial_stiffness=stiffness, mass_per_length=mass)
        rest = mb.equilibrium(system)
        nodes = range(0, elements + 1, elements // 8)
        x, y, z = (rest.channels([f"rope.node{k}.{axis}" for k in nodes]) for axis in "xyz")
        errors.append(np.abs([np.hypot(x, y) - exact[0], z - exact[1]]).max())
        assert np.ptp(np.arctan2(y[1:], x[1:])) < 1e-9  # in one plane
    order = np.log2(errors[0] / errors[2]) / 2
    common = {"topic": TOPIC, "kind": "closed form", "source": "elastic catenary; Irvine, Cable Structures (1981)"}
    record_evidence("Slack cable, order of its places", 4.0, order, tolerance=0.6, **common)
    record_evidence(
        "Slack cable of 32 elements, error of its places", 0.0, errors[2], unit="m", tolerance=1e-5, **common
    )
    tension = rest.channels(["load.tension"])[0]
    record_evidence(
        "Slack cable of 32 elements, tension at its start", np.hypot(*force), tension, unit="N", tolerance=1e-4,
        relative=True, **common,
    )  # fmt: skip


def test_frequencies_of_a_string_with_bending(record_evidence):
    """f_n = n / (2 L) sqrt(T / m + n^2 pi^2 E I / (m L^2)), twice each: along y and along z."""
    length, tension, mass, bending = 2.0, 40.0, 0.1, 0.5
    stiffness = 1e8
    n, found = np.arange(1, 5), []
    exact = n / (2 * length) * np.sqrt((tension + n**2 * np.pi**2 * bending / length**2) / mass)
    for elements in (8, 16, 32):
        system = hung(
            length / (1 + tension / stiffness), elements, (length, 0.0, 0.0), axial_stiffness=stiffness,
            mass_per_length=mass, bending_stiffness=bending, gravity=0.0,
        )  # fmt: skip
        found.append(mb.modes(mb.equilibrium(system)).frequencies[:8])
    errors = np.abs(np.array(found) / np.repeat(exact, 2) - 1).max(axis=1)
    common = {"topic": TOPIC, "kind": "closed form", "source": "sine shapes of a beam under tension"}
    order = np.log2(errors[0] / errors[2]) / 2
    record_evidence("String with bending stiffness, order of its frequencies", 4.0, order, tolerance=0.4, **common)
    record_evidence(
        "String with bending stiffness, first four frequencies, along y and z", np.repeat(exact, 2), found[-1],
        unit="Hz", tolerance=1e-4, relative=True, **common,
    )  # fmt: skip


def test_frequencies_of_a_chain_under_its_weight(record_evidence):
    """Vertical, with a weight at its end that a guide keeps on the vertical.

    With the tension T(s) the shape is a sum of J0 and Y0 of 2 omega / g sqrt(T / m); both ends are at rest.
    """
    length, mass, bob = 1.5, 0.3, 0.2
    low, high = (2 / GRAVITY * np.sqrt(weight * GRAVITY / mass) for weight in (bob, bob + mass * length))

    def gap(rate):
        return j0(rate * low) * y0(rate * high) - j0(rate * high) * y0(rate * low)

    rates = np.linspace(1.0, 40.0, 400)
    signs = np.flatnonzero(np.diff(np.sign(gap(rates))))[:3]
    exact = [brentq(gap, rates[k], rates[k + 1], xtol=1e-12) for k in signs]
    system = sp.SpatialSystem()
    down = sp.Orientation.by_angles("y", [np.pi / 2])
    chain = system.add(sp.Cable("chain", length, 16, axial_stiffness=1e8, mass_per_length=mass, orientation=down))
    weight = system.add(sp.PointMass("bob", bob, chain.end))
    system.add(sp.SphericalJoint("hook", system.ground, chain.start))
    system.add(sp.SphericalJoint("knot", chain.end, weight.point("centre")))
    system.add(sp.PointOnLineJoint("guide", system.ground.point((0.0, 0.0, -1.0)), weight.point("centre")))
    found = 2 * np.pi * mb.modes(mb.equilibrium(system)).frequencies[:6]
    record_evidence(
        "Chain under its weight, first three frequencies, along x and y", np.repeat(exact, 2), found, unit="rad/s",
        tolerance=1e-4, relative=True, topic=TOPIC, kind="closed form", source="Bessel's functions J0 and Y0",
    )  # fmt: skip


def test_in_a_plane_it_is_the_planar_cable(record_evidence):
    """A soft pendulum with damping, beside the planar element: the same forces."""
    times = np.linspace(0.0, 0.5, 26)
    material = {"youngs_modulus": 1e7, "density": 1000.0, "height": 0.02, "width": 0.02, "damping": 0.01}
    flat = mb.System()
    bar = flat.add(mb.AncfCable("rope", 1.0, 4, **material))
    flat.add(mb.RevoluteJoint("pin", flat.ground, bar.start))
    system = sp.SpatialSystem()
    rope = system.add(
        sp.Cable(
            "rope", 1.0, 4, axial_stiffness=1e7 * 4e-4, bending_stiffness=1e7 * 1.6e-7 / 12, mass_per_length=0.4,
            damping=0.01,
        )
    )  # fmt: skip
    system.add(sp.SphericalJoint("pin", system.ground, rope.start))
    integrator = mb.GeneralizedAlpha(step=1e-3)
    planar = mb.simulate(flat, 0.5, integrator, times=times).channels(["rope.end.x", "rope.end.y"])
    ours = mb.simulate(system, 0.5, integrator, times=times).channels(["rope.end.x", "rope.end.z"])
    record_evidence(
        "Flexible pendulum in a plane, tip", planar, ours, unit="m", tolerance=1e-9, topic=TOPIC, kind="other method",
        source="the planar cable element",
    )  # fmt: skip


def test_a_cable_that_flies_keeps_its_energy_and_momenta(record_evidence):
    """Thrown, spinning about two axes and vibrating, without gravity."""
    system = sp.SpatialSystem(gravity=(0.0, 0.0, 0.0))
    fields = {"axial_stiffness": 200.0, "bending_stiffness": 0.05, "mass_per_length": 0.5, "span": 0.8}
    rope = system.add(sp.Cable("rope", 1.0, 4, angular_velocity=(1.0, 4.0, 2.0), **fields))
    motion = mb.simulate(system, 1.0, mb.RadauIIA(tolerance=1e-10), times=np.linspace(0.0, 1.0, 51))
    energy = motion.energies["kinetic"] + motion.energies["potential"]
    nodes, rates = (part[:, :30].reshape(51, -1, 2, 3) for part in (motion.states.x, motion.states.v))
    spin = angular_momentum(nodes, rates, rope)
    common = {"topic": TOPIC, "kind": "conservation law", "source": "a free motion"}
    record_evidence(
        "Flying cable, energy", np.full(51, energy[0]), energy, unit="J", tolerance=1e-7, relative=True, **common
    )
    record_evidence(
        "Flying cable, angular momentum", np.tile(spin[0], (51, 1)), spin, unit="kg*m^2/s",
        tolerance=1e-8 * np.abs(spin).max(), **common,
    )  # fmt: skip


def angular_momentum(nodes: np.ndarray, rates: np.ndarray, cable: sp.Cable) -> np.ndarray:
    """Integral of m r x r' over the line, (times, 3), by Gauss' rule of four points: exact for cubics."""
    h, (places, weights) = cable.length / cable.elements, np.polynomial.legendre.leggauss(4)
    total = np.zeros((len(nodes), 3))
    for share, weight in zip((places + 1) / 2, weights / 2, strict=True):
        shape = np.array([1 - 3 * share**2 + 2 * share**3, h * share * (1 - share) ** 2,
                          3 * share**2 - 2 * share**3, h * share**2 * (share - 1)])  # fmt: skip
        for element in range(cable.elements):
            r, v = (part[:, element : element + 2].reshape(len(part), 4, 3) for part in (nodes, rates))
            r, v = (np.einsum("k,tkc->tc", shape, part) for part in (r, v))
            total += weight * h * cable.mass_per_length * np.cross(r, v)
    return total
