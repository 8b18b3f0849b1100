"""Beams against closed forms: large deflections, rolling up, frequencies."""

import numpy as np
import pytest

import dalembert as da

TOPIC = "Beams"


def slender(elements: int, height: float, angle: float = 0.0) -> tuple[da.System, da.AncfCable]:
    """A cable of length 1 m and bending stiffness 1 N m^2, without gravity."""
    system = da.System(gravity=(0.0, 0.0))
    modulus = 12 / height**3
    return system, system.add(
        da.AncfCable("bar", 1.0, elements, modulus, density=1 / height, height=height, width=1.0, angle=angle)
    )


def end(system: da.System) -> np.ndarray:
    """x, y and angle of the end in equilibrium."""
    return np.ravel(da.equilibrium(system).channels(["bar.end.x", "bar.end.y", "bar.end.angle"]))


def test_cantilever_under_an_end_force(reference, record_evidence) -> None:
    """So slender that stretch, load height² / 12 = 3e-6, does not show in the printed digits.

    The slenderer, the finer the mesh must be before the error falls with the fourth power of the element's length: at
    this height it is 4e-4, 2e-5 and 3e-6 (the stretch) with 16, 32 and 64 elements.
    """
    data = reference("cantilever")
    table = data["end_force"]
    ours = []
    for load in table["load"]:
        system, bar = slender(elements=64, height=2e-3)
        system.add(da.FixedJoint("clamp", system.ground, bar.start))
        system.add(da.Force("load", bar.end, y=-load))
        x, y, angle = end(system)
        ours.append([-y, 1 - x, -angle])
    units = {"deflection": "m", "shortening": "m", "rotation": "rad"}
    for (name, unit), values in zip(units.items(), np.transpose(ours), strict=True):
        record_evidence(
            f"cantilever, {name} of the end for P L²/(E I) = 1 … 10 (64 cables)",
            table[name],
            values,
            unit=unit,
            tolerance=1e-5,
            topic=TOPIC,
            kind=data["kind"],
            source=data["source"],
        )


@pytest.mark.parametrize("part", [0.25, 0.5], ids=["quarter circle", "half circle"])
def test_a_bar_rolls_up_under_an_end_moment(record_evidence, part: float) -> None:
    system, bar = slender(elements=16, height=1e-2)
    system.add(da.FixedJoint("clamp", system.ground, bar.start))
    turn = 2 * np.pi * part
    system.add(da.Torque("moment", bar.end, turn))
    record_evidence(
        f"cantilever rolled up to {part:g} of a circle by a moment, x and y of the end (16 cables)",
        [np.sin(turn) / turn, (1 - np.cos(turn)) / turn],
        end(system)[:2],
        unit="m",
        tolerance=1e-5,
        topic=TOPIC,
        kind="closed form",
        source="circle of radius E I / M",
    )


@pytest.mark.parametrize("support", ["cantilever", "simply_supported"])
def test_frequencies_of_slender_beams(reference, record_evidence, support: str) -> None:
    data = reference("beam_frequencies")

    def frequencies(elements: int) -> np.ndarray:
        system, bar = slender(elements, height=1e-2, angle=0.3)
        if support == "cantilever":
            system.add(da.FixedJoint("clamp", system.ground, bar.start))
        else:
            system.add(da.RevoluteJoint("left", system.ground, bar.start))
            system.add(da.RevoluteJoint("right", system.ground, bar.end))
        return da.modes(system).frequencies[:4]

    exact = np.square(data["wave_numbers"][support]) / (2 * np.pi)
    coarse, fine = frequencies(16), frequencies(32)
    common = {"topic": TOPIC, "kind": data["kind"], "source": data["source"]}
    name = f"{support.replace('_', ' ')} beam"
    record_evidence(
        f"{name}, first four frequencies (32 cables)", exact, fine, unit="Hz", tolerance=2e-5, relative=True, **common
    )
    order = np.log2((coarse[3] - exact[3]) / (fine[3] - exact[3]))
    record_evidence(
        f"{name}, order of the fourth frequency in the length of a cable", 4.0, order, tolerance=0.1, **common
    )


def timoshenko(height: float, modes: np.ndarray, poisson_ratio: float = 0.0, shear_factor: float = 1.0) -> np.ndarray:
    """Frequencies (Hz) of a simply supported beam, length, modulus, density and width 1.

    The lower root of  A w^4 - B w^2 + C = 0  with a = n pi: A = (r I)(m)/(k G A), C = a^4 E I,
    B = m + a^2 (r I + m E I / (k G A)).
    """
    area, second = height, height**3 / 12
    shear = shear_factor * area / (2 * (1 + poisson_ratio))
    a = np.pi * modes
    first, middle, last = second * area / shear, area + a**2 * (second + area * second / shear), a**4 * second
    return np.sqrt((middle - np.sqrt(middle**2 - 4 * first * last)) / (2 * first)) / (2 * np.pi)


def supported(elements: int, **material) -> np.ndarray:
    """First two frequencies (Hz) of a simply supported thick beam."""
    system = da.System(gravity=(0.0, 0.0))
    bar = system.add(da.AncfBeam("bar", 1.0, elements, 1.0, density=1.0, height=0.2, width=1.0, **material))
    system.add(da.RevoluteJoint("left", system.ground, bar.start))
    system.add(da.RevoluteJoint("right", system.ground, bar.end))
    return da.modes(system).frequencies[:2]


THICK = {
    "unit": "Hz",
    "relative": True,
    "topic": TOPIC,
    "kind": "closed form",
    "source": "Timoshenko, Phil. Mag. 41 (1921), simply supported beam",
}


def test_frequencies_of_a_thick_beam(record_evidence) -> None:
    exact = timoshenko(0.2, np.array([1.0, 2.0]), 0.3, shear_factor=10 * 1.3 / 15.3)
    coarse, fine = (supported(n, poisson_ratio=0.3) for n in (8, 16))
    name = "thick simply supported beam (L/H = 5)"
    record_evidence(f"{name}, first two frequencies (16 beams)", exact, fine, tolerance=2e-5, **THICK)
    order = np.log2((coarse - exact) / (fine - exact))
    record_evidence(
        f"{name}, order of the first two frequencies in the length of a beam",
        [4.0, 4.0],
        order,
        tolerance=0.1,
        topic=TOPIC,
        kind=THICK["kind"],
        source=THICK["source"],
    )


@pytest.mark.slow
def test_frequencies_of_a_thick_beam_as_a_continuum(record_evidence) -> None:
    """The published element has shear and rotatory inertia of its section, with shear factor 1.

    Its curvature converges slowly, with the square of the element's length, so two meshes are extrapolated.
    """

    coarse, fine = (supported(n, poisson_ratio=0.0, formulation="continuum") for n in (16, 32))
    record_evidence(
        "thick simply supported beam (L/H = 5), first two frequencies (16 and 32 beams as a continuum, extrapolated)",
        timoshenko(0.2, np.array([1.0, 2.0])),
        fine + (fine - coarse) / 3,
        tolerance=1e-4,
        **THICK,
    )
