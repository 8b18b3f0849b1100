"""Noise estimated with the parameters: NIST regressions, generalised least squares, errors in variables, coverage."""

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

import dalembert as da
from correlated_noise import autoregressive
from nist_regressions import MODELS, Regression
from noise_coverage import CASES, LEVEL, METHODS, covered

TOPIC = "Noise models"
NIST = "NIST Statistical Reference Datasets, nonlinear regression"
TIMES = np.linspace(0.0, 3.0, 101)
LINE = da.PythonModel(
    lambda level, slope: level + slope * TIMES, {"level": (-5.0, 5.0), "slope": (-5.0, 5.0)}, ["x"], TIMES
)
COLUMNS = np.stack([np.ones(101), TIMES], axis=1)
VALUES = COLUMNS @ [1.0, 0.5] + 0.1 * autoregressive(3, 101, 0.6)
DATA = da.Measurements.of(TIMES, {"x": VALUES})


def covariance(coefficient):
    """Covariance of first-order noise of variance 1, from its definition."""
    return coefficient ** np.abs(np.arange(101)[:, None] - np.arange(101))


def generalised(matrix):
    """Generalised least squares: values, inverse information, and the sum of squares of whitened residuals."""
    inverse = np.linalg.inv(matrix)
    spread = np.linalg.inv(COLUMNS.T @ inverse @ COLUMNS)
    values = spread @ COLUMNS.T @ inverse @ VALUES
    residual = VALUES - COLUMNS @ values
    return values, spread, residual @ inverse @ residual


@pytest.mark.parametrize("name", MODELS)
def test_nist_problems_keep_their_digits_with_noise_models(name, reference, record_evidence):
    problem = Regression(name, reference("nist_regressions")[name])
    fit = problem.fit(problem.values, noise="constant", starts=1, horizon=None)
    common = {"tolerance": 1e-4, "topic": TOPIC, "kind": "published", "source": NIST}
    certified = np.array(problem.given["deviations"])
    record_evidence(f"{name}, constant noise: values over the certified ones", np.ones(len(fit.values)),
                    fit.values / problem.values, **common)  # fmt: skip
    record_evidence(f"{name}, constant noise: deviations over the certified ones", np.ones(len(fit.values)),
                    fit.deviations / certified, **common)  # fmt: skip
    contains = [da.MixedNoise(relative=0.0)]
    contains += [da.AutoregressiveNoise(partial=(0.0,))] if len(problem.y) >= 10 else []
    for noise in contains:
        other = problem.fit(problem.values, noise=noise, starts=1, horizon=None)
        record_evidence(f"{name}, {noise.name} noise with further parameters fixed at 0: deviations over the certified ones",
                        np.ones(len(fit.values)), other.deviations / certified, **common)  # fmt: skip


def test_known_autoregressive_noise_is_generalised_least_squares(record_evidence):
    noise = da.AutoregressiveNoise(partial=(0.6,), deviation=da.ConstantNoise(deviation=0.1))
    fit = da.identify(LINE, DATA, noise=noise, starts=1)
    values, spread, _ = generalised(0.01 * covariance(0.6))
    common = {"topic": TOPIC, "kind": "closed form", "source": "generalised least squares (Aitken 1935)"}
    record_evidence("AR(1) of known φ and σ: estimate", values, fit.values, tolerance=1e-8, **common)
    record_evidence("AR(1) of known φ and σ: standard deviations", np.sqrt(np.diag(spread)), fit.deviations,
                    tolerance=1e-8, **common)  # fmt: skip
    record_evidence("AR(1) of known φ and σ: correlation", spread[0, 1] / np.sqrt(spread[0, 0] * spread[1, 1]),
                    fit.correlation[0, 1], tolerance=1e-8, **common)  # fmt: skip


def test_unknown_autoregressive_noise_has_the_largest_restricted_likelihood(record_evidence):
    """The restricted likelihood with dense matrices, made largest over φ; σ² is the mean square over n − p."""

    def loss(coefficient):
        matrix = covariance(coefficient)
        _, spread, squares = generalised(matrix)
        return 99 * np.log(squares / 99) + np.linalg.slogdet(matrix)[1] - np.linalg.slogdet(spread)[1]

    best = minimize_scalar(loss, bounds=(0.0, 0.95), method="bounded", options={"xatol": 1e-10}).x
    values, spread, squares = generalised(covariance(best))
    fit = da.identify(LINE, DATA, noise=da.AutoregressiveNoise(order=1), starts=1)
    common = {"topic": TOPIC, "kind": "closed form", "source": "restricted likelihood (Patterson and Thompson 1971)"}
    sigma = np.sqrt(squares / 99)
    record_evidence(
        "AR(1) of unknown φ and σ: σ and φ", np.array([sigma, best]), fit.noise.values, tolerance=1e-6, **common
    )
    record_evidence("AR(1) of unknown φ and σ: estimate", values, fit.values, tolerance=1e-7, **common)
    record_evidence("AR(1) of unknown φ and σ: standard deviations", sigma * np.sqrt(np.diag(spread)), fit.deviations,
                    tolerance=1e-6, **common)  # fmt: skip


