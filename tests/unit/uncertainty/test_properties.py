"""What must hold for every smooth response: inner bounds inside estimates inside enclosures; wider box, wider bands."""

import numpy as np
import pytest
from hypothesis import example, given, settings
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
CONSTANTS = np.eye(1, 16) * np.array([[0.7720018029212952], [-0.4425056874752045], [-0.3822852671146393]])
"""The fit leaves traces of their rounding in all other terms, which no enclosure is to resolve."""


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
@example(CONSTANTS, (-0.36, 0.33), (0.31, 0.07))
@example(CONSTANTS, (0.21, -0.28), (0.44, 0.28))
@example(CONSTANTS, (-0.12, 0.4), (0.19, 0.13))
def test_inner_bounds_lie_inside_estimates_and_these_inside_enclosures(coefficients, centre, radius):
    """The optimised polynomial may miss a valley between the points of its scan, which is a part of its width."""
    model, within = cubic(coefficients), box(centre, radius)
    estimate = propagate(model, within, Chebyshev(Tensor(3), tolerance=ANY))
    enclosure = propagate(model, within, Chebyshev(Tensor(3), tolerance=ANY, bounds="bernstein"))
    rounding, valley = 1e-12, 1e-3 * np.max(estimate.width) + 1e-12
    for method in ("vertex", MonteCarlo(100), LatinHypercube(50), "optimise"):
        inner = propagate(model, within, method)
        assert np.all(inner.lower >= estimate.lower - valley)
        assert np.all(inner.upper <= estimate.upper + valley)
        assert np.all(inner.lower >= enclosure.lower - rounding)
        assert np.all(inner.upper <= enclosure.upper + rounding)
    assert np.all(enclosure.lower <= estimate.lower + rounding)
    assert np.all(enclosure.upper >= estimate.upper - rounding)


@settings(max_examples=15, deadline=None)
@given(COEFFICIENTS, CENTRES, RADII, st.floats(0.1, 0.9))
def test_a_wider_box_gives_wider_bands(coefficients, centre, radius, share):
    model = cubic(coefficients)
    for method, slack in (
        (Chebyshev(Tensor(3), tolerance=ANY), 1e-3),
        (Chebyshev(Tensor(3), tolerance=ANY, bounds="bernstein"), 1e-5),
    ):
        narrow = propagate(model, box(centre, radius, share), method)
        wide = propagate(model, box(centre, radius), method)
        least = slack * np.max(wide.width) + 2 * np.max(narrow.error) + 1e-12
        assert np.all(wide.lower <= narrow.lower + least)
        assert np.all(wide.upper >= narrow.upper - least)


@pytest.mark.parametrize("seed", range(40))
def test_direct_optimisation_finds_the_extremes_of_random_cubics(seed):
    """Against a dense scan; and a wider box gives wider bands."""
    random = np.random.default_rng(seed)
    coefficients = random.uniform(-1, 1, (3, 16)) * (random.random((3, 16)) < 0.4)
    centre, radius = random.uniform(-0.4, 0.4, 2), random.uniform(0.05, 0.6, 2)
    found = propagate(cubic(coefficients), box(centre, radius), "optimise")
    x, y = (middle + size * np.linspace(-1, 1, 201) for middle, size in zip(centre, radius, strict=True))
    scan = np.polynomial.polynomial.polygrid2d(x, y, coefficients.reshape(3, 4, 4).transpose(1, 2, 0)).reshape(3, -1)
    least = 1e-5 * np.max(np.ptp(scan, axis=1)) + 1e-12
    assert np.all(found.lower[:, 0] <= scan.min(axis=1) + least)
    assert np.all(found.upper[:, 0] >= scan.max(axis=1) - least)
    narrow = propagate(cubic(coefficients), box(centre, radius, 0.7), "optimise")
    assert np.all(found.lower <= narrow.lower + least)
    assert np.all(found.upper >= narrow.upper - least)
