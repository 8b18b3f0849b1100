"""A double pendulum that forgets its beginning: how often its parameters come back, by segments and without."""

import numpy as np
import pytest

import dalembert as da

TIMES = np.linspace(0, 10, 201)
CHANNELS = ["OA.end.angle", "AB.end.angle", "OA.end.rate", "AB.end.rate"]
TRUTH = np.array([2.0, 1.5, 0.0, 0.0, 0.02])
NOISE = 0.01  # rad
SEEDS = 5  # of the noise, and of where the search starts within the bounds
BOUNDS = {"angle1": (1.5, 2.5), "angle2": (1.0, 2.0), "rate1": (-1.0, 1.0), "rate2": (-1.0, 1.0), "drag": (0.0, 0.2)}
SHOOTING = da.MultipleShooting(
    {
        "angle1": da.ShootingState("OA.end.angle", -15, 15),
        "angle2": da.ShootingState("AB.end.angle", -40, 40),
        "rate1": da.ShootingState("OA.end.rate", -15, 15, rate_of="OA.end.angle"),
        "rate2": da.ShootingState("AB.end.rate", -15, 15, rate_of="AB.end.angle"),
    },
    segments=8,
)
WAYS = {"segments": {"shooting": SHOOTING}, "growing": {}, "whole": {"horizon": None}}


def pendulum(angle1, angle2, rate1, rate2, drag):
    system = da.System()
    oa = system.add(da.RigidBar("OA", length=1.0, mass=1.0, angle=angle1, angular_velocity=rate1))
    along = (-np.sin(angle1) * rate1, np.cos(angle1) * rate1)  # the velocity of the end of OA
    ab = system.add(
        da.RigidBar("AB", length=1.0, mass=1.0, angle=angle2, angular_velocity=rate2, start=oa.end, velocity=along)
    )
    system.add(da.RevoluteJoint("O", system.ground, oa.start, viscous=drag))
    system.add(da.RevoluteJoint("A", oa.end, ab.start, viscous=drag))
    return system


@pytest.mark.slow
def test_segments_find_what_one_run_does_not_from_every_start(record_evidence):
    model = da.TimeResponse(pendulum, BOUNDS, CHANNELS, TIMES, solver=da.GeneralizedAlpha(step=2e-3))
    exact, jacobian = model.linearise(TRUTH)
    assert np.linalg.norm(jacobian[-1, :, :4], 2) > 5e6  # what a small change of the state has grown by
    lower, upper = model.parameters.lower, model.parameters.upper
    found = dict.fromkeys(WAYS, 0)
    for seed in range(SEEDS):
        noisy = exact[:, :2] + NOISE * np.random.default_rng(seed).standard_normal((len(TIMES), 2))
        data = da.Measurements.of(TIMES, dict(zip(CHANNELS[:2], noisy.T, strict=True)), NOISE)
        start = lower + (upper - lower) * np.random.default_rng(50 + seed).random(5)
        for way, options in WAYS.items():
            fit = da.identify(model, data, start=start, starts=1, **options)
            noise_explains = "misfit-at-noise" in {item.code for item in fit.outcome}
            near = np.all(np.abs(fit.values - TRUTH) < 4 * fit.deviations)
            found[way] += noise_explains and near
    record_evidence(
        "share of starts from which a chaotic double pendulum is identified, by multiple shooting",
        1.0,
        found["segments"] / SEEDS,
        tolerance=0.0,
        topic="Identification of chaotic motion",
        kind="known truth",
        source="the true parameters, within four standard deviations and the noise of the data",
    )
    assert found["whole"] == 0
    assert found["growing"] < found["segments"]
