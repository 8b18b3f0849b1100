"""Intervals of a spinning pendulum in space: bounds of its motion, intervals from bands, and sets from errors."""

import numpy as np
import pytest

import dalembert as da
from dalembert.multibody.spatial import Inertia, RigidBody, SpatialSystem, SphericalJoint

TIMES = np.linspace(0.0, 1.0, 21)
CHANNELS = ["body.low.x", "body.low.y", "body.low.z"]
SEARCHED = {"length": (0.3, 0.6), "spin": (0.0, 6.0)}
MIDDLE = np.array([0.45, 3.0])
LOWER, UPPER = 0.95 * MIDDLE, 1.05 * MIDDLE


def pendulum(length, spin):
    system = SpatialSystem(gravity=(0.0, 0.0, -9.81))
    inertia = Inertia.box(1.0, (0.1, 0.06, 0.3)).moved((0.0, 0.0, -length / 2))
    points = {"low": (0.0, 0.0, -length)}
    body = system.add(RigidBody("body", inertia, points=points, angular_velocity=(spin, 1.0, spin)))
    system.add(SphericalJoint("pivot", system.ground.point((0.0, 0.0, 0.0)), body.point("origin")))
    return system


MODEL = da.TimeResponse(pendulum, SEARCHED, CHANNELS, TIMES, da.GeneralizedAlpha(step=5e-3))


@pytest.fixture(scope="module")
def bands():
    box = dict(zip(SEARCHED, map(da.Interval, LOWER, UPPER), strict=True))
    return da.propagate(MODEL, box, da.Chebyshev(tolerance=1e-7))


def test_bounds_are_those_of_a_scan(bands):
    """The scan lies within the bounds; a fine one reaches them to the second order of its spacing."""
    grid = np.stack(np.meshgrid(*np.linspace(LOWER, UPPER, 13).T), axis=-1).reshape(-1, 2)
    runs = MODEL.evaluate(grid).only()
    assert np.all(runs >= bands.lower - 1e-6)
    assert np.all(runs <= bands.upper + 1e-6)
    np.testing.assert_allclose(bands.lower, runs.min(axis=0), atol=1e-4)
    np.testing.assert_allclose(bands.upper, runs.max(axis=0), atol=1e-4)


def test_intervals_come_back_from_their_bands(bands):
    found = da.identify_bands(MODEL, bands)
    np.testing.assert_allclose(found.box.lower, LOWER, rtol=1e-5)
    np.testing.assert_allclose(found.box.upper, UPPER, rtol=1e-5)


def test_a_set_contains_the_parameters_of_the_data_and_excludes_others():
    motion = MODEL.evaluate(MIDDLE).only()[0]
    data = da.Measurements.of(TIMES, dict(zip(CHANNELS, motion.T, strict=True)))
    found = da.identify_set(MODEL, data, error=2e-3)
    assert found.contains(np.array([MIDDLE, LOWER, UPPER])).tolist() == [1.0, 0.0, 0.0]
    assert np.all(np.abs(found.outer.middle - MIDDLE) < found.outer.radius)
