"""Multiple shooting of a body on a ball joint: its states are director components and their rates."""

import numpy as np
import pytest

import dalembert as da
from dalembert.inverse import MultipleShooting
from dalembert.multibody.spatial import Inertia, RigidBody, SpatialSystem, SphericalJoint
from dalembert.report import figures

TIMES = np.linspace(0.0, 2.0, 41)
TRUE = np.array([0.4, 2.5, 3.0])
CHANNELS = [f"body.{point}.{axis}" for point in ("low", "side") for axis in "xyz"]


def build(length, wx, wy):
    system = SpatialSystem()
    body = system.add(
        RigidBody(
            "body",
            Inertia.box(2.0, (0.1, 0.06, 0.4)).moved((0.0, 0.0, -length / 2)),
            points={"low": (0.0, 0.0, -length), "side": (0.1, 0.0, -length)},
            angular_velocity=(wx, wy, 0.5),
        )
    )
    system.add(SphericalJoint("ball", system.ground, body.point("origin")))
    return system


@pytest.mark.slow
@pytest.mark.parametrize("start", [[0.42, 2.3, 3.2], [0.5, 4.0, 1.5]], ids=["near", "far"])
def test_it_finds_the_parameters(start):
    bounds = {"length": (0.3, 0.6), "wx": (0.0, 6.0), "wy": (0.0, 6.0)}
    model = da.TimeResponse(build, bounds, CHANNELS, TIMES, da.GeneralizedAlpha(step=5e-3))
    exact = model.evaluate(TRUE).only()[0]
    noisy = exact + 1e-3 * np.random.default_rng(1).standard_normal(exact.shape)
    data = da.Measurements.of(TIMES, dict(zip(CHANNELS, noisy.T, strict=True)))
    fit = da.identify(model, data, shooting=MultipleShooting(), starts=1, start=start)
    assert fit.success
    assert np.all(np.abs(fit.values - TRUE) < 4 * fit.deviations)
    assert fit.nodes is not None
    assert any(name.startswith("body.director ") for name in fit.nodes.states)
    assert "gaps" in figures(fit)
