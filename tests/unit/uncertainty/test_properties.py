"""What must hold for every smooth response: inner bounds inside estimates inside enclosures; wider box, wider bands."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from dalembert.forward import PythonModel
from dalembert.surrogate import Tensor
from dalembert.uncertainty import Chebyshev, LatinHypercube, MonteCarlo, propagate

POWERS = np.array([(i, j) for i in range(4) for j in range(4)])
SAMPLES = np.arange(3.0)
ANY = 1e9
"""Tolerance that refuses nothing: Tensor(3) holds a cubic exactly, however slowly its coefficients decay."""
COEFFICIENTS = arrays(float, (3, 16), elements=st.floats(-1, 1, width=32))
CENTRES = st.tuples(st.floats(-0.4, 0.4), st.floats(-0.4, 0.4))
RADII = st.tuples(st.floats(0.05, 0.5), st.floats(0.05, 0.5))


def cubic(coefficients):
    """Three samples, each a polynomial of degree three in both parameters, which Tensor(3) holds exactly."""
    return PythonModel(
        lambda x, y: coefficients @ (x ** POWERS[:, 0] * y ** POWERS[:, 1]),
        {"x": (-1.0, 1.0), "y": (-1.0, 1.0)},
        ["z"],
        SAMPLES,
    )


def box(centre, radius, share=1.0):
    return {
        name: (middle - share * size, middle + share * size)
        for name, middle, size in zip("xy", centre, radius, strict=True)
    }


@settings(max_examples=15, deadline=None)
@given(COEFFICIENTS, CENTRES, RADII)
def test_inner_bounds_lie_inside_estimates_and_these_inside_enclosures(coefficients, centre, radius):
    model, within = cubic(coefficients), box(centre, radius)
    estimate = propagate(model, within, Chebyshev(Tensor(3), tolerance=ANY))
    enclosure = propagate(model, within, Chebyshev(Tensor(3), tolerance=ANY, bounds="bernstein"))
    rounding = 1e-12
    for method in ("vertex", MonteCarlo(100), LatinHypercube(50), "optimise"):
        inner = propagate(model, within, method)
        assert np.all(inner.lower >= estimate.lower - rounding)
        assert np.all(inner.upper <= estimate.upper + rounding)
        assert np.all(inner.lower >= enclosure.lower - rounding)
        assert np.all(inner.upper <= enclosure.upper + rounding)
    assert np.all(enclosure.lower <= estimate.lower + rounding)
    assert np.all(enclosure.upper >= estimate.upper - rounding)


@settings(max_examples=15, deadline=None)
@given(COEFFICIENTS, CENTRES, RADII, st.floats(0.1, 0.9))
def test_a_wider_box_gives_wider_bands(coefficients, centre, radius, share):
    model = cubic(coefficients)
    for method in (Chebyshev(Tensor(3), tolerance=ANY), "optimise"):
        narrow = propagate(model, box(centre, radius, share), method)
        wide = propagate(model, box(centre, radius), method)
        slack = 1e-5 * np.max(wide.width) + 1e-12
        assert np.all(wide.lower <= narrow.lower + slack)
        assert np.all(wide.upper >= narrow.upper - slack)


@settings(max_examples=15, deadline=None)
@given(COEFFICIENTS, CENTRES, RADII)
def test_direct_optimisation_agrees_with_the_exact_surrogate(coefficients, centre, radius):
    model, within = cubic(coefficients), box(centre, radius)
    exact = propagate(model, within, Chebyshev(Tensor(3), tolerance=ANY))
    found = propagate(model, within, "optimise")
    least = 1e-5 * np.max(exact.width) + 1e-12
    np.testing.assert_allclose(found.lower, exact.lower, atol=least, rtol=0)
    np.testing.assert_allclose(found.upper, exact.upper, atol=least, rtol=0)
