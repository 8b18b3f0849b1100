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


@pytest.mark.slow
def test_deviations_are_near_the_bound_of_cramer_and_rao(record_evidence):
    """The spread of estimates over seeds, beside the bound of a wave of constant rate in the window."""
    spreads, bounds = [], []
    noise = 5e-3
    results = [da.ring_down(LINEAR.record(0, noise, seed), 0.16, quantity="displacement") for seed in range(60)]
    count = min(map(len, results))
    for point in range(3, count - 1, 3):
        values = np.array([[mode.decay_frequencies[point], mode.decay_damping[point]] for mode in results])
        times = np.array([mode.times[point] for mode in results])
        if np.ptp(times) > 1.0:
            continue
        spreads.append(values[:, 0].std(ddof=1))
        # Fisher information of ln a, φ, σ and ω of a wave a e^{-σt} cos(ωt + φ) in the samples of the window.
        half = np.pi * results[0].periods[point] / (2 * np.pi * results[0].decay_frequencies[point])
        middle = results[0].times[point]
        step = LINEAR.decay[0][1]
        local = np.arange(-half, half, step)
        size = np.exp(-LINEAR.damping / 2 * (middle + local))
        wave = size * np.exp(1j * local)
        columns = np.stack([wave.real, -wave.imag, local * wave.real, -local * wave.imag], axis=1)
        bounds.append(noise * np.sqrt(np.linalg.inv(columns.T @ columns)[3, 3]) / (2 * np.pi))
    ratios = np.array(spreads) / np.array(bounds)
    assert len(ratios) >= 2
    record_evidence(
        "largest standard deviation of frequencies over that of the bound of Cramér and Rao", 1.0, float(ratios.max()),
        tolerance=0.3, topic=TOPIC, kind="closed form", source="inverse of the Fisher information, 60 seeds",
    )  # fmt: skip
