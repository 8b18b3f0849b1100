"""Beams in space: an independent shooting method, closed forms, published tables and published motions."""

import numpy as np
import pytest

import dalembert.multibody as mb
import dalembert.multibody.spatial as sp
from beam_shooting import shoot
from dalembert.multibody.spatial import Beam, FixedJoint, NodePoint, Orientation, Section, SpatialSystem
from momenta import momenta

TOPIC = "Beams in space"
TIP = ("b.end.x", "b.end.y", "b.end.z")
SHOOTING = "shooting on the beam's differential equation, DOP853, 1e-12"


def given(stretch, shear, twist, bending) -> Section:
    """A section by its stiffnesses; its inertia does not matter in statics."""
    return Section((stretch, shear, shear, twist, *bending), 1.0, (1.0, 1.0))


def coupled() -> Section:
    """A section with all entries of its stiffness matrix."""
    noise = np.random.default_rng(4).standard_normal((6, 6))
    roots = np.sqrt([1e4, 4e3, 5e3, 1.0, 2.0, 1.5])
    matrix = np.outer(roots, roots) * (np.eye(6) + 0.125 * (noise + noise.T))
    return Section(matrix, 1.0, (1.0, 1.0))


def square(ratio: float) -> Section:
    """A square section of a beam of length one, its side one over the ratio."""
    e, h = 2e11, 1.0 / ratio
    shear, moment = e / 2.6, h**4 / 12
    return given(e * h * h, 5 / 6 * shear * h * h, shear * 0.1406 * h**4, (e * moment, e * moment))


def clamped(
    section: Section, length: float, elements: int, degree: int, force=(0.0, 0.0, 0.0), **shape
) -> SpatialSystem:
    """A beam along x, clamped at its start, with a dead force at its end."""
    system = SpatialSystem(gravity=shape.pop("gravity", (0.0, 0.0, 0.0)))
    beam = system.add(Beam("b", section, length, elements, degree, **shape))
    system.add(FixedJoint("clamp", system.ground, beam.start))
    system.add(sp.Force("pull", beam.end, *map(float, force)))
    return system


def varying(s) -> np.ndarray:
    """Twist and curvatures that change along the line."""
    return np.array([0.5 * s, 0.3 + s * s, 2.0 - s])


THIN, THICK = square(1000.0), square(5.0)
CASES = {
    "45° bend": (given(1e7, 5e6, 5e6 / 6, (1e7 / 12,) * 2), 100 * np.pi / 4, (0, 0, 600.0), (0.0, 0.0, 0.01)),
    "cantilever 1:1000": (THIN, 1.0, (0, 0, 4 * THIN.matrix[4, 4]), (0.0, 0.0, 0.0)),
    "cantilever 1:5": (THICK, 1.0, (0, 0, 4 * THICK.matrix[4, 4]), (0.0, 0.0, 0.0)),
    "helix, full matrix": (coupled(), 1.0, (1.2, -2.0, 2.4), (1.0, 0.6, 2.0)),
    "curvature that varies": (coupled(), 1.0, (1.2, -2.0, 2.4), varying),
}
"""Section, length, force at the tip and curvature."""


def tip_by_shooting(section, length, force, curvature) -> np.ndarray:
    along = curvature if callable(curvature) else lambda s: np.array(curvature)
    return shoot(length, section.matrix, force=force, curvature=along)


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_tips_of_clamped_beams_converge_with_twice_the_degree(record_evidence, case):
    """Errors with four and eight elements fall by 2^(2 p); with eight cubic ones they are below 1e-6 of the length."""
    section, length, force, curvature = CASES[case]
    expected = tip_by_shooting(section, length, force, curvature)
    orders, tips = [], {}
    for degree in (1, 2, 3):
        errors = []
        for elements in (4, 8):
            rest = mb.equilibrium(clamped(section, length, elements, degree, force, curvature=curvature))
            tips[degree] = rest.channels(TIP)
            errors.append(np.linalg.norm(tips[degree] - expected))
        orders.append(np.log2(errors[0] / errors[1]))
    record_evidence(
        f"{case}, orders of degrees 1, 2 and 3", [2.0, 4.0, 6.0], orders, tolerance=0.4, topic=TOPIC,
        kind="target", source="twice the degree",
    )  # fmt: skip
    record_evidence(
        f"{case}, tip with eight cubic elements", expected, tips[3], unit="m", tolerance=1e-6 * length, topic=TOPIC,
        kind="other method", source=SHOOTING,
    )  # fmt: skip