def test_deviations_of_noise_parameters_are_those_of_the_restricted_likelihood(record_evidence):
    """A short record, in which estimates of the model follow the noise; second differences of the dense likelihood."""
    count = 25
    times, columns = TIMES[:count], COLUMNS[:count]
    values = columns @ [1.0, 0.5] + 0.1 * autoregressive(4, count, 0.6)
    line = da.PythonModel(
        lambda level, slope: level + slope * times, {"level": (-5.0, 5.0), "slope": (-5.0, 5.0)}, ["x"], times
    )

    def density(noise):
        sigma, coefficient = noise
        inverse = np.linalg.inv(sigma**2 * covariance(coefficient)[:count, :count])
        information = columns.T @ inverse @ columns
        residual = values - columns @ np.linalg.solve(information, columns.T @ inverse @ values)
        sizes = np.linalg.slogdet(inverse)[1] - np.linalg.slogdet(information)[1]
        return 0.5 * (sizes - residual @ inverse @ residual)

    fit = da.identify(line, da.Measurements.of(times, {"x": values}), noise=da.AutoregressiveNoise(order=1), starts=1)
    steps = np.diag(1e-4 * fit.noise.values)
    at = lambda *moves: density(fit.noise.values + sum(moves))  # noqa: E731
    curvature = [
        [(at(a, b) - at(a, -b) - at(-a, b) + at(-a, -b)) / (4 * a.sum() * b.sum()) for b in steps] for a in steps
    ]
    expected = np.sqrt(np.diag(np.linalg.inv(-np.array(curvature))))
    record_evidence("AR(1), 25 samples: standard deviations of σ and φ", expected, fit.noise.deviations, tolerance=1e-5,
                    relative=True, topic=TOPIC, kind="closed form",
                    source="restricted likelihood (Patterson and Thompson 1971)")  # fmt: skip


def test_the_gradient_of_mixed_noise_is_the_complex_step(record_evidence):
    decay = da.PythonModel(
        lambda height, rate: height * np.exp(-rate * TIMES), {"height": (0.1, 5.0), "rate": (0.1, 5.0)}, ["x"], TIMES
    )
    found = da.likelihood(decay, DATA, noise="mixed")

    def density(height, rate, constant, relative):
        response = height * np.exp(-rate * TIMES)
        variance = constant**2 + (relative * response) ** 2
        return np.sum(-0.5 * (VALUES - response) ** 2 / variance - 0.5 * np.log(2 * np.pi * variance))

    there = np.array([1.7, 0.4, 0.2, 0.3])
    steps = there + 1e-30j * np.eye(4)
    expected = np.array([density(*row).imag / 1e-30 for row in steps])
    record_evidence("mixed noise: gradient of the log-likelihood by p, a and b", expected, found.linearise(there)[1],
                    tolerance=1e-12, relative=True, topic=TOPIC, kind="closed form",
                    source="complex step on the density of the normal distribution")  # fmt: skip


def test_an_estimated_input_has_no_attenuation(record_evidence):
    """A gain from an input and an output with noise: Deming's regression through the origin."""
    random = np.random.default_rng(5)
    force = np.sin(5 * TIMES) + 0.5 * np.cos(13 * TIMES)
    given = force + 0.4 * random.standard_normal(101)
    output = 2.0 * force + 0.1 * random.standard_normal(101)
    errors = da.input_errors("force", TIMES, deviation=0.4)
    gain = da.Parameter("gain", 0.1, 10.0)
    model = da.PythonModel(
        lambda gain, **known: gain * (given + errors.values(known)), [gain, *errors.parameters], ["x"], TIMES
    )
    fit = da.identify(model, da.Measurements.of(TIMES, {"x": output}, deviations=0.1), starts=1, horizon=None)
    ratio = (0.1 / 0.4) ** 2
    apart = output @ output - ratio * given @ given
    deming = (apart + np.sqrt(apart**2 + 4 * ratio * (given @ output) ** 2)) / (2 * given @ output)
    record_evidence("gain from noisy input and output", deming, fit.values[0], tolerance=1e-6, topic=TOPIC,
                    kind="closed form", source="W. E. Deming, Statistical adjustment of data, 1943")  # fmt: skip
    plain = (given @ output) / (given @ given)
    expected = 2.0 * (force @ force) / (force @ force + 101 * 0.16)
    record_evidence("gain with the input taken for exact: attenuation", expected, plain, tolerance=0.1, topic=TOPIC,
                    kind="closed form", source="W. A. Fuller, Measurement Error Models, 1987, section 1.1")  # fmt: skip
    assert abs(fit.values[0] - 2.0) < 3 * fit.deviations[0]
    assert plain < 1.8


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES, ids=[case.name for case in CASES])
def test_intervals_contain_the_truth(case, record_evidence):
    """Fewer seeds than `python -m benchmarks coverage`; the tolerance is three standard errors of a share."""
    seeds = 120
    found = covered(case, range(seeds), METHODS)
    tolerance = 3 * np.sqrt(LEVEL * (1 - LEVEL) / seeds)
    for (method, name), share in found.items():
        record_evidence(f"coverage of 95 % intervals by {method}, {name} of a decay, {case.name} noise", LEVEL, share,
                        tolerance=tolerance, topic=TOPIC, kind="known truth",
                        source=f"the definition of a confidence interval, {seeds} repetitions")  # fmt: skip
