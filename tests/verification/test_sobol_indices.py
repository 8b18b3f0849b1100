"""Sobol indices of Chebyshev surrogates against closed forms."""

import numpy as np
import pytest
from scipy import stats
from scipy.stats import qmc

import dalembert as da
from dalembert.surrogate import Adaptive, ChebyshevPolynomial, Tensor, TotalDegree, fit, sobol_indices
from dalembert.surrogate.orthonormal import orthonormal

TOPIC = "Sobol indices"
A, B = 7.0, 0.1
ISHIGAMI = "Ishigami and Homma (1990), a = 7, b = 0.1: variances of sin x1 + a sin² x2 + b x3⁴ sin x1"
SOBOL_G = "Sobol, product of (|4x − 2| + a)/(1 + a): V_i = 1/(3 (1 + a_i)²), V = Π (1 + V_i) − 1"


def ishigami(x):
    return (np.sin(x[:, 0]) + A * np.sin(x[:, 1]) ** 2 + B * x[:, 2] ** 4 * np.sin(x[:, 0]))[:, None]


def test_ishigami(record_evidence):
    found = sobol_indices(fit(ishigami, [-np.pi] * 3, [np.pi] * 3, Adaptive(1e-8)))
    first = 0.5 * (1 + B * np.pi**4 / 5) ** 2
    third = 8 * B**2 * np.pi**8 / 225
    whole = A**2 / 8 + B * np.pi**4 / 5 + B**2 * np.pi**8 / 18 + 0.5
    for quantity, reference, ours in (
        ("variance", whole, found.variance[0]),
        ("first-order indices", np.array([first, A**2 / 8, 0.0]) / whole, found.first[:, 0]),
        ("total indices", np.array([first + third, A**2 / 8, third]) / whole, found.total[:, 0]),
    ):
        record_evidence(
            f"Ishigami function, {quantity}", reference, ours, tolerance=1e-6, topic=TOPIC, kind="closed form",
            source=ISHIGAMI,
        )  # fmt: skip
    assert found.uncertainty[0] < 1e-5
    for ends, exact in (
        (found.first_ends, [first, A**2 / 8, 0.0]),
        (found.total_ends, [first + third, A**2 / 8, third]),
    ):
        assert np.all(ends[0, :, 0] <= np.array(exact) / whole)
        assert np.all(np.array(exact) / whole <= ends[1, :, 0])


G = np.array([0.0, 1.0, 4.5])
G_MODEL = da.PythonModel(
    lambda x1, x2, x3: np.prod([(abs(4 * x - 2) + a) / (1 + a) for x, a in zip((x1, x2, x3), G, strict=True)])[None],
    dict.fromkeys(("x1", "x2", "x3"), (0.0, 1.0)),
    ["y"],
    np.zeros(1),
)


@pytest.mark.slow
def test_a_function_with_kinks(record_evidence):
    """Its surrogate converges slowly. Random runs show how exact the indices are all the same."""
    parts = 1 / (3 * (1 + G) ** 2)
    whole = np.prod(1 + parts) - 1
    total = np.array([part * np.prod(1 + np.delete(parts, k)) for k, part in enumerate(parts)]) / whole
    found = da.global_sensitivity(G_MODEL, None, Tensor((20, 20, 20)), tolerance=0.01, checks=1000)
    for quantity, reference, ours in (
        ("first-order indices", parts / whole, found.aggregated_first[0]),
        ("total indices", total, found.aggregated_total[0]),
    ):
        record_evidence(
            f"Sobol's g-function (kinks), {quantity}", reference, ours, tolerance=1e-2, topic=TOPIC, kind="closed form",
            source=SOBOL_G,
        )  # fmt: skip
        assert np.abs(reference - ours).max() < found.uncertainty[0] < 1e-2