@pytest.mark.slow
def test_beam_under_its_weight(record_evidence):
    """q L^3 / (E I) = 8: the tip of a slender cantilever under a load along its length."""
    load = 8 * THIN.matrix[4, 4]
    expected = shoot(1.0, THIN.matrix, load=(0.0, 0.0, load))
    rest = mb.equilibrium(clamped(THIN, 1.0, 6, 3, gravity=(0.0, 0.0, load)))
    record_evidence(
        "Cantilever under its weight, tip, six cubic elements", expected, rest.channels(TIP), unit="m",
        tolerance=2e-6, topic=TOPIC, kind="other method", source=SHOOTING,
    )  # fmt: skip


def test_a_moment_bends_a_beam_to_a_circle(record_evidence):
    """The moment 2 pi E I / L turns the end once: the line is a circle of the length L, closed."""
    moment = 2 * np.pi * THIN.matrix[5, 5]
    system = clamped(THIN, 1.0, 6, 4)
    system.add(sp.Torque("turn", system.bodies[0].end, z=moment))
    rest = mb.equilibrium(system)
    record_evidence(
        "Full circle by an end moment, tip, six elements of degree 4", np.zeros(3), rest.channels(TIP), unit="m",
        tolerance=1e-6, topic=TOPIC, kind="closed form", source="a circle of the circumference L",
    )  # fmt: skip
    middle = rest.channels(["b.node12.y"])[0]
    record_evidence(
        "Full circle by an end moment, height of the middle", 1 / np.pi, middle, unit="m", tolerance=1e-6, topic=TOPIC,
        kind="closed form", source="diameter L / pi",
    )  # fmt: skip


@pytest.mark.slow
def test_one_element_has_the_exact_flexibility(record_evidence):
    """Six small loads at the tip of a straight beam with a full stiffness matrix: integral of H^T C^-1 H."""
    section, degree, size = coupled(), 2, 1e-6
    at, weights = np.polynomial.legendre.leggauss(4)
    exact = np.zeros((6, 6))
    for share, weight in zip(0.5 + 0.5 * at, 0.5 * weights, strict=True):
        arm = 1.0 - share
        carry = np.eye(6)  # force and moment at a section from those at the tip
        carry[4, 2], carry[5, 1] = -arm, arm
        exact += weight * carry.T @ np.linalg.inv(section.matrix) @ carry
    flexibility = []
    names = [*TIP, "b.end.rotation_x", "b.end.rotation_y", "b.end.rotation_z"]
    for load in np.eye(6):
        system = clamped(section, 1.0, 1, degree, size * load[:3])
        system.add(sp.Torque("turn", system.bodies[0].end, *map(float, size * load[3:])))
        moved = mb.equilibrium(system).channels(names) - [1.0, 0, 0, 0, 0, 0]
        flexibility.append(moved / size)
    record_evidence(
        "Flexibility matrix of one quadratic element, all entries over the largest", exact / np.abs(exact).max(),
        np.array(flexibility).T / np.abs(exact).max(), tolerance=1e-5, topic=TOPIC, kind="closed form",
        source="integral of H^T C^-1 H, small loads",
    )  # fmt: skip


def test_princeton_beam(record_evidence):
    """A strip that is loaded obliquely bends about both axes and twists; published beam of another program."""
    length, high, wide = 0.508, 12.3777e-3, 3.2024e-3
    section = Section.rectangle(wide, high, youngs_modulus=71.7e9, poisson_ratio=0.31, density=2700.0)
    force = 13.345 * np.array([0.0, np.sin(np.pi / 4), np.cos(np.pi / 4)])
    tip = mb.equilibrium(clamped(section, length, 2, 3, force)).channels(TIP)
    record_evidence(
        "Princeton beam, 13.345 N at 45°, tip across", [0.156467, 0.015186], tip[1:], unit="m", tolerance=3e-4,
        topic=TOPIC, kind="published", source="Dowell and Traybar 1975; beam of a finite element program",
    )  # fmt: skip


