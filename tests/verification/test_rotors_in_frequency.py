"""Rotors in frequency, beside closed forms: unbalance, whirl, thresholds of internal damping, and an annular rub."""

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import dalembert as da
from dalembert.structure import Disc, RotatingDamper, Structure, lumped, with_rotors
from dalembert.vibration import Newmark, steady_state

TOPIC = "Rotors in frequency"
MASS, STIFFNESS, OUTER, INNER, ECCENTRICITY = 2.0, 800.0, 3.0, 1.5, 1e-4  # kg, N/m, N s/m, N s/m, m
CRITICAL = np.sqrt(STIFFNESS / MASS)  # rad/s
JEFFCOTT = "Jeffcott rotor: (k - m Ω² + i Ω c) z = m e Ω²"
SOURCES = {
    "whirl": "I (θ'' + ...) with M_x = I_p Ω θ_y', M_y = -I_p Ω θ_x': two complex equations",
    "threshold": "Ω = ω (1 + c_outer/c_inner), where m z'' + (c_o+c_i) z' + (k-iΩc_i) z = 0 begins to grow",
    "rub": "(k-mΩ²+iΩc)z + k_s(1-g/|z|)(1+iμ)z = meΩ², for |z|",
}


def jeffcott(inner: float = INNER) -> Structure:
    """A disc on an isotropic shaft, whose internal damping turns with it."""
    axes = ("disc.x", "disc.y")
    rotor = lumped(dict.fromkeys(axes, MASS), [(axis, None, STIFFNESS, OUTER) for axis in axes])
    return with_rotors(rotor, [RotatingDamper(*axes, inner)])


def unbalanced(inner: float = INNER) -> da.VibrationSystem:
    system = da.VibrationSystem(jeffcott(inner), speed="synchronous")
    system.add(da.Unbalance("disc.x", "disc.y", moment=MASS * ECCENTRICITY))
    return system


def test_the_unbalance_response_of_a_jeffcott_rotor(record_evidence):
    # Internal damping turns with the whirl, and does not feel it.
    speeds = np.linspace(0.2, 2.8, 27) * CRITICAL
    curve = da.frequency_response(unbalanced(), speeds / (2 * np.pi), da.HarmonicBalance(3), stability=True)
    exact = MASS * ECCENTRICITY * speeds**2 / (STIFFNESS - MASS * speeds**2 + 1j * speeds * OUTER)
    error = float(np.abs(curve.amplitude("disc.x", "harmonic 1") / np.abs(exact) - 1).max())
    assert np.all(curve.stable == 1)
    record_evidence(
        "Jeffcott rotor, synchronous whirl, largest error of 27 speeds", 0.0, error,
        tolerance=1e-12, topic=TOPIC, kind="closed form", source=JEFFCOTT,
    )  # fmt: skip


def test_the_threshold_of_internal_damping(record_evidence):
    ends = np.array([2.8, 3.2]) * CRITICAL / (2 * np.pi)
    curve = da.frequency_response(
        unbalanced(), tuple(ends), da.HarmonicBalance(1), continuation="arc-length", stability=True
    )
    threshold = CRITICAL * (1 + OUTER / INNER)
    [(kind, point)] = curve.markers
    assert kind == "torus"
    assert curve.stable[0] == 1
    assert curve.stable[-1] == 0
    record_evidence(
        "Threshold of internal damping", threshold, 2 * np.pi * curve.frequencies[point], unit="rad/s",
        tolerance=1e-4, relative=True, topic=TOPIC, kind="closed form", source=SOURCES["threshold"],
    )  # fmt: skip


@pytest.mark.parametrize("speed", [0.0, 30.0, "synchronous"])
def test_the_whirl_of_a_disc_that_tilts(speed, record_evidence):
    tilt, polar, stiffness, damping = 0.4, 0.7, 500.0, 2.0
    axes = ("disc.rx", "disc.ry")
    rotor = lumped(dict.fromkeys(axes, tilt), [(axis, None, stiffness, damping) for axis in axes])
    system = da.VibrationSystem(with_rotors(rotor, [Disc(*axes, polar)]), speed=speed)
    system.add(da.HarmonicForce("disc.rx", 1.0))
    omegas = np.linspace(5.0, 60.0, 23)
    curve = da.frequency_response(system, omegas / (2 * np.pi), da.HarmonicBalance(1))
    ours = curve.response[:, :, 1] - 1j * curve.response[:, :, 2]
    exact = []
    for omega in omegas:
        turn = 1j * omega * polar * (omega if speed == "synchronous" else speed)
        direct = stiffness - omega**2 * tilt + 1j * omega * damping
        exact.append(np.linalg.solve([[direct, turn], [-turn, direct]], [1.0, 0.0]))
    error = float(np.abs(ours - exact).max() / np.abs(exact).max())
    record_evidence(
        f"Disc that tilts, speed {speed if isinstance(speed, str) else f'{speed:g} rad/s'}", 0.0, error,
        tolerance=1e-12, topic=TOPIC, kind="closed form", source=SOURCES["whirl"],
    )  # fmt: skip


