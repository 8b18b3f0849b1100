"""Harmonic balance with friction against independent codes, closed forms, and limits of the laws."""

import numpy as np
import pytest

from dalembert.vibration import HarmonicBalance, frequency_response
from vibrating_systems import chain, duffing, one_mass, two_masses

TOPIC = "Friction in frequency"
CODES = "the same equations in independent harmonic balance codes"
TURN = 2 * np.pi


@pytest.mark.parametrize(
    ("harmonics", "published"), [(1, 3.6405013685), (5, 3.6251784738), (7, 3.6247259686), (9, 3.6247415284)]
)
def test_one_mass_with_a_slider(record_evidence, harmonics: int, published: float) -> None:
    curve = frequency_response(one_mass(), np.array([1.12]) / TURN, HarmonicBalance(harmonics, samples=1024))
    record_evidence(
        f"one mass with a slider, {harmonics} harmonics: largest displacement at 1.12 rad/s",
        published, curve.amplitude("m")[0], tolerance=5e-11, topic=TOPIC, source=CODES, unit="m",
    )  # fmt: skip


@pytest.mark.parametrize(
    ("harmonics", "published"), [(1, 4.8150033694), (5, 4.6653328247), (7, 4.6635200230), (9, 4.6647671962)]
)
def test_two_masses_with_a_slider(record_evidence, harmonics: int, published: float) -> None:
    curve = frequency_response(two_masses(), np.array([0.88]) / TURN, HarmonicBalance(harmonics, samples=1024))
    record_evidence(
        f"two masses with a slider, {harmonics} harmonics: largest displacement at 0.88 rad/s",
        published, curve.amplitude("m2")[0], tolerance=5e-11, topic=TOPIC, source=CODES, unit="m",
    )  # fmt: skip


@pytest.mark.slow
def test_three_masses_with_sliders_cubic_springs_and_a_stop(record_evidence) -> None:
    omegas = np.arange(0.8, 1.7001, 0.005)
    curve = frequency_response(chain(), omegas / TURN, HarmonicBalance(7, samples=1024))
    assert curve.converged.all()
    for mass, at, published in (("m1", 1.635, 0.20274), ("m2", 1.610, 0.23301), ("m3", 1.625, 0.71153)):
        sizes = curve.amplitude(mass, "rms")
        record_evidence(
            f"three masses with sliders, cubic springs and a stop: largest rms of {mass}",
            published, sizes.max(), tolerance=5e-6, topic=TOPIC, source=CODES, unit="m",
        )  # fmt: skip
        assert omegas[sizes.argmax()] == pytest.approx(at, abs=1e-9)


def test_duffing_oscillator_past_its_folds(record_evidence) -> None:
    method = HarmonicBalance(7, resolution=0.01)
    curve = frequency_response(duffing(), (0.5 / TURN, 2.0 / TURN), method, continuation="arc-length")
    assert curve.converged.all()
    for folds, published in zip(curve.folds * TURN, (1.269602, 1.115700), strict=True):
        record_evidence(
            "Duffing oscillator: frequency of a fold", published, folds,
            tolerance=1e-6, topic=TOPIC, source=CODES, unit="rad/s",
        )  # fmt: skip
    record_evidence(
        "Duffing oscillator: largest first harmonic", 2.83019, curve.peak("m", "harmonic 1").amplitude,
        tolerance=1e-5, topic=TOPIC, source=CODES, unit="m",
    )  # fmt: skip
    up = frequency_response(duffing(), np.append(np.arange(0.8, 1.265, 0.02), 1.26878) / TURN, method)
    record_evidence(
        "Duffing oscillator: first harmonic at 1.26878 rad/s, where the published curve is largest", 2.83019,
        up.amplitude("m", "harmonic 1")[-1], tolerance=5e-6, topic=TOPIC, source=CODES, unit="m",
    )  # fmt: skip
