"""Sobol indices of Chebyshev surrogates against closed forms."""

import numpy as np
import pytest
from scipy.stats import qmc

from dalembert.surrogate import Adaptive, ChebyshevPolynomial, Tensor, TotalDegree, fit, sobol_indices
from dalembert.surrogate.sobol import in_legendre

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


def test_a_function_with_kinks(record_evidence):
    """Its surrogate converges slowly; the intervals of the indices contain the true ones."""
    a = np.array([0.0, 1.0, 4.5])
    surrogate = fit(
        lambda x: np.prod((np.abs(4 * x - 2) + a) / (1 + a), axis=1)[:, None],
        [0.0] * 3,
        [1.0] * 3,
        Tensor((40, 40, 40)),
    )
    found = sobol_indices(surrogate)
    parts = 1 / (3 * (1 + a) ** 2)
    whole = np.prod(1 + parts) - 1
    total = np.array([part * np.prod(1 + np.delete(parts, k)) for k, part in enumerate(parts)]) / whole
    for quantity, reference, ours, ends in (
        ("first-order indices", parts / whole, found.first[:, 0], found.first_ends[:, :, 0]),
        ("total indices", total, found.total[:, 0], found.total_ends[:, :, 0]),
    ):
        record_evidence(
            f"Sobol's g-function (kinks), {quantity}", reference, ours, tolerance=1e-2, topic=TOPIC, kind="closed form",
            source=SOBOL_G,
        )  # fmt: skip
        assert np.all((ends[0] <= reference) & (reference <= ends[1]))
    assert found.uncertainty[0] > 1e-2  # the error of the surrogate is stated, not hidden


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
    degrees, coefficients = in_legendre(polynomial)
    x = random.uniform(-1.0, 1.0, (20, 3))
    basis = np.ones((20, len(degrees)))
    for k in range(3):
        table = np.polynomial.legendre.legvander(x[:, k], 5) * np.sqrt(2 * np.arange(6) + 1)
        basis *= table[:, degrees[:, k]]
    np.testing.assert_allclose(basis @ coefficients, polynomial(x), atol=1e-12)
