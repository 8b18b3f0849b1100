"""Ring-downs of simulated decays against periodic motions, and their intervals against the truth."""

import json

import numpy as np
import pytest

import dalembert as da
import ring_down_coverage
from ring_downs import DUFFING, JENKINS, LINEAR, QUANTITIES, SEVERAL_SLIDERS

TOPIC = "Ring-downs"
MOTION = "harmonic balance of the periodic motion, 9 harmonics; the decay by Runge-Kutta steps"
CORNER = 0.2
"""Distance from the corner of a single slider, in the logarithm of the amplitude, within which windows smooth it."""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "oscillator", "order"),
    [("Jenkins, a tenth of the stiffness", JENKINS, 0), ("Duffing", DUFFING, 2), ("Iwan", SEVERAL_SLIDERS, 1)],
)
def test_a_decay_without_noise_gives_the_periodic_motion(record_evidence, name, oscillator, order):
    mode = da.ring_down(oscillator.record(order), quantity=QUANTITIES[order])
    frequencies, damping = oscillator.periodic(mode.amplitudes)
    far = np.abs(np.log(mode.amplitudes)) > CORNER if oscillator is JENKINS else np.ones(len(mode), dtype=bool)
    # The start of the Duffing oscillator is 87 % stiffer than its rest.
    far &= mode.amplitudes < 1.3 if oscillator is DUFFING else True
    assert far.sum() >= 10
    for quantity, reference, ours, tolerance in (
        ("frequencies", frequencies, mode.frequencies, 1e-4),
        ("damping ratios", damping, mode.damping, 1e-2),
    ):
        record_evidence(
            f"{quantity} of a decaying {name} oscillator, {QUANTITIES[order]}", reference[far], ours[far],
            tolerance=tolerance, relative=True, topic=TOPIC, kind="other method", source=MOTION,
        )  # fmt: skip


def test_a_linear_decay_gives_the_undamped_frequency(record_evidence):
    mode = da.ring_down(LINEAR.record(), quantity="displacement")
    record_evidence(
        "frequencies of a decaying linear oscillator, damping ratio 1 %", np.full(len(mode), 1 / (2 * np.pi)),
        mode.frequencies, unit="Hz", tolerance=1e-8, relative=True, topic=TOPIC, kind="closed form", source="√(k/m)",
    )  # fmt: skip


@pytest.mark.slow
def test_intervals_contain_the_truth(record_evidence):
    """Of 400 seeds 368 to 391 intervals contain the truth with a probability of 98.5 %; the first ones are repeated."""
    table = json.loads(ring_down_coverage.TABLE.read_text(encoding="utf-8"))
    assert (table["seeds"], table["first"]) == (ring_down_coverage.SEEDS, ring_down_coverage.FIRST)
    for name, count in table["contained"].items():
        record_evidence(
            f"coverage of 95 % intervals of a ring-down, {name} of the first amplitude", 0.95, count / table["seeds"],
            tolerance=0.03, topic=TOPIC, kind="known truth",
            source="the definition of a confidence interval, 400 seeds",
        )  # fmt: skip
        assert 368 <= count <= 391
    first = [
        ring_down_coverage.contains(seed) for seed in range(ring_down_coverage.FIRST, ring_down_coverage.FIRST + 10)
    ]
    assert np.array(first).sum(axis=0).tolist() == table["in the first ten"]


def bound(mode, point, noise):
    """Bound of Cramér and Rao for the frequency, Hz, of a wave of constant frequency and decay rate in a window."""
    half, step = np.pi * mode.periods[point], LINEAR.decay[0][1]
    times = np.arange(-half, half, step)
    # Fisher information of ln a, φ, σ and ω of a wave a e^{-σt} cos(t + φ).
    wave = np.exp(-LINEAR.damping / 2 * (mode.times[point] + times)) * np.exp(1j * times)
    columns = np.stack([wave.real, -wave.imag, -times * wave.real, -times * wave.imag], axis=1)
    return noise * np.sqrt(np.linalg.inv(columns.T @ columns)[3, 3]) / (2 * np.pi)


@pytest.mark.slow
def test_errors_are_near_the_bound_of_cramer_and_rao(record_evidence):
    """Root mean square of the errors over 30 seeds, from the initial amplitude to a tenth of it, over the bound."""
    noise, truth, ratios = 5e-3, np.sqrt(1 - LINEAR.damping**2 / 4) / (2 * np.pi), []
    for seed in range(30):
        mode = da.ring_down(LINEAR.record(0, noise, seed), 0.16, quantity="displacement")
        bounds = [bound(mode, point, noise) for point in range(len(mode))]
        ratios += ((mode.decay_frequencies - truth) / bounds).tolist()
    record_evidence(
        "errors of frequencies of a ring-down over the bound of Cramér and Rao, root mean square", 1.0,
        float(np.sqrt(np.mean(np.square(ratios)))), tolerance=0.3, topic=TOPIC, kind="closed form",
        source="inverse of the Fisher information of each window, 30 seeds",
    )  # fmt: skip
