"""Chebyshev surrogates and bounds of polynomials against closed forms and published numbers."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.special import jv

from dalembert.surrogate import Adaptive, Tensor, TotalDegree, bounds, fit

TOPIC = "Chebyshev surrogates and bounds of polynomials"


def test_a_function_with_poles_converges_geometrically(record_evidence) -> None:
    """1/(1 + 25x²) has its poles at ±i/5: the error falls by ρ = (1 + √26)/5 a degree."""
    runge = lambda x: 1 / (1 + 25 * x**2)  # noqa: E731
    everywhere = np.linspace(-1, 1, 4001)[:, None]
    orders = np.arange(40, 101, 10)
    errors = [
        np.abs(fit(runge, [-1.0], [1.0], Tensor(int(order)))(everywhere) - runge(everywhere)).max() for order in orders
    ]
    record_evidence(
        "1/(1 + 25x²): decay of the interpolation error, logarithm a degree",
        np.log((1 + np.sqrt(26)) / 5),
        -np.polyfit(orders, np.log(errors), 1)[0],
        tolerance=2e-3,
        topic=TOPIC,
        kind="published",
        source="Trefethen, Approximation Theory and Approximation Practice, theorem 8.2",
    )


def test_coefficients_of_an_oscillation_are_bessel_functions(record_evidence) -> None:
    """cos(10x) = J_0(10) + 2 Σ (−1)^k J_2k(10) T_2k(x)."""
    found = fit(lambda x: np.cos(10 * x), [-1.0], [1.0], Tensor(40)).polynomial.coefficients[::2, 0]
    degrees = np.arange(0, 41, 2)
    record_evidence(
        "cos 10x: Chebyshev coefficients to degree 40",
        (2.0 - (degrees == 0)) * (-1.0) ** (degrees // 2) * jv(degrees, 10),
        found,
        tolerance=1e-14,
        topic=TOPIC,
        kind="closed form",
        source="Jacobi–Anger expansion, DLMF 10.12.2",
        noisy=True,
    )


@pytest.mark.parametrize(("phase", "tolerance"), [(5.0, 1e-4), (10.0, 1e-6), (20.0, 1e-6)])
def test_the_adaptive_order_is_the_one_that_the_phase_needs(record_evidence, phase: float, tolerance: float) -> None:
    """sin(phase·η + 1): the tail of its series of Bessel functions says from which degree on nothing is missing."""
    found = fit(lambda x: np.sin(phase * x + 1), [-1.0], [1.0], Adaptive(tolerance))
    left_out = 2 * np.cumsum(np.abs(jv(np.arange(100, 0, -1), phase)))[::-1]  # of degrees 1, 2 … and all above
    record_evidence(
        f"sin(ωt), phase spread by ±{phase:g}: degree for a tolerance of {tolerance:g}",
        int(np.argmax(left_out <= tolerance * found.scale[0])),
        float(found.polynomial.degrees[0]),
        tolerance=2,
        topic=TOPIC,
        kind="closed form",
        source="Jacobi–Anger expansion, DLMF 10.12",
    )


@pytest.mark.parametrize(
    ("directions", "order", "terms", "grid"), [(2, 2, 6, 16), (3, 2, 10, 27), (2, 4, 15, 36), (3, 3, 20, 64)]
)
def test_the_published_scheme_takes_two_runs_a_term(
    record_evidence, directions: int, order: int, terms: int, grid: int
) -> None:
    points = TotalDegree(order).points(directions)
    record_evidence(
        f"order {order} in {directions} parameters: runs, M = 2P",
        2 * terms,
        float(len(points)),
        tolerance=0,
        topic=TOPIC,
        kind="published",
        source="Guo & Jin 2025, equations (5)–(13), P = (p + d)!/(p! d!)",
    )
    sides = round(grid ** (1 / directions))
    assert len(np.unique(points, axis=0)) == 2 * terms
    np.testing.assert_allclose(np.cos(sides * np.arccos(points)), 0, atol=1e-12)  # roots of T_sides
    assert sides == order + 1 or (sides - 1) ** directions < 2 * terms


def camel(points: np.ndarray) -> np.ndarray:
    x, y = points[:, :1], points[:, 1:]
    return (4 - 2.1 * x**2 + x**4 / 3) * x**2 + x * y + (4 * y**2 - 4) * y**2


def goldstein_price(points: np.ndarray) -> np.ndarray:
    x, y = points[:, :1], points[:, 1:]
    return (1 + (x + y + 1) ** 2 * (19 - 14 * x + 3 * x**2 - 14 * y + 6 * x * y + 3 * y**2)) * (
        30 + (2 * x - 3 * y) ** 2 * (18 - 32 * x + 12 * x**2 + 48 * y - 36 * x * y + 27 * y**2)
    )


@pytest.mark.parametrize(
    ("function", "upper", "orders", "lowest", "largest"),
    [
        (camel, [3.0, 2.0], (6, 4), -1.0316284534898774, 162.9),
        (goldstein_price, [2.0, 2.0], (8, 8), 3.0, 1015690.2717980597),
    ],
)
def test_published_minima_of_polynomials_with_several_valleys(
    record_evidence, function: Callable, upper: list[float], orders: tuple[int, int], lowest: float, largest: float
) -> None:
    lower = -np.array(upper)
    polynomial = fit(function, lower, upper, Tensor(orders)).polynomial
    size = np.abs(polynomial.coefficients).sum()
    found = bounds(polynomial, lower, upper)
    enclosed = bounds(polynomial, lower, upper, "bernstein", gap=1e-10)
    record_evidence(
        f"{function.__name__.replace('_', ' ')} function: lowest value, relative to its range",
        lowest / size,
        found.lower[0] / size,
        tolerance=1e-13,
        topic=TOPIC,
        kind="published",
        source="Dixon & Szegő, Towards Global Optimisation 2 (1978)",
    )
    assert enclosed.lower[0] <= lowest
    assert lowest - enclosed.lower[0] <= 2e-10 * size
    assert enclosed.upper[0] >= found.upper[0]
    np.testing.assert_allclose(found.upper[0], largest, rtol=1e-6)