def test_a_tolerance_that_kinks_do_not_allow_is_refused():
    refused = r"uncertain by 0\.\d+, more than the tolerance of 0\.001\. Improve .* Monte Carlo: scipy\.stats\.sobol_indices\."
    with pytest.raises(da.SolveError, match=refused):
        da.global_sensitivity(G_MODEL, None, Tensor((6, 6, 6)), tolerance=1e-3)


def test_the_advised_monte_carlo_estimates_the_indices_of_a_function_with_kinks(record_evidence):
    found = stats.sobol_indices(
        func=lambda points: G_MODEL.evaluate(points.T).values[:, :, 0].T, n=1024, dists=[stats.uniform(0.0, 1.0)] * 3,
        rng=np.random.default_rng(1),
    )  # fmt: skip
    parts = 1 / (3 * (1 + G) ** 2)
    whole = np.prod(1 + parts) - 1
    for quantity, reference, ours in (
        ("first-order indices", parts / whole, np.ravel(found.first_order)),
        ("total indices", parts / (1 + parts) * (1 + whole) / whole, np.ravel(found.total_order)),
    ):
        record_evidence(
            f"Sobol's g-function (kinks) by Monte Carlo, {quantity}", reference, ours, tolerance=2e-2, topic=TOPIC,
            kind="closed form", source=SOBOL_G, noisy=True,
        )  # fmt: skip


def test_inputs_with_normal_and_log_normal_distributions(record_evidence):
    """y = a + b c with normal a and b, and log-normal c: moments of products of independent factors."""
    priors = {"a": da.Normal(0.0, 0.5), "b": da.Normal(1.0, 0.2), "c": da.LogNormal(1.0, 0.1)}
    wide = {"a": (-9.0, 9.0), "b": (-9.0, 9.0), "c": (1e-3, 9.0)}
    model = da.PythonModel(lambda a, b, c: np.array([a + b * c]), wide, ["y"], np.zeros(1))
    found = da.global_sensitivity(model, priors)
    mean, square = np.exp(0.5 * 0.1**2), np.exp(2 * 0.1**2)
    of_c = square - mean**2
    whole = 0.5**2 + (1 + 0.2**2) * square - mean**2
    for quantity, reference, ours in (
        ("first-order indices", np.array([0.5**2, 0.2**2 * mean**2, of_c]) / whole, found.aggregated_first[0]),
        ("total indices", np.array([0.5**2, 0.2**2 * square, of_c * (1 + 0.2**2)]) / whole, found.aggregated_total[0]),
    ):
        record_evidence(
            f"sum and product of normal and log-normal inputs, {quantity}", reference, ours, tolerance=5e-4,
            topic=TOPIC, kind="closed form", source="variances of sums and products; tails of 1e-5 are cut off",
        )  # fmt: skip


@pytest.mark.slow
def test_salib_estimates_the_same_indices(record_evidence):
    """Saltelli's estimator of another program, on a motion over time."""
    saltelli, sobol = pytest.importorskip("SALib.sample.sobol"), pytest.importorskip("SALib.analyze.sobol")
    times = np.linspace(0.0, 3.0, 7)
    box = {"frequency": (3.0, 3.5), "damping": (0.1, 0.5), "amplitude": (0.9, 1.1)}

    def swing(frequency, damping, amplitude):
        return amplitude * np.exp(-damping * times) * np.cos(frequency * times)

    found = da.global_sensitivity(da.PythonModel(swing, box, ["x"], times), box)
    problem = {"num_vars": 3, "names": list(box), "bounds": list(map(list, box.values()))}
    points = saltelli.sample(problem, 2**14, calc_second_order=False, seed=1)
    values = np.array([swing(*point) for point in points])
    theirs = [
        sobol.analyze(problem, values[:, k], calc_second_order=False, num_resamples=2, seed=1) for k in range(1, 7)
    ]
    for quantity, key, ours in (("first-order", "S1", found.first), ("total", "ST", found.total)):
        record_evidence(
            f"damped oscillation, {quantity} indices at 6 times", np.array([one[key] for one in theirs]), ours[1:, 0],
            tolerance=1e-2, topic=TOPIC, kind="other code", source="SALib, Saltelli's estimator from 81,920 runs",
            noisy=True,
        )  # fmt: skip