def test_torsion_and_bending_frequencies(record_evidence):
    """A cantilever 1:5: torsion (2 k - 1) / (4 L) sqrt(G J / (rho I_p)), and bending by Timoshenko's equation."""
    side, e, shear = 0.2, 1.0, 1 / 2.6
    area, moment, torsion = side**2, side**4 / 12, 0.1406 * side**4
    stiffness = (e * area, 5 / 6 * shear * area, 5 / 6 * shear * area, shear * torsion, e * moment, e * moment)
    system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    beam = system.add(Beam("b", Section(stiffness, area, (moment, moment)), 1.0, 4, 3))
    system.add(FixedJoint("clamp", system.ground, beam.start))
    found = 2 * np.pi * mb.modes(system).frequencies
    record_evidence(
        "Torsion of a cantilever, first frequency", np.pi / 2 * np.sqrt(shear * torsion / (2 * moment)), found[2],
        unit="rad/s", tolerance=1e-6, topic=TOPIC, kind="closed form", source="sqrt(G J / (rho I_p)) pi / (2 L)",
    )  # fmt: skip
    first = _timoshenko(e * moment, 5 / 6 * shear * area, area, moment, found[0])
    record_evidence(
        "Bending of a cantilever 1:5, first frequency", first, found[0], unit="rad/s", tolerance=1e-6, topic=TOPIC,
        kind="closed form", source="Timoshenko's equation",
    )  # fmt: skip


def _timoshenko(bending, shear, mass, rotatory, near) -> float:
    """The frequency of a cantilever of length one near a guess: where the boundary conditions are singular."""
    from scipy.linalg import expm
    from scipy.optimize import brentq

    def determinant(omega: float) -> float:
        # y = (w, psi, M, Q): w' = psi + Q / kGA, psi' = M / EI, M' = -Q - rho I omega^2 psi, Q' = -rho A omega^2 w.
        rates = np.zeros((4, 4))
        rates[0, 1], rates[0, 3], rates[1, 2] = 1.0, 1 / shear, 1 / bending
        rates[2, 1], rates[2, 3], rates[3, 0] = -rotatory * omega**2, -1.0, -mass * omega**2
        return float(np.linalg.det(expm(rates)[2:, 2:]))

    return brentq(determinant, 0.9 * near, 1.1 * near, xtol=1e-14)


@pytest.mark.slow
def test_rotating_beam(record_evidence):
    """First frequencies of flapping of a blade at four speeds, sqrt(rho A L^4 / E I) omega."""
    slender, found = 2e-3, []
    section = Section((1 / slender**2,) + (0.5 / slender**2,) * 2 + (1.0, 1.0, 4.0), 1.0, (slender**2,) * 2)
    for speed in (0.0, 3.0, 6.0, 12.0):
        system, spin = SpatialSystem(gravity=(0.0, 0.0, 0.0)), (0.0, 0.0, speed)
        hub = system.add(sp.RigidBody("hub", sp.Inertia.box(1e4, (1.0, 1.0, 1.0)), angular_velocity=spin))
        system.add(sp.RevoluteJoint("axis", system.ground, hub.point("origin"), axis=(0.0, 0.0, 1.0)))
        blade = system.add(Beam("b", section, 1.0, 2, 3, angular_velocity=spin))
        system.add(FixedJoint("root", hub.point("origin"), blade.start))
        frequencies = 2 * np.pi * (mb.modes(system, frame="rotating") if speed else mb.modes(system)).frequencies
        found.append(frequencies[np.argmin(np.abs(frequencies - (3.516, 4.797, 7.360, 13.170)[len(found)]))])
    record_evidence(
        "Rotating cantilever, flapping at 0, 3, 6 and 12", [3.5160, 4.7973, 7.3604, 13.1702], found, tolerance=1e-3,
        topic=TOPIC, kind="published", source="Wright, Smith, Thresher and Wang 1982",
    )  # fmt: skip


