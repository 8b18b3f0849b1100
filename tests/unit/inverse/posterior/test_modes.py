"""Modes of posteriors: chains start in each of them, and what no chain connects is an error."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from inline_snapshot import snapshot

from dalembert.data import Measurements
from dalembert.forward import Checkpoint, PythonModel, Recorded
from dalembert.inverse import NUTS, AffineInvariant, DelayedAcceptance, Posterior, identify, sample
from dalembert.parameter import Parameter
from dalembert.priors import Normal
from dalembert.surrogate import TotalDegree
from posterior_models import DECAY, DECAYED

ONE = np.zeros(1)
SHORT = {"chains": 4, "draws": 60, "warmup": 60, "seed": 1}
SQUARE = PythonModel(lambda x: np.array([x * x]), {"x": (-5.0, 5.0)}, ["y"], ONE)
FOUR = Measurements.of(ONE, {"y": np.array([4.0])}, deviations=0.3)


def separate(found: Posterior) -> Any:
    return next((finding for finding in found.findings if finding.code == "separate-modes"), None)


@pytest.mark.parametrize("sampler", [NUTS(), DelayedAcceptance(TotalDegree(4))])
@pytest.mark.parametrize("start", [[2.0], [-2.0]])
def test_chains_start_in_both_modes_from_either(sampler: Any, start: list[float]) -> None:
    found = sample(SQUARE, FOUR, sampler=sampler, start=start, **SHORT)
    assert not found.success
    assert np.sum(found["x"].mean(axis=1) > 0) == 2  # of four chains
    finding = separate(found)
    assert finding.severity == "error"
    assert sorted(finding.values[f"mode_{k}.x"] for k in (1, 2)) == pytest.approx([-2.0, 2.0], abs=0.02)
    assert finding.values["mode_1.share"] == pytest.approx(0.5, abs=1e-6)  # the modes are mirror images
    assert finding.values["mode_1.draws"] == pytest.approx(0.5)


def test_one_chain_does_not_hide_a_mode() -> None:
    found = sample(SQUARE, FOUR, start=[2.0], chains=1, draws=60, warmup=60)
    assert not found.success
    assert sorted(separate(found).values[f"mode_{k}.draws"] for k in (1, 2)) == [0.0, 1.0]


def test_a_fit_is_a_start_of_all_its_minima() -> None:
    found = sample(SQUARE, FOUR, start=identify(SQUARE, FOUR), **SHORT)
    assert str(separate(found)) == snapshot(
        "The posterior has 2 modes that no chain connects: x = 1.99893 (about 50 % of the probability, 50 % of the draws); x = -1.99893 (about 50 % of the probability, 50 % of the draws). Use the sampler 'affine-invariant', which jumps between modes, measure another channel, or narrow the bounds to one mode."
    )


def test_walkers_jump_between_modes_by_their_probability() -> None:
    """The prior makes one mode 4 times as probable as the other: their shares are those of a quadrature."""
    model = PythonModel(
        lambda x: np.array([x * x]), {"x": Parameter("x", -5.0, 5.0, prior=Normal(1.0, 1.7))}, ["y"], ONE
    )
    x = np.linspace(-5.0, 5.0, 20_001)
    density = np.exp(-0.5 * ((x * x - 4.0) / 0.3) ** 2 - 0.5 * ((x - 1.0) / 1.7) ** 2)
    share = density[x > 0].sum() / density.sum()
    assert 0.75 < share < 0.85
    found = sample(model, FOUR, sampler=AffineInvariant(thin=3), start=[-2.0], draws=500, warmup=100, seed=1)
    assert separate(found) is None
    right = found["x"] > 0
    effective = float(found.bulk[0])
    assert effective > 500
    assert right.mean() == pytest.approx(share, abs=4 * np.sqrt(share * (1 - share) / effective))
    assert right.mean(axis=1).std() < 0.1  # 0.4 for walkers that do not jump


def test_a_narrow_mode_is_found() -> None:
    """A second zero of the residual, 1/20 as wide, has 5 % of the probability by a quadrature."""
    model = PythonModel(
        lambda x: np.array([(x - 1.0) * (1 - np.exp(-(((x - 4.3) / 0.05) ** 2)))]), {"x": (-5.0, 8.0)}, ["y"], ONE
    )
    found = sample(model, Measurements.of(ONE, {"y": ONE}, deviations=0.2), start=[1.0], draws=200, warmup=100, seed=1)
    values = separate(found).values
    assert values["mode_2.x"] == pytest.approx(4.3, abs=0.01)
    assert 0.02 < values["mode_2.share"] < 0.1
    assert not found.success


def test_unknown_noise_does_not_hide_a_mode() -> None:
    times = np.linspace(0.0, 2.0, 30)
    model = PythonModel(lambda a, b: a * a + b * times, {"a": (-3.0, 3.0), "b": (-5.0, 5.0)}, ["x"], times)
    noise = 0.1 * np.random.default_rng(0).standard_normal(30)
    found = sample(model, Measurements.of(times, {"x": 2 + times + noise}), start=[1.4, 1.0], **SHORT)
    values = separate(found).values
    assert values["modes"] == 2
    assert values["mode_1.a"] == pytest.approx(-values["mode_2.a"], rel=1e-3)


@pytest.mark.parametrize("seed", range(6))
def test_one_mode_is_one_mode(seed: int) -> None:
    noise = 0.05 * np.random.default_rng(seed).standard_normal(11)
    times = np.linspace(0.0, 1.0, 11)
    model = PythonModel(lambda rate, height: height * np.exp(-rate * times), DECAY.parameters, ["x"], times)
    data = Measurements.of(times, {"x": np.exp(-2 * times) + noise})
    found = sample(model, data, chains=2, draws=30, warmup=30)
    assert separate(found) is None


def test_a_killed_search_of_modes_continues_with_the_same_bits(tmp_path: Path) -> None:
    limit, calls = -1, 0

    def square(x: float) -> np.ndarray:
        nonlocal calls
        calls += 1
        if calls == limit:
            raise KeyboardInterrupt
        return np.array([x * x])

    def sampled(path: Path) -> Posterior:
        checkpoint = Checkpoint(path)
        with checkpoint:
            return sample(
                Recorded(PythonModel(square, {"x": (-5.0, 5.0)}, ["y"], ONE), checkpoint),
                FOUR, start=[2.0], chains=2, draws=20, warmup=20,
            )  # fmt: skip

    whole, calls, limit = sampled(tmp_path / "whole"), 0, 60
    with pytest.raises(KeyboardInterrupt):
        sampled(tmp_path / "killed")
    limit = -1
    continued = sampled(tmp_path / "killed")
    assert np.array_equal(continued.draws, whole.draws)
    assert continued.summary() == whole.summary()


def test_a_decay_keeps_its_chains() -> None:
    found = sample(DECAY, DECAYED, start=[2.0, 1.0], **SHORT)
    assert np.all(np.abs(found.draws.mean(axis=1) - found.mode) < 2 * found.linear_deviations)