@pytest.mark.parametrize("scheme", [Tensor(4), TotalDegree(4), Adaptive(1e-6)], ids=["tensor", "total", "adaptive"])
def test_variance_and_indices_agree_with_sampling(scheme):
    def function(x):
        return np.stack([x[:, 0] * x[:, 1] + x[:, 2], np.ones(len(x)), x[:, 1] ** 3], axis=1)

    found = sobol_indices(fit(function, [0.0, -1.0, 2.0], [1.0, 2.0, 2.5], scheme))
    x = qmc.scale(qmc.Sobol(3, seed=1).random_base2(14), [0.0, -1.0, 2.0], [1.0, 2.0, 2.5])
    np.testing.assert_allclose(found.mean, function(x).mean(axis=0), rtol=1e-3)
    np.testing.assert_allclose(found.variance, function(x).var(axis=0), rtol=2e-3, atol=1e-12)
    np.testing.assert_allclose(found.first[:, 2], [0.0, 1.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(found.first[2, 0], (0.25 / 12) / found.variance[0], rtol=1e-6)


def test_the_change_of_the_basis_keeps_the_values():
    random = np.random.default_rng(2)
    exponents = np.unique(random.integers(0, 6, (30, 3)), axis=0)
    polynomial = ChebyshevPolynomial([-1.0] * 3, [1.0] * 3, exponents, random.standard_normal((len(exponents), 2)))
    expansion = orthonormal(polynomial)
    x = random.uniform(-1.0, 1.0, (20, 3))
    basis = np.ones((20, len(expansion.exponents)))
    for k in range(3):
        table = np.polynomial.legendre.legvander(x[:, k], 5) * np.sqrt(2 * np.arange(6) + 1)
        basis *= table[:, expansion.exponents[:, k]]
    np.testing.assert_allclose(basis @ expansion.coefficients, polynomial(x), atol=1e-12)
    for rows, table in expansion.tables(x):
        np.testing.assert_allclose(table, basis[rows], atol=1e-12)


@pytest.mark.parametrize("spread", [0.5, 1.0, 1.2])
def test_tails_that_are_cut_off_are_within_the_stated_uncertainty(spread, record_evidence):
    """A log-normal and a normal input of the same variance: half of the variance each."""
    variance = np.expm1(spread**2) * np.exp(spread**2)
    model = da.PythonModel(lambda a, b: [a + b], {"a": (1e-9, 1e9), "b": (-1e9, 1e9)}, ["x"], np.array([0.0]))
    found = da.global_sensitivity(model, {"a": da.LogNormal(1.0, spread), "b": da.Normal(0.0, np.sqrt(variance))})
    record_evidence(
        f"log-normal input of the spread {spread:g}: first-order index, to the stated uncertainty", 0.5,
        found.aggregated_first[0, 0], tolerance=1.001 * found.uncertainty[0] / 0.5, topic=TOPIC, kind="closed form",
        source="variance of the log-normal distribution",
    )  # fmt: skip


def test_tails_that_matter_more_than_the_tolerance_are_refused():
    model = da.PythonModel(lambda a, b: [a + b], {"a": (1e-9, 1e9), "b": (-1e9, 1e9)}, ["x"], np.array([0.0]))
    with pytest.raises(da.SolveError) as refused:
        da.global_sensitivity(model, {"a": da.LogNormal(1.0, 1.5), "b": da.Normal(0.0, 9.0)})
    assert str(refused.value) == (
        "global_sensitivity: the distribution of 'a' has 0.11 of its variance in tails beyond [0.00167, 600], which "
        "leaves the indices of channel 'x' uncertain by 0.03, more than the tolerance of 0.02. Give the parameter "
        "narrower bounds, or a distribution with lighter tails."
    )