def test_whirl_of_a_shaft(record_evidence):
    """A thick shaft turns between a hub with a universal joint and a sliding bearing.

    With u = U sin(k x) and rotations R cos(k x) in the fixed frame, a Timoshenko shaft has det = 0 of
    [-rho A w^2 + G A k^2, -G A k; -G A k, E I k^2 + G A - rho I w^2 + 2 rho I speed w].
    """
    speed, radius, density, e = 2000.0, 0.05, 7800.0, 2e11
    area, moment = np.pi * radius**2, np.pi * radius**4 / 4
    stretch, shear, bending = e * area, 0.9 * e / 2.6 * area, e * moment
    mass, inertia = density * area, density * moment
    section = Section((stretch, shear, shear, 2 * e / 2.6 * moment, bending, bending), mass, (inertia, inertia))
    system, spin = SpatialSystem(gravity=(0.0, 0.0, 0.0)), (speed, 0.0, 0.0)
    hub = system.add(sp.RigidBody("hub", sp.Inertia.box(1e-3, (0.1, 0.1, 0.1)), angular_velocity=spin))
    shaft = system.add(Beam("shaft", section, 1.0, 4, 4, angular_velocity=spin))
    system.add(sp.RevoluteJoint("bearing", system.ground, hub.point("origin"), axis=(1.0, 0.0, 0.0)))
    axes = {"axis_a": (0.0, 1.0, 0.0), "axis_b": (0.0, 0.0, 1.0)}
    system.add(sp.UniversalJoint("left", hub.point("origin"), shaft.start, **axes))
    end = system.ground.point((1.0, 0.0, 0.0))
    system.add(sp.PointOnLineJoint("right", end, shaft.end, axis=(1.0, 0.0, 0.0)))
    frequencies = 2 * np.pi * mb.modes(system, frame="rotating").frequencies
    expected = []
    for k in (np.pi, 2 * np.pi):
        row = [-inertia, 2 * inertia * speed, bending * k * k + shear]
        whirl = np.polysub(np.polymul([-mass, 0.0, shear * k * k], row), [(shear * k) ** 2])
        expected += sorted(abs(root.real - speed) for root in np.roots(whirl) if abs(root) < 1e4)
    found = [frequencies[np.argmin(np.abs(frequencies - one))] for one in expected]
    record_evidence(
        "Whirl of a shaft at 2000 rad/s: forward and backward, two modes, in the rotating frame", expected, found,
        unit="rad/s", tolerance=1e-5, relative=True, topic=TOPIC, kind="closed form", source="rotating Timoshenko shaft",
    )  # fmt: skip


def test_elbow_in_motion(record_evidence):
    """An elbow of two beams, pushed out of its plane for two seconds, swings by more than its length."""
    section = Section((1e6, 1e6, 1e6, 1e3, 1e3, 1e3), 1.0, (10.0, 10.0))
    system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    corner = NodePoint("end", orientation=Orientation.by_angles("z", np.pi / 2))
    first = system.add(Beam("a", section, 10.0, 4, 2, points={"corner": corner}))
    second = system.add(Beam("b", section, 10.0, 4, 2, position=first.point("corner")))
    system.add(FixedJoint("clamp", system.ground, first.start))
    system.add(FixedJoint("weld", first.point("corner"), second.start))
    push = mb.Table([0.0, 1.0, 2.0, 40.0], [0.0, 50.0, 0.0, 0.0], interpolation="linear")
    system.add(sp.Force("push", first.end, z=push))
    motion = mb.simulate(system, 17.0, mb.GeneralizedAlpha(step=1e-2, spectral_radius=0.95))
    tip = motion.channels(["b.end.z"])[:, 0]
    record_evidence(
        "Elbow in motion, largest and smallest tip", [8.25, -9.73], [tip.max(), tip.min()], unit="m", tolerance=0.05,
        topic=TOPIC, kind="published", source="Simo and Vu-Quoc 1988; 40 linear elements a leg",
    )  # fmt: skip
    total = motion.energies["total"][motion.times > 2.05]
    record_evidence(
        "Elbow in motion, change of its energy after the push", 0.0, np.ptp(total) / total[0], tolerance=1e-4,
        topic=TOPIC, kind="conservation law", source="energy of a free motion",
    )  # fmt: skip


