"""Responses are at the time stamps, not a step late: damping comes back, and readings one step late would bias it."""

import numpy as np

import dalembert as da

MASS, STIFFNESS, DAMPING, FREE, START = 1.0, 30.0, 0.05, 1.0, 1.2  # kg, N/m, N s/m, m, m
STEP = 0.02  # s, between two samples
TIMES = np.arange(1, 251) * STEP
SOLVER = da.GeneralizedAlpha(step=1e-3, spectral_radius=1.0)


def oscillator(damping, stiffness):
    system = da.System(gravity=(0.0, 0.0))
    bob = system.add(da.PointMass("bob", mass=MASS, position=(START, 0.0)))
    wall = system.ground.point(0.0, 0.0)
    system.add(da.Spring("spring", wall, bob.centre, stiffness=stiffness, damping=damping, free_length=FREE))
    return system


PARAMETERS = {"damping": (0.0, 1.0), "stiffness": (20.0, 40.0)}
MODEL = da.TimeResponse(oscillator, PARAMETERS, ["bob.centre.x"], TIMES, solver=SOLVER)


def motion(times):
    """The closed form of the free vibration."""
    decay = DAMPING / (2 * MASS)
    own = np.sqrt(STIFFNESS / MASS - decay**2)
    away = np.exp(-decay * times) * (np.cos(own * times) + decay / own * np.sin(own * times))
    return FREE + (START - FREE) * np.where(times < 0, 1.0, away)


def measured(readings, times=TIMES):
    return da.Measurements.of(times, {"bob.centre.x": readings})


def test_damping_is_recovered_from_the_motion_at_the_time_stamps():
    fit = da.identify(MODEL, measured(motion(TIMES)))
    np.testing.assert_allclose(fit.values, [DAMPING, STIFFNESS], rtol=1e-4)


def test_readings_one_step_late_bias_the_damping_and_leave_residuals():
    """What a model whose outputs came one step late would do to good data, the other way round."""
    late, good = (da.identify(MODEL, measured(motion(TIMES - lag))) for lag in (STEP, 0.0))
    assert late.values[0] > 1.03 * DAMPING
    assert late.values[1] < 0.99 * STIFFNESS
    assert late.misfit > 1e9 * good.misfit
    assert "systematic-residuals" in {finding.code for finding in late.findings}


def test_an_unknown_delay_gain_and_offset_are_told_apart_from_the_mechanism():
    fine = da.TimeResponse(oscillator, PARAMETERS, ["bob.centre.x"], np.arange(0, 1001) * 5e-3, solver=SOLVER)
    sensor = da.Sensor(delay=(0.0, 0.05), gain=(0.5, 2.0), offset=(-0.5, 0.5), at_rest=True)
    seen = da.Sensors(fine, {"bob.centre.x": sensor}, TIMES)
    fit = da.identify(seen, measured(1.1 * motion(TIMES - 0.0273) - 0.2))
    np.testing.assert_allclose(fit.values, [DAMPING, STIFFNESS, 0.0273, 1.1, -0.2], rtol=1e-4)
