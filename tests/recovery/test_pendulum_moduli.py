"""Two Young's moduli of a flexible double pendulum behind many false minima, from far starts and through noise."""

import numpy as np
import pytest

import dalembert as da

TRUTH = np.array([2e8, 2e7])  # Pa
TIMES = np.linspace(0, 2, 41)
CHANNELS = ("OA.end.x", "OA.end.y", "AB.end.x", "AB.end.y")
NOISE = 0.01  # m


def pendulum(e_oa, e_ab):
    system = da.System()
    section = {"height": 0.4, "width": 0.2, "density": 5540.0}
    oa = system.add(da.AncfCable("OA", length=1.0, elements=2, youngs_modulus=e_oa, angle=-np.pi / 4, **section))
    ab = system.add(
        da.AncfCable("AB", length=2.0, elements=4, youngs_modulus=e_ab, angle=-np.pi / 6, start=oa.end, **section)
    )
    system.add(da.RevoluteJoint("O", system.ground, oa.start))
    system.add(da.RevoluteJoint("A", oa.end, ab.start))
    return system


def model(factors):
    start = TRUTH * factors
    parameters = [
        da.Parameter(name, truth / 50, truth * 50, unit="Pa", scale=first, start=first)
        for name, truth, first in zip(("e_oa", "e_ab"), TRUTH, start, strict=True)
    ]
    solver = da.GeneralizedAlpha(step=5e-4, spectral_radius=0.8)
    return da.TimeResponse(pendulum, parameters, CHANNELS, TIMES, solver=solver)


def measured(noise, seed=0):
    exact = model((1, 1)).evaluate(TRUTH[None]).only()[0]
    noisy = exact + noise * np.random.default_rng(seed).standard_normal(exact.shape)
    return da.Measurements.of(TIMES, dict(zip(CHANNELS, noisy.T, strict=True)), noise or None)


@pytest.mark.slow
@pytest.mark.parametrize("factors", [(2.0, 0.5), (5.0, 0.2)])
def test_exact_motion_gives_both_moduli(factors):
    fit = da.identify(model(factors), measured(0.0))
    np.testing.assert_allclose(fit.values, TRUTH, rtol=1e-7)
    assert fit.simulations < 100


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("factors", [(2.0, 0.5), (5.0, 0.2)])
def test_noisy_motion_gives_a_minimum_no_worse_than_the_one_beside_the_truth(factors, seed):
    data = measured(NOISE, seed)
    beside = da.identify(model((1, 1)), data, starts=1, horizon=None)
    fit = da.identify(model(factors), data)
    assert fit.misfit < beside.misfit + 0.5  # half a variance of the noise: what no data can tell