def test_gradient_by_an_unknown_history(record_evidence):
    """The tip of a cantilever is pushed by a spline; the gradient by its coefficients, by the adjoint."""

    def build(**coefficients):
        system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
        section = Section.rectangle(0.02, 0.01, youngs_modulus=2e9, poisson_ratio=0.3, density=1000.0)
        beam = system.add(Beam("b", section, 1.0, 2, 2, curvature=(0.4, 0.3, 0.0)))
        system.add(FixedJoint("clamp", system.ground, beam.start))
        push = mb.BSpline(np.array(list(coefficients.values())), 0.0, 0.2)
        system.add(sp.Force("push", beam.end, z=push))
        return system

    names, times = ["b.end.x", "b.end.z", "b.end.rotation_x", "clamp.torque_2"], np.linspace(0.0, 0.2, 41)
    box = {f"c{k}": (-5.0, 5.0) for k in range(20)}
    model = mb.TimeResponse(build, box, names, times, mb.GeneralizedAlpha(1e-3))
    chance = np.random.default_rng(4)
    vector, cotangent = chance.normal(size=20), chance.normal(size=(41, 4))
    exact = np.einsum("sc,scp->p", cotangent, model.jacobian(vector))
    gradient = model.pullback(vector)[1](cotangent)
    record_evidence(
        "Gradient of a beam's motion by 20 coefficients of a load, by the adjoint: largest difference", 0.0,
        np.abs(gradient - exact).max() / np.abs(exact).max(), tolerance=1e-9, topic=TOPIC,
        kind="other method", source="direct sensitivities by dual numbers",
    )  # fmt: skip


@pytest.mark.slow
def test_in_a_plane_it_is_the_planar_beam(record_evidence):
    """A pendulum of one material and section, by beams in space and in the plane, while it bends by a third."""
    length, side, e = 1.0, 0.05, 2e6
    section = Section.rectangle(side, side, youngs_modulus=e, poisson_ratio=0.0, density=1000.0)
    system = SpatialSystem()
    beam = system.add(Beam("b", section, length, 4, 3))
    system.add(sp.RevoluteJoint("pin", system.ground, beam.start, axis=(0.0, 1.0, 0.0)))
    flat = mb.System()
    bar = flat.add(mb.AncfBeam("b", length, 8, e, 0.0, 1000.0, side, side))
    flat.add(mb.RevoluteJoint("pin", flat.ground, bar.start))
    times, solver = np.array([0.3, 0.6]), mb.RadauIIA(tolerance=1e-9)
    ours = mb.simulate(system, 0.6, solver, times=times).channels(["b.end.x", "b.end.z"])
    expected = mb.simulate(flat, 0.6, solver, times=times).channels(["b.end.x", "b.end.y"])
    record_evidence(
        "Flexible pendulum in a plane, tip", expected, ours, unit="m", tolerance=2e-3, topic=TOPIC,
        kind="other method", source="planar shear-deformable elements with Green's stretch",
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("body", ["beam", "cable"])
def test_a_free_flight_keeps_energy_over_100000_steps(record_evidence, body):
    """A curved beam and a slack cable that tumble and vibrate, without gravity and damping."""
    system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    if body == "beam":
        section = Section.rectangle(0.02, 0.01, youngs_modulus=2e9, poisson_ratio=0.3, density=1200.0)
        system.add(Beam("b", section, 1.0, 1, 2, curvature=(0.0, 0.0, 0.3), angular_velocity=(1.0, 4.0, 3.0)))
    else:
        fields = {"axial_stiffness": 2e4, "bending_stiffness": 0.1, "mass_per_length": 0.2, "span": 0.9}
        system.add(sp.Cable("b", 1.0, 2, angular_velocity=(1.0, 4.0, 3.0), **fields))
    motion = mb.simulate(system, 100.0, mb.EnergyMomentum(step=1e-3), times=np.linspace(0.0, 100.0, 2001))
    assert len(motion.newton_iterations) >= 100_000
    energy = motion.energies["kinetic"] + motion.energies["potential"]
    common = {"topic": TOPIC, "kind": "conservation law", "source": "energy of a free motion"}
    record_evidence(
        f"Free {body}, 100,000 steps of 1 ms: range of its energy",
        0.0,
        np.ptp(energy) / energy[0],
        tolerance=1e-10,
        **common,
    )
    conserved = momenta(motion)
    record_evidence(
        f"Free {body}, 100,000 steps of 1 ms: range of its momenta by the largest", 0.0,
        np.ptp(conserved, axis=0).max() / np.abs(conserved).max(), tolerance=1e-8, **common,
    )  # fmt: skip
    trend = np.polyfit(motion.times, energy / energy[0], 1)[0] * 100.0
    record_evidence(f"Free {body}, 100,000 steps of 1 ms: trend of its energy", 0.0, trend, tolerance=2e-11, **common)
