"""Sampling: determinism, files, ArviZ, what is refused and what is concluded."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from inline_snapshot import snapshot

from dalembert.data import Measurements
from dalembert.errors import InputError, SolveError
from dalembert.forward import Checkpoint, PythonModel, Recorded
from dalembert.inverse import (
    NUTS,
    AffineInvariant,
    AutoregressiveNoise,
    ConstantNoise,
    DelayedAcceptance,
    Drawn,
    Experiment,
    Posterior,
    identify,
    likelihood,
    sample,
)  # fmt: skip
from dalembert.inverse.posterior.convergence import convergence, ended
from dalembert.parameter import Parameter
from dalembert.priors import CorrelatedNormal, Normal, Uniform
from dalembert.surrogate import TotalDegree
from posterior_models import DECAY, DECAYED, DESIGN, SIGMA, TIMES, line, measured

SHORT = {"chains": 2, "draws": 25, "warmup": 25}


@pytest.fixture(scope="module")
def posterior() -> Posterior:
    return sample(DECAY, DECAYED, chains=2, draws=150, warmup=100)


@pytest.mark.parametrize("sampler", [NUTS(), AffineInvariant(thin=1), DelayedAcceptance(TotalDegree(4))])
def test_the_same_seed_gives_the_same_bits(sampler: Any) -> None:
    first, second = (sample(DECAY, DECAYED, sampler=sampler, seed=3, start=[2.0, 1.0], **SHORT) for _ in range(2))
    assert np.array_equal(first.draws, second.draws)
    assert first.simulations == second.simulations
    assert first.summary() == second.summary()
    other = sample(DECAY, DECAYED, sampler=sampler, seed=4, start=[2.0, 1.0], **SHORT)
    assert not np.array_equal(first.draws, other.draws)


def test_a_file_gives_back_the_same_bits(posterior: Posterior, tmp_path: Path) -> None:
    posterior.save(tmp_path / "posterior.nc")
    loaded = Posterior.load(tmp_path / "posterior.nc")
    for name in ("draws", "log_density", "r_hat", "bulk", "tail", "mode", "log_likelihood", "replicas", "rows", "kept"):
        assert np.array_equal(getattr(loaded, name), getattr(posterior, name), equal_nan=True), name
    for name, values in posterior.statistics.items():
        assert np.array_equal(loaded.statistics[name], values)
        assert loaded.statistics[name].dtype == values.dtype
    assert loaded.summary() == posterior.summary()
    assert loaded.conclusions == posterior.conclusions


def test_arviz_has_all_groups(posterior: Posterior) -> None:
    found = posterior.inference_data
    assert set(found.groups()) == {
        "posterior", "sample_stats", "log_likelihood", "posterior_predictive", "observed_data",
    }  # fmt: skip
    assert dict(found.posterior.sizes) == {"chain": 2, "draw": 150}
    assert found.log_likelihood["x"].shape == (2, 150, len(TIMES))
    assert found.posterior_predictive["x"].shape == (1, 300, len(TIMES))
    np.testing.assert_array_equal(found.observed_data["x"], DECAYED.values[:, 0])
    np.testing.assert_array_equal(found.observed_data["x.sample"], TIMES)
    np.testing.assert_array_equal(found.posterior["rate"], posterior["rate"])
    assert found.sample_stats["diverging"].dtype == bool


def test_the_log_likelihood_of_values_is_that_of_the_noise(posterior: Posterior) -> None:
    rate, height = posterior.flat[7]
    residual = (height * np.exp(-rate * TIMES) - DECAYED.values[:, 0]) / 0.05
    expected = -0.5 * residual**2 - np.log(0.05 * np.sqrt(2 * np.pi))
    np.testing.assert_allclose(posterior.log_likelihood[7], expected, rtol=1e-12)


def test_replicas_have_the_noise_of_the_data(posterior: Posterior) -> None:
    rate, height = posterior.flat[posterior.replicated].T[:, :, None]
    noise = posterior.replicas[:, :, 0] - height * np.exp(-rate * TIMES)
    np.testing.assert_allclose(noise.std(), 0.05, rtol=0.05)  # of 3300 values
    lower, upper = posterior.band(0.9)
    assert np.all(lower < upper)


def test_a_killed_run_continues_with_the_same_bits(tmp_path: Path) -> None:
    calls: list[int] = []

    def counted(rate: float, height: float) -> np.ndarray:
        calls.append(1)
        if len(calls) == limit:
            raise KeyboardInterrupt
        return height * np.exp(-rate * TIMES)

    def model(path: Path) -> tuple[Checkpoint, Recorded]:
        own = PythonModel(counted, DECAY.parameters, ["x"], TIMES)
        checkpoint = Checkpoint(path)
        return checkpoint, Recorded(own, checkpoint)

    settings = {"start": [2.0, 1.0], "chains": 1, "draws": 60, "warmup": 60}
    limit = -1
    checkpoint, recorded = model(tmp_path / "whole")
    with checkpoint:
        whole = sample(recorded, DECAYED, **settings)
    total, limit = len(calls), len(calls) // 2
    calls.clear()
    checkpoint, recorded = model(tmp_path / "killed")
    with pytest.raises(KeyboardInterrupt), checkpoint:
        sample(recorded, DECAYED, **settings)
    calls.clear()
    limit = -1
    checkpoint, recorded = model(tmp_path / "killed")
    with checkpoint:
        continued = sample(recorded, DECAYED, **settings)
    assert len(calls) < 0.6 * total
    assert np.array_equal(continued.draws, whole.draws)
    assert np.array_equal(continued.replicas, whole.replicas)
    assert continued.summary() == whole.summary()


@pytest.mark.slow
@pytest.mark.parametrize("sampler", [NUTS(), AffineInvariant(thin=1), DelayedAcceptance(TotalDegree(4))])
def test_a_cluster_gives_the_same_bits(sampler: Any) -> None:
    from distributed import Client

    here = sample(DECAY, DECAYED, sampler=sampler, start=[2.0, 1.0], **SHORT)
    with Client(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None) as client:
        there = sample(DECAY, DECAYED, sampler=sampler, start=[2.0, 1.0], executor=client, **SHORT)
    assert np.array_equal(here.draws, there.draws)


def test_events_tell_the_draws_in_hundredths() -> None:
    told: list[Any] = []
    sample(DECAY, DECAYED, start=[2.0, 1.0], on_event=told.append, **SHORT)
    drawn = [event.draws for event in told if isinstance(event, Drawn)]
    assert drawn == list(range(1, 101))


def test_a_listener_may_stop_a_run() -> None:
    def stop(event: Any) -> None:
        raise RuntimeError("stopped")

    with pytest.raises(RuntimeError, match="stopped"):
        sample(DECAY, DECAYED, start=[2.0, 1.0], on_event=stop, **SHORT)


def test_a_model_without_jacobian_is_sampled_without_gradients() -> None:
    model = PythonModel(lambda rate: np.abs(rate) * TIMES, {"rate": (0.5, 3.0)}, ["x"], TIMES)
    data = measured(a=1.5, b=0.0)
    found = sample(model, data, start=[1.5], chains=2, draws=100, warmup=50)
    assert found.sampler == "AffineInvariant"
    exact = SIGMA / np.sqrt(np.sum(TIMES**2))
    np.testing.assert_allclose(found.deviations, [exact], rtol=0.25)
    np.testing.assert_allclose(found.linear_deviations, [exact], rtol=0.02)


def test_experiments_share_parameters() -> None:
    several = [Experiment(name, line(), measured(seed), ["b"]) for name, seed in (("one", 1), ("two", 2))]
    found = sample(several, **SHORT)
    assert found.parameters.names == ("a", "one.b", "two.b")
    assert set(found.experiments) == {"one", "two"}
    assert found.log_likelihood.shape == (50, 2 * len(TIMES))
    assert set(found.inference_data.log_likelihood.data_vars) == {"one.x", "two.x"}


def test_a_failed_simulation_is_an_impossible_value() -> None:
    def risky(rate: float, height: float) -> np.ndarray:
        if np.real(rate) > 2.05:
            raise ValueError("too fast")
        return height * np.exp(-rate * TIMES)

    model = PythonModel(risky, DECAY.parameters, ["x"], TIMES)
    found = sample(model, DECAYED, start=[1.9, 1.0], **SHORT)
    assert np.max(found["rate"]) <= 2.05
    codes = {finding.code for finding in found.conclusions}
    assert "divergent-draws" in codes


def test_a_prior_that_excludes_the_data_is_found() -> None:
    found = sample(line(a=Normal(-1.0, 0.2)), measured(), **SHORT)
    finding = next(item for item in found.findings if item.code == "prior-conflict")
    assert finding.values["parameter"] == "a"
    deviation = np.sqrt(0.2**2 + SIGMA**2 * np.linalg.inv(DESIGN.T @ DESIGN)[0, 0])
    best = np.linalg.lstsq(DESIGN, measured().values[:, 0], rcond=None)[0][0]
    np.testing.assert_allclose(finding.values["deviations"], (best + 1.0) / deviation, rtol=1e-3)
    assert str(finding) == snapshot(
        "The prior of 'a' excludes what the data show: they are 10.7 standard deviations apart. Correct the prior, or look for what the model lacks."
    )


def test_a_fit_finds_the_same_conflict() -> None:
    fit = identify(line(a=Normal(-1.0, 0.2)), measured(), starts=1)
    finding = next(item for item in fit.doubts if item.code == "prior-conflict")
    deviation = np.sqrt(0.2**2 + SIGMA**2 * np.linalg.inv(DESIGN.T @ DESIGN)[0, 0])
    best = np.linalg.lstsq(DESIGN, measured().values[:, 0], rcond=None)[0][0]
    np.testing.assert_allclose(finding.values["deviations"], (best + 1.0) / deviation, rtol=1e-6)
    agreeing = identify(line(a=Normal(1.0, 0.2)), measured(), starts=1)
    assert "prior-conflict" not in {item.code for item in agreeing.doubts}


def test_a_prior_that_agrees_is_no_finding() -> None:
    found = sample(line(a=Normal(1.0, 0.2)), measured(), **SHORT)
    assert not {"prior-conflict", "prior-dominates"} & {item.code for item in found.findings}


def test_what_only_the_prior_determines_is_found() -> None:
    model = PythonModel(
        lambda a, ghost: a * TIMES + 0 * ghost,
        {"a": (0.0, 3.0), "ghost": Parameter("ghost", -5.0, 5.0, prior=Normal(1.0, 0.5))},
        ["x"],
        TIMES,
    )
    found = sample(model, measured(b=0.0), chains=2, draws=200, warmup=100)
    assert [item.values["parameters"] for item in found.findings if item.code == "prior-dominates"] == ["ghost"]
    np.testing.assert_allclose(found.mean[1], 1.0, atol=0.2)


def test_a_posterior_at_a_bound_is_found() -> None:
    found = sample(line(bounds=(-5.0, 1.1)), measured(), chains=2, draws=200, warmup=100)
    sides = {
        (item.values["parameter"], item.values["side"]) for item in found.findings if item.code == "posterior-at-bound"
    }
    assert sides == {("a", "upper")}


def test_too_few_draws_are_told() -> None:
    found = sample(DECAY, DECAYED, start=[2.0, 1.0], chains=1, draws=10, warmup=20)
    assert not found.success
    assert {item.code for item in found.outcome} >= {"few-draws", "one-chain"}


@pytest.mark.parametrize(("apart", "code"), [(0.0, "chains-converged"), (1.0, "chains-differ")])
def test_chains_in_different_minima_are_told(apart: float, code: str) -> None:
    draws = np.random.default_rng(1).standard_normal((4, 500, 1))
    draws[2:] += apart
    found = list(ended(["a"], convergence(draws), 4, 500))
    assert found[0].code == code
    assert found[0].severity == ("note" if apart == 0.0 else "error")


def test_a_surrogate_that_is_too_inaccurate_is_refused() -> None:
    model = PythonModel(lambda a: np.full(len(TIMES), a + np.cos(40 * a)), {"a": (-1.0, 1.0)}, ["x"], TIMES)
    data = Measurements.of(TIMES, {"x": np.ones(len(TIMES))}, deviations=1.0)
    with pytest.raises(SolveError, match="runs is too inaccurate: over 32 draws of its posterior, its log density is"):
        sample(model, data, surrogate=TotalDegree(1), start=[0.0], **SHORT)


def test_a_surrogate_needs_few_simulations() -> None:
    found = sample(DECAY, DECAYED, surrogate=True, start=[2.0, 1.0], **SHORT)
    assert found.simulations < 300  # 120 decisions at most, 32 draws of the test, the surrogate, the mode
    assert "delayed-acceptance" in {item.code for item in found.findings}


def test_a_fit_is_a_start() -> None:
    fit = identify(DECAY, DECAYED)
    found = sample(DECAY, DECAYED, start=fit, **SHORT)
    assert np.all(np.abs(found.mode - fit.values) < 0.5 * fit.deviations)


JOINT = CorrelatedNormal(("a", "other"), (0.0, 0.0), ((1.0, 0.0), (0.0, 1.0)))
MISTAKES = {
    "no data": lambda: sample(DECAY),
    "sampler": lambda: sample(DECAY, DECAYED, sampler="nut"),
    "no sampler": lambda: sample(DECAY, DECAYED, sampler=3),
    "surrogate": lambda: sample(DECAY, DECAYED, surrogate="yes"),
    "both": lambda: sample(DECAY, DECAYED, sampler="nuts", surrogate=True),
    "chains": lambda: sample(DECAY, DECAYED, chains=0),
    "priors": lambda: sample(DECAY, DECAYED, priors={"rates": Normal(1.0, 0.1)}),
    "joint": lambda: sample(line(), measured(), priors={"a": JOINT}),
    "narrow": lambda: sample(line(), measured(), priors={"a": Uniform(0.0, 1.0)}),
    "improper": lambda: sample(line(), measured(), priors={"a": Uniform(-np.inf, np.inf)}),
    "start": lambda: sample(DECAY, DECAYED, start=[1.0]),
    "level": lambda: sample(DECAY, DECAYED, start=[2.0, 1.0], **SHORT).intervals(2.0),
}


def test_mistakes_are_explained() -> None:
    told = {}
    for name, mistake in MISTAKES.items():
        with pytest.raises(InputError) as error:
            mistake()
        told[name] = str(error.value)
    assert told == snapshot(
        {
            "no data": "sample: no data were given; expected sample(model, data), or sample([Experiment(...)])",
            "sampler": "unknown sampler 'nut'; did you mean 'nuts'?",
            "no sampler": "sample: sampler is 3; expected a sampler such as NUTS(), or its name",
            "surrogate": "sample: surrogate is 'yes'; expected a scheme such as TotalDegree(4), or True",
            "both": "sample: surrogate and the sampler 'nuts' were given; a surrogate proposes draws of the sampler 'delayed-acceptance'. Leave one of them out",
            "chains": "sample: chains is 0; expected a whole number, at least 1",
            "priors": "sample: priors: unknown parameter 'rates'; did you mean 'rate'?",
            "joint": "parameter 'a': its prior is that of a, other, but 'other' has another one or none. Give all of them the same prior",
            "narrow": "parameter 'a': its prior is uniform from 0 to 1, narrower than its bounds (-5, 5). Use the ends of the prior as bounds",
            "improper": "Uniform: it extends from -inf to inf, which makes the prior improper; expected two finite numbers",
            "start": "a parameter vector of shape (1,) was given; expected (2,) for rate, height",
            "level": "intervals: level is 2.0; expected a number between 0 and 1, such as 0.95",
        }
    )


def test_a_missing_package_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "nutpie", None)
    with pytest.raises(InputError) as error:
        sample(DECAY, DECAYED, sampler="nuts")
    assert str(error.value) == snapshot(
        "the sampler NUTS needs nutpie, which is not installed; run: pip install 'dalembert[posterior]'"
    )


def test_the_mode_is_found_where_the_noise_is_not_known() -> None:
    """The mode of a line in the coordinates of the search: the deviation of least squares, √(RSS/n)."""
    times = np.linspace(0.0, 2.0, 30)
    model = PythonModel(lambda a, b: a + b * times, {"a": (-50.0, 50.0), "b": (-50.0, 50.0)}, ["x"], times)
    values = 2 + times + 3.0 * np.random.default_rng(0).standard_normal(30)
    rows = np.stack([np.ones(30), times], axis=1)
    (residual,) = np.linalg.lstsq(rows, values, rcond=None)[1]
    found = sample(model, Measurements.of(times, {"x": values}), chains=2, draws=20, warmup=20)
    assert found.mode[2] == pytest.approx(np.sqrt(residual / 30), rel=0.02)
    exact = np.sqrt(residual / 30 * np.linalg.inv(rows.T @ rows)[0, 0])
    assert found.linear_deviations[0] == pytest.approx(exact, rel=0.03)


def test_left_out_densities_are_those_of_refits_without_each_value() -> None:
    times = np.linspace(0.0, 1.0, 12)
    model = PythonModel(lambda a: a + 0 * times, {"a": (-9.0, 9.0)}, ["x"], times)
    random = np.random.default_rng(0)
    values, partial, size = random.standard_normal(12), 0.7, 0.4
    likely = likelihood(
        model,
        Measurements.of(times, {"x": values}),
        noise=AutoregressiveNoise(deviation=ConstantNoise(deviation=size), order=1, partial=[partial]),
    )
    covariance = size**2 * partial ** np.abs(np.subtract.outer(np.arange(12), np.arange(12)))
    residual, expected = values - 0.3, np.empty(12)
    for k in range(12):
        others = np.delete(np.arange(12), k)
        weights = np.linalg.solve(covariance[np.ix_(others, others)], covariance[others, k])
        variance = covariance[k, k] - weights @ covariance[others, k]
        expected[k] = -0.5 * (residual[k] - weights @ residual[others]) ** 2 / variance
        expected[k] -= 0.5 * np.log(2 * np.pi * variance)
    np.testing.assert_allclose(likely.left_out([[0.3]], np.arange(12))[0][0], expected, rtol=1e-10)


def test_findings_of_the_fit_concern_the_draws_too() -> None:
    short = {"chains": 2, "draws": 20, "warmup": 20}
    drift = np.cumsum(0.1 * np.random.default_rng(1).standard_normal(200))
    times = np.linspace(0.0, 2.0, 200)
    model = PythonModel(lambda a, b: a + b * times, {"a": (-9.0, 9.0), "b": (-9.0, 9.0)}, ["x"], times)
    data = Measurements.of(times, {"x": 2 + times + drift})
    codes = {item.code for item in sample(model, data, **short).findings}
    assert "correlated-residuals" in codes
    codes = {item.code for item in sample(model, data, noise=AutoregressiveNoise(order=1), **short).findings}
    assert "correlated-residuals" not in codes


def test_a_start_outside_the_bounds_is_refused() -> None:
    with pytest.raises(InputError) as refused:
        sample(line(), measured(), start={"a": 99.0, "b": 0.0}, **SHORT)
    assert "start: 'a' is 99.0, outside its bounds" in str(refused.value)


def test_an_interrupt_of_the_affine_invariant_sampler_prints_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    """emcee prints a traceback of all that the density raises, of an interrupt too."""
    calls: list[float] = []

    def stopped(rate: float) -> np.ndarray:
        calls.append(rate)
        if len(calls) > 300:
            raise KeyboardInterrupt
        return np.exp(-rate * TIMES)

    model = PythonModel(stopped, {"rate": (0.1, 2.0)}, ["x"], TIMES)
    data = Measurements.of(TIMES, {"x": np.exp(-0.7 * TIMES)}, deviations=0.01)
    with pytest.raises(KeyboardInterrupt):
        sample(model, data, draws=200, warmup=50, sampler=AffineInvariant(thin=1), start={"rate": 0.7})
    assert capsys.readouterr().out == ""