CLEARANCE, STATOR, RUBBING = 3e-4, 1200.0, 0.05  # m, N/m


def rub(motion: np.ndarray) -> np.ndarray:
    """Forces of a ring around the rotor with friction against its turning, (2, samples)."""
    x, y = motion
    radius = np.sqrt(x * x + y * y)
    touched = np.real(radius) > CLEARANCE
    share = STATOR * np.where(touched, 1 - CLEARANCE / np.where(touched, radius, 1.0), 0.0)
    return np.stack([share * (x - RUBBING * y), share * (y + RUBBING * x)])


def test_a_full_annular_rub(record_evidence):
    system = unbalanced(0.0)
    system.add(da.UserElement("ring", ("disc.x", "disc.y"), rub))
    speeds = np.array([1.0, 1.05, 1.1, 1.15]) * CRITICAL
    curve = da.frequency_response(system, speeds / (2 * np.pi), da.HarmonicBalance(3))
    errors = []
    for number, speed in enumerate(speeds):
        dynamic = STIFFNESS - MASS * speed**2 + 1j * speed * OUTER

        def unbalance(radius: float, dynamic: complex = dynamic, speed: float = float(speed)) -> float:
            ring = STATOR * max(0.0, 1 - CLEARANCE / radius) * (1 + 1j * RUBBING)
            return float(abs(dynamic + ring) * radius - MASS * ECCENTRICITY * speed**2)

        exact: Any = brentq(unbalance, 0.5 * CLEARANCE, 10 * CLEARANCE, xtol=1e-16)
        errors.append(curve.amplitude("disc.x", "harmonic 1")[number] / exact - 1)
    assert curve.amplitude("disc.x").min() > CLEARANCE
    record_evidence(
        "Full annular rub, largest error of four speeds", 0.0, float(np.abs(errors).max()),
        tolerance=1e-9, topic=TOPIC, kind="closed form", source=SOURCES["rub"],
    )  # fmt: skip


def test_the_path_turns_where_the_ring_opens(record_evidence):
    # Behind the peak the ring opens over the whole turn at once: a corner, at which the path turns back.
    system = unbalanced(0.0)
    system.add(da.UserElement("ring", ("disc.x", "disc.y"), rub))
    ends = 0.6 * CRITICAL / (2 * np.pi), 1.9 * CRITICAL / (2 * np.pi)
    curve = da.frequency_response(system, ends, da.HarmonicBalance(3), continuation="arc-length")
    assert not curve.findings
    assert len(curve.folds) == 2

    def excess(speed: float) -> float:
        free = MASS * ECCENTRICITY * speed**2 / abs(STIFFNESS - MASS * speed**2 + 1j * speed * OUTER)
        return float(free - CLEARANCE)

    corner: Any = brentq(excess, CRITICAL, 1.6 * CRITICAL, xtol=1e-12)
    turned = 2 * np.pi * curve.frequencies[curve.fold.argmax() :].min()
    record_evidence(
        "Rub of a ring: speed at which it opens, a corner of the path", corner, float(turned), unit="rad/s",
        tolerance=1e-4, relative=True, topic=TOPIC, kind="closed form", source="|m e Ω²/(k - m Ω² + i Ω c)| = g",
    )  # fmt: skip


def test_a_nonlinear_gyroscopic_response_beside_integration_in_time(record_evidence):
    axes = ("disc.rx", "disc.ry")
    rotor = with_rotors(
        lumped(dict.fromkeys(axes, 0.4), [(axis, None, 500.0, 2.0) for axis in axes]), [Disc(*axes, 0.7)]
    )
    system = da.VibrationSystem(rotor, speed=30.0)
    system.add(da.HarmonicForce("disc.rx", 20.0))
    system.add(da.CubicSpring("bearing", "disc.rx", stiffness=1e5))
    curve = da.frequency_response(system, np.array([2.0]), da.HarmonicBalance(15))
    motion = steady_state(system, 2.0, Newmark(steps_per_period=4096), way="shooting")
    record_evidence(
        "Disc on a nonlinear bearing at 30 rad/s: tilt across the force", motion.amplitude("disc.ry"),
        float(curve.amplitude("disc.ry")[0]), unit="rad", tolerance=1e-5, relative=True, topic=TOPIC,
        kind="other method", source="integration in time, 4,096 steps of a period",
    )  # fmt: skip
