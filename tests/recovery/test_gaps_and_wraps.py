"""Known truth behind an angle that a sensor gives modulo a turn, with a third of its samples lost."""

import numpy as np
import pytest

import dalembert as da

TIMES = np.linspace(0, 4, 161)
TRUTH = {"drag": 0.06, "speed": 14.0}


def spinning(drag, speed):
    """A bar on a pin that drags, thrown so fast that it turns over several times before it swings."""
    system = da.System()
    rod = system.add(da.RigidBar("rod", 0.8, mass=1.5, angle=-np.pi / 2, angular_velocity=speed))
    system.add(da.RevoluteJoint("pin", system.ground, rod.start, viscous=drag))
    return system


MODEL = da.TimeResponse(
    spinning,
    {"drag": (0.01, 0.3), "speed": (11.0, 17.0)},
    ["rod.end.angle"],
    TIMES,
    solver=da.GeneralizedAlpha(step=5e-3),
)


def sensor(noise, seed=0):
    exact = MODEL.evaluate(np.array([list(TRUTH.values())])).only()[0, :, 0]
    assert np.ptp(exact) > 4 * np.pi
    random = np.random.default_rng(seed)
    wrapped = (exact + noise * random.standard_normal(len(TIMES)) + np.pi) % (2 * np.pi) - np.pi
    wrapped[random.random(len(TIMES)) < 1 / 3] = np.nan
    return wrapped


@pytest.mark.parametrize(("noise", "within"), [(0.0, 1e-8), (0.02, 0.02)])
def test_drag_and_speed_come_back_from_a_wrapped_angle_with_gaps(noise, within):
    data = da.Measurements.of(TIMES, {"rod.end.angle": sensor(noise)}, missing="leave-out", wraps=["rod.end.angle"])
    fit = da.identify(MODEL, data, starts=3)
    assert fit.success, fit.status
    np.testing.assert_allclose(fit.values, list(TRUTH.values()), rtol=within)
    if noise:
        assert np.all(np.abs(fit.values - list(TRUTH.values())) < 4 * fit.deviations)


def test_through_a_file_in_degrees_and_milliseconds(tmp_path):
    path = tmp_path / "sensor.csv"
    angles = ["" if np.isnan(angle) else repr(angle) for angle in np.rad2deg(sensor(0.0)).tolist()]
    lines = [f"{1000 * time:.10g},{angle}" for time, angle in zip(TIMES, angles, strict=True)]
    path.write_text("\n".join(["ms,deg", *lines]))
    units = {"ms": "ms", "deg": "deg"}
    data = da.read(path, "ms", {"rod.end.angle": "deg"}, units=units, missing="leave-out", wraps=["rod.end.angle"])
    fit = da.identify(MODEL, data, starts=1)
    np.testing.assert_allclose(fit.values, list(TRUTH.values()), rtol=1e-7)
