"""Enclosures whose boxes would not settle: constants with a trace of something else, and flat valleys."""

import tracemalloc

import numpy as np
import pytest

from dalembert.surrogate import ChebyshevPolynomial, bernstein, bounds


@pytest.fixture
def halved(monkeypatch) -> list[int]:
    """Parts of boxes that were halved at once, one number a time."""
    numbers, halve = [], bernstein._halved

    def counting(cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        numbers.append(len(cells))
        assert 2 * cells.size <= bernstein.CHUNK
        return halve(cells)

    monkeypatch.setattr(bernstein, "_halved", counting)
    return numbers


def with_terms(directions: int, terms: dict[tuple[int, ...], float]) -> ChebyshevPolynomial:
    """One output on [−1, 1]^directions, Chebyshev coefficients by their degrees."""
    return ChebyshevPolynomial(
        -np.ones(directions), np.ones(directions), np.array(list(terms)), np.array(list(terms.values()))[:, None]
    )


def square_of_sum(directions: int) -> ChebyshevPolynomial:
    """(Σ x_k)², smallest on the whole of Σ x_k = 0."""
    unit = np.eye(directions, dtype=int)
    terms = {(0,) * directions: directions / 2}
    for k in range(directions):
        terms[tuple(2 * unit[k])] = 0.5
        terms |= {tuple(unit[k] + unit[j]): 2.0 for j in range(k)}
    return with_terms(directions, terms)


@pytest.mark.parametrize(
    ("constant", "traces", "centre", "radius"),
    [
        (-0.3, {(2, 1): -1e-15}, (0.1, 0.22), (0.33, 0.46)),
        (-0.4, {(2, 1): 1e-13}, (0.13, -0.2), (0.4, 0.15)),
        (0.6, {(1, 3): 1e-32, (3, 1): 1e-55}, (-0.26, -0.24), (0.38, 0.06)),
        (0.7, {(2, 1): 1e-15}, (-0.05, 0.02), (0.38, 0.29)),
        (0.3, {(0, 2): 1e-15, (0, 3): 3e-32, (1, 0): 1e-16, (1, 3): 3e-16, (2, 1): 1e-16}, (0.0, 0.0), (1.0, 1.0)),
        (0.0, {(1, 1): 1e-310, (3, 3): -5e-324}, (0.0, 0.1), (1.0, 0.2)),
    ],
)
def test_a_constant_with_a_trace_of_something_else_is_settled_at_once(constant, traces, centre, radius, halved) -> None:
    """What rounding makes of a constant is no valley to look for; all parts of the box would stay open."""
    polynomial = with_terms(2, {(0, 0): constant} | traces)
    box = np.subtract(centre, radius), np.add(centre, radius)
    found, optimised = bounds(polynomial, *box, "bernstein"), bounds(polynomial, *box)
    slack = 3 * sum(map(abs, traces.values())) + 1e-12 * abs(constant) + 1e-300
    assert constant - slack < found.lower[0] <= optimised.lower[0]
    assert constant + slack > found.upper[0] >= optimised.upper[0]
    assert sum(halved) < 100


def test_a_valley_flat_in_many_directions_costs_bounded_memory_and_sharpness_alone(halved) -> None:
    """(Σ x_k)² in five directions: a gap of 10⁻⁶ would ask for some 10¹¹ parts of the box."""
    polynomial = square_of_sum(5)
    box = -np.ones(5), np.ones(5)
    tracemalloc.start()
    found = bounds(polynomial, *box, "bernstein")
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 12 * 8 * bernstein.CHUNK
    assert max(halved) > bernstein.CHUNK // 3**5 // 8  # it did fill the memory
    assert -2.0 < found.lower[0] <= 0.0
    assert bounds(polynomial, *box, "bernstein", gap=np.inf).lower[0] < found.lower[0]
    assert found.upper[0] == pytest.approx(25.0)


def test_many_outputs_share_the_memory_and_are_bounded_as_each_alone(halved, monkeypatch) -> None:
    monkeypatch.setattr(bernstein, "CHUNK", 20_000)
    flat = square_of_sum(3)
    shifts = np.linspace(-1, 1, 30)
    coefficients = np.where(np.all(flat.exponents == 0, axis=1)[:, None], shifts, 0.0) + flat.coefficients
    many = ChebyshevPolynomial(flat.lower, flat.upper, flat.exponents, coefficients)
    together = bounds(many, flat.lower, flat.upper, "bernstein", gap=1e-3)
    for output in (0, 13, 29):
        single = ChebyshevPolynomial(flat.lower, flat.upper, flat.exponents, coefficients[:, [output]])
        alone = bounds(single, flat.lower, flat.upper, "bernstein", gap=1e-3)
        np.testing.assert_allclose(together.lower[output], alone.lower[0], atol=1e-13)
        np.testing.assert_allclose(together.upper[output], alone.upper[0], atol=1e-13)
    assert np.all(together.lower <= shifts)
    assert max(halved) * 27 * 4 > bernstein.CHUNK


def test_a_flat_line_is_as_sharp_as_was_asked_for(halved) -> None:
    """(x + y)² and (x − 1/4)², smallest along a line."""
    for polynomial in (square_of_sum(2), with_terms(2, {(0, 0): 0.5625, (1, 0): -0.5, (2, 0): 0.5})):
        found = bounds(polynomial, [-0.9, -0.8], [0.7, 1.0], "bernstein")
        varying = np.abs(polynomial.coefficients[1:]).sum()
        assert -1.01e-6 * varying < found.lower[0] <= 0.0
    assert max(halved) < 10_000
